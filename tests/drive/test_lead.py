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


def test_one_clock_for_all_drives_and_a_clock_for_each_are_clocks():
    assert lead.length(np.full(3, 0.08), ERROR, SPEED) is None
    assert lead.length([0.08, -0.02, 0.05], ERROR, SPEED) is None
    assert lead.length([0.0, 0.001, -0.001], ERROR, SPEED) is None  # no clock at all


def test_at_one_speed_nobody_knows():
    assert lead.length(1.37 / SPEED[:2], ERROR[:2], SPEED[:2]) is None
    assert lead.length([0.06], [0.001], [22.0]) is None
    assert lead.length([], [], []) is None


def test_drives_whose_place_was_not_recorded_are_not_asked():
    drives = [
        xr.Dataset({"v_x": ("time", [v, v])}, attrs={"place_measured": measured, "clock_offset": 1.2 / v, "clock_offset_error": 0.0005})
        for v, measured in ((22.0, 1), (14.0, 1), (30.0, 0))
    ]
    drives[2].attrs["clock_offset"] = 0.3
    assert lead.of_drives(drives) == pytest.approx(1.2)
    assert lead.of_drives(drives[1:]) is None


def test_words_name_the_front_axle_where_it_is_that_and_the_way_out_where_not():
    assert lead.words(1.40, 1.37).endswith("1.40 m ahead of the centre of gravity, where the front axle is (distance_of: front_axle)")
    assert "0.80 m behind the centre of gravity; shift s by as much" in lead.words(-0.80, 1.37)
