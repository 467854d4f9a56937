"""Comparisons made up for tests: an error that was put at a known place, frequency and speed."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort.vocabulary import SIGNALS


def put_between_1400_and_1600_m() -> xr.Dataset:
    """Two drives of 100 s, faster in the second half; a_z errs at 11 Hz between 1,400 and 1,600 m."""
    rng = np.random.default_rng(0)
    time = np.arange(10000) / 100.0
    speed = np.where(time < 50, 15.0, 25.0)
    s = np.cumsum(speed) / 100.0
    measured = rng.standard_normal((2, 6, time.size))
    error = 1e-3 * rng.standard_normal((2, 6, time.size))
    error[:, SIGNALS.index("a_z")] += np.where((s > 1400) & (s < 1600), 0.8 * np.sin(2 * np.pi * 11.0 * time), 0.0)
    series = np.broadcast_to(speed, (2, time.size)), np.broadcast_to(s, (2, time.size))
    dims = ("state", "drive", "signal", "time")
    return xr.Dataset(
        {
            "residual": (dims, error[None]),
            "measured": (dims[1:], measured),
            "simulated": (dims, (measured + error)[None]),
            "v_x": (("drive", "time"), series[0]),
            "s": (("drive", "time"), series[1]),
            "e": (("drive", "time"), np.zeros_like(series[1])),
        },
        {"state": ["calibrated"], "drive": ["one", "two"], "signal": list(SIGNALS), "time": time},
    )
