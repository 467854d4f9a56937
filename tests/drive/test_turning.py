"""The yaw rate of a drive against the bends of its road."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.drive import turning


@pytest.mark.parametrize("gain", [1.0, 1.04, -1.0, np.pi / 180])
def test_the_gain_of_a_gyroscope_is_told_by_the_bends_of_the_road(gain):
    """A drive that sways across a winding road, with a body that sideslips; its path is what turns it."""
    u = np.arange(0.0, 2000.0, 0.5)
    road = xr.Dataset({"curvature": ("u", 0.01 * np.sin(2 * np.pi * u / 300))}, {"u": u})
    time = np.arange(0.0, 100.0, 0.01)
    s, e = 18.0 * time, 0.5 * np.sin(2 * np.pi * 0.02 * time)
    course = np.interp(s, u, road["curvature"].values) * 18.0 + np.gradient(np.gradient(e, time) / 18.0, time)
    sideslip = 0.03 * np.gradient(course, time)
    noise = 0.01 * np.random.default_rng(3).standard_normal(time.size)
    drive = xr.Dataset({"s": ("time", s), "e": ("time", e), "yaw_rate": ("time", gain * (course - sideslip) + noise)}, {"time": time})
    found, error = turning.gyroscope_gain(drive, road)
    assert found == pytest.approx(gain, abs=0.005) and error < 0.01


def test_a_straight_road_or_an_unknown_path_tells_no_gain():
    u, time = np.arange(0.0, 2000.0, 0.5), np.arange(0.0, 100.0, 0.01)
    road = xr.Dataset({"curvature": ("u", np.zeros(u.size))}, {"u": u})
    yaw_rate = 0.01 * np.random.default_rng(4).standard_normal(time.size)
    drive = xr.Dataset({"s": ("time", 18.0 * time), "e": ("time", np.zeros(time.size)), "yaw_rate": ("time", yaw_rate)}, {"time": time})
    swaying = 0.05 * np.sin(2 * np.pi * 0.1 * time)
    assert np.isnan(turning.gyroscope_gain(drive.assign(e=("time", swaying)), road)).all()
    assert np.isnan(turning.gyroscope_gain(drive.assign(e=np.nan * drive["e"]), road)).all()
