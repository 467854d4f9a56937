"""Occupants that bounce on their seats."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="seated_occupants",
    sentence=(
        "People sit on foam and spring on the softness of their own bodies: above their bounce of some 4 Hz they hardly "
        "follow the car, which is lighter by them then, and around it they absorb its motion."
    ),
    source=(
        "Griffin (1990), Handbook of Human Vibration: apparent mass of the seated body; ISO 5982 (2019), Range of idealized "
        "values to characterize human biodynamic response; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 150.0, (0.0, 420.0), "mass of the people that bounces, part of that of the body"),
        Parameter("ahead", "m", -0.3, -0.3, (-1.2, 0.5), "their place ahead of the centre of gravity"),
        Parameter("frequency", "Hz", 4.2, 4.2, (2.5, 6.5), "natural frequency on seat and body"),
        Parameter("damping_ratio", "1", 0.3, 0.3, (0.15, 0.6), "damping ratio of the bounce"),
    ),
    states=("lift", "rate"),
)


def act(motion, lift, rate, mass, ahead, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    floor = motion.vertical_acceleration - ahead * motion.pitch_acceleration
    acceleration = -floor - turns * (turns * lift + 2.0 * damping_ratio * rate)
    # The rigid body carries this mass already; what is missing is the inertia of moving against it.
    force = -mass * acceleration
    return 0.0, 0.0, force, 0.0, -ahead * force, 0.0, rate, acceleration
