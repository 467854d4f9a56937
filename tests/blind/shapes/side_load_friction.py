"""Friction of struts that are bent by the forces of their tyres."""

from math import sqrt

from ridecomfort.effects.contract import Effect, Parameter

EDGE = 0.002
"""m/s over which the force turns with the direction of motion."""

STICKING = 20000.0
"""N s/m; what does not slide is no stiffer damper than this, which a wheel can follow at a step of 1 ms."""

effect = Effect(
    name="side_load_friction",
    sentence=(
        "Side and braking forces of a tyre bend its strut, whose rod and piston rub in proportion: in bends and under "
        "braking the suspension sticks, straight ahead it is free."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: side load and friction of McPherson struts; Dixon "
        "(2007), The Shock Absorber Handbook; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.12, (0.0, 0.6), "friction over horizontal force of the tyre, front"),
        Parameter("rear", "1", 0.0, 0.08, (0.0, 0.6), "friction over horizontal force of the tyre, rear"),
    ),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    friction = (front if wheel < 2 else rear) * sqrt(force_x * force_x + force_y * force_y)
    return friction * min(max(velocity / (EDGE + friction / STICKING), -1.0), 1.0)
