"""Snow or gravel that gives way under a wheel and does not come back."""

from ridecomfort.effects.contract import Effect, Parameter

RADIUS = 0.318
"""m; of the wheels."""

YIELDING = 0.006
"""s in which the ground is pressed down."""

effect = Effect(
    name="soft_ground",
    sentence=(
        "A layer of snow or gravel is pressed down at once under a wheel that bears more and stays down; a wheel that bears less rises "
        "only as it rolls on to what has not been pressed. Peaks of load are cut, and energy is lost. The ruts at rest belong to the road."
    ),
    source=(
        "Bekker (1969), Introduction to Terrain-Vehicle Systems, and Wong (2008), Theory of Ground Vehicles: pressure, sinkage and "
        "unloading; law and sizes made for blind trials"
    ),
    port="tyre_vertical",
    parameters=(
        Parameter("depth", "m", 0.0, 0.006, (0.0, 0.02), "sinkage at rest"),
        Parameter("length", "m", 0.3, 0.3, (0.1, 1.0), "way on which a wheel that bears less comes up"),
    ),
    states=("sunk",),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, sunk, depth, length):
    pressed = max((deflection - sunk) / rest, 0.0) - 1.0
    gap = depth * pressed - sunk
    rate = 1.0 / YIELDING if gap > 0.0 else min(abs(spin) * RADIUS / length, 1.0 / YIELDING)
    return -stiffness * sunk, gap * rate
