"""The least-squares problem of a calibration at points that no vehicle can be at."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from ridecomfort import calibrated, problem
from tests import quarter_cars


def test_a_point_whose_vehicle_there_cannot_be_is_one_that_cannot_be_driven(repository):
    nominal = quarter_cars.vehicle(repository)
    car = lambda point: calibrated.with_values(nominal, {}, {"cg_to_front_axle": point[0]})
    task = SimpleNamespace(replays=[None], _car=car, _residual=None)
    assert "lies behind the rear axle" in str(problem.Problem._piece(task, 0, np.array([1.01 * nominal["wheelbase"]])))
