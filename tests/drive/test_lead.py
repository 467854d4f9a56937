"""Clocks that are one length over the speed are told as the distance of another point, and clocks that are clocks are not."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.drive import lead

SPEED = np.array([22.2, 22.4, 13.9])
ERROR = np.full(3, 0.0005)


@pytest.mark.parametrize("metres", [1.37, -0.8])
def test_one_length_over_the_speed_is_found_with_its_sign(metres):
    clock = metres / SPEED + 0.0005 * np.array([1, -1, 1])
    assert lead.length(clock, ERROR, SPEED) == pytest.approx(metres, abs=0.02)


def test_a_clock_for_each_drive_and_one_for_all_are_clocks():
    assert lead.length([0.08, -0.02, 0.05], ERROR, SPEED) is None
    assert lead.length(np.full(3, 0.08), ERROR, SPEED) is None
    near = np.array([20.0, 22.4])  # both, one clock and one length, are within what clocks are known to
    assert lead.length([0.08, 0.08], [0.01, 0.01], near) is None


def test_a_length_of_centimetres_is_not_worth_a_word():
    assert lead.length(0.25 / SPEED, ERROR, SPEED) is None
    assert lead.length(0.35 / SPEED, ERROR, SPEED) == pytest.approx(0.35)


def test_at_one_speed_nobody_knows():
    exact = np.full(2, 1e-9)
    assert lead.length(13.7 / np.array([22.2, 24.0]), exact, [22.2, 24.0]) is None
    assert lead.length(13.7 / np.array([22.2, 25.0]), exact, [22.2, 25.0]) == pytest.approx(13.7)
    assert lead.length([0.06], [0.001], [22.0]) is None
    assert lead.length([], [], []) is None


def test_a_clock_counts_by_its_error_and_not_at_all_where_that_is_not_known():
    clock = 1.37 / SPEED + np.array([0.0, 0.02, 0.0])
    assert lead.length(clock, ERROR, SPEED) is None
    assert lead.length(clock, [0.0005, 0.02, 0.0005], SPEED) == pytest.approx(1.37, abs=0.01)
    assert lead.length(clock, [0.0005, np.nan, 0.0005], SPEED) == pytest.approx(1.37)
    assert lead.length(clock, np.full(3, np.nan), SPEED) is None


def drive(clock, speeds, measured=1):
    attributes = {"place_measured": measured, "clock_offset": clock, "clock_offset_error": 0.0005}
    return xr.Dataset({"v_x": ("time", np.asarray(speeds, float))}, attrs=attributes)


def test_drives_whose_place_was_not_recorded_are_not_asked():
    drives = [drive(1.2 / 22.0, [22, 22]), drive(1.2 / 14.0, [14, 14]), drive(0.3, [30, 30], measured=0)]
    assert lead.of_drives(drives) == pytest.approx(1.2)
    assert lead.of_drives(drives[1:]) is None and lead.of_drives([]) is None


def test_the_clock_of_a_drive_whose_speed_varies_is_the_mean_of_the_length_over_it():
    varied = np.array([10.0, 20.0, 30.0])
    assert lead.of_drives([drive(np.mean(1.2 / varied), varied), drive(1.2 / 25.0, [25, 25])]) == pytest.approx(1.2)


def test_words_say_which_point_it_is_and_the_way_out():
    assert lead.words(1.40, 1.37).endswith("1.40 m ahead of the centre of gravity, where the front axle is (distance_of: front_axle)")
    assert "0.80 m behind the centre of gravity" in lead.words(-0.80, 1.37) and "+0.80 m to s" in lead.words(-0.80, 1.37)
    assert lead.words(-1.30, 1.37, is_of_front_axle=True).endswith("not of the front axle (leave out distance_of)")
    assert "2.37 m ahead of" in lead.words(1.0, 1.37, is_of_front_axle=True)
    assert "began 9.00 m behind the road's (+9.00 m to it" in lead.words(-9.0, 1.37)
