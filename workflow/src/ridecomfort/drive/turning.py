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

GAIN, STANDARD_ERRORS = 0.02, 2.0
"""Difference of a recorded gain from one that is more than a calibrated instrument has, and standard errors by which it must lie beyond that."""

TURNED = 0.35
"""rad to and fro, but for a rate that is constant or drifts, by which a vehicle that keeps on its road cannot turn otherwise than its path does: what is
wrong of a path by a lane turns that by 0.1 at 20 m/s."""


def gyroscope_gain(drive: xr.Dataset, road: xr.Dataset) -> tuple[float, float]:
    """Gain of the yaw rate of a drive against how the course of its path turns, below TURNING, and its standard error.

    The body sideslips, but turns as far as the road does by the end of a bend. Both are nan where no path was measured or it hardly bends.
    """
    path, yaw_rate, rate = _slowly(drive, road)
    if not path.size or not path.std() > LEAST_TURNING:
        return float("nan"), float("nan")
    power = float(path @ path)
    gain = float(path @ yaw_rate) / power
    left = yaw_rate - gain * path
    return gain, float(np.sqrt(left @ left / power / max(2.0 * TURNING * len(left) / rate, 1.0)))


def words(drive: xr.Dataset, road: xr.Dataset) -> str:
    """Words on a yaw rate whose gain surely is not one; empty where it may be, or nothing tells."""
    gain, error = gyroscope_gain(drive, road)
    return f"the gyroscope's gain is {gain:.3f} against the bends of the road" if abs(gain - 1.0) > GAIN + STANDARD_ERRORS * error else ""


def without_bends(drive: xr.Dataset, road: xr.Dataset) -> str:
    """Words on a vehicle that turns as its path does not where its road hardly bends; empty where it does not, or nothing tells."""
    path, yaw_rate, rate = _slowly(drive, road)
    if not path.size or path.std() > LEAST_TURNING:
        return ""
    heading, way = np.cumsum(yaw_rate - path) / rate, np.linspace(-1.0, 1.0, path.size)
    turned = float(np.ptp(heading - np.polyval(np.polyfit(way, heading, 2), way)))
    if not turned > TURNED:
        return ""
    return f"yaw_rate: the vehicle turns by {np.degrees(turned):.0f} deg where the road hardly bends: are the headings of its file right?"


def _slowly(drive: xr.Dataset, road: xr.Dataset) -> tuple[np.ndarray, np.ndarray, float]:
    """How the course of a drive's path turns and how its body does (rad/s, less their means), below TURNING, and their rate (Hz); nothing where no
    path was measured or the drive is too short."""
    time, s, e = (drive[name].values for name in ("time", "s", "e"))
    rate = rate_of(time)
    if not np.isfinite(e).all() or len(time) < 4 * MARGIN * rate:
        return np.empty(0), np.empty(0), rate
    sos = butter(2, TURNING, fs=rate, output="sos")
    slow = lambda series: sosfiltfilt(sos, series)
    progress = np.gradient(s, time)
    aside = np.arctan2(np.gradient(slow(e), time), slow(progress))
    path = slow(np.interp(s, road["u"].values, road["curvature"].values) * progress) + np.gradient(aside, time)
    inner = slice(int(MARGIN * rate), -int(MARGIN * rate))
    path, yaw_rate = path[inner], slow(drive["yaw_rate"].values)[inner]
    return path - path.mean(), yaw_rate - yaw_rate.mean(), rate
