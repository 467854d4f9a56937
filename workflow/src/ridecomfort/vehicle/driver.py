"""The driver: the speed that a site calls for, and how speed and path are held to."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numba import njit
from scipy.ndimage import minimum_filter1d

from ..errors import InputError
from .motion import SPEED

CURVATURE_LENGTH = 10.0
"""m over which the curvature of a reference line is averaged: what a driver takes for the bend."""

PREVIEW_TIME = 0.8
"""s ahead that the path follower aims for; about what drivers look ahead on country roads."""

PREVIEW_MINIMUM = 6.0
"""m; keeps the path follower stable at low speed."""

SLOWEST = 1.0
"""m/s; below it the tyres' slips lose their meaning."""

STEERING_LIMIT = 0.7
"""rad; the lock of the front wheels."""

SPEED_PREVIEW_TIME = 0.3
"""s ahead that the speed controller reads its profile, making up for its own delay."""

SPEED_GAIN = 1.0
"""1/s; acceleration asked for per m/s of speed error."""

SPEED_INTEGRAL_GAIN = 0.2
"""1/s2; removes the error that a grade would leave."""


AROUND, NOT_DRIVEN = 5.0, 0.1
"""s by which a change of speed is held at its ends, and share of a wave below which it counts as one that is not driven."""


def smooth_curvature(road: xr.Dataset) -> np.ndarray:
    """Curvature of the reference line in 1/m over u, averaged over CURVATURE_LENGTH."""
    return _moving_average(road.curvature.values, road.u.values, CURVATURE_LENGTH)


def speed_profile(
    road: xr.Dataset,
    *,
    limit: float,
    lateral_acceleration: float,
    acceleration: float,
    deceleration: float,
    smoothing: float = 20.0,
) -> xr.DataArray:
    """Speed in m/s over u that keeps a site's limit and comfort (sec:sim_env: the motion profile).

    The highest speed that stays below ``limit`` (m/s) and below ``lateral_acceleration`` in
    bends and needs no more than ``acceleration`` and ``deceleration`` (m/s2, both positive)
    between them, averaged over ``smoothing`` metres so that its acceleration has no steps; a
    bend's speed holds from half of that before it to half of that after it.
    """
    for name, value in (
        ("limit", limit),
        ("lateral_acceleration", lateral_acceleration),
        ("acceleration", acceleration),
        ("deceleration", deceleration),
    ):
        if not value > 0:
            raise InputError(f"{value!r}, expected a positive number", place=f"speed.{name}")
    u = road.u.values
    curvature = np.abs(smooth_curvature(road))
    square = np.minimum(limit**2, lateral_acceleration / np.maximum(curvature, 1e-9))
    square = minimum_filter1d(square, 2 * round(smoothing / (u[1] - u[0]) / 2) + 1, mode="nearest")
    square = _limit_growth(square, u, acceleration)
    square = _limit_growth(square[::-1], -u[::-1], deceleration)[::-1]
    speed = _moving_average(np.sqrt(square), u, smoothing)
    return xr.DataArray(speed, coords={"u": road.u}, dims="u", name="speed", attrs={"units": "m/s"})


@njit(cache=True)
def _limit_growth(square, u, acceleration):
    limited = square.copy()
    for i in range(1, len(u)):
        reachable = limited[i - 1] + 2.0 * acceleration * (u[i] - u[i - 1])
        limited[i] = min(limited[i], reachable)
    return limited


def _moving_average(values: np.ndarray, u: np.ndarray, length: float) -> np.ndarray:
    """Centred average over ``length`` metres of equidistant values; the ends are held."""
    half = int(round(length / (u[1] - u[0]) / 2))
    if half < 1:
        return np.asarray(values, dtype=float)
    padded = np.pad(np.asarray(values, dtype=float), half, mode="edge")
    total = np.concatenate([[0.0], np.cumsum(padded)])
    width = 2 * half + 1
    return (total[width:] - total[:-width]) / width


@njit(forceinline=True)
def steering(e, course, speed, target, curvature, wheelbase):
    """Angle of the front wheels in rad: the bend of the lane at the target offset, and pure pursuit of that offset.

    ``curvature`` is that of the reference line. ``course`` is the direction of travel against the reference line, so that the slip of the
    body in a bend leaves no offset. Pure pursuit: Coulter (1992), CMU-RI-TR-92-01.
    """
    preview = max(PREVIEW_MINIMUM, PREVIEW_TIME * speed)
    error = e + preview * course - target
    bend = curvature / (1.0 - curvature * target)
    angle = wheelbase * (bend - 2.0 * error / (preview * preview))
    return min(max(angle, -STEERING_LIMIT), STEERING_LIMIT)


def path_demand(offset: np.ndarray, interval: float, speed: np.ndarray) -> np.ndarray:
    """Target in m that the path follower must be given to drive ``offset`` (m), both over uniform time (``interval`` in s).

    The inverse of pure pursuit: with a preview of T seconds it drives an offset e for which, linearised,
    e + T de/dt + T^2/2 d2e/dt2 is the target. ``offset`` must be smooth: a wave of 1 Hz comes out thirteen times as large.
    """
    preview = np.maximum(PREVIEW_MINIMUM, PREVIEW_TIME * speed) / speed
    rate = np.gradient(offset, interval)
    return offset + preview * rate + 0.5 * preview**2 * np.gradient(rate, interval)


@njit(forceinline=True)
def acceleration_demand(speed, target, target_ahead, distance_ahead, integral):
    """Acceleration in m/s2 that the speed controller asks for.

    Feed-forward of the profile's own acceleration, and a proportional-integral correction.
    """
    profile = target * (target_ahead - target) / distance_ahead
    return profile + SPEED_GAIN * (target - speed) + SPEED_INTEGRAL_GAIN * integral


@njit(forceinline=True, error_model="numpy", _nrt=False)
def locate(surface, targets, s):
    """Cell of the targets (u, 3) at s in m, and how far into it."""
    place = (s - surface.u0) * surface.per_u
    index = min(max(int(place), 0), targets.shape[0] - 2)
    return index, min(max(place - index, 0.0), 1.0)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def target_at(targets, index, fraction, column):
    """A column of the targets (u, 3) at what ``locate`` found."""
    return targets[index, column] + fraction * (targets[index + 1, column] - targets[index, column])


@njit(forceinline=True, error_model="numpy", _nrt=False)
def speed_control(car, surface, targets, index, fraction, s, v_x, pace, integral, step):
    """Force in N that the driver asks for, and the integral of the speed error in m."""
    target = target_at(targets, index, fraction, SPEED)
    distance = SPEED_PREVIEW_TIME * pace
    index, fraction = locate(surface, targets, s + distance)
    ahead = target_at(targets, index, fraction, SPEED)
    integral += step * (target - v_x)
    return car.total_mass * acceleration_demand(v_x, target, ahead, distance, integral), integral


def speed_demand(change: np.ndarray, interval: float) -> np.ndarray:
    """Change in m/s of the profile that the speed controller must be given to drive a ``change`` (m/s), both over uniform time (``interval``
    in s).

    The inverse of `acceleration_demand`, whose feed-forward is the slope of the profile over the next SPEED_PREVIEW_TIME: of a wave of 2.5 Hz
    three tenths are driven, of one of 3.3 Hz next to nothing, which is not asked for (Wiener's inverse).
    """
    around = int(AROUND / interval)
    padded = np.pad(change, around, mode="edge")
    by_time = 2j * np.pi * np.fft.rfftfreq(padded.size, interval)[1:]
    corrected = SPEED_GAIN + SPEED_INTEGRAL_GAIN / by_time
    driven = ((np.exp(by_time * SPEED_PREVIEW_TIME) - 1.0) / SPEED_PREVIEW_TIME + corrected) / (by_time + corrected)
    inverse = np.concatenate([[1.0], driven.conj() / (np.abs(driven) ** 2 + NOT_DRIVEN**2)])
    return np.fft.irfft(np.fft.rfft(padded) * inverse, padded.size)[around : around + change.size]
