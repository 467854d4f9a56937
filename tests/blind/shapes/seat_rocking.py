"""A seat that rocks fore and aft under the instrument."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.005
"""s over which the speed is differentiated."""

HARDEST = 6.0
"""m/s2; no car brakes or drives harder on such a road."""

effect = Effect(
    name="seat_rocking",
    sentence=(
        "The instrument is strapped to a seat, and the seat rocks fore and aft on its rails and its back: around its own "
        "frequency the instrument feels more surge than the floor has."
    ),
    source=(
        "Griffin (1990), Handbook of Human Vibration: seat transmissibility; Qiu and Griffin (2003), Transmission of fore-aft "
        "vibration to a car seat using field tests and laboratory simulation, Journal of Sound and Vibration 264:135; made for "
        "blind trials"
    ),
    port="flexing",
    parameters=(
        Parameter("participation", "1", 0.0, 0.15, (0.0, 1.2), "rocking of the instrument over rocking of the top of the seat"),
        Parameter("frequency", "Hz", 12.0, 12.0, (5.0, 22.0), "natural frequency of the rocking"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.05, 0.4), "damping ratio of the rocking"),
    ),
    states=("sway", "rate", "speed"),
)


def act(motion, x, y, z, sway, rate, past, participation, frequency, damping_ratio):
    slope = (motion.speed - past) / TIME
    change = min(max(slope, -HARDEST), HARDEST) if past > 0.999 * motion.speed else 0.0  # the state begins at rest
    floor = change + z * motion.pitch_acceleration
    turns = 2.0 * pi * frequency
    acceleration = -floor - turns * (turns * sway + 2.0 * damping_ratio * rate)
    return participation * acceleration, 0.0, 0.0, rate, acceleration, slope
