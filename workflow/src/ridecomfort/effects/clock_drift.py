"""A clock of the inertial unit that runs too fast."""

from ridecomfort.drive.record import late
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="clock_drift",
    sentence="Accelerations and rates lag behind place and speed by a time that grows over the drive.",
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: latency between aiding and inertial data",
    port="sensor",
    parameters=(
        Parameter("drift", "1", 0.0, 2e-4, (-2e-3, 2e-3), "time that inertial signals fall behind per time driven"),
    ),
    order=2,
)


def act(drive, drift):
    time = drive.time.values
    return drive if drift == 0.0 else late(drive, (*SIGNALS, "roll", "pitch"), drift * (time - time[0]))
