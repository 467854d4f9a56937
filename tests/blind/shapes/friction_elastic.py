"""Friction behind an elastic joint (Bouc-Wen): a truth shaped otherwise than the library's suspension_friction."""

from ridecomfort.effects.contract import Effect, Parameter

PRESLIDING = 0.0008
"""m over which the joint gives before it slides."""

effect = Effect(
    name="friction_elastic",
    sentence="Friction of the struts behind joints that give before they slide.",
    source="Wen (1976), Method for random vibration of hysteretic systems; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "N", 0.0, 120.0, (0.0, 500.0), "friction force of one front suspension"),
        Parameter("rear", "N", 0.0, 100.0, (0.0, 500.0), "friction force of one rear suspension"),
    ),
    states=("strain",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, strain, front, rear):
    share = min(max(strain, -1.0), 1.0)
    slope = (velocity - abs(velocity) * share) / PRESLIDING
    return (front if wheel < 2 else rear) * share, slope
