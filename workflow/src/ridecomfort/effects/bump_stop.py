"""Bump stops that the suspension meets when it is compressed."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="bump_stop",
    sentence="Elastic stops add their stiffness once the suspension is compressed by more than a clearance.",
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Heissing and Ersoy (2011), Chassis Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "N/m", 0.0, 80000.0, (0.0, 400000.0), "stiffness of one front stop, at the wheel"),
        Parameter("rear", "N/m", 0.0, 80000.0, (0.0, 400000.0), "stiffness of one rear stop, at the wheel"),
        Parameter("clearance_front", "m", 0.03, 0.03, (0.01, 0.1), "compression from rest at which a front stop is met"),
        Parameter("clearance_rear", "m", 0.04, 0.04, (0.01, 0.12), "compression from rest at which a rear stop is met"),
    ),
)


def act(
    wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, clearance_front, clearance_rear
):
    if wheel < 2:
        return front * max(deflection - clearance_front, 0.0)
    return rear * max(deflection - clearance_rear, 0.0)
