"""What the kernel is given to drive on and what it tells of the body's motion."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

COLUMNS = ("s", "e", "v_x", "a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate", "roll", "pitch")
"""Columns of a kernel's record, named as in the vocabulary."""

SENSED = slice(3, 9)
"""The columns of what a sensor senses: accelerations and rates."""

SPEED, LATERAL, CURVATURE = range(3)
"""Columns of what the driver aims for: speed (m/s), lateral position (m), curvature of the road (1/m)."""

S, E, HEADING, Z, ROLL, PITCH = range(6)
"""Entries of the pose: place on the road, heading against it, height and angles of the body."""

V_X, V_Y, YAW_RATE, V_Z, ROLL_RATE, PITCH_RATE = range(6)
"""Entries of the speeds, in axes that turn with the heading of the body but stay level."""


SINE = (-1 / 6, 1 / 120, -1 / 5040, 1 / 362880)
COSINE = (-1 / 2, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800)
"""Taylor coefficients."""


class BodyMotion(NamedTuple):
    """The motion of the sprung mass at an instant, for effects that act on it (SI units, level axes).

    Effects are asked four times in a step: accelerations are those of the step before in the first round, and those that the round before
    led to in the next ones, of which the last counts. ``suspension_front`` and ``suspension_rear``: forces in N of the
    axles on the body; ``front`` and ``rear``: their places in m ahead of the centre of gravity.
    """

    s: float
    speed: float
    side_speed: float
    vertical_speed: float
    roll: float
    pitch: float
    roll_rate: float
    pitch_rate: float
    yaw_rate: float
    vertical_acceleration: float
    roll_acceleration: float
    pitch_acceleration: float
    suspension_front: float
    suspension_rear: float
    sprung_mass: float
    front: float
    rear: float


@njit(forceinline=True, error_model="numpy", _nrt=False)
def sensor_acceleration(row, sensor, pose, speeds, change):
    """Put the acceleration in body axes (m/s2) of a sensor fixed to the body into row[0:3].

    ``sensor``: its place in m relative to the centre of gravity. ``change``: time derivatives
    of ``speeds``. Roll and pitch enter to first order.
    """
    roll, pitch = pose[ROLL], pose[PITCH]
    p, q, r = speeds[ROLL_RATE], speeds[PITCH_RATE], speeds[YAW_RATE]
    # The axes turn with the heading, and so does what they tell of the turning.
    p_dot, q_dot, r_dot = change[ROLL_RATE] - r * q, change[PITCH_RATE] + r * p, change[YAW_RATE]
    x = sensor[0] + pitch * sensor[2]
    y = sensor[1] - roll * sensor[2]
    z = sensor[2] - pitch * sensor[0] + roll * sensor[1]
    turn = p * x + q * y + r * z
    square = p * p + q * q + r * r
    a_x = change[V_X] - r * speeds[V_Y] + q_dot * z - r_dot * y + p * turn - square * x
    a_y = change[V_Y] + r * speeds[V_X] + r_dot * x - p_dot * z + q * turn - square * y
    a_z = change[V_Z] + p_dot * y - q_dot * x + r * turn - square * z
    row[0] = a_x - pitch * a_z
    row[1] = a_y + roll * a_z
    row[2] = a_z + pitch * a_x - roll * a_y


@njit(forceinline=True, error_model="numpy", _nrt=False)
def body_rates(row, pose, speeds):
    """Rates about the body's axes."""
    roll, pitch = pose[ROLL], pose[PITCH]
    p, q, r = speeds[ROLL_RATE], speeds[PITCH_RATE], speeds[YAW_RATE]
    row[0] = p - pitch * r
    row[1] = q + roll * r
    row[2] = r + pitch * p - roll * q


@njit(forceinline=True, error_model="numpy", _nrt=False)
def body_course(row, pose, speeds):
    """Put place, speed and angles of the body into a row of COLUMNS."""
    pitch = pose[PITCH]
    row[0] = pose[S]
    row[1] = pose[E]
    row[2] = speeds[V_X] * (1.0 - 0.5 * pitch * pitch) - pitch * speeds[V_Z]
    row[9] = pose[ROLL]
    row[10] = pitch


@njit(forceinline=True, error_model="numpy", _nrt=False)
def sin_cos(angle):
    """Sine and cosine by their series: exact to 3e-9 up to 0.8 rad, beyond what the driver steers."""
    x = angle * angle
    sine = angle * (1.0 + x * (SINE[0] + x * (SINE[1] + x * (SINE[2] + x * SINE[3]))))
    cosine = 1.0 + x * (COSINE[0] + x * (COSINE[1] + x * (COSINE[2] + x * (COSINE[3] + x * COSINE[4]))))
    return sine, cosine
