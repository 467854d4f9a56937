"""The first bending mode of the body, as the sensor feels it."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

effect = Effect(
    name="body_bending",
    sentence=(
        "The body bends like a beam that floats, driven by the forces of the axles, and a sensor between the nodes "
        "feels it. What the bending does to the suspensions is left out: the nodes lie near the axles."
    ),
    source="Timoshenko, Young and Weaver (1974), Vibration Problems in Engineering: beam with free ends; Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge",
    port="flexing",
    parameters=(
        Parameter("mass_ratio", "1", 0.0, 1.0, (0.0, 4.0), "sprung mass over modal mass, the middle moving by 1"),
        Parameter("frequency", "Hz", 24.0, 24.0, (12.0, 40.0), "natural frequency of the mode"),
        Parameter("damping_ratio", "1", 0.05, 0.05, (0.01, 0.15), "damping ratio of the mode"),
        Parameter("node", "m", 1.3, 1.3, (0.6, 2.0), "distance of the nodes from the centre of gravity"),
    ),
    states=("bend", "rate"),
)


def act(motion, x, y, z, bend, rate, mass_ratio, frequency, damping_ratio, node):
    turns = 2.0 * pi * frequency
    weight = motion.sprung_mass * STANDARD_GRAVITY / (motion.front - motion.rear)
    front = (motion.suspension_front + weight * motion.rear) * (1.0 - (motion.front / node) ** 2)
    rear = (motion.suspension_rear - weight * motion.front) * (1.0 - (motion.rear / node) ** 2)
    acceleration = mass_ratio * (front + rear) / motion.sprung_mass
    acceleration -= turns * (turns * bend + 2.0 * damping_ratio * rate)
    return 0.0, 0.0, acceleration * (1.0 - (x / node) ** 2), rate, acceleration
