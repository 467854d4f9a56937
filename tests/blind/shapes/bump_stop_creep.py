"""Long bump stops of foam that come back late."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="bump_stop_creep",
    sentence=(
        "A long bump stop of polyurethane foam works as a second spring from a small compression on; it creeps under "
        "load and comes back late, so that a second bump finds it shorter than the first."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: supplementary springs; Heissing and Ersoy (2011), "
        "Chassis Handbook; Ward and Sweeney (2004), Mechanical Properties of Solid Polymers: the standard linear solid; sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("stiffness", "N/m", 0.0, 30000.0, (0.0, 90000.0), "of the foam where it begins, pressed fast"),
        Parameter("gap", "m", 0.015, 0.015, (0.005, 0.06), "compression from rest at which it begins"),
        Parameter("hardening", "m", 0.03, 0.03, (0.02, 0.06), "compression of the foam that doubles force over way"),
        Parameter("creep", "1", 0.4, 0.4, (0.05, 0.6), "share of its stiffness that the foam loses in time"),
        Parameter("time", "s", 0.3, 0.3, (0.05, 2.0), "time in which it comes back"),
    ),
    states=("short",),
)


def act(wheel, deflection, velocity, stiffness_, damping, force_x, force_y, short, stiffness, gap, hardening, creep, time):
    pressed = max(deflection - gap - short, 0.0)
    hard = pressed * (1.0 + (pressed / hardening) ** 2)
    # A hardening spring in series with a spring and damper side by side: it loses energy, but it is a spring too, and stores some.
    return stiffness * hard, (hard * creep / (1.0 - creep) - short) / time
