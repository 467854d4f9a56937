"""A body that is held against rolling the more it rolls: a truth that the library does not hold."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="body_in_roll",
    sentence="Liquid in a tank across the car follows its roll rate with a moment that brakes it.",
    source="Abramson (1966), The Dynamic Behavior of Liquids in Moving Containers; made for blind trials",
    port="body",
    parameters=(Parameter("damping", "N m s", 0.0, 1500.0, (0.0, 8000.0), "moment per roll rate"),),
)


def act(motion, damping):
    return 0.0, 0.0, 0.0, -damping * motion.roll_rate, 0.0, 0.0
