"""A coil spring whose end coil has broken off at one corner."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="broken_coil",
    sentence=(
        "The end coil of one spring has broken off: fewer coils work and this corner alone is stiffer. The height at "
        "rest is taken as set again."
    ),
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis: rate over number of working coils; sizes made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front_left", "1", 0.0, 0.25, (0.0, 0.6), "growth of the front left rate, relative"),
        Parameter("rear_right", "1", 0.0, 0.0, (0.0, 0.6), "growth of the rear right rate, relative"),
    ),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front_left, rear_right):
    share = 0.0
    if wheel == 0:
        share = front_left
    elif wheel == 3:
        share = rear_right
    return share * stiffness * deflection
