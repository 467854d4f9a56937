"""A gyroscope that answers later than the accelerometer beside it."""

from ridecomfort.drive.record import late
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="gyroscope_delay",
    sentence="Rates pass another filter than accelerations, or come on another channel, and are recorded later by a constant time.",
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: synchronisation of gyroscopes and accelerometers",
    port="sensor",
    parameters=(
        Parameter("time", "s", 0.0, 0.004, (-0.05, 0.05), "by how much rates are stamped later than accelerations"),
    ),
    order=2,
)


def act(drive, time):
    return drive if time == 0.0 else late(drive, SIGNALS[3:], time)
