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


def test_the_influence_of_a_sample_is_what_it_adds_to_the_gradient_of_the_cost(repository):
    """Errors are taken out of a residual once, and out of the Jacobian that it is weighed by: the gradient takes them out twice."""
    car, road = quarter_cars.vehicle(repository), quarter_cars.road(length=300.0)
    run, rng = quarter_cars.run(road, car, speed=20.0, start=55.0, end=240.0), np.random.default_rng(0)
    noise = dict(zip(SIGNALS, (0.01, 0.01, 0.02, 5e-4, 5e-4, 5e-4)))
    time = run["time"].values
    given = {name: (time, run[name].values + noise.get(name, 0.0) * rng.standard_normal(time.size)) for name in (*SIGNALS, "s", "v_x", "e")}
    chosen = ("spring_stiffness_front", "tyre_radial_stiffness")
    task = calibrate.problem([record.from_arrays(given, gravity=False)], road, car, simulate=quarter_cars.run, parameters=chosen)
    point = task.point([car[name] for name in chosen])
    jacobian, (residual,) = task.jacobian(point, [0, 1]), task.residuals_as_aligned(point)
    change = 1e-3 * residual.std() * rng.standard_normal(residual.shape)
    without = [task._left_over[0](residual + share * change).ravel() for share in (0.0, 1.0)]
    (influence,) = task.influence(point, jacobian)
    added = np.einsum("stp,st->p", influence, change)
    np.testing.assert_allclose(added, jacobian.T @ (without[1] - without[0]), rtol=1e-6)
    assert (np.abs(added / (jacobian.T @ change.ravel()) - 1.0) > 1e-3).all()  # errors that are taken out but once


def test_a_point_whose_vehicle_there_cannot_be_is_one_that_cannot_be_driven(repository):
    nominal = quarter_cars.vehicle(repository)
    car = lambda point: calibrated.with_values(nominal, {}, {"cg_to_front_axle": point[0]})
    task = SimpleNamespace(replays=[None], _car=car, _residual=None)
    assert "lies behind the rear axle" in str(problem.Problem._piece(task, 0, np.array([1.01 * nominal["wheelbase"]])))
