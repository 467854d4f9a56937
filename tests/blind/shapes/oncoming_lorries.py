"""The bow waves of lorries that come the other way."""

from math import exp, floor

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import AIR_DENSITY

SLOWEST = 3.0
"""m/s; a car that crawls meets its lorries as one at this speed does."""

TAIL = 0.4
"""Strength of the wake that closes behind a lorry over that of its bow wave."""

LONG = 15.0
"""m; length of a lorry."""

effect = Effect(
    name="oncoming_lorries",
    sentence=(
        "A lorry that comes on the other lane pushes the car away with its bow wave and at once sucks it back, first at "
        "the nose and then at the tail; its own tail does the same again, weaker and the other way round."
    ),
    source=(
        "Noger, Regardin and Szechenyi (2005), Investigation of the transient aerodynamic phenomena associated with "
        "passing manoeuvres, Journal of Fluids and Structures 21; Hucho (1998), Aerodynamics of Road Vehicles; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("area", "m2", 0.0, 1.5, (0.0, 4.0), "side area of the car times the coefficient of the bow wave"),
        Parameter("pace", "m/s", 22.0, 22.0, (10.0, 28.0), "speed of the lorries"),
        Parameter("spacing", "m", 300.0, 300.0, (100.0, 3000.0), "way of the car from lorry to lorry"),
        Parameter("width", "m", 3.0, 3.0, (1.5, 6.0), "distance from the bow at which it pushes most"),
        Parameter("height", "m", 0.15, 0.15, (-0.2, 0.6), "height of the force above the centre of gravity"),
    ),
    symmetric=False,
)


def act(motion, area, pace, spacing, width, height):
    ahead = spacing * (0.5 - (motion.s / spacing + 1.0 / 6.0 - floor(motion.s / spacing + 1.0 / 6.0)))
    bow = ahead * (1.0 + pace / max(motion.speed, SLOWEST))
    strength = 0.25 * AIR_DENSITY * area * pace * pace
    front = (bow - motion.front) / width
    rear = (bow - motion.rear) / width
    front_tail, rear_tail = front + LONG / width, rear + LONG / width
    # Traffic keeps right: the lorry is on the left and pushes to the right while its bow is still ahead.
    nose = -strength * (front * exp(0.5 - 0.5 * front * front) - TAIL * front_tail * exp(0.5 - 0.5 * front_tail * front_tail))
    stern = -strength * (rear * exp(0.5 - 0.5 * rear * rear) - TAIL * rear_tail * exp(0.5 - 0.5 * rear_tail * rear_tail))
    side = nose + stern
    return 0.0, side, 0.0, -height * side, 0.0, motion.front * nose + motion.rear * stern
