"""The wake of a lorry ahead."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave
from ridecomfort.vocabulary import AIR_DENSITY

STROUHAL = 0.2
"""Frequency of the shedding times the width of the lorry over the speed."""

NOSE = 0.8
"""m by which the force lies ahead of the centre of gravity."""

effect = Effect(
    name="lorry_wake",
    sentence=(
        "A car that follows a lorry drives in its wake: eddies leave the lorry's flanks by turns and buffet the nose from side to "
        "side and, less, up and down, some twice a second and the faster the faster both drive."
    ),
    source=(
        "Hucho (1998), Aerodynamics of Road Vehicles: unsteady wakes; Watkins and Vino (2008), The effect of vehicle spacing on the "
        "aerodynamics of a representative car shape, Journal of Wind Engineering and Industrial Aerodynamics 96:1232; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("area", "m2", 0.0, 0.8, (0.0, 4.0), "side area of the car times the swing of its side-force coefficient"),
        Parameter("width", "m", 2.5, 2.5, (1.5, 3.0), "width of the lorry"),
        Parameter("lift", "1", 0.5, 0.5, (0.0, 1.0), "swing of the lift over that of the side force"),
        Parameter("height", "m", 0.1, 0.1, (-0.2, 0.5), "height of the side force above the centre of gravity"),
    ),
    states=("phase",),
    symmetric=False,
)


def act(motion, phase, area, width, lift, height):
    pressure = 0.5 * AIR_DENSITY * area * motion.speed * motion.speed
    # No wake is regular: three eddies of frequencies that never come round together.
    side = 0.6 * pressure * (wave(phase) + 0.7 * wave(0.618 * phase + 1.0) + 0.5 * wave(1.732 * phase + 2.0))
    up = 0.6 * lift * pressure * (wave(2.0 * phase + 0.5) + 0.6 * wave(1.414 * phase + 3.0))
    return 0.0, side, up, -height * side, -NOSE * up, NOSE * side, 2.0 * pi * STROUHAL * motion.speed / width
