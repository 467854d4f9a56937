"""Drives that were not made, on which two models would differ: those that were, at other speeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from ..drive.replay import Replay
from ..errors import InputError
from ..vocabulary import SIGNALS

SPEEDS = (0.6, 0.8, 1.25)
"""Times the speed of a drive at which it might be driven as well..."""

HARDEST = 5.0
"""m/s2 across, at most, if that is faster: what few passengers are driven at."""

SETTLED = 3.0
"""s after which a model drives as its driver means it to."""

Model = tuple[object, Mapping[str, Mapping[str, float]]]
"""A vehicle and its effects."""


def differences(again: Replay, one: Model, other: Model, rate: float) -> dict[str, np.ndarray]:
    """By how much the signals of ``one`` model lie above those of the ``other`` at equal place, (6, sample) at this ``rate`` (Hz), were a drive made
    faster or slower; by its mean speed in words. A speed at which one of them cannot be driven, or that few would drive, is left out."""
    found = {}
    for times in SPEEDS:
        asked = times * again.demand["speed"]
        at_speed = replace(again, demand={**again.demand, "speed": asked})
        try:
            runs = [at_speed.run(vehicle, effects) for vehicle, effects in (one, other)]
        except InputError:
            continue
        if times < 1.0 or float(np.abs(runs[0]["a_y"]).max()) <= HARDEST:
            found[f"{3.6 * float(asked.mean()):.0f} km/h"] = _apart(*runs, rate)
    return found


def _apart(one: xr.Dataset, other: xr.Dataset, rate: float) -> np.ndarray:
    time, own = one["time"].values, other["time"].values
    place = np.maximum.accumulate(other["s"].values)
    at = np.arange(time[0] + SETTLED, time[-1], 1.0 / rate)
    passed = np.interp(at, time, one["s"].values)
    at, passed = at[passed <= place[-1]], passed[passed <= place[-1]]
    signals = lambda run, instants: CubicSpline(run["time"].values, np.stack([run[name].values for name in SIGNALS]), axis=1)(instants)
    return signals(one, at) - signals(other, np.interp(passed, place, own))
