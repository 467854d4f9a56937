"""Dampers that a controller makes firm after much travel."""

from ridecomfort.effects.contract import Effect, Parameter

ATTACK = 0.01
"""s; valve and controller."""

effect = Effect(
    name="adaptive_damper",
    sentence=(
        "A controlled damper goes firm as soon as its wheel has travelled beyond a threshold and stays so for a while "
        "before it comes back to soft."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook: adaptive damping; Savaresi et al. (2010), Semi-Active Suspension Control Design for Vehicles; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.6, (0.0, 2.0), "damping that a front damper gains when firm, over that when soft"),
        Parameter("rear", "1", 0.0, 0.6, (0.0, 2.0), "damping that a rear damper gains when firm, over that when soft"),
        Parameter("threshold", "m", 0.012, 0.012, (0.004, 0.05), "travel at which a damper begins to go firm"),
        Parameter("hold", "s", 0.7, 0.7, (0.1, 3.0), "time in which it comes back to soft"),
    ),
    states=("peak",),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, peak, front, rear, threshold, hold):
    gain = front if wheel < 2 else rear
    firm = min(max(2.0 * (peak - threshold) / threshold, 0.0), 1.0)
    travel = abs(deflection)
    slope = (travel - peak) / (ATTACK if travel > peak else hold)
    return gain * firm * damping * velocity, slope
