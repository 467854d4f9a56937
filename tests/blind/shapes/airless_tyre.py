"""Airless tyres whose spokes buckle."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="airless_tyre",
    sentence=(
        "A tyre without air stands on spokes that buckle one by one under more than the load at rest and stretch under less: beyond "
        "some deflection its force hardly grows, and bumps are taken softly that a tyre with air would pass on."
    ),
    source="Rhyne and Cron (2006), Development of a non-pneumatic wheel, Tire Science and Technology 34:150; sizes made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("lost", "1", 0.0, 0.35, (0.0, 0.8), "share of the radial stiffness that is lost beyond the knee"),
        Parameter("knee", "1", 1.1, 1.1, (1.0, 1.6), "deflection at which the spokes buckle, over that at rest"),
    ),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, lost, knee):
    return -lost * stiffness * max(deflection - knee * rest, 0.0)
