"""A gyroscope that answers later than the accelerometer beside it."""

import numpy as np

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
)


def act(drive, time):
    if time == 0.0:
        return drive
    from scipy.interpolate import CubicSpline  # here: it takes half a second, and the library is read at every start

    clock = drive.time.values
    past = np.clip(clock - time, clock[0], clock[-1])
    return drive.assign({name: drive[name].copy(data=CubicSpline(clock, drive[name].values)(past)) for name in SIGNALS[3:]})
