"""Steering that gives way to the side force."""

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.02
"""s; time constant of rack and linkage giving way."""

effect = Effect(
    name="steering_compliance",
    sentence="Rack, linkage and bushings give way to the side force of the front tyres, which turns them out of the bend.",
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics; Pacejka (2012), Tire and Vehicle Dynamics",
    port="steer",
    parameters=(
        Parameter("compliance", "rad/N", 0.0, 1e-6, (0.0, 4e-6), "angle of the front wheels per side force of the axle"),
    ),
    states=("angle",),
    order=1,
)


def act(angle, speed, force_y, turned, compliance):
    return angle - turned, (compliance * force_y - turned) / TIME
