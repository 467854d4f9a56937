"""A vehicle's file that is farther off than it was thought to be."""

from __future__ import annotations

import pytest

from ridecomfort.discrepancy import beyond, rung, select
from ridecomfort.discrepancy import car as cars
from ridecomfort.vehicle import parameters
from tests.blind import trials


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def found(car, **wrong):
    """What lies beyond its bounds where the measured car is another: (parameters by name, all of it)."""
    true = car.replace(**{name: factor * car[name] for name, factor in wrong.items()})
    drives = trials.make(41, true, {}, 1.0).measured
    experiment = cars.car(cars.sites_of(drives), car, library_names=["crosswind"])
    selection = select.search(rung.begin(experiment, cars.start_values(experiment)), most=1)
    told = beyond.beyond_bounds(selection)
    return {one.parameter: one for one in told.parameters} if told else {}, told


def test_a_bar_twice_as_stiff_and_an_inertia_of_seven_tenths_are_told_with_what_they_explain(car):
    wrong = {"anti_roll_stiffness_rear": 2.0, "roll_inertia": 0.7}
    by_name, told = found(car, **wrong)
    for name, factor in wrong.items():
        lower, upper = by_name[name].interval
        assert lower < factor * car[name] < upper and not by_name[name].bounds[0] < by_name[name].value < by_name[name].bounds[1]
    assert told.share > 0.3 and told.held_out_share > 0.3
    assert "roll_inertia" in told.words()


def test_nothing_is_told_of_a_car_that_is_within_its_bounds(car):
    assert found(car, anti_roll_stiffness_rear=1.1) == ({}, None)
