"""Lift of the air at the axles."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import AIR_DENSITY

effect = Effect(
    name="aerodynamic_lift",
    sentence="The air lifts the body at the axles with a force that grows with the square of speed.",
    source="Hucho (1998), Aerodynamics of Road Vehicles; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="body",
    parameters=(
        Parameter("front", "m2", 0.0, 0.15, (-0.8, 0.8), "front lift coefficient times frontal area"),
        Parameter("rear", "m2", 0.0, 0.2, (-0.8, 0.8), "rear lift coefficient times frontal area"),
    ),
)


def act(motion, front, rear):
    pressure = 0.5 * AIR_DENSITY * motion.speed * motion.speed
    moment = -pressure * (front * motion.front + rear * motion.rear)
    return 0.0, 0.0, pressure * (front + rear), 0.0, moment, 0.0
