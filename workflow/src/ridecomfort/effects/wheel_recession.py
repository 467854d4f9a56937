"""Wheels that move back, or forward, as they rise."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="wheel_recession",
    sentence=(
        "Links that are inclined seen from the side lead a wheel back as it rises: its inertia and its tyre push fore and "
        "aft with every bump, and driving and braking forces lift or lower the body."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics; Heissing and Ersoy (2011), Chassis Handbook",
    port="kinematics",
    parameters=(
        Parameter("front", "1", 0.0, 0.1, (-0.4, 0.4), "way back of a front wheel per compression"),
        Parameter("rear", "1", 0.0, 0.1, (-0.4, 0.4), "way back of a rear wheel per compression"),
    ),
)


def act(wheel, deflection, front, rear):
    return front if wheel < 2 else rear, 0.0, 0.0
