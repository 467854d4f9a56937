"""What the alignment of a drive and the file of its road leave open: errors that no model is blamed for, each at its usual size.

Directions are slow errors of the clock and of the path along the road, the road between its points, gains, tilts and biases, in
this order.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import BSpline

from ..drive.record import upward
from ..drive.replay import Replay, Simulated
from ..vocabulary import SIGNALS, STANDARD_GRAVITY

KNOTS = 30.0
"""m between the knots of what alignment may still get wrong of the place along and across the road. Paths wander within some
ten metres; a vehicle that is pushed aside by a centimetre meets another road, so that a path which is straighter than the driven
one makes evidence for whatever pushes (lift, cross-wind), and sizes too small and too sure."""

PATH_KNOTS = 12.0
"""m between those of a path of which is known what moving aside does to the signals. A path that is 2 mm off over 50 m, as the roughness of a road
leaves it, accelerates a car aside by ten times the noise of an instrument, in every repeat alike: of a stand-in car a relaxation length came
out 2.2 % short by that, and springs that harden 2.9 % too much (0.8 and 0.2 % with these)."""

FORGOTTEN = 1e-4
"""Share of the largest change that a path makes below which none counts: it is made along a part of the road only."""

DEGREE = 3
"""Of the splines."""

CLOCK, PATH, OTHERWISE, GAIN, TILT, BIAS = 0.002, 0.05, 0.7, 0.02, 0.02, (0.1, 0.1, 0.1, 0.01, 0.01, 0.01)
"""Usual sizes of what alignment leaves: s, m, share of the way to the other interpolation, 1, rad, and m/s2 or rad/s."""

BETWEEN, OF_FORCE, OF_RATES = -12, -11, -10
"""Where the road's other interpolation and the two gains stand among the nuisances of a record, from their end: three tilts and
six biases follow."""


def directions(
    again: Replay, simulated: Simulated, otherwise: np.ndarray, *, aside: np.ndarray | None = None, moved: Callable[[np.ndarray], np.ndarray] | None = None
) -> np.ndarray:
    """What each does to the signals behind the run-in, (direction, 6, sample). ``otherwise``: the signals on a road that is interpolated the other
    way. ``moved``: makes of how far the path lies farther left, (time,) in m, the change of the signals behind the run-in (6, sample); where that is
    not known, ``aside`` is their change (6, time) per metre."""
    kept = again.compared
    place = again.place[kept]
    clock, path = _splines(place, place, _pieces(place, KNOTS)), _splines(place, again.place, _pieces(place, PATH_KNOTS if moved else KNOTS))
    up = STANDARD_GRAVITY * upward(simulated.roll, simulated.pitch)[:, kept]
    force = simulated.signals[:3, kept] + up * float(again.drive.attrs.get("gravity", 0))
    rates = simulated.signals[3:, kept]
    rows = np.zeros((len(clock) + len(path) - BETWEEN, len(SIGNALS), kept.sum()), np.float32)
    for row, spline in zip(rows, clock):
        there = spline > 0
        row[:, there] = spline[there] * simulated.slopes[:, kept][:, there]
    for row, spline in zip(rows[len(clock) :], path):
        change = moved(spline) if moved else spline[kept] * aside[:, kept]
        row[:] = np.where(np.abs(change) > FORGOTTEN * np.abs(change).max(axis=1, keepdims=True), change, 0.0)
    rows[BETWEEN] = (otherwise - simulated.signals)[:, kept]
    rows[OF_FORCE, :3], rows[OF_RATES, 3:] = force, rates
    for row, axis in zip(rows[OF_RATES + 1 :], np.eye(3)):
        row[:3], row[3:] = np.cross(axis, force.T).T, np.cross(axis, rates.T).T
    rows[-len(SIGNALS) :] = np.eye(len(SIGNALS))[:, :, None]
    rows *= _usual(len(clock), len(path))[:, None, None]
    return rows


def slow(amounts: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By how much amounts (direction,) put the clock later (s) and the path farther left (m) at every ``place`` (m), each (sample,)."""
    first, count = path_among(len(amounts), place)
    clock, path = (_splines(place, place, splines - DEGREE) for splines in (first, count))
    sized = amounts * _usual(first, count)
    return sized[:first] @ clock, sized[first:BETWEEN] @ path


def path_among(count: int, place: np.ndarray) -> tuple[int, int]:
    """Number of the first of ``count`` nuisances of a record with these places (m) that is an error of its path, and how many are."""
    first = _pieces(place, KNOTS) + DEGREE
    return first, count + BETWEEN - first


def between(amounts: np.ndarray) -> float:
    """Share of the way from the road's interpolation to the other one that amounts (direction,) stand for."""
    return -OTHERWISE * float(amounts[BETWEEN])


def gains(amounts: np.ndarray) -> tuple[float, float]:
    """Gains of the accelerometer and of the gyroscope that amounts (direction,) stand for."""
    return 1.0 - GAIN * float(amounts[OF_FORCE]), 1.0 - GAIN * float(amounts[OF_RATES])


def _usual(clock: int, path: int) -> np.ndarray:
    """Usual sizes of the nuisances of a record, so many of them of its ``clock`` and of its ``path``."""
    return np.array([CLOCK] * clock + [PATH] * path + [OTHERWISE, GAIN, GAIN, *[TILT] * 3, *BIAS], np.float32)


def _pieces(place: np.ndarray, spacing: float) -> int:
    """Pieces of a spline over the place, knots about ``spacing`` apart."""
    return max(1, int(round(np.ptp(place) / spacing)))


def _splines(over: np.ndarray, place: np.ndarray, pieces: int) -> np.ndarray:
    """Cubic B-splines of so many ``pieces`` over the places ``over``, at every ``place``: slow functions that sum to one, (spline, sample)."""
    inner = np.linspace(over.min(), over.max(), pieces + 1)
    knots = np.concatenate([np.full(DEGREE, inner[0]), inner, np.full(DEGREE, inner[-1])])
    return BSpline.design_matrix(np.clip(place, inner[0], inner[-1]), knots, DEGREE).toarray().T
