"""Tyres that stiffen as they are pressed."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_progression",
    sentence=(
        "The load of a tyre grows faster than its deflection. The deflection at rest stays as it is, and no force is "
        "left when the tyre lifts off."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: load as a second-degree polynomial of deflection",
    port="tyre_vertical",
    parameters=(
        Parameter("progression", "1/m", 0.0, 3.5, (0.0, 15.0), "growth of load over deflection, relative, per metre"),
    ),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, progression):
    return stiffness * progression * deflection * (deflection - rest)
