"""Wind from the side, steady and in gusts."""

from math import pi, sin, sqrt

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import AIR_DENSITY

effect = Effect(
    name="crosswind",
    sentence=(
        "Wind across the road pushes the body aside ahead of its centre of gravity. Its gusts lie along the road as "
        "buildings and gaps in the hedge do."
    ),
    source="Hucho (1998), Aerodynamics of Road Vehicles; ISO 12021:2010 for the response to crosswind",
    port="body",
    parameters=(
        Parameter("wind", "m/s", 0.0, 5.0, (-15.0, 15.0), "speed of the steady wind, positive blowing to the left"),
        Parameter("gust", "m/s", 0.0, 4.0, (-8.0, 8.0), "amplitude of the gusts"),
        Parameter("length", "m", 60.0, 60.0, (15.0, 500.0), "distance from gust to gust"),
        Parameter("area", "m2", 5.0, 5.0, (2.0, 20.0), "growth of side-force coefficient with angle, times frontal area"),
        Parameter("lever", "m", 0.5, 0.5, (-0.5, 1.5), "distance of the force ahead of the centre of gravity"),
    ),
    symmetric=False,
)


def act(motion, wind, gust, length, area, lever):
    across = wind + gust * sin(2.0 * pi * motion.s / length)
    force = 0.5 * AIR_DENSITY * area * across * sqrt(motion.speed * motion.speed + across * across)
    return 0.0, force, 0.0, 0.0, 0.0, lever * force
