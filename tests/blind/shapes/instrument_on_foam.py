"""An instrument that lies on a mat of foam."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

effect = Effect(
    name="instrument_on_foam",
    sentence=(
        "The instrument lies on a mat of foam with nothing but its weight to hold it: it bounces up and down at its own frequency, "
        "and as the foam is hard when pressed and soft when relieved, it is thrown up longer than it is pressed down."
    ),
    source=(
        "Hilyard and Cunningham (1994), Low Density Cellular Plastics: compression of foams; spring-mass oscillator with a moving "
        "base as in any textbook of vibration; made for blind trials"
    ),
    port="flexing",
    parameters=(
        Parameter("participation", "1", 0.0, 0.2, (0.0, 1.0), "share of the bounce that the instrument takes part in"),
        Parameter("frequency", "Hz", 15.0, 15.0, (8.0, 30.0), "natural frequency of small bounces"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.05, 0.4), "damping ratio of small bounces"),
        Parameter("hardening", "1", 2.0, 2.0, (1.0, 4.0), "exponent of force over compression"),
    ),
    states=("lift", "rate"),
)


def act(motion, x, y, z, lift, rate, participation, frequency, damping_ratio, hardening):
    turns = 2.0 * pi * frequency
    sunk = hardening * STANDARD_GRAVITY / (turns * turns)
    pressed = max(1.0 - lift / sunk, 0.0) ** hardening
    floor = motion.vertical_acceleration - x * motion.pitch_acceleration + y * motion.roll_acceleration
    acceleration = STANDARD_GRAVITY * (pressed - 1.0) - floor - 2.0 * damping_ratio * turns * rate
    return 0.0, 0.0, participation * acceleration, rate, acceleration
