"""Wheels that turn about their steering axes as they travel."""

from ridecomfort.effects.contract import Effect, Parameter

TRAVEL = 0.03
"""s; a wheel's load passes to its spring about that late."""

LEVEL = 3.0
"""s; over which the load that belongs to the ride height is taken."""

effect = Effect(
    name="bump_steer_by_load",
    sentence=(
        "Tie rod and arms swing about different centres, so that a wheel turns about its steering axis as its spring is "
        "compressed: bumps under one side steer the car, bumps under both sides only toe the wheels."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics: steering geometry error; Milliken and Milliken (1995), Race Car Vehicle Dynamics; made for blind trials",
    port="tyre_planar",
    parameters=(
        Parameter("front", "rad/N", 0.0, 2.5e-6, (-5e-6, 1e-5), "change of the slip angle of the front left wheel per load on its spring, of the right one reversed"),
        Parameter("rear", "rad/N", 0.0, -1.5e-6, (-5e-6, 1e-5), "change of the slip angle of the rear left wheel per load on its spring, of the right one reversed"),
    ),
    states=("sprung", "level"),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, sprung, level, front, rear):
    toe = (front if wheel < 2 else rear) * (sprung - level)
    if wheel == 1 or wheel == 3:
        toe = -toe
    return slip_x, slip_y + toe, 0.0, (load - sprung) / TRAVEL, (load - level) / LEVEL
