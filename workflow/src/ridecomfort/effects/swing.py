"""A mass on spring and damper whose base is shaken, that effects of instruments share."""

from __future__ import annotations

import numpy as np

from ridecomfort.drive.record import felt
from ridecomfort.vocabulary import SIGNALS


def swung(drive, signal: str, participation: float, frequency: float, damping_ratio: float):
    """The ``drive`` whose ``signal``, an acceleration, an instrument records that takes part in the swing of what holds it."""
    if participation == 0.0:
        return drive
    body = drive[signal].values
    change = swing(felt(drive)[SIGNALS.index(signal)], float(drive["time"][1] - drive["time"][0]), frequency, damping_ratio)
    return drive.assign({signal: drive[signal].copy(data=body + participation * change)})


def swing(base: np.ndarray, interval: float, frequency: float, damping_ratio: float) -> np.ndarray:
    """Acceleration in m/s2 (time,) of the mass against its ``base``, whose acceleration (time,) comes every ``interval`` s.

    At the beginning the base has not changed for long. Exact for a base that is straight between its samples.
    """
    from scipy.signal import cont2discrete, lfilter, lfilter_zi  # here: they take half a second, and the library is read at every start

    turns = 2.0 * np.pi * frequency
    mode = ([-1.0, 0.0, 0.0], [1.0, 2.0 * damping_ratio * turns, turns * turns])
    (ahead,), back, _ = cont2discrete(mode, interval, "foh")
    return lfilter(ahead, back, base, zi=lfilter_zi(ahead, back) * base[0])[0]
