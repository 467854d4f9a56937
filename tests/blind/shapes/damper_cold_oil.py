"""Dampers whose oil is cold at the start and is warmed by what they take up."""

from math import exp

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_cold_oil",
    sentence=(
        "Cold oil is thick: at the start of a winter drive the dampers are too hard, and every bump that they take up "
        "warms them, the sooner the rougher the road."
    ),
    source=(
        "Dixon (2007), The Shock Absorber Handbook: temperature and viscosity; Ramos, Rivas, Biera, Sacramento and Sala "
        "(2005), Development of a thermal model for automotive twin-tube shock absorbers, Applied Thermal Engineering 25; sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "N s/m", 0.0, 900.0, (0.0, 3000.0), "further damping of a cold damper, front"),
        Parameter("rear", "N s/m", 0.0, 900.0, (0.0, 3000.0), "further damping of a cold damper, rear"),
        Parameter("warming", "N m", 8000.0, 8000.0, (1000.0, 40000.0), "work that leaves 1/e of it"),
    ),
    states=("work",),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, work, front, rear, warming):
    cold = front if wheel < 2 else rear
    further = cold * exp(-max(work, 0.0) / warming)
    return further * velocity, (damping + further) * velocity * velocity
