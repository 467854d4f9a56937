"""A driver's foot, of which the accelerometer tells what a noisy speed does not."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.drive import pedals, sampling
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


def missed(again, run, car):
    """What the driver of a replay misses of the speed that was driven, in his band, m/s rms."""
    own = again.run(car)
    true, modelled = (np.interp(again.place, each["s"], each["v_x"]) for each in (run, own))
    return in_its_band(again, true - modelled).std()


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
    heard = pedals.listening(slow, car).replay
    assert heard.by_foot is not None and heard.by_foot[0] < 0.3 and heard.by_foot[1] > 1.5
    assert missed(heard, run, car) < 0.25 * missed(slow, run, car)
    pitch = SIGNALS.index("pitch_rate")
    left = [in_its_band(one, np.nan_to_num(one.residual(one(car))[pitch])).std() for one in (heard, slow)]
    assert left[0] < 0.3 * left[1]


@pytest.mark.parametrize("noise", [0.0, 1e-5])
def test_however_clean_the_speed_what_is_faster_than_half_a_hertz_is_the_accelerometers(course, car, noise):
    drive, run = braked.drive(course, car, noise=noise)
    slow = replay(drive, course, simulate.run).tuned(car)
    heard = pedals.listening(slow, car).replay
    assert heard.by_foot is not None and heard.by_foot[0] == pedals.MOST
    assert missed(heard, run, car) < 0.25 * missed(slow, run, car)


def test_a_speed_that_was_recorded_once_a_second_looks_clean_and_is_no_foot(course, car):
    drive, run = braked.drive(course, car, noise=0.0)
    time = drive["time"].values
    seldom = drive.assign(v_x=("time", np.interp(time, time[::100], drive["v_x"].values[::100])))
    heard = pedals.listening(replay(seldom, course, simulate.run), car).replay
    assert heard.by_foot is not None
    lost = in_its_band(heard, seldom["v_x"].values - np.interp(heard.place, run["s"], run["v_x"])).std()
    assert missed(heard, run, car) < 0.4 * lost


def test_a_speed_that_is_constant_has_no_noise_to_be_weighed_against(course, car):
    drive, _ = braked.drive(course, car)
    again = replay(drive, course, simulate.run)
    steady = replace(again, drive=drive.assign(v_x=0.0 * drive["v_x"] + 20.0))
    assert pedals.band(steady, again(car)) == (pedals.MOST, pedals.HIGHEST)


def test_nobody_listens_where_the_accelerometer_is_noisy(course, car):
    drive, _ = braked.drive(course, car, of_acceleration=0.5)
    assert pedals.listening(replay(drive, course, simulate.run), car).replay.by_foot is None


@pytest.mark.parametrize("own", [100.0, 20.0, 12.0, 8.0])
def test_noise_is_no_foot_however_slow_the_instrument(own):
    """What a filter leaves at 0.2 to 2.5 Hz of a slow one's noise stands out of what it leaves above its cut-off."""
    rng = np.random.default_rng(3)
    time, clock = np.arange(12000) / 100.0, np.arange(round(121 * own)) / own
    noise, _, cut_off = sampling.resample_inertial(clock, 0.05 * rng.standard_normal(clock.size), time, 100.0)
    told = SimpleNamespace(signals=np.zeros((6, time.size)), roll=0.0 * time, pitch=0.0 * time)
    speed = 20.0 + 0.5 * np.sin(2 * np.pi * time / 20.0) + 0.014 * rng.standard_normal(time.size)
    drive = xr.Dataset({"v_x": ("time", speed)}, attrs={"gravity": 0, "cut_off": cut_off})
    again = SimpleNamespace(
        time=time, compared=np.ones(time.size, bool), drive=drive, demand={"sensor": (0.0, 0.0, 0.0)},
        measured=lambda: np.stack([noise, *np.zeros((5, time.size))]),
    )  # fmt: skip
    assert pedals.band(again, told) is None


def test_a_driver_who_does_not_answer_is_not_asked(course, car):
    """Of another simulator: one who drives the speed that he was asked for at first, whatever comes then."""
    drive, _ = braked.drive(course, car)
    first = replay(drive, course, simulate.run).tuned(car).demand["speed"]
    stubborn = lambda road, vehicle, **asked: simulate.run(road, vehicle, **{**asked, "speed": first})
    assert pedals.listening(replay(drive, course, stubborn), car).replay.by_foot is None
    other = lambda road, vehicle, **asked: simulate.run(road, vehicle, **asked)
    assert pedals.listening(replay(drive, course, other), car).replay.by_foot is not None


def test_a_driver_who_is_held_to_what_he_drove_is_heard_anew_unless_what_he_missed_is_held_too(course, car):
    drive, _ = braked.drive(course, car)
    slow = replay(drive, course, simulate.run).tuned(car)
    heard, run = pedals.listening(slow, car).replay, slow.run(car)
    missed = heard.astray(run)["speed"]
    in_band = lambda again: in_its_band(heard, again.astray(run)["speed"])
    size = in_its_band(heard, missed).std()
    assert size > 0.01
    for held in (heard.keeping(run), heard.keeping(run, missed)):
        assert (in_band(held) - in_its_band(heard, missed)).std() < 0.1 * size
    silent = drive.assign(a_x=0.0 * drive["a_x"])
    anew, kept = (replace(held, drive=silent) for held in (heard.keeping(run), heard.keeping(run, missed)))
    assert (in_band(anew) - in_its_band(heard, missed)).std() > 0.5 * size
    assert (in_band(kept) - in_its_band(heard, missed)).std() < 0.1 * size


def test_it_is_said_in_which_band_drivers_are_listened_to():
    assert pedals.words([None, None]) == ""
    assert "from 0.2 Hz up to 2.4 Hz" in pedals.words([(0.2, 2.4), None])
    assert "from 0.2-0.3 Hz up to 1.9-2.4 Hz" in pedals.words([(0.2, 2.4), (0.3, 1.9)])


@pytest.fixture(scope="module")
def drawn(course, car):
    """Replays that hear a foot of 0.01 m/s2 below 1.2 Hz amid noise of 0.03 m/s2 at 100 Hz, each with the two."""
    drive, _ = braked.drive(course, car)
    again, rng, found = replay(drive, course, simulate.run), np.random.default_rng(5), []
    for _ in range(10):
        foot = smooth(rng.standard_normal(again.time.size), 100.0, 1.2, order=4)
        foot *= 0.01 / foot.std()
        noise = 0.03 * rng.standard_normal(again.time.size)
        found.append((replace(again, by_foot=(0.5, 2.0), foot=foot + noise), foot, noise))
    return found


def gained(again, acceleration):
    """The speed in m/s that an acceleration gains within the band in which a driver is heard, (time,)."""
    speed = np.cumsum(acceleration) / 100.0
    return pedals.driven(speed - smooth(speed, 100.0, again.by_foot[0]), 100.0, again.by_foot)


def test_what_is_asked_amid_noise_errs_by_nothing_that_goes_with_it(drawn, monkeypatch):
    """Else a record's own noise, which moves the model, speaks for whatever answers to its driving forces."""
    alike, errors = [], []
    for again, foot, noise in drawn:
        monkeypatch.setattr(pedals, "missing_acceleration", lambda again, simulated: noise)
        heard, true = gained(again, again.foot), gained(again, foot)
        asked = heard - pedals.without_noise(again, None).by_chance
        alike.append([np.corrcoef(heard[again.compared], (speed - true)[again.compared])[0, 1] for speed in (heard, asked)])
        errors.append([np.std((speed - true)[again.compared]) for speed in (heard, asked)])
    (of_all, of_likely), (all_of_it, likely) = np.mean(alike, axis=0), np.mean(errors, axis=0)
    assert of_all > 0.4 and abs(of_likely) < 0.1
    assert likely < 0.9 * all_of_it


def test_of_noise_alone_little_is_asked_and_of_a_foot_far_above_it_all(drawn, course, car, monkeypatch):
    left = []
    for again, _, noise in drawn:
        monkeypatch.setattr(pedals, "missing_acceleration", lambda again, simulated: noise)
        alone = replace(again, foot=noise)
        asked = gained(alone, noise) - pedals.without_noise(alone, None).by_chance
        left.append(np.var(asked[again.compared]) / np.var(gained(alone, noise)[again.compared]))
    assert np.mean(left) < 0.25
    monkeypatch.undo()
    drive, _ = braked.drive(course, car)
    heard = pedals.listening(replay(drive, course, simulate.run), car)
    braking = pedals.without_noise(heard.replay, heard.simulated)
    assert np.var(braking.by_chance[braking.compared]) < 0.01 * np.var(gained(braking, braking.foot)[braking.compared])


def test_who_is_not_heard_is_asked_for_what_he_was(course, car):
    drive, _ = braked.drive(course, car)
    slow = replay(drive, course, simulate.run)
    assert pedals.without_noise(slow, slow(car)) is slow
