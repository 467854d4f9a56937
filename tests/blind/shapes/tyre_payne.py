"""Rubber that is stiffer to small motion."""

from ridecomfort.effects.contract import Effect, Parameter

FASTEST = 500.0
"""1/s; how fast the filler is broken up at most, so that a step of 1 ms can follow."""

effect = Effect(
    name="tyre_payne",
    sentence=(
        "The filler in the rubber of a tyre holds together while it is deformed a little and breaks up in larger "
        "motion: the tyre is stiffer to small unevenness, and turns back along another line than it came."
    ),
    source="Payne (1962), The dynamic properties of carbon black-loaded natural rubber vulcanizates; Pacejka (2012), Tire and Vehicle Dynamics; made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("share", "1", 0.0, 0.35, (0.0, 1.0), "stiffness that is gained in small motion, over that in large motion"),
        Parameter("travel", "m", 0.003, 0.003, (0.0005, 0.006), "deflection in which the filler breaks up"),
    ),
    states=("held",),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, held, share, travel):
    if deflection <= -rest:
        return 0.0, -held / 0.01
    pace = min(max(velocity, -FASTEST * travel), FASTEST * travel)
    return share * stiffness * held, pace - abs(pace) * held / travel
