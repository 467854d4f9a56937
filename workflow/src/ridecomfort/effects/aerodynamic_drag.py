"""Drag of the air."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import AIR_DENSITY

effect = Effect(
    name="aerodynamic_drag",
    sentence="The air holds the body back with a force that grows with the square of speed.",
    source="Hucho (1998), Aerodynamics of Road Vehicles; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="body",
    parameters=(
        Parameter("area", "m2", 0.0, 0.66, (0.0, 2.0), "drag coefficient times frontal area"),
        Parameter("height", "m", 0.0, 0.0, (-0.5, 0.8), "height of the force above the centre of gravity"),
    ),
    dissipative=True,
)


def act(motion, area, height):
    force = -0.5 * AIR_DENSITY * area * motion.speed * abs(motion.speed)
    return force, 0.0, 0.0, 0.0, height * force, 0.0
