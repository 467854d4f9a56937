"""Drives that were not made, which would tell two models apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.discrepancy import elsewhere
from ridecomfort.drive import record
from ridecomfort.drive.replay import replay
from ridecomfort.vehicle import parameters
from tests.vehicle.roads import road, rough


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def again(car):
    course = simulate.prepare(road(300.0, height=rough))
    (drive,) = record.completed([simulate.run(course, car, speed=20.0)])
    return replay(drive, course, simulate.run)


def power(difference) -> float:
    return float(np.mean(difference[2] ** 2))


def test_a_model_differs_from_itself_nowhere_and_from_a_firmer_one_more_the_faster_it_goes(again, car):
    same, other = (car, {}), (car.replace(damping_front=1.3 * car["damping_front"]), {})
    assert all(np.abs(own).max() < 1e-9 for own in elsewhere.differences(again, same, same, 100.0).values())
    found = elsewhere.differences(again, same, other, 100.0)
    assert list(found) == ["43 km/h", "58 km/h", "90 km/h"]
    assert power(found["43 km/h"]) < power(found["58 km/h"]) < power(found["90 km/h"])


def test_models_that_go_at_another_speed_are_compared_at_equal_place(again, car):
    """A drag that slows one by centimetres a second moves no bump: at equal time the difference would be that of two places."""
    dragged = car, {"aerodynamic_drag": {"area": 1.0}}
    found = elsewhere.differences(again, (car, {}), dragged, 100.0)["58 km/h"]
    assert power(found) < 1e-3 * np.var(simulate.run(again.road, car, speed=16.0)["a_z"].values)


def test_no_drive_is_asked_for_that_is_harder_than_passengers_are_driven_or_that_does_not_arrive(again, car):
    bent = simulate.prepare(road(300.0, height=rough, curvature=0.011))
    (drive,) = record.completed([simulate.run(bent, car, speed=20.0)])
    hard = replay(drive, bent, simulate.run)
    assert list(elsewhere.differences(hard, (car, {}), (car, {}), 100.0)) == ["43 km/h", "58 km/h"]
    crawling = replace(again, demand={**again.demand, "speed": 0.01 * again.demand["speed"]})
    assert elsewhere.differences(crawling, (car, {}), (car, {}), 100.0) == {}
