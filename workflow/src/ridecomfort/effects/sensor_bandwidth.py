"""An instrument that follows fast motion weakly."""

import numpy as np

from ridecomfort.drive.record import acceleration, felt
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="sensor_bandwidth",
    sentence=(
        "The instrument is a low pass of first order: what is faster than its bandwidth comes weakened. Slow motion it shows in time: its "
        "delay there is one of the clock (clock_offset), which alignment takes out."
    ),
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: bandwidth of inertial sensors",
    port="sensor",
    parameters=(
        Parameter("time", "s", 0.0, 0.004, (0.0, 0.05), "time constant, 1 / (2 pi bandwidth); 4 ms is 40 Hz"),
    ),
    order=2,
)


def act(drive, time):
    if time == 0.0:
        return drive
    from scipy.interpolate import CubicSpline  # here: they take half a second, and the library is read at every start
    from scipy.signal import lfilter

    clock = drive.time.values
    interval = float(clock[1] - clock[0])
    kept = np.exp(-interval / time)
    mean = time / interval * (1.0 - kept)
    # The exact answer to a signal that is straight between its samples.
    now, before = 1.0 - mean, mean - kept
    in_time = np.minimum(clock + time, clock[-1])
    shown = np.stack([drive[name].values for name in SIGNALS])
    shown[:3] = felt(drive)
    for values in shown:
        state = [(before + kept) * values[0]]
        late = lfilter([now, before], [1.0, -kept], values, zi=state)[0]
        values[:] = CubicSpline(clock, late)(in_time)
    shown[:3] = acceleration(shown[:3], drive["roll"].values, drive["pitch"].values)
    return drive.assign({name: drive[name].copy(data=row) for name, row in zip(SIGNALS, shown, strict=True)})
