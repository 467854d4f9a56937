"""Dampers whose valves open: degressive beyond a knee."""

from math import copysign

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_knee",
    sentence=(
        "Beyond a knee the valves of a damper open and its force grows more slowly, so that fast motion of the "
        "wheels is damped less than the slow motion of the body."
    ),
    source="Dixon (2007), The Shock Absorber Handbook; Heissing and Ersoy (2011), Chassis Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.6, (0.0, 0.9), "share of the damping that is lost beyond the knee, front"),
        Parameter("rear", "1", 0.0, 0.6, (0.0, 0.9), "share of the damping that is lost beyond the knee, rear"),
        Parameter("knee", "m/s", 0.1, 0.1, (0.03, 0.5), "speed of the knee, at the wheel"),
    ),
    also_sees=("damper",),
    also_returns=("damper",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, damper, front, rear, knee):
    share = front if wheel < 2 else rear
    return 0.0, damper - share * damping * copysign(max(abs(velocity) - knee, 0.0), velocity)
