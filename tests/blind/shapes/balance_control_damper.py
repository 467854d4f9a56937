"""Dampers that are switched so as to balance the spring."""

from math import sqrt

from ridecomfort.effects.contract import Effect, Parameter

SCALE = 0.0002
"""m2/s; product of travel and speed over which the controller turns from hard to soft."""

effect = Effect(
    name="balance_control_damper",
    sentence=(
        "A switched damper is firm while a wheel comes back to its place of rest, when its force takes away that of the "
        "spring, and soft while the wheel leaves it, when both would push the body the same way."
    ),
    source=(
        "Rakheja and Sankar (1985), Vibration and shock isolation performance of a semi-active on-off damper, ASME Journal of "
        "Vibration, Acoustics, Stress, and Reliability in Design 107:398; Savaresi et al. (2010), Semi-Active Suspension "
        "Control Design for Vehicles; sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.5, (0.0, 0.9), "share of the damping that a soft front damper lacks"),
        Parameter("rear", "1", 0.0, 0.5, (0.0, 0.9), "share of the damping that a soft rear damper lacks"),
        Parameter("valve", "s", 0.012, 0.012, (0.005, 0.05), "time in which the valve follows"),
    ),
    states=("soft",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, soft, front, rear, valve):
    outward = deflection * velocity
    wanted = 0.5 * (1.0 + outward / sqrt(outward * outward + SCALE * SCALE))
    return -(front if wheel < 2 else rear) * damping * soft * velocity, (wanted - soft) / valve
