"""Whether the horizontal axes of an instrument are exchanged."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.drive import axes, mounting, replay
from tests import quarter_cars
from tests.blind import trials
from tests.quarter_cars import LATERAL, driven

RIGHT = {name: (name, 1) for name in ("a_x", "a_y", "roll_rate", "pitch_rate")}
TO_THE_LEFT = {"a_x": ("a_y", 1), "a_y": ("a_x", -1), "roll_rate": ("pitch_rate", 1), "pitch_rate": ("roll_rate", -1)}
"""What an instrument that is turned by a quarter to the left tells as each signal: its x axis points to the left of the vehicle."""


@pytest.fixture(scope="module")
def made(repository):
    """A road, a car, and a record of another car on that road."""
    road, car = quarter_cars.road(length=560.0), quarter_cars.vehicle(repository)
    return road, car, quarter_cars.recorded(driven(road, quarter_cars.other(car)), noise=1.0, lateral_position=LATERAL)


def told(made, instrument):
    """What is found of a drive whose ``instrument`` tells these signals with these signs: agreement and words."""
    road, car, recorded = made
    drive = mounting.level(recorded.assign({name: sign * recorded[own] for name, (own, sign) in instrument.items()}))
    again = replay.replay(drive, road, quarter_cars.run)
    return axes.agreement(again, again(car)), axes.words(again, again(car))


def test_axes_that_are_right_agree_and_are_not_told(made):
    agreement, words = told(made, RIGHT)
    assert words == "" and agreement[0] > 0.9 and abs(agreement[1]) < 0.1
    np.testing.assert_allclose(agreement[2:], -agreement[:2])


def test_a_quarter_to_the_left_is_put_right_by_what_is_told(made):
    agreement, words = told(made, TO_THE_LEFT)
    assert np.argmax(agreement) == 1 and "turned by +90 deg in yaw" in words
    assert "a_x = -a_y, a_y = a_x, roll_rate = -pitch_rate, pitch_rate = roll_rate" in words


@pytest.mark.parametrize("pair", axes.PAIRS)
def test_columns_that_are_exchanged_are_no_turn_but_told(repository, pair):
    """Of a whole car: a_x of quarter cars does in bends what a_y does."""
    car, road = quarter_cars.vehicle(repository), trials.a_road(np.random.default_rng(1))
    u = road["u"]
    run = simulate.run(road, quarter_cars.other(car), speed=20.0 + 2.0 * np.sin(2 * np.pi * u / 250), lateral=xr.full_like(u, LATERAL), step=0.001)
    run = run.isel(time=(run["time"] >= 2.0).values)
    recorded = quarter_cars.recorded(run.assign_coords(time=run["time"] - 2.0), noise=1.0, lateral_position=LATERAL)
    one, other = pair
    asked = lambda drive: replay.replay(mounting.level(drive), road, simulate.run, options={"step": 0.001})
    swapped = asked(recorded.assign({one: recorded[other], other: recorded[one]}))
    assert axes.words(swapped, swapped(car)) == ""
    told = axes.columns(swapped, swapped(car)).split("; ")
    assert axes.exchanged(one, other) in told and axes.exchanged(other, one) in told and len(told) == 2
    right = asked(recorded)
    assert axes.columns(right, right(car)) == ""


def test_one_signal_of_the_wrong_sign_is_no_turn(made):
    for name in RIGHT:
        assert told(made, RIGHT | {name: (name, -1)})[1] == ""


def test_signals_without_motion_agree_with_nothing(made):
    road, car, recorded = made
    agreement, words = told((road, car, recorded.assign({name: 0.0 * recorded[name] for name in RIGHT})), RIGHT)
    assert words == "" and not agreement.any()
