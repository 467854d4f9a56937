"""A roll bar that sticks in its bushes."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="antiroll_bar_bush_friction",
    sentence=(
        "A roll bar turns in rubber bushes that grip it until they slip: small roll is held stiffly and comes back late, "
        "large roll loses energy, and heave does not know of it. The axles are taken to stay level."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: anti-roll bar bushes, bonded and sliding; Dahl (1976), Solid "
        "friction damping of mechanical vibrations, AIAA Journal 14:1675; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("friction", "N m", 0.0, 80.0, (0.0, 400.0), "roll moment at which the bushes of both bars slip"),
        Parameter("grip", "rad", 0.003, 0.003, (0.001, 0.015), "roll over which the moment turns"),
    ),
    states=("held",),
)


def act(motion, held, friction, grip):
    return 0.0, 0.0, 0.0, -friction * held, 0.0, 0.0, (motion.roll_rate - abs(motion.roll_rate) * held) / grip
