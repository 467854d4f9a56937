"""A load that sits to one side of the car."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

effect = Effect(
    name="uneven_load",
    sentence=(
        "A driver alone, or a load on one side, moves the centre of gravity aside: the car leans, every bounce of the body also "
        "rolls it, and every roll lifts it. That it turns when it brakes is left out."
    ),
    source="Newton-Euler equations about a point beside the centre of gravity; 75 kg for an occupant as in ISO 2416:1992, 0.35 m aside",
    port="body",
    parameters=(Parameter("shift", "kg m", 0.0, 25.0, (-150.0, 150.0), "mass times its place to the left of the middle of the car"),),
    symmetric=False,
)


def act(motion, shift):
    lift = -shift * motion.roll_acceleration
    lean = -shift * (STANDARD_GRAVITY + motion.vertical_acceleration)
    return 0.0, 0.0, lift, lean, 0.0, 0.0
