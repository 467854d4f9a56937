"""A roof that sways on its pillars."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="upper_body_racking",
    sentence=(
        "The upper body shears on its pillars, to the side more easily than fore and aft, and a sensor above the floor "
        "feels it, the more the higher it sits."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook: stiffness of the body; Happian-Smith (2001), An Introduction to Modern Vehicle Design: lozenging; made for blind trials",
    port="flexing",
    parameters=(
        Parameter("lateral", "1/m", 0.0, 0.15, (0.0, 2.0), "part that the lateral mode has in the motion, per height"),
        Parameter("longitudinal", "1/m", 0.0, 0.15, (0.0, 2.0), "part that the longitudinal mode has in the motion, per height"),
        Parameter("frequency", "Hz", 17.0, 17.0, (10.0, 35.0), "natural frequency of the lateral mode; the longitudinal one is 1.3 times it"),
        Parameter("damping_ratio", "1", 0.04, 0.04, (0.01, 0.15), "damping ratio of both modes"),
    ),
    states=("side", "side_rate", "ahead", "ahead_rate"),
)


def act(motion, x, y, z, side, side_rate, ahead, ahead_rate, lateral, longitudinal, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    slope_side = z * motion.roll_acceleration - motion.speed * motion.yaw_rate
    slope_side -= turns * (turns * side + 2.0 * damping_ratio * side_rate)
    turns *= 1.3
    slope_ahead = -z * motion.pitch_acceleration - turns * (turns * ahead + 2.0 * damping_ratio * ahead_rate)
    height = max(z, 0.0)
    return longitudinal * height * slope_ahead, lateral * height * slope_side, 0.0, side_rate, slope_side, ahead_rate, slope_ahead
