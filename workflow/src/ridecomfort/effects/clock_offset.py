"""A clock of the inertial unit that is off."""

import numpy as np
from scipy.interpolate import CubicSpline

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
)


def act(drive, offset):
    if offset == 0.0:
        return drive
    time = drive.time.values
    past = np.clip(time - offset, time[0], time[-1])
    late = {name: CubicSpline(time, drive[name].values)(past) for name in (*SIGNALS, "roll", "pitch")}
    return drive.assign({name: drive[name].copy(data=values) for name, values in late.items()})
