"""Noise of a scanner is found in a road that holds it, with its size, and not in one that does not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import suspect
from tests.vehicle import roads


@pytest.fixture(scope="module")
def rough():
    return roads.road(600.0, height=roads.rough)


def test_a_road_of_iso_8608_holds_no_noise(rough):
    assert suspect.road_noise(rough) == 0.0


@pytest.mark.parametrize(
    ("jump", "wander", "is_suspect"), [(0.010, 0.15, True), (0.004, 0.15, False), (0.010, 0.006, False)]
)
def test_clocks_are_suspect_that_wander_where_alignment_saw_it_too(jump, wander, is_suspect):
    """Three records at 20 m/s whose clocks jump half way by what is left of it in the fit; ``wander``: m that alignment took out."""
    drive = xr.Dataset({"v_x": ("time", np.full(1000, 20.0))}, attrs={"distance_wander": wander})
    shift = np.where(np.arange(1000) < 500, 0.0, jump)
    fitted = SimpleNamespace(shifts=lambda other, index: shift)
    came = SimpleNamespace(replays=[SimpleNamespace(drive=drive)] * 3)
    reasons = suspect.of_clocks(came, SimpleNamespace(experiment=fitted, indices=[0, 1, 2]))
    assert [("10 ms" in reason) for reason in reasons] == ([True] if is_suspect else [])


@pytest.mark.parametrize("gain", [1.0, 1.04])
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
    found, error = suspect.gyroscope_gain(drive, road)
    assert found == pytest.approx(gain, abs=0.005) and error < 0.01


def test_a_straight_road_or_an_unknown_path_tells_no_gain():
    u, time = np.arange(0.0, 2000.0, 0.5), np.arange(0.0, 100.0, 0.01)
    road = xr.Dataset({"curvature": ("u", np.zeros(u.size))}, {"u": u})
    yaw_rate = 0.01 * np.random.default_rng(4).standard_normal(time.size)
    drive = xr.Dataset({"s": ("time", 18.0 * time), "e": ("time", np.zeros(time.size)), "yaw_rate": ("time", yaw_rate)}, {"time": time})
    swaying = 0.05 * np.sin(2 * np.pi * 0.1 * time)
    assert np.isnan(suspect.gyroscope_gain(drive.assign(e=("time", swaying)), road)).all()
    assert np.isnan(suspect.gyroscope_gain(drive.assign(e=np.nan * drive["e"]), road)).all()


def test_the_size_of_white_noise_is_estimated(rough):
    noisy = rough.copy()
    noisy["elevation"] = rough["elevation"] + 1e-3 * np.random.default_rng(2).standard_normal(rough["elevation"].shape)
    assert suspect.road_noise(noisy) == pytest.approx(1e-3, rel=0.15)
