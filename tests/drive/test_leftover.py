"""What alignment leaves: how it shows in the signals, and that a fit asks for it again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.drive import leftover, record, replay
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests.vehicle.roads import road, rough


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def course():
    bends = 0.004 * np.sin(np.arange(0, 400.05, 0.1) / 40)
    return simulate.prepare(road(400.0, height=rough, curvature=bends))


@pytest.fixture(scope="module")
def again(course, car):
    """A drive of the car itself, driven again by its own driver."""
    run = simulate.run(course, car, speed=20.0, lateral=0.2)
    time = run["time"].values
    given = {name: (time, run[name].values) for name in (*SIGNALS, "v_x", "s", "e")}
    drive = record.from_arrays(given, gravity=False, name="own")
    return replay.replay(drive, course, simulate.run).tuned(car)


def test_the_driver_is_brought_onto_the_measured_path_through_bends(again, car):
    run = again.run(car)
    driven = np.interp(again.place, run["s"].values, run["e"].values)
    untuned = replay.replay(again.drive, again.road, simulate.run).run(car)
    before = np.interp(again.place, untuned["s"].values, untuned["e"].values)
    off, off_before = (np.std((path - again.drive["e"].values)[again.compared]) for path in (driven, before))
    assert off < 0.005 and off < 0.2 * off_before


def test_columns_of_the_path_say_what_a_moved_path_changes(again, car):
    at = leftover.knots(again, 25.0)
    base = again(car)
    columns = leftover.moved(again, "lateral", car, (), at, base)
    change = 0.005 * np.sin(np.arange(len(at)))
    path = leftover._asked(again, "lateral", at, change)
    moved = replace(again, demand={**again.demand, "lateral": again.demand["lateral"] + path})(car)
    expected = (moved.signals - base.signals)[:, again.compared]
    predicted = (columns @ change).reshape(expected.shape)
    for signal, wanted, found in zip(SIGNALS, expected, predicted):
        if signal != "a_x":  # the speed controller remembers for longer than the knots are apart
            assert np.std(found - wanted) < 0.2 * np.std(wanted), signal


def projection(again, car):
    errors = leftover.leftover(again, car)
    return leftover.Projection(errors.columns, 1e-6 / errors.expected**2, errors.parts)


def test_planted_errors_of_an_instrument_are_taken_out(again, car):
    simulated = again(car)
    clean = again.residual(simulated)[:, again.compared]
    drive = again.drive.copy()
    drive["a_z"] = 1.004 * drive["a_z"]
    drive["roll_rate"] = drive["roll_rate"] + 4e-4
    wrong = replace(again, drive=drive).residual(simulated)[:, again.compared]
    left = projection(again, car)(wrong) - projection(again, car)(clean)
    assert np.std(left[2]) < 0.1 * np.std(wrong[2] - clean[2])
    assert np.abs(left[3]).mean() < 0.1 * 4e-4


@pytest.mark.parametrize("clock", [0.0004, 0.004])
def test_the_clock_is_taken_out_no_further_than_it_is_trusted_to(again, car, clock):
    shifted = again.residual(again(car, clock=clock))[:, again.compared]
    found = projection(again, car).errors(shifted)[0]
    assert abs(found) == pytest.approx(min(clock, replay.CLOCK_LEFT), rel=0.1)


def test_a_path_that_is_off_is_corrected_by_what_the_residual_asks_for(again, car):
    u = again.demand["lateral"]["u"]
    off = replace(again, demand={**again.demand, "lateral": again.demand["lateral"] + 0.01 * np.sin(u / 30)})
    found, errors = off, projection(off, car)
    for _ in range(3):
        found, errors = leftover.corrected(found, errors, found.residual(found(car))[:, found.compared])
    rms = [np.std(one.residual(one(car))[SIGNALS.index("yaw_rate"), one.compared]) for one in (off, found)]
    assert rms[1] < 0.4 * rms[0]


def test_asking_again_does_not_ask_for_more(again, car):
    """Usual sizes count from the path as aligned: else every round would follow the noise of the record a little farther."""
    u = again.demand["lateral"]["u"]
    found = replace(again, demand={**again.demand, "lateral": again.demand["lateral"] + 0.01 * np.sin(u / 30)})
    whole = projection(found, car)
    errors = leftover.Projection(whole.columns, 1e4 * whole.prior, whole.parts)  # sizes that hold half of the path back
    sizes = []
    for _ in range(6):
        found, errors = leftover.corrected(found, errors, found.residual(found(car))[:, found.compared])
        sizes.append(np.std(errors.driven[errors.parts["lateral"]]))
    assert sizes == pytest.approx([sizes[0]] * 6, rel=0.02) and sizes[0] < 0.005  # of a path that was moved by 0.007 m rms
