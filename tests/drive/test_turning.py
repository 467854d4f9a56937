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


@pytest.mark.parametrize(("degrees", "is_told"), [(8.0, False), (60.0, True)])
def test_a_vehicle_that_turns_where_its_road_hardly_bends_is_told(degrees, is_told):
    """A file whose headings are all nil, of a road with bends; a swerve on a straight one is none."""
    u, time = np.arange(0.0, 2000.0, 0.5), np.arange(0.0, 100.0, 0.01)
    road = xr.Dataset({"curvature": ("u", np.zeros(u.size))}, {"u": u})
    yaw_rate = np.radians(degrees) / 2 * np.gradient(np.sin(2 * np.pi * 0.05 * time), time) + 0.002
    drive = xr.Dataset({"s": ("time", 18.0 * time), "e": ("time", np.zeros(time.size)), "yaw_rate": ("time", yaw_rate)}, {"time": time})
    said = turning.without_bends(drive, road)
    assert bool(said) is is_told
    if is_told:
        degrees_told = float(said.split("turns by ")[1].split(" deg")[0])
        assert degrees_told == pytest.approx(degrees, rel=0.1) and said.endswith("are the headings of its file right?")
    bending = road.assign(curvature=("u", 0.01 * np.sin(2 * np.pi * u / 300)))
    assert turning.without_bends(drive, bending) == "", "there the gain tells"


def bend(u, degrees, radius=800.0, start=1000.0):
    """Curvature of one bend, which sets in over 60 m."""
    return np.sign(degrees) / radius * np.clip(np.minimum((u - start) / 60.0, (start + np.radians(abs(degrees)) * radius + 60.0 - u) / 60.0), 0.0, 1.0)


@pytest.mark.parametrize("in_file", [1.0, 0.0])
def test_a_road_with_one_gentle_bend_is_right_where_its_file_has_it(in_file):
    """50 deg of 800 m radius in 4 km: the rms of its rate is less than that by which a gain is told."""
    u = np.arange(0.0, 4000.0, 0.5)
    time = np.arange(0.0, 155.0, 0.01)
    drive = xr.Dataset({"s": ("time", 25.0 * time), "e": ("time", np.zeros(time.size))}, {"time": time})
    drive["yaw_rate"] = 25.0 * np.interp(drive["s"], u, bend(u, 50.0)) + 0.005
    road = xr.Dataset({"curvature": ("u", in_file * bend(u, 50.0))}, {"u": u})
    assert np.isnan(turning.gyroscope_gain(drive, road)).all()
    assert bool(turning.without_bends(drive, road)) is not bool(in_file)


def test_a_gyroscope_that_warms_up_turns_no_road():
    u, time = np.arange(0.0, 14000.0, 1.0), np.arange(0.0, 600.0, 0.01)
    road = xr.Dataset({"curvature": ("u", np.zeros(u.size))}, {"u": u})
    warming = np.radians(0.3) * (1.0 - np.exp(-time / 300.0)) / (1.0 - np.exp(-2.0))
    drive = xr.Dataset({"s": ("time", 20.0 * time), "e": ("time", 0.0 * time), "yaw_rate": ("time", warming)}, {"time": time})
    assert turning.without_bends(drive, road) == ""


def test_a_gain_is_told_only_where_it_is_surely_not_one(monkeypatch):
    for gain, error, is_told in ((1.0, 0.001, False), (1.019, 0.001, False), (1.11, 0.004, True), (1.11, 0.05, False), (np.nan, np.nan, False)):
        monkeypatch.setattr(turning, "gyroscope_gain", lambda *_: (gain, error))
        assert turning.words(None, None) == (f"the gyroscope's gain is {gain:.3f} against the bends of the road" if is_told else "")
