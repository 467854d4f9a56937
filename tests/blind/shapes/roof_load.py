"""A load on the roof rack that rocks fore and aft."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

TIME = 0.005
"""s over which the speed is differentiated."""

STARTING = 1.0
"""m/s; by as much the followed speed differs only at the start of a drive."""

effect = Effect(
    name="roof_load",
    sentence=(
        "A load on the roof, part of the sprung mass, rocks fore and aft on its rack and straps, driven by the speed of the car "
        "changing and by pitch."
    ),
    source="spring-mass oscillator with a moving base as in any textbook of vibration; made for blind trials",
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 40.0, (0.0, 200.0), "mass of the load"),
        Parameter("height", "m", 1.1, 1.1, (0.6, 1.6), "its height above the centre of gravity"),
        Parameter("frequency", "Hz", 5.0, 5.0, (2.0, 12.0), "natural frequency on a body that stands"),
        Parameter("damping_ratio", "1", 0.08, 0.08, (0.02, 0.4), "damping ratio on a body that stands"),
    ),
    states=("place", "rate", "speed"),
)


def act(motion, place, rate, followed, mass, height, frequency, damping_ratio):
    behind = motion.speed - followed
    change = behind / TIME
    body = height * motion.pitch_acceleration - motion.yaw_rate * motion.side_speed
    if abs(behind) < STARTING:
        body += change
    turns = 2.0 * pi * frequency
    acceleration = -body - turns * (turns * place + 2.0 * damping_ratio * rate)
    force = -mass * acceleration
    return force, 0.0, 0.0, 0.0, height * force + mass * STANDARD_GRAVITY * place, 0.0, rate, acceleration, change
