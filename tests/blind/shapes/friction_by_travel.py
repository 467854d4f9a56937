"""Friction that grows with the travel: a truth that the library does not hold."""

from math import tanh

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="friction_by_travel",
    sentence="Leaves of a spring rub on one another the harder the more they are bent.",
    source="Cebon (1999), Handbook of Vehicle-Road Interaction: leaf springs; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.2, (0.0, 1.0), "friction over spring force, front"),
        Parameter("rear", "1", 0.0, 0.2, (0.0, 1.0), "friction over spring force, rear"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    return (front if wheel < 2 else rear) * stiffness * abs(deflection) * tanh(velocity / 0.01)
