"""A roll bar whose links have play."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="antiroll_bar_slack",
    sentence=(
        "Worn drop links leave the roll bar slack over a small angle: the car rolls more softly about the level than in "
        "a bend, where the bar holds it as before but from an angle further on."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook: anti-roll bars and their links; made for blind trials",
    port="body",
    parameters=(
        Parameter("stiffness", "N m/rad", 0.0, 12000.0, (0.0, 25000.0), "roll stiffness of the bar that is slack"),
        Parameter("play", "rad", 0.004, 0.004, (0.001, 0.015), "roll to either side over which it is slack"),
    ),
)


def act(motion, stiffness, play):
    return 0.0, 0.0, 0.0, stiffness * min(max(motion.roll, -play), play), 0.0, 0.0
