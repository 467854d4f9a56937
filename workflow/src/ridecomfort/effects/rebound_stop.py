"""Rebound stops that the suspension meets when it is drawn out."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="rebound_stop",
    sentence="Stops inside the dampers hold the wheels back once the suspension is drawn out by more than a clearance.",
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Dixon (2007), The Shock Absorber Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "N/m", 0.0, 150000.0, (0.0, 400000.0), "stiffness of one front stop, at the wheel"),
        Parameter("rear", "N/m", 0.0, 150000.0, (0.0, 400000.0), "stiffness of one rear stop, at the wheel"),
        Parameter("clearance_front", "m", 0.06, 0.06, (0.02, 0.15), "rebound from rest at which a front stop is met"),
        Parameter("clearance_rear", "m", 0.06, 0.06, (0.02, 0.15), "rebound from rest at which a rear stop is met"),
    ),
)


def act(
    wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, clearance_front, clearance_rear
):
    if wheel < 2:
        return front * min(deflection + clearance_front, 0.0)
    return rear * min(deflection + clearance_rear, 0.0)
