"""The compiled kernel equals the plain model."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.effects import compose
from ridecomfort.vehicle import reference
from ridecomfort.vehicle.constants import constants, wheel_table

from tests.vehicle.roads import road, rough


@pytest.mark.parametrize(
    ("interpolation", "friction", "speed", "slowing"),
    [("cubic", 0.8, 22.0, 0.0), ("linear", 0.3, 9.0, 0.0), ("linear", 0.3, 11.0, 0.35)],
    ids=["fast and dry", "slow and slippery", "wheels lock"],
)
def test_kernel_equals_reference(car, interpolation, friction, speed, slowing):
    ground = road(60.0, height=lambda u, v: rough(u, v) + 0.07 * u + 0.04 * v, curvature=0.012)
    course = simulate.prepare(ground, interpolation)
    targets = np.stack(
        [np.maximum(speed - slowing * course.u, 1.0) + np.sin(course.u / 5), 0.3 * np.sin(course.u / 7), course.curvature], axis=1
    )
    start, end, step, every, sensor = 4.0, 40.0, 0.001, 10, (-0.1, 0.2, 0.9)
    record, sensed = np.empty((11, 2000)).T, np.empty((6, 20000))  # in memory as a simulation has them
    records, steps = compose.compose([]).drive(
        constants(car), wheel_table(car), course.surface, course.elevation, targets, friction,
        start, end, step, every, sensor, np.zeros(0), 0, record, sensed,
    )  # fmt: skip
    expected, expected_sensed = reference.drive(
        car, course.surface, course.elevation, targets, friction, start, end, step, every, sensor
    )
    assert steps == expected_sensed.shape[1] > 1000
    np.testing.assert_allclose(sensed[:3, :steps], expected_sensed[:3], rtol=0, atol=1e-6)
    # Equal but for rounding, which a car near the limit of friction makes grow.
    np.testing.assert_allclose(sensed[3:, :steps], expected_sensed[3:], rtol=0, atol=1e-7)
    known = [0, 1, 2, 9, 10]
    np.testing.assert_allclose(record[:records, known], expected[:, known], rtol=0, atol=1e-7)
