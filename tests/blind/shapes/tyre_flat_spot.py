"""Tyres with a flat from standing or from a locked brake."""

from math import floor, pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

PHASE = 2.4
"""rad from wheel to wheel; the golden angle, by which no two wheels ever turn in step."""

effect = Effect(
    name="tyre_flat_spot",
    sentence=(
        "A tyre has a flat where it stood for long or slid on a locked brake: once a turn the road falls away "
        "under it for a short while."
    ),
    source=(
        "Pottinger (2005), Uniformity: a crucial attribute of tire/vehicle systems, in The Pneumatic Tire (NHTSA DOT HS "
        "810 561): flat spots; Gillespie (1992), Fundamentals of Vehicle Dynamics; made for blind trials"
    ),
    port="tyre_vertical",
    parameters=(
        Parameter("front", "m", 0.0, 1e-3, (0.0, 5e-3), "depth of the flat of a front tyre"),
        Parameter("rear", "m", 0.0, 1e-3, (0.0, 5e-3), "depth of the flat of a rear tyre"),
        Parameter("half", "rad", 0.25, 0.25, (0.15, 0.6), "half of the angle that the flat takes"),
    ),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, front, rear, half):
    depth = front if wheel < 2 else rear
    turns = (rotation + PHASE * wheel) / (2.0 * pi)
    away = 2.0 * pi * abs(turns - floor(turns) - 0.5)
    if away >= half:
        return 0.0
    missing = depth * 0.5 * (1.0 + wave(pi * (away / half + 0.5)))
    return -stiffness * min(missing, max(deflection, 0.0))
