"""How far a recorded yaw rate turns the body against how far the path of the drive does."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.signal import butter, sosfiltfilt

from .sampling import rate_of

TURNING, MARGIN = 0.2, 3.0
"""Hz below which a body turns as its path does, and s at either end that a low pass of that takes to settle."""

LEAST_TURNING = 0.02
"""rad/s (rms) of the path below which what is noise of its place is no longer small beside it: 5 cm are 0.001 rad/s."""


def gyroscope_gain(drive: xr.Dataset, road: xr.Dataset) -> tuple[float, float]:
    """Gain of the yaw rate of a drive against how the course of its path turns, below TURNING, and its standard error.

    The body sideslips, but turns as far as the road does by the end of a bend. Both are nan where no path was measured or it hardly bends.
    """
    time, s, e = (drive[name].values for name in ("time", "s", "e"))
    rate = rate_of(time)
    if not np.isfinite(e).all() or len(time) < 4 * MARGIN * rate:
        return float("nan"), float("nan")
    sos = butter(2, TURNING, fs=rate, output="sos")
    slow = lambda series: sosfiltfilt(sos, series)
    progress = np.gradient(s, time)
    aside = np.arctan2(np.gradient(slow(e), time), slow(progress))
    turning = slow(np.interp(s, road["u"].values, road["curvature"].values) * progress) + np.gradient(aside, time)
    inner = slice(int(MARGIN * rate), -int(MARGIN * rate))
    turning, yaw_rate = turning[inner] - turning[inner].mean(), slow(drive["yaw_rate"].values)[inner]
    if not turning.std() > LEAST_TURNING:
        return float("nan"), float("nan")
    power = float(turning @ turning)
    gain = float(turning @ yaw_rate) / power
    left = yaw_rate - yaw_rate.mean() - gain * turning
    return gain, float(np.sqrt(left @ left / power / max(2.0 * TURNING * len(left) / rate, 1.0)))
