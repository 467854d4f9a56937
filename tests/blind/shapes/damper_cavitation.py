"""Dampers whose oil tears off in fast bump."""

from ridecomfort.effects.contract import Effect, Parameter

WIDTH = 0.0008
"""m of void over which a damper loses its grip."""

DISSOLVING = 0.4
"""s in which a void is filled again without any motion."""

effect = Effect(
    name="damper_cavitation",
    sentence=(
        "In fast bump too little oil passes the piston and a void is left above it: the rebound that follows meets no "
        "damping until its stroke has closed the void."
    ),
    source=(
        "Dixon (2007), The Shock Absorber Handbook: cavitation; Duym, Stiens and Reybrouck (1997), Evaluation of shock "
        "absorber models, Vehicle System Dynamics 27; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.7, (0.0, 1.0), "share of the damping that is lost over a void, front"),
        Parameter("rear", "1", 0.0, 0.7, (0.0, 1.0), "share of the damping that is lost over a void, rear"),
        Parameter("critical", "m/s", 0.04, 0.04, (0.01, 0.5), "speed of bump beyond which a void grows"),
    ),
    states=("void",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, void, front, rear, critical):
    share = front if wheel < 2 else rear
    size = max(void, 0.0)
    growth = max(velocity - critical, 0.0) - void / DISSOLVING
    if velocity < 0.0:
        growth += velocity * min(size / WIDTH, 1.0)
        return -share * damping * velocity * size / (size + WIDTH), growth
    return 0.0, growth
