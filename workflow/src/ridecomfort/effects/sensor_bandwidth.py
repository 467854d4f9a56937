"""An instrument that follows fast motion late and weakly."""

import numpy as np

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="sensor_bandwidth",
    sentence="The instrument is a low pass of first order: what is faster than its bandwidth comes late and weakened.",
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: bandwidth of inertial sensors",
    port="sensor",
    parameters=(
        Parameter("time", "s", 0.0, 0.004, (0.0, 0.05), "time constant, 1 / (2 pi bandwidth); 4 ms is 40 Hz"),
    ),
)


def act(drive, time):
    if time == 0.0:
        return drive
    from scipy.signal import lfilter  # here: it takes half a second, and the library is read at every start

    interval = float(drive.time[1] - drive.time[0])
    kept = np.exp(-interval / time)
    mean = time / interval * (1.0 - kept)
    # The exact answer to a signal that is straight between its samples.
    now, before = 1.0 - mean, mean - kept
    late = {}
    for name in SIGNALS:
        values = drive[name].values
        state = [(before + kept) * values[0]]
        late[name] = drive[name].copy(data=lfilter([now, before], [1.0, -kept], values, zi=state)[0])
    return drive.assign(late)
