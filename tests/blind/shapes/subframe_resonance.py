"""Subframes on rubber between the links and the body."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

effect = Effect(
    name="subframe_resonance",
    sentence=(
        "Part of the force of an axle reaches the body through a subframe on rubber: around the frequency of the "
        "subframe it is magnified, and above swallowed."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: subframes and their mounts; Mitschke and Wallentowitz (2014), "
        "Dynamik der Kraftfahrzeuge; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("front", "1", 0.0, 0.2, (0.0, 0.9), "share of the front force that passes a subframe"),
        Parameter("rear", "1", 0.0, 0.35, (0.0, 0.9), "share of the rear force that passes a subframe"),
        Parameter("frequency", "Hz", 18.0, 18.0, (12.0, 30.0), "natural frequency of a subframe on its mounts"),
        Parameter("damping_ratio", "1", 0.1, 0.1, (0.04, 0.4), "damping ratio of a subframe on its mounts"),
    ),
    states=("front", "front_rate", "rear", "rear_rate"),
)


def act(motion, passed_front, rate_front, passed_rear, rate_rear, front, rear, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    weight = motion.sprung_mass * STANDARD_GRAVITY / (motion.front - motion.rear)
    force_front = motion.suspension_front + weight * motion.rear
    force_rear = motion.suspension_rear - weight * motion.front
    slope_front = turns * (turns * (force_front - passed_front) - 2.0 * damping_ratio * rate_front)
    slope_rear = turns * (turns * (force_rear - passed_rear) - 2.0 * damping_ratio * rate_rear)
    extra_front = front * (passed_front - force_front)
    extra_rear = rear * (passed_rear - force_rear)
    moment = -motion.front * extra_front - motion.rear * extra_rear
    force = extra_front + extra_rear
    return 0.0, 0.0, force, 0.0, moment, 0.0, rate_front, slope_front, rate_rear, slope_rear
