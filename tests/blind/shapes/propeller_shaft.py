"""A propeller shaft that is bent: a truth that the library does not hold."""

from math import sin

from ridecomfort.effects.contract import Effect, Parameter

TURN = 0.8
"""m that the car drives in a turn of the shaft."""

effect = Effect(
    name="propeller_shaft",
    sentence="A shaft along the car that is out of balance shakes the body, with the square of its speed.",
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics: driveline excitation; made for blind trials",
    port="body",
    parameters=(Parameter("imbalance", "kg m", 0.0, 0.003, (0.0, 0.05), "mass times eccentricity of the shaft"),),
    symmetric=False,
)


def act(motion, imbalance):
    turns = 6.283185307 / TURN
    force = imbalance * (turns * motion.speed) ** 2 * sin(turns * motion.s)
    return 0.0, 0.0, force, 0.0, 0.4 * force, 0.0
