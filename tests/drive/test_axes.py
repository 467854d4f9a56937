"""Whether the horizontal axes of an instrument are exchanged."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.drive import axes, mounting, replay
from tests import quarter_cars
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
def test_columns_that_are_exchanged_are_no_turn_but_told(made, pair):
    road, car, recorded = made
    one, other = pair
    drive = mounting.level(recorded.assign({one: recorded[other], other: recorded[one]}))
    again = replay.replay(drive, road, quarter_cars.run)
    simulated = again(car)
    assert axes.words(again, simulated) == ""
    assert axes.columns(again, simulated) == f"{one} and {other} each do what the model does in the other: are their columns exchanged?"
    right = replay.replay(mounting.level(recorded), road, quarter_cars.run)
    assert axes.columns(right, right(car)) == ""


def test_one_signal_of_the_wrong_sign_is_no_turn(made):
    for name in RIGHT:
        assert told(made, RIGHT | {name: (name, -1)})[1] == ""


def test_signals_without_motion_agree_with_nothing(made):
    road, car, recorded = made
    agreement, words = told((road, car, recorded.assign({name: 0.0 * recorded[name] for name in RIGHT})), RIGHT)
    assert words == "" and not agreement.any()
