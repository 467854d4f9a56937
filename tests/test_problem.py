"""The least-squares problem of a calibration: what it leaves open of drives, and points that no vehicle can be at."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from ridecomfort import calibrate, calibrated, problem
from ridecomfort.drive import record
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars


def test_the_distance_of_a_path_counts_from_the_aligned_one_though_it_is_driven(repository):
    """Aligned 30 mm to the right of where it was driven: what is left open of a path, within its usual size, finds most of that."""
    car, road = quarter_cars.vehicle(repository), quarter_cars.road(length=500.0)
    run = quarter_cars.run(road, car, speed=20.0, lateral=0.1, start=55.0, end=440.0)
    time, rng = run["time"].values, np.random.default_rng(0)
    noise = dict(zip(SIGNALS, (0.01, 0.01, 0.02, 5e-4, 5e-4, 5e-4)))
    given = {name: (time, run[name].values + noise.get(name, 0.0) * rng.standard_normal(time.size)) for name in (*SIGNALS, "s", "v_x")}
    given["e"] = time, run["e"].values - 0.03
    drive = record.from_arrays(given, gravity=False)
    drive = drive.assign(roll=0.0 * drive["a_x"], pitch=0.0 * drive["a_x"])
    task = calibrate.problem([drive], road, car, simulate=quarter_cars.run, parameters=["spring_stiffness_front"])
    point = task.point([car["spring_stiffness_front"]])
    ((_, path),) = task.about(point).left_over(point)
    assert 0.02 < path < 0.035


def test_a_point_whose_vehicle_there_cannot_be_is_one_that_cannot_be_driven(repository):
    nominal = quarter_cars.vehicle(repository)
    car = lambda point: calibrated.with_values(nominal, {}, {"cg_to_front_axle": point[0]})
    task = SimpleNamespace(replays=[None], _car=car, _residual=None)
    assert "lies behind the rear axle" in str(problem.Problem._piece(task, 0, np.array([1.01 * nominal["wheelbase"]])))
