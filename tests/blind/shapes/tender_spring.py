"""A soft tender spring in series with the main one, coil-bound at rest."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tender_spring",
    sentence=(
        "A soft tender spring stacked on the main spring is coil-bound at rest and opens in rebound, from where on the "
        "two in series are much softer than the main spring alone."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics: springs in series; sizes made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.4, (0.0, 0.8), "share of the front rate that is lost once the tender spring is open"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 0.8), "share of the rear rate that is lost once the tender spring is open"),
        Parameter("gap", "m", 0.004, 0.004, (0.0, 0.03), "rebound from rest at which the tender spring opens"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, gap):
    share = front if wheel < 2 else rear
    return share * stiffness * max(-deflection - gap, 0.0)
