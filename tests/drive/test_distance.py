"""What is told of a distance, a path and a speed: held, standing, rounded, differentiated."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ridecomfort.drive import record, sampling
from ridecomfort.errors import InputError
from tests.drive.smooth import TIME, alone, quantities, standing


def test_a_distance_that_is_held_jumps_by_a_metre_or_is_told_beside_a_speed_in_another_unit_is_not_refused():
    record.from_arrays(quantities(s=(TIME, 20 * np.floor(4 * TIME) / 4)))
    jitter = np.random.default_rng(3).uniform(-0.7, 0.7, TIME[::10].size)
    record.from_arrays(quantities(s=(TIME[::10], 20 * TIME[::10] + jitter)))
    record.from_arrays(quantities(s=(TIME[::10], 20 * TIME[::10]), v_x=(TIME, 72 + 0 * TIME)))


def test_a_distance_without_a_speed_tells_it_though_it_jitters():
    driven = 20 * TIME + 1.5 * np.sin(0.8 * TIME)
    clean = record.from_arrays(alone(driven))
    np.testing.assert_allclose(clean["v_x"].values, np.gradient(driven, 0.01), rtol=0, atol=1e-9)
    jitter = 0.5 * np.random.default_rng(3).standard_normal(TIME.size)
    found = record.from_arrays(alone(driven + jitter))
    assert "low-passed" in found.attrs["treatment"]
    wrong = np.abs(found["v_x"].values - np.gradient(driven, 0.01))
    assert wrong.max() < 5.0 and wrong[100:-100].max() < 0.5
    coarse = record.from_arrays(alone(np.round(driven, 1)))
    assert "v_x differentiated from s, low-passed at 0.4 Hz (it jitters by 1.8 m/s)" in coarse.attrs["treatment"]
    assert np.abs(coarse["v_x"].values - np.gradient(driven, 0.01))[100:-100].max() < 0.06
    held = record.from_arrays(alone(20 * np.floor(4 * TIME) / 4 + 0.1 * np.floor(4 * TIME) ** 2))
    assert 15 < held["v_x"].values.min() < held["v_x"].values.max() < 95


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (alone(400 - 20 * TIME), "s: falls from 400.0 to 0.2 m: driven against the reference line"),
        (alone(20 * TIME + 5 * (TIME >= 8)), "s: sample 801 (8 s) lies +5.2 m from the value before it, while it goes on by 0.2 m"),
        (alone(20 * TIME + 5 * (TIME >= TIME[-1])), "s: sample 2000 (19.99 s) lies +5.2 m from the value before it"),
        ({name: (time + 7, values) for name, (time, values) in alone(200 * TIME).items()}, "s: changes by 200 m/s at 7 s (expected -5 to 90; are the units"),
    ],
)
def test_a_mistake_in_a_distance_without_a_speed_is_told_of_the_distance(given, words):
    with pytest.raises(InputError) as problem:
        record.from_arrays(given, file="drive.csv")
    assert str(problem.value).startswith(f"drive.csv: {words}")


@pytest.mark.parametrize("hold", [0.1, 0.25, 1.0])
def test_a_place_that_is_held_until_the_next_is_known_is_that_of_its_changes(hold):
    driven = lambda time: 20 * time + 1.5 * np.sin(0.8 * time)
    aside = lambda time: 0.5 * np.sin(0.4 * time)
    known = hold * np.floor(TIME / hold + 1e-6)
    drive = record.from_arrays(quantities(s=(TIME, driven(known)), v_x=(TIME, np.gradient(driven(TIME), TIME)), e=(TIME, aside(known))))
    time = drive["time"].values + drive.attrs["start_time"]
    assert np.abs(drive["s"].values - driven(time)).max() < 0.15 * hold**2  # of a line between its changes, an eighth of the acceleration
    assert np.abs(drive["e"].values - aside(time)).max() < 0.02 * hold**2
    assert drive.attrs["treatment"].count(f"held for {hold:.3g} s at a time") == 2
    assert time[0] == pytest.approx(hold, abs=0.011) and time[-1] > TIME[-1] - 1.1 * hold


@pytest.mark.parametrize("is_alone", [False, True])
def test_a_place_that_is_held_for_too_long_is_refused(is_alone):
    """Between two seconds a line misses it by more than half of the acceleration, and a speed made of it would be one of stairs."""
    told = 20 * (known := 2.0 * np.floor(TIME / 2.0 + 1e-6)) + 1.5 * np.sin(0.8 * known)
    with pytest.raises(InputError) as problem:
        record.from_arrays(alone(told) if is_alone else quantities(s=(TIME, told), v_x=(TIME, 20 + 1.2 * np.cos(0.8 * TIME))), file="drive.csv")
    told = "drive.csv: s: is held for 2 s at a time until the next value (expected 1.1 s at most"
    assert str(problem.value) == told + (")" if is_alone else "; or leave s out, which is then integrated from v_x)")


@pytest.mark.parametrize("hold", [0.1, 0.2, 1.0])
def test_a_speed_that_is_held_until_the_next_is_known_is_that_of_its_changes(hold):
    """Told late by half a hold, its way would be 0.6 m short in 20 s with a hold of a second."""
    speed = lambda time: 20 + 1.2 * np.cos(0.8 * time) + 0.06 * time
    known = hold * np.floor(TIME / hold + 1e-6)
    drive = record.from_arrays({name: pair for name, pair in quantities(v_x=(TIME, speed(known))).items() if name != "s"})
    time = drive["time"].values + drive.attrs["start_time"]
    assert np.abs(drive["v_x"].values - speed(time)).max() < 0.11 * hold**2
    driven = 20 * time + 1.5 * np.sin(0.8 * time) + 0.03 * time**2
    assert np.abs(drive["s"].values - (driven - driven[0])).max() < 0.15 * hold**2
    assert f"v_x, held for {hold:.3g} s at a time" in drive.attrs["treatment"] and time[0] == pytest.approx(hold, abs=0.011)


def test_a_speed_that_is_held_and_stays_for_long_keeps_its_value_until_it_changes():
    known = np.floor(TIME)
    speed = lambda time: 20 - np.interp(time, [7, 11], [0, 6.4]) - 0.05 * np.sin(time) * ((time > 6.5) & (time < 15.5))
    drive = record.from_arrays({name: pair for name, pair in quantities(v_x=(TIME, speed(known))).items() if name != "s"})
    time = drive["time"].values + drive.attrs["start_time"]
    np.testing.assert_allclose(drive["v_x"].values, np.interp(time, np.arange(20), speed(np.arange(20))), rtol=0, atol=1e-9)
    assert time[0] == pytest.approx(0.0, abs=1e-9) and time[-1] == pytest.approx(19.0, abs=0.011)


@pytest.mark.parametrize("decimals", [9, 2])
def test_a_speed_in_whole_kilometres_an_hour_stays_as_it_is(decimals):
    rounded = np.round(np.round(72 + 4 * np.cos(0.8 * TIME) + 0.2 * TIME) / 3.6, decimals)
    drive = record.from_arrays({name: pair for name, pair in quantities(v_x=(TIME, rounded)).items() if name != "s"})
    np.testing.assert_allclose(drive["v_x"].values, rounded, rtol=0, atol=1e-9)
    assert drive.attrs["treatment"] == "s integrated from v_x"


@pytest.mark.parametrize("is_alone", [False, True])
@pytest.mark.parametrize(("rounded", "near"), [(False, 0.15), (True, 0.65)])
def test_a_distance_that_stands_now_and_then_goes_on_between_where_it_does(rounded, near, is_alone):
    told, driven = standing((0.0, 0.5), (5.0, 5.3), (9.0, 10.0), (19.8, 20.0), rounded=rounded)
    given = alone(told) if is_alone else quantities(s=(TIME, told), v_x=(TIME, np.gradient(driven, TIME)))
    drive = record.from_arrays(given)
    time = drive["time"].values + drive.attrs["start_time"]
    assert np.abs(drive["s"].values - np.interp(time, TIME, driven)).max() < near  # of a line over a second, an eighth of the acceleration
    assert time[0] == pytest.approx(0.5, abs=0.06) and time[-1] == pytest.approx(19.8, abs=0.06)
    assert re.search(r"cut at an end \(places: 4, the first at 0 s, for up to (0.99|1.02) s\)", drive.attrs["treatment"])


def test_a_distance_that_stands_where_the_vehicle_does_stays_as_it_is():
    speed = np.interp(TIME, [0, 4, 8, 12, 16, 20], [16, 16, 0, 0, 16, 16])
    driven = sampling.integral(speed, TIME)
    drive = record.from_arrays(quantities(s=(TIME, driven), v_x=(TIME, speed)))
    np.testing.assert_allclose(drive["s"].values, driven, rtol=0, atol=1e-9)
    assert drive.attrs["treatment"] == "none"


def test_a_place_that_is_rounded_or_seldom_changes_stays_as_it_is():
    aside = np.where(TIME < 8, 0.1, np.where(TIME < 13, 0.4, np.where(TIME < 16, 0.2, 0.0)))
    given = quantities(s=(TIME, np.round(20 * TIME + 1.5 * np.sin(0.8 * TIME))), e=(TIME, aside))
    drive = record.from_arrays(given)
    assert drive.attrs["treatment"] == "none"
    for name in ("s", "e"):
        np.testing.assert_allclose(drive[name].values, given[name][1], rtol=0, atol=1e-9)


def test_a_distance_that_goes_on_where_no_speed_was_recorded_is_no_jump():
    middle = (TIME >= 5) & (TIME <= 15)
    seldom = TIME[::20]
    drive = record.from_arrays(quantities(s=(seldom, 25 * seldom), v_x=(TIME[middle], 25 + 0 * TIME[middle])))
    assert float(drive["time"][-1]) == pytest.approx(10.0, abs=0.02)
    with pytest.raises(InputError, match=r"sample 52 \(10.2 s\) lies \+45 m"):
        record.from_arrays(quantities(s=(seldom, 25 * seldom + 40 * (seldom > 10.1)), v_x=(TIME[middle], 25 + 0 * TIME[middle])))
