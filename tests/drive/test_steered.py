"""A path that is missed by millimetres, made good without driving again."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.drive import record
from ridecomfort.drive.replay import replay
from ridecomfort.drive.steered import steered
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars
from tests.vehicle.roads import road, rough


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def drive(car):
    """A drive of the car itself through bends, and its road."""
    course = simulate.prepare(road(500.0, height=rough, curvature=0.004 * np.sin(np.arange(0, 500.05, 0.1) / 40)))
    u = course.road["u"].values
    run = simulate.run(course, car, speed=xr.DataArray(np.interp(u, [100.0, 400.0], [10.0, 25.0]), {"u": u}, "u"), lateral=0.2)
    given = {name: (run["time"].values, run[name].values) for name in (*SIGNALS, "v_x", "s", "e")}
    return record.from_arrays(given, gravity=False, name="own"), course


def test_what_it_foretells_is_what_a_driver_who_comes_nearer_changes(drive, car):
    """A wave of 3 mm and 4 s, while the car gathers speed."""
    again = replay(*drive, simulate.run).tuned(car)
    missing = 0.003 * np.sin(2 * np.pi * again.time / 4.0)
    foretold = steered(again, car).made_good(missing)
    nearer = again.corrected({"lateral": missing})
    driven = (nearer(car).signals - again(car).signals)[:, again.compared]
    for signal, wanted, found in zip(SIGNALS, driven, foretold):
        if signal != "a_x":  # the speed controller remembers for longer than the knots are apart
            assert np.std(found - wanted) < 0.3 * np.std(wanted), signal


def test_nothing_is_made_good_where_no_path_was_measured(drive, car):
    own, course = drive
    assert steered(replay(own.assign(e=own["e"] * np.nan), course, simulate.run), car) is None


def test_a_driver_who_is_where_he_is_asked_to_be_is_not_asked_ahead(repository):
    """Other simulators have other drivers: steering for a point ahead is undone only where that is how one steers."""
    vehicle, course = quarter_cars.vehicle(repository), quarter_cars.road(length=500.0)
    run = quarter_cars.run(course, vehicle, speed=20.0)
    wave = 0.05 * np.sin(2 * np.pi * run["s"].values / 80.0)
    given = {name: (run["time"].values, run[name].values) for name in (*SIGNALS, "v_x", "s")} | {"e": (run["time"].values, wave)}
    again = replay(record.from_arrays(given, gravity=False, name="own"), course, quarter_cars.run)
    tuned = again.tuned(vehicle)
    off, off_before = (np.std(one.astray(one.run(vehicle))["lateral"][one.compared]) for one in (tuned, again))
    assert again.is_late and not tuned.is_late and off < 0.1 * off_before
