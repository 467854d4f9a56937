"""An instrument that bounces on what holds it."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.swing import swung

effect = Effect(
    name="sensor_mount",
    sentence=(
        "The instrument sits on foam, a bracket or a holder that gives: around the natural frequency of that it is shaken up and down "
        "more than the body at its place, and less above it."
    ),
    source=(
        "ISO 5348:2021, Mechanical vibration and shock: mechanical mounting of accelerometers; spring-mass oscillator with a moving base "
        "as in any textbook of vibration"
    ),
    port="sensor",
    parameters=(
        Parameter("participation", "1", 0.0, 0.3, (0.0, 1.6), "share of the instrument in the mode: 1 on foam, 1.57 at the tip of a bracket"),
        Parameter("frequency", "Hz", 15.0, 15.0, (6.0, 40.0), "natural frequency of the mode"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.02, 0.5), "damping ratio of the mode"),
    ),
)


def act(drive, participation, frequency, damping_ratio):
    return swung(drive, "a_z", participation, frequency, damping_ratio)
