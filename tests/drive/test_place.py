"""Where on the road a drive was: its clock, its scale, its way."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.drive import align, place, replay
from tests import quarter_cars
from tests.quarter_cars import LATERAL


def on_hills(road, vehicle, *, speed, lateral=0.0, **options):
    """``quarter_cars.run`` with the speed along the body: uphill and outside of a bend it passes less of the reference line."""
    aside = np.interp(road["u"], lateral["u"], lateral) if isinstance(lateral, xr.DataArray) else lateral
    stretch = (1 - road["curvature"] * aside) * np.sqrt(1 + road["slope"] ** 2)
    over = lambda u: np.interp(u, road["u"], stretch)
    drive = quarter_cars.run(road, vehicle, speed=speed / over(speed["u"]), lateral=lateral, **options)
    return drive.assign(v_x=drive["v_x"] * over(drive["s"]))


@pytest.fixture(scope="module")
def hills(nominal):
    """A road with slopes of 4 to 12 % and bends down to a radius of 125 m, and a drive 0.6 m left of its line."""
    road = quarter_cars.road(length=560.0, slope=0.08, bend=0.008)
    u = road["u"].values
    speed = xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u")
    run = on_hills(road, nominal, speed=speed, lateral=0.6, end=550.0)
    run = run.isel(time=(run["s"] > 60).values)
    return road, run.assign_coords(time=run["time"] - run["time"][0])


def by_heights_alone(road):
    """The road as of a file without a channel for its slope."""
    return road.assign(slope=0 * road["slope"])


@pytest.mark.parametrize("told", [0.6, 0.4])
def test_an_odometer_that_is_exact_is_placed_on_hills_and_bends_without_a_scale(hills, nominal, told):
    road, drive = hills
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive, place=False, distance_start=start + 3.0, lateral_position=told)
    simulate = lambda _, vehicle, **demand: on_hills(road, vehicle, **demand)
    found = align.align(recorded, by_heights_alone(road), nominal, simulate=simulate)
    assert found.attrs["speed_scale"] == pytest.approx(1.0, abs=2e-4)
    np.testing.assert_allclose(found["s"], drive["s"], atol=0.02)


def test_a_speed_that_is_exact_has_no_scale_where_the_place_was_measured_on_hills_and_bends(hills):
    road, drive = hills
    recorded = quarter_cars.recorded(drive, lateral_position=0.6)
    for told in (road, by_heights_alone(road)):
        assert place.speed_scale(recorded, place.way(recorded, told)) == pytest.approx(1.0, abs=5e-5)


def test_a_sample_of_the_distance_that_is_wrong_changes_no_scale(drive, road):
    recorded = quarter_cars.recorded(drive)
    along = place.way(recorded, road)
    wrong = recorded["s"].values.copy()
    wrong[-1] -= 2.5
    assert place.speed_scale(recorded.assign(s=("time", wrong)), along) == pytest.approx(place.speed_scale(recorded, along), abs=5e-5)


def test_a_clock_is_looked_for_no_farther_than_a_drive_lasts_behind_the_run_in(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL)
    short = recorded.isel(time=(recorded["time"] < 5.0).values)
    again = replay.replay(short, road, quarter_cars.run)
    found = place.coarse_clock(again, again(nominal), search=10.0)
    assert again.compared.sum() < 1000 and abs(found) < 0.02


def test_a_place_on_the_road_and_the_way_to_it_are_each_others_inverse(hills):
    road, drive = hills
    way = place.way(quarter_cars.recorded(drive, lateral_position=0.6), road, start=100.0)
    s = np.linspace(-50.0, 700.0, 2000)  # beyond both ends, too
    np.testing.assert_allclose(way.place(way(s)), s, rtol=0, atol=1e-6)
    assert way(100.0) == pytest.approx(100.0) and np.ptp(way(s) - s) > 1.0


def test_moving_the_clock_moves_place_and_not_the_inertial_signals(drive):
    recorded = quarter_cars.recorded(drive)
    moved = place.moved(recorded, clock=0.25)
    np.testing.assert_array_equal(moved["a_z"], recorded["a_z"])
    later = (recorded["time"].values > 0.3) & (recorded["time"].values < 20)
    expected = np.interp(recorded["time"] - 0.25, recorded["time"], recorded["s"])
    np.testing.assert_allclose(moved["s"].values[later], expected[later])


def test_the_end_of_a_record_is_continued_by_its_trend_and_not_by_its_noise(drive):
    recorded = quarter_cars.recorded(drive)
    noisy = recorded["v_x"].copy(data=20.0 + 0.02 * np.random.default_rng(2).standard_normal(recorded.sizes["time"]))
    moved = place.moved(recorded.assign(v_x=noisy), clock=-0.05)
    # Five samples beyond the end: by the slope of the last two they would be off by 0.1 m/s (rms).
    assert np.abs(moved["v_x"].values[-5:] - 20.0).max() < 0.02
