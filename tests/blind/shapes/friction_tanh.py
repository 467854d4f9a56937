"""Friction that turns smoothly: a truth shaped otherwise than the library's suspension_friction."""

from math import tanh

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="friction_tanh",
    sentence="Friction of the struts that grows over some speed before it holds its level.",
    source="made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "N", 0.0, 120.0, (0.0, 500.0), "friction force of one front suspension"),
        Parameter("rear", "N", 0.0, 100.0, (0.0, 500.0), "friction force of one rear suspension"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    return (front if wheel < 2 else rear) * tanh(velocity / 0.02)
