"""An instrument on a post that sways sideways."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.005
"""s over which the side speed is differentiated."""

effect = Effect(
    name="instrument_post",
    sentence=(
        "The instrument stands on a post or a tripod that sways to the side: around its own frequency it feels more side "
        "acceleration than the body has at its foot."
    ),
    source="spring-mass oscillator with a moving base as in any textbook of vibration; made for blind trials",
    port="flexing",
    parameters=(
        Parameter("participation", "1", 0.0, 0.12, (0.0, 1.6), "sway of the instrument over sway of the top of the post"),
        Parameter("frequency", "Hz", 11.0, 11.0, (6.0, 25.0), "natural frequency of the sway"),
        Parameter("damping_ratio", "1", 0.12, 0.12, (0.02, 0.4), "damping ratio of the sway"),
    ),
    states=("sway", "rate", "speed"),
)


def act(motion, x, y, z, sway, rate, followed, participation, frequency, damping_ratio):
    change = (motion.side_speed - followed) / TIME
    body = change + motion.yaw_rate * motion.speed - z * motion.roll_acceleration
    turns = 2.0 * pi * frequency
    acceleration = -body - turns * (turns * sway + 2.0 * damping_ratio * rate)
    return 0.0, participation * acceleration, 0.0, rate, acceleration, change
