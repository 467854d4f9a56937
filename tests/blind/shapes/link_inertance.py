"""Masses that turn as a wheel travels."""

from ridecomfort.effects.contract import Effect, Parameter

SMOOTHING = 0.005
"""s; over which the acceleration of the travel is taken."""

effect = Effect(
    name="link_inertance",
    sentence=(
        "Arms, drive shafts, a roll bar's ends and the oil in the ducts of a damper have to be set in motion as a wheel "
        "travels: a force in proportion to the acceleration of the travel, on wheel and body alike."
    ),
    source="Smith (2002), Synthesis of mechanical networks: the inerter, IEEE Transactions on Automatic Control 47; Dixon (2007), The Shock Absorber Handbook: inertia of the fluid; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "kg", 0.0, 4.0, (0.0, 30.0), "inertance of one front corner, at the wheel"),
        Parameter("rear", "kg", 0.0, 6.0, (0.0, 30.0), "inertance of one rear corner, at the wheel"),
    ),
    states=("smooth",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, smooth, front, rear):
    acceleration = (velocity - smooth) / SMOOTHING
    return (front if wheel < 2 else rear) * acceleration, acceleration
