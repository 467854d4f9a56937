"""A clock of the inertial unit that runs too fast."""

import numpy as np
from scipy.interpolate import CubicSpline

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
)


def act(drive, drift):
    if drift == 0.0:
        return drive
    time = drive.time.values
    past = np.clip(time - drift * (time - time[0]), time[0], time[-1])
    late = {name: CubicSpline(time, drive[name].values)(past) for name in (*SIGNALS, "roll", "pitch")}
    return drive.assign({name: drive[name].copy(data=values) for name, values in late.items()})
