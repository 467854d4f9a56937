"""A trailer that nods on its axle and heaves the tail of the car."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

GYRATION = 0.33
"""Radius of gyration of the trailer about its centre of gravity, over the distance from ball to axle."""

AHEAD = 0.03
"""Distance by which its centre of gravity lies ahead of its axle, over that from ball to axle."""

BALL = AHEAD * AHEAD + GYRATION * GYRATION
AXLE = (1.0 - AHEAD) * (1.0 - AHEAD) + GYRATION * GYRATION
BOTH = AHEAD * (1.0 - AHEAD) - GYRATION * GYRATION
"""Entries of the mass matrix of heights at ball and axle, over the mass of the trailer."""

effect = Effect(
    name="trailer_porpoising",
    sentence=(
        "A trailer on springs nods about its ball: the tail of the car has to lift part of it, and near the trailer's own "
        "frequency it heaves the tail in turn. What the road does under the trailer's own wheels is left out."
    ),
    source=(
        "Sharp and Fernandez (2002), Car-caravan snaking, Proc. IMechE C 216:707 (its mass data); Lagrange's equations of a rigid bar on a spring; "
        "sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 700.0, (0.0, 1500.0), "mass of the trailer"),
        Parameter("overhang", "m", 1.0, 1.0, (0.6, 1.4), "from the rear axle of the car to the ball"),
        Parameter("frequency", "Hz", 2.0, 2.0, (1.0, 4.0), "natural frequency of the trailer on its springs, the ball held"),
        Parameter("damping_ratio", "1", 0.12, 0.12, (0.03, 0.4), "damping ratio of that motion"),
    ),
    states=("height", "rate"),
)


def act(motion, height, rate, mass, overhang, frequency, damping_ratio):
    place = motion.rear - overhang
    ball = motion.vertical_acceleration - place * motion.pitch_acceleration
    turns = 2.0 * pi * frequency
    axle = -BOTH / AXLE * ball - turns * (turns * height + 2.0 * damping_ratio * rate)
    force = -mass * (BALL * ball + BOTH * axle)
    return 0.0, 0.0, force, 0.0, -place * force, 0.0, rate, axle
