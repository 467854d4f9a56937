"""Tyres that have worn to three lobes."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

PHASE = 1.7
"""rad from wheel to wheel."""

effect = Effect(
    name="polygonised_tyre",
    sentence=(
        "A tyre that has worn in lobes (heel and toe, scalloping) is stiffer at three places of its circumference: its "
        "radial force varies three times a turn, in proportion to its deflection."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics: higher harmonics of radial force variation; sizes made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("front", "1", 0.0, 0.02, (0.0, 0.1), "amplitude of the radial stiffness of a front tyre, relative"),
        Parameter("rear", "1", 0.0, 0.02, (0.0, 0.1), "amplitude of the radial stiffness of a rear tyre, relative"),
    ),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, front, rear):
    share = front if wheel < 2 else rear
    return share * stiffness * max(deflection, 0.0) * wave(3.0 * rotation + PHASE * wheel)
