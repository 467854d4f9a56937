"""A smooth drive at 20 m/s, as it was recorded."""

from __future__ import annotations

import numpy as np

from ridecomfort.vocabulary import SIGNALS, STANDARD_GRAVITY

TIME = np.arange(0, 20, 0.01)


def quantities(**changed):
    """A smooth drive at 20 m/s with gravity in it."""
    wave = np.sin(2 * np.pi * 1.3 * TIME)
    values = {name: 0.1 * wave for name in SIGNALS}
    values["a_z"] = STANDARD_GRAVITY + wave
    values["v_x"] = 20 + 0 * TIME
    values["s"] = 20 * TIME
    return {name: (TIME, row) for name, row in values.items()} | changed


def alone(s, time=TIME):
    """A drive whose distance (m) was recorded without a speed."""
    return {name: pair for name, pair in quantities(s=(time, s)).items() if name != "v_x"}


def standing(*stands, rounded=False):
    """The distance of an uneven drive, which stands still from some instants until others (s), and that of the drive."""
    driven = 20 * TIME + 1.5 * np.sin(0.8 * TIME)
    told = np.round(driven) if rounded else driven
    for begin, end in stands:
        told = np.where((TIME > begin - 0.001) & (TIME < end - 0.001), np.interp(begin, TIME, told), told)
    return told, driven
