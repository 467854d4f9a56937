"""Springs that stiffen as they are compressed."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="spring_progression",
    sentence=(
        "A progressive spring is stiffer the more it is compressed, and softer in rebound: its rate changes in "
        "proportion to the deflection from rest, and is never negative."
    ),
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Heissing and Ersoy (2011), Chassis Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "1/m", 0.0, 4.0, (0.0, 12.0), "relative growth of the front rate per metre of compression"),
        Parameter("rear", "1/m", 0.0, 6.0, (0.0, 12.0), "relative growth of the rear rate per metre of compression"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    growth = front if wheel < 2 else rear
    if growth * deflection < -1.0:
        return -stiffness * (deflection + 0.5 / growth)
    return 0.5 * stiffness * growth * deflection * deflection
