"""Steering with play."""

from ridecomfort.effects.contract import Effect, Parameter

FOLLOWING = 0.005
"""s; in which the wheels follow once the play is taken up."""

effect = Effect(
    name="steering_play",
    sentence=(
        "Worn joints and a worn rack let the steering wheel turn a little before the wheels follow, in both directions: "
        "small corrections come to nothing, larger ones come short."
    ),
    source="Pfeffer and Harrer (2017), Steering Handbook: play and hysteresis; made for blind trials",
    port="steer",
    parameters=(Parameter("play", "rad", 0.0, 0.002, (0.0, 0.015), "half of the play, at the front wheels"),),
    states=("followed",),
)


def act(angle, speed, force_y, followed, play):
    ahead = angle - followed
    taken = min(max(ahead, -play), play)
    return angle - taken, (ahead - taken) / FOLLOWING
