"""A clock of the inertial unit that is off."""

from ridecomfort.drive.record import late
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="clock_offset",
    sentence="Accelerations and rates are recorded later than place and speed by a constant time.",
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: latency between aiding and inertial data",
    port="sensor",
    parameters=(
        Parameter("offset", "s", 0.0, 0.01, (-0.5, 0.5), "by how much inertial signals are stamped too late"),
    ),
    order=2,
)


def act(drive, offset):
    return drive if offset == 0.0 else late(drive, (*SIGNALS, "roll", "pitch"), offset)
