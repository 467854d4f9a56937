"""Tyres that are not round."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import PHASE, wave

effect = Effect(
    name="tyre_runout",
    sentence="The radius of a tyre changes once a turn, which acts like a road that rises and falls with every turn.",
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="road",
    parameters=(
        Parameter("front", "m", 0.0, 3e-4, (0.0, 1.5e-3), "amplitude of the radius of the front tyres"),
        Parameter("rear", "m", 0.0, 3e-4, (0.0, 1.5e-3), "amplitude of the radius of the rear tyres"),
    ),
    symmetric=False,
)


def act(wheel, u, v, height, rotation, surface, elevation, front, rear):
    amplitude = front if wheel < 2 else rear
    return amplitude * wave(rotation + PHASE * wheel)
