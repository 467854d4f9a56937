"""Liquid that swings from side to side in a tank."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

SPAN = 0.02
"""s over which the change of the side speed is taken."""

effect = Effect(
    name="tank_slosh",
    sentence=(
        "Part of the liquid in a half-filled tank swings from side to side like a pendulum, driven by bends and by "
        "the roll of the body, and pushes and leans on the car with a rhythm of its own."
    ),
    source=(
        "Ibrahim (2005), Liquid Sloshing Dynamics; Rakheja, Sankar and Ranganathan (1988), Roll plane analysis of "
        "articulated tank vehicles during steady turning, Vehicle System Dynamics 17; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 80.0, (0.0, 400.0), "mass of the liquid that swings"),
        Parameter("height", "m", 0.1, 0.1, (-0.3, 1.0), "its height above the centre of gravity"),
        Parameter("ahead", "m", -1.0, -1.0, (-2.5, 1.5), "its place ahead of the centre of gravity"),
        Parameter("frequency", "Hz", 0.9, 0.9, (0.5, 2.0), "natural frequency in a tank that stands"),
        Parameter("damping_ratio", "1", 0.06, 0.06, (0.01, 0.3), "damping ratio in a tank that stands"),
    ),
    states=("aside", "rate", "side_speed"),
)


def act(motion, aside, rate, past, mass, height, ahead, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    change = (motion.side_speed - past) / SPAN
    body = change + motion.speed * motion.yaw_rate - height * motion.roll_acceleration + STANDARD_GRAVITY * motion.roll
    acceleration = -body - turns * (turns * aside + 2.0 * damping_ratio * rate)
    # The rigid body carries this mass already; what is missing is the inertia of moving against it and its new place.
    force = -mass * acceleration
    moment = -height * force - mass * STANDARD_GRAVITY * aside
    return 0.0, force, 0.0, moment, 0.0, ahead * force, rate, acceleration, change
