"""An error is found where, at what frequency and at what speed it was put."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import locate
from ridecomfort.vocabulary import SIGNALS


@pytest.fixture(scope="module")
def comparison():
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
        },
        {"state": ["calibrated"], "drive": ["one", "two"], "signal": list(SIGNALS), "time": time},
    )


def test_the_largest_power_lies_where_the_error_was_put(comparison):
    located = locate.locate(comparison)
    signal, stretch, band = np.unravel_index(located["share"].values.argmax(), located["share"].shape)
    assert SIGNALS[signal] == "a_z"
    assert located["band_lower"][band] <= 11.0 < located["band_upper"][band]
    assert 1300 < located["stretch_start"][stretch] < 1600


def test_power_adds_up_to_the_mean_square(comparison):
    located = locate.locate(comparison)
    white_between_0_3_and_40_hz = (40 - 0.3) / 50 * comparison["measured"].sel(signal="a_z").var()
    whole = located["share"].sel(signal="a_z").sum() * white_between_0_3_and_40_hz
    assert float(whole) == pytest.approx(float((comparison["residual"].sel(signal="a_z") ** 2).mean()), rel=0.03)


def test_it_is_said_in_words(comparison):
    (first, *others) = locate.words(locate.locate(comparison))
    assert first.startswith("a_z, 8-14 Hz, half of it at 1.") and "speeds above" in first and not others


def test_coherence_is_one_where_model_and_measurement_agree(comparison):
    located = locate.locate(comparison)
    assert float(located["coherence"].sel(signal="a_x").min()) > 0.99
    assert float(np.abs(located["gain"].sel(signal="a_x") - 1).max()) < 0.02
