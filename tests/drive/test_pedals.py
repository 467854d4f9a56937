"""A driver's foot, of which the accelerometer tells what a noisy speed does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.drive import pedals
from ridecomfort.drive.replay import replay
from ridecomfort.drive.slow import smooth
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import braked

@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def course():
    return braked.course()


def in_its_band(again, missing):
    """What is slower than 2.4 Hz and faster than 0.4 Hz of a series, where a drive is compared, without the first 4 s of that."""
    within = smooth(missing, 100.0, 2.4, order=4)
    return (within - smooth(within, 100.0, 0.4))[again.compared][400:-100]


@pytest.mark.parametrize("gravity", [True, False])
@pytest.mark.parametrize("effects", [(), ("anti_dive",)])
def test_it_is_the_acceleration_of_the_centre_of_gravity_whatever_the_body_does(course, car, gravity, effects):
    """Of a car that dives less than the model, and with an instrument on the roof."""
    drive, run = braked.drive(course, car, gravity=gravity, effects=effects)
    again = replay(drive, course, simulate.run).tuned(car)
    simulated = again.run(car)
    true = np.gradient(np.interp(again.place, run["s"], run["v_x"]) - np.interp(again.place, simulated["s"], simulated["v_x"]), 0.01)
    found = pedals.missing_acceleration(again, again.sample(simulated))
    error = in_its_band(again, found - true)
    assert error.std() < 0.15 * in_its_band(again, true).std()


def test_a_driver_who_is_listened_to_brakes_as_the_measured_one_did(course, car):
    drive, run = braked.drive(course, car)
    slow = replay(drive, course, simulate.run).tuned(car)
    heard = pedals.listening(slow, car)
    assert heard.by_foot is not None and heard.by_foot[0] < 0.3 and heard.by_foot[1] > 1.5
    true = np.interp(heard.place, run["s"], run["v_x"])
    missed = [in_its_band(one, true - np.interp(one.place, again["s"], again["v_x"])).std() for one in (heard, slow) for again in [one.run(car)]]
    assert missed[0] < 0.25 * missed[1]
    pitch = SIGNALS.index("pitch_rate")
    left = [in_its_band(one, np.nan_to_num(one.residual(one(car))[pitch])).std() for one in (heard, slow)]
    assert left[0] < 0.3 * left[1]


@pytest.mark.parametrize("noises", [{"noise": 0.0}, {"noise": 1e-5}, {"of_acceleration": 0.5}])
def test_nobody_listens_where_the_speed_tells_as_much_or_the_accelerometer_is_noisy(course, car, noises):
    drive, _ = braked.drive(course, car, **noises)
    assert pedals.listening(replay(drive, course, simulate.run), car).by_foot is None


def test_nor_where_the_speed_is_constant(course, car):
    drive, _ = braked.drive(course, car)
    again = replay(drive, course, simulate.run)
    steady = replace(again, drive=drive.assign(v_x=0.0 * drive["v_x"] + 20.0))
    assert pedals.band(steady, again(car)) is None


def test_a_driver_who_does_not_answer_is_not_asked(course, car):
    """Of another simulator: one who drives the speed that he was asked for at first, whatever comes then."""
    drive, _ = braked.drive(course, car)
    first = replay(drive, course, simulate.run).tuned(car).demand["speed"]
    stubborn = lambda road, vehicle, **asked: simulate.run(road, vehicle, **{**asked, "speed": first})
    assert pedals.listening(replay(drive, course, stubborn), car).by_foot is None
    other = lambda road, vehicle, **asked: simulate.run(road, vehicle, **asked)
    assert pedals.listening(replay(drive, course, other), car).by_foot is not None


def test_it_is_said_in_which_band_drivers_are_listened_to():
    assert pedals.words([None, None]) == ""
    assert "from 0.2 Hz up to 2.4 Hz" in pedals.words([(0.2, 2.4), None])
    assert "from 0.2-0.3 Hz up to 1.9-2.4 Hz" in pedals.words([(0.2, 2.4), (0.3, 1.9)])
