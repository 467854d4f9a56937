"""Wheels whose centre of mass lies off their axle."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import PHASE, wave

effect = Effect(
    name="wheel_imbalance",
    sentence=(
        "A wheel whose centre of mass lies off its axle shakes with a force that turns with it and grows with the "
        "square of speed. Its vertical part acts here."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics; ISO 21940-11:2016 for the measure of imbalance",
    port="tyre_vertical",
    parameters=(
        Parameter("front", "kg m", 0.0, 0.01, (0.0, 0.05), "mass times eccentricity of a front wheel"),
        Parameter("rear", "kg m", 0.0, 0.01, (0.0, 0.05), "mass times eccentricity of a rear wheel"),
    ),
    symmetric=False,
    also_returns=("shake",),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, front, rear):
    imbalance = front if wheel < 2 else rear
    return 0.0, imbalance * spin * spin * wave(rotation + PHASE * wheel)
