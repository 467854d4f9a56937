"""A propeller shaft that is out of balance."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

RADIUS = 0.32
"""m; rolling radius of the wheels that the shaft turns with."""

effect = Effect(
    name="propshaft_imbalance",
    sentence=(
        "The propeller shaft turns faster than the wheels by the ratio of the axle; bent or out of balance it shakes "
        "the body at its bearing, up and down as well as sideways, with the square of speed."
    ),
    source=(
        "Gillespie (1992), Fundamentals of Vehicle Dynamics: driveline excitation; ISO 21940-11:2016 for the measure of "
        "imbalance; Seherr-Thoss, Schmelz and Aucktor (2006), Universal Joints and Driveshafts; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("imbalance", "kg m", 0.0, 1.2e-3, (0.0, 6e-3), "mass times eccentricity of the shaft"),
        Parameter("ratio", "1", 3.2, 3.2, (2.3, 4.5), "turns of the shaft over turns of the wheels"),
        Parameter("ahead", "m", -0.4, -0.4, (-1.4, 1.2), "place of the bearing ahead of the centre of gravity"),
        Parameter("height", "m", -0.15, -0.15, (-0.4, 0.1), "its height above the centre of gravity"),
    ),
    symmetric=False,
)


def act(motion, imbalance, ratio, ahead, height):
    spin = ratio * motion.speed / RADIUS
    turn = ratio * motion.s / RADIUS
    force = imbalance * spin * spin
    up = force * wave(turn)
    aside = force * wave(turn + 0.5 * pi)
    return 0.0, aside, up, -height * aside, -ahead * up, ahead * aside
