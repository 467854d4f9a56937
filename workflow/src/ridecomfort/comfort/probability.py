"""Shares of runs: their confidence intervals."""

from __future__ import annotations

import numpy as np
from scipy.special import betainccinv, betaincinv, ndtri

from ..errors import InputError

CONFIDENCE = 0.95


def wilson(count, runs, confidence: float = CONFIDENCE) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper bound of the probability of an event seen ``count`` times in ``runs`` (Wilson 1927).

    Its coverage is ``confidence`` on average over the probability.
    """
    count, runs = _counts(count, runs)
    z = -ndtri((1.0 - confidence) / 2.0)
    share = count / runs
    centre = (share + z**2 / (2 * runs)) / (1 + z**2 / runs)
    half = z / (1 + z**2 / runs) * np.sqrt(share * (1 - share) / runs + z**2 / (4 * runs**2))
    return np.where(count == 0, 0.0, centre - half), np.where(count == runs, 1.0, centre + half)


def clopper_pearson(count, runs, confidence: float = CONFIDENCE) -> tuple[np.ndarray, np.ndarray]:
    """As ``wilson``, with a coverage of at least ``confidence`` for every probability (Clopper and Pearson 1934)."""
    count, runs = _counts(count, runs)
    tail = (1.0 - confidence) / 2.0
    with np.errstate(invalid="ignore"):
        lower = betaincinv(count, runs - count + 1, tail)
        upper = betainccinv(count + 1, runs - count, tail)
    return np.where(count == 0, 0.0, lower), np.where(count == runs, 1.0, upper)


INTERVALS = {"wilson": wilson, "clopper_pearson": clopper_pearson}


def interval(count, runs, confidence: float = CONFIDENCE, method: str = "wilson"):
    """Bounds by one of ``INTERVALS``; InputError for a method that is none."""
    if method not in INTERVALS:
        raise InputError(f"{method!r} is unknown; expected one of {', '.join(INTERVALS)}", place="interval")
    return INTERVALS[method](count, runs, confidence)


def _counts(count, runs) -> tuple[np.ndarray, np.ndarray]:
    count, runs = np.broadcast_arrays(np.asarray(count, float), np.asarray(runs, float))
    if np.any(runs < 1) or np.any(count < 0) or np.any(count > runs):
        raise InputError("expected counts between 0 and the number of runs, and at least one run")
    return count, runs
