"""Rear struts that pump themselves up."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="self_pumping_strut",
    sentence=(
        "Self-levelling rear struts pump oil against their gas with every stroke: on a rough stretch they lift the tail and "
        "go hard, on a smooth one oil leaks back and they sink and go soft."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: self-levelling struts (Nivomat); Causemann (2003), Kraftfahrzeugstossdaempfer; "
        "made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("hardening", "1", 0.0, 0.5, (0.0, 2.5), "rate that a strut gains when pumped up, over that of its spring"),
        Parameter("lift", "N", 0.0, 250.0, (0.0, 1500.0), "force that a strut gains when pumped up"),
        Parameter("stroke", "m", 0.4, 0.4, (0.1, 3.0), "way of strokes in which it is pumped up"),
        Parameter("leak", "s", 4.0, 4.0, (1.0, 30.0), "time in which it sinks"),
    ),
    states=("pumped",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, pumped, hardening, lift, stroke, leak):
    if wheel < 2:
        return 0.0, 0.0
    gain = (1.0 - pumped) * abs(velocity) / stroke - pumped / leak
    return pumped * (lift + hardening * stiffness * deflection), gain
