"""Whether two records are one: exported twice, with other digits, at another rate, cut, or with a clock of its own.

As repeats they would differ by no noise, and what one of them taught would be confirmed by the other.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, correlate, sosfiltfilt

from .sampling import rate_of

BELOW = 10.0
"""Hz up to which records are compared: what filters do to exports of other rates lies above."""

SAME = 2e-3
"""rms of the difference over that of a record up to which both are one: exports at another rate leave 0.0017, cut ones, in other units or with four
digits 0.0002; two drives on one path, with a noise of 0.01 m/s2, would differ by 0.004 by that alone."""

LEAST = 3.0
"""s of a drive of less than which none is known to be a copy: it is refused for that."""

STEPS = 6
"""Steps to the lag at which they agree best, from that to a sample."""


def is_copy(one, other, name: str = "a_z") -> bool:
    """Whether the signal of this ``name`` of two drives at one rate is the same on the middle half of the shorter (filters leave traces at the ends of
    a cut), at some lag and in some unit. One that stands still is a copy of none."""
    rate = rate_of(one["time"].values)
    if min(one.sizes["time"], other.sizes["time"]) < LEAST * rate:
        return False
    low_pass = butter(4, min(BELOW, 0.4 * rate), fs=rate, output="sos")
    short, long = sorted((sosfiltfilt(low_pass, drive[name].values) for drive in (one, other)), key=len)
    first = len(short) // 4
    middle = short[first : len(short) - first]
    if np.ptp(middle) <= 1e-9 * np.max(np.abs(middle)):
        return False
    middle = (middle - middle.mean()) / middle.std()
    lag, spline = float(_lag(middle, long)), make_interp_spline(np.arange(len(long)), long, k=5)
    left = np.inf
    for _ in range(STEPS):
        place = np.clip(lag + np.arange(len(middle)), 0, len(long) - 1)
        columns = np.stack([spline(place), spline(place, nu=1), np.ones(len(middle))], axis=1)
        (gain, ahead, _), *_ = np.linalg.lstsq(columns, middle, rcond=None)
        left = float(np.std(middle - gain * columns[:, 0]))
        if left <= SAME or gain == 0.0:
            break
        lag += float(np.clip(ahead / gain, -1.0, 1.0))
    return left <= SAME


def _lag(middle: np.ndarray, long: np.ndarray) -> int:
    """Samples by which a part without a mean lies behind the beginning of ``long`` where their correlation is largest."""
    products = correlate(long - long.mean(), middle, mode="valid", method="fft")
    sums, squares = (np.concatenate([[0.0], np.cumsum((long - long.mean()) ** power)]) for power in (1, 2))
    count = len(middle)
    spread = (squares[count:] - squares[:-count]) - (sums[count:] - sums[:-count]) ** 2 / count
    return int(np.argmax(products / np.sqrt(np.maximum(spread, 1e-12 * spread.max()))))
