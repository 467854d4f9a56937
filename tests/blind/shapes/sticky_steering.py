"""Steering that sticks and then jumps."""

from ridecomfort.effects.contract import Effect, Parameter

SLIDING = 0.02
"""s in which the wheels jump to the angle asked for."""

TURNING = 0.005
"""s in which sticking gives way to sliding, and back."""

CAUGHT = 0.15
"""Angle left at which a rack that slides sticks again, over that at which it breaks away."""

effect = Effect(
    name="sticky_steering",
    sentence=(
        "A dry rack or a worn servo sticks around where it is: small corrections do nothing until their sum breaks it away, "
        "then the wheels jump to the whole of the angle asked for and stick there."
    ),
    source=(
        "Pfeffer and Harrer (2017), Steering Handbook: friction of steering gears; Armstrong-Helouvry, Dupont and Canudas de Wit "
        "(1994), Automatica 30: stick-slip; sizes made for blind trials"
    ),
    port="steer",
    parameters=(
        Parameter("stick", "rad", 0.0, 0.0012, (0.0, 0.006), "angle of the front wheels that has to come together before they move"),
    ),
    states=("followed", "sliding"),
)


def act(angle, speed, force_y, followed, sliding, stick):
    ahead = angle - followed
    limit = stick * (1.0 - (1.0 - CAUGHT) * sliding)
    wanted = min(max((abs(ahead) - limit) / (0.1 * stick + 1e-6) + 0.5, 0.0), 1.0)
    held = min(max(ahead, -1.1 * stick), 1.1 * stick)
    return angle - held, (ahead - held) / TURNING + sliding * held / SLIDING, (wanted - sliding) / TURNING
