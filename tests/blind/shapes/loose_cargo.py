"""Luggage that slides."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

CREEP = 0.02
"""m/s over which the friction turns with the direction of sliding."""

WALL, REBOUND = 8000.0, 25.0
"""1/s2 and 1/s; stiffness and damping of the walls of the boot over the mass of the luggage."""

effect = Effect(
    name="loose_cargo",
    sentence=(
        "Luggage that nobody has tied down stays where it is until a bend is sharp enough, or a bump has made it light, "
        "then slides across the boot and knocks against its wall."
    ),
    source="VDI 2700 (2004), Securing of loads on road vehicles: friction; made for blind trials",
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 100.0, (0.0, 400.0), "mass of the luggage, part of that of the body"),
        Parameter("friction", "1", 0.2, 0.2, (0.05, 0.6), "coefficient of friction of the floor of the boot"),
        Parameter("room", "m", 0.1, 0.1, (0.02, 0.5), "way to the wall on either side"),
        Parameter("behind", "m", 0.5, 0.5, (0.0, 1.0), "place behind the rear axle"),
    ),
    states=("place", "rate"),
)


def act(motion, place, rate, mass, friction, room, behind):
    x = motion.rear - behind
    aside = motion.speed * motion.yaw_rate + STANDARD_GRAVITY * motion.roll
    weight = max(STANDARD_GRAVITY + motion.vertical_acceleration - x * motion.pitch_acceleration, 0.0)
    held = friction * weight * min(max(rate / CREEP, -1.0), 1.0)
    knock = 0.0
    if place > room:
        knock = max(WALL * (place - room) + REBOUND * rate, 0.0)
    if place < -room:
        knock = min(WALL * (place + room) + REBOUND * rate, 0.0)
    slope = -aside - held - knock
    force = -mass * slope
    return 0.0, force, 0.0, 0.0, 0.0, x * force, rate, slope
