"""What a sensor on the body senses, against the body's motion in space."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ridecomfort.vehicle import motion

TURNING, STEP = 0.35, 1e-3
"""rad/s of yaw, and s over which positions are differentiated."""


def angles(time):
    """Roll and pitch of a body that rocks, with their first and second derivatives."""
    roll, pitch = (0.02, 7.0, 0.3), (0.015, 5.0, 1.0)
    return [
        (size * np.sin(turns * time + phase), size * turns * np.cos(turns * time + phase), -size * turns**2 * np.sin(turns * time + phase))
        for size, turns, phase in (roll, pitch)
    ]


def axes(time):
    """Rotation from the body's axes to space."""
    (roll, *_), (pitch, *_) = angles(time)
    return Rotation.from_euler("ZYX", [TURNING * time, pitch, roll]).as_matrix()


@pytest.mark.parametrize("place", [(0.0, 0.0, 1.0), (1.2, 0.0, 0.0), (-0.5, 0.6, 0.9)])
def test_a_place_on_a_body_that_rocks_while_it_turns_feels_the_second_derivative_of_where_it_is(place):
    """To second order in roll and pitch. The level axes turn with the heading: without that a_x 1 m above the centre is off by an eighth."""
    found, expected = np.empty((2, 300, 3))
    for k, time in enumerate(np.linspace(0.0, 3.0, 300)):
        ahead, here, behind = (axes(time + shift) @ place for shift in (STEP, 0.0, -STEP))
        expected[k] = axes(time).T @ (ahead - 2.0 * here + behind) / STEP**2
        (roll, roll_rate, rolling), (pitch, pitch_rate, pitching) = angles(time)
        pose, speeds, change = np.zeros((3, 6))
        pose[[motion.ROLL, motion.PITCH]] = roll, pitch
        rates = [motion.YAW_RATE, motion.ROLL_RATE, motion.PITCH_RATE]
        speeds[rates] = TURNING - roll_rate * pitch, roll_rate, pitch_rate  # it rolls about an axis that is pitched
        change[rates] = -rolling * pitch - roll_rate * pitch_rate, rolling, pitching
        motion.sensor_acceleration.py_func(found[k], place, pose, speeds, change)
    off, size = (found - expected).std(axis=0), expected.std(axis=0)
    assert (off < 0.01 * size.max()).all()
