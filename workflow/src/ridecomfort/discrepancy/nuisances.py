"""What the alignment of a drive and the file of its road leave open: errors that no model is blamed for, each at its usual size.

Directions are slow errors of the clock and of the path along the road, the road between its points, gains, tilts and biases, in
this order.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from ..drive.record import upward
from ..drive.replay import Replay, Simulated
from ..vocabulary import SIGNALS, STANDARD_GRAVITY

KNOTS = 30.0
"""m between the knots of what alignment may still get wrong of the place along and across the road. Paths wander within some
ten metres; a vehicle that is pushed aside by a centimetre meets another road, so that a path which is straighter than the driven
one makes evidence for whatever pushes (lift, cross-wind), and sizes too small and too sure."""

CLOCK, PATH, OTHERWISE, GAIN, TILT, BIAS = 0.002, 0.05, 0.7, 0.02, 0.02, (0.1, 0.1, 0.1, 0.01, 0.01, 0.01)
"""Usual sizes of what alignment leaves: s, m, share of the way to the other interpolation, 1, rad, and m/s2 or rad/s."""

BETWEEN, OF_FORCE, OF_RATES = -12, -11, -10
"""Where the road's other interpolation and the two gains stand among the nuisances of a record, from their end: three tilts and
six biases follow."""


def directions(again: Replay, simulated: Simulated, aside: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """What each does to the signals behind the run-in, (direction, 6, sample). ``aside``: change of the signals (6, time) per metre that the path
    lies farther left; ``otherwise``: the signals on a road that is interpolated the other way."""
    kept = again.compared
    splines = _splines(again.place[kept], KNOTS)
    up = STANDARD_GRAVITY * upward(simulated.roll, simulated.pitch)[:, kept]
    force = simulated.signals[:3, kept] + up * float(again.drive.attrs.get("gravity", 0))
    rates = simulated.signals[3:, kept]
    rows = np.zeros((2 * len(splines) - BETWEEN, len(SIGNALS), kept.sum()), np.float32)
    for own, slow in ((rows, simulated.slopes[:, kept]), (rows[len(splines) :], aside[:, kept])):
        for row, spline in zip(own, splines):
            there = spline > 0
            row[:, there] = spline[there] * slow[:, there]
    rows[BETWEEN] = (otherwise - simulated.signals)[:, kept]
    rows[OF_FORCE, :3], rows[OF_RATES, 3:] = force, rates
    for row, axis in zip(rows[OF_RATES + 1 :], np.eye(3)):
        row[:3], row[3:] = np.cross(axis, force.T).T, np.cross(axis, rates.T).T
    rows[-len(SIGNALS) :] = np.eye(len(SIGNALS))[:, :, None]
    rows *= _usual(len(rows))[:, None, None]
    return rows


def slow(amounts: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By how much amounts (direction,) put the clock later (s) and the path farther left (m) at every ``place`` (m), each (sample,)."""
    splines = _splines(place, KNOTS)
    sized = amounts * _usual(len(amounts))
    return sized[: len(splines)] @ splines, sized[len(splines) : 2 * len(splines)] @ splines


def between(amounts: np.ndarray) -> float:
    """Share of the way from the road's interpolation to the other one that amounts (direction,) stand for."""
    return -OTHERWISE * float(amounts[BETWEEN])


def gains(amounts: np.ndarray) -> tuple[float, float]:
    """Gains of the accelerometer and of the gyroscope that amounts (direction,) stand for."""
    return 1.0 - GAIN * float(amounts[OF_FORCE]), 1.0 - GAIN * float(amounts[OF_RATES])


def _usual(count: int) -> np.ndarray:
    """Usual sizes of ``count`` nuisances of a record."""
    splines = (count + BETWEEN) // 2
    return np.array([CLOCK] * splines + [PATH] * splines + [OTHERWISE, GAIN, GAIN, *[TILT] * 3, *BIAS], np.float32)


def _splines(place: np.ndarray, spacing: float) -> np.ndarray:
    """Cubic B-splines over the place, knots about ``spacing`` apart: slow functions that sum to one, (spline, sample)."""
    pieces = max(1, int(round(np.ptp(place) / spacing)))
    inner = np.linspace(place.min(), place.max(), pieces + 1)
    knots = np.concatenate([np.full(3, inner[0]), inner, np.full(3, inner[-1])])
    return BSpline.design_matrix(np.clip(place, inner[0], inner[-1]), knots, 3).toarray().T
