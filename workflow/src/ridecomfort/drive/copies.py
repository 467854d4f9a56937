"""Whether two records are one, or parts of one: exported twice, with other digits, at another rate, cut, or with a clock of its own.

As repeats they would differ by no noise, and what one of them taught would be confirmed by the other.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.signal import butter, correlate, sosfiltfilt

from .sampling import low_pass, rate_of

BELOW, OF_CUT_OFF = 10.0, 0.6
"""Hz, and share of the lower of their cut-offs, up to which records are compared: what filters do to exports of other rates lies above."""

SAME = 2e-3
"""rms of the difference over that of a piece up to which both are one: exports at another rate leave 0.0003 to 0.002, cut ones, in other units or with
four digits 0.0002; two drives on one path, with a noise of 0.01 m/s2, would differ by 0.004 by that alone."""

LEAST = 3.0
"""s of a drive of less than which none is known to be a copy: it is refused for that."""

PIECE, PIECES, TWICE = 6.0, 8, 2
"""s of a piece, at most half of the shorter record, how many of that are looked for in the other, and how many must be there: records that overlap
have some in common, and clocks differ by a constant rate within each."""

MARGIN, APART, STILL = 1.0, 0.5, 0.1
"""s at the ends of a cut where filters leave traces, s by which the lags of pieces may differ, and share of the rms of the record below which one says
nothing."""

STEPS = 6
"""Steps to the lag at which they agree best, from that to a sample."""


def is_copy(one, other, name: str = "a_z") -> bool:
    """Whether the signal of this ``name`` of two drives at one rate is the same on TWICE of the pieces of the shorter, at some lag and in some unit.
    One that stands still is a copy of none."""
    rate = rate_of(one["time"].values)
    if min(one.sizes["time"], other.sizes["time"]) < LEAST * rate:
        return False
    cut_offs = [float(drive.attrs.get("cut_off", 0.5 * rate)) for drive in (one, other)]
    slow = butter(4, min(BELOW, OF_CUT_OFF * min(cut_offs), 0.4 * rate), fs=rate, output="sos")
    pairs = [[drive[name].values for drive in (one, other)]]
    if cut_offs[0] != cut_offs[1]:  # the filter that brought one to the study's rate has a ripple, which the other may lack
        filtered = lambda own, cut_off: low_pass(own[:, None], 1.0 / rate, min(cut_offs))[:, 0] if cut_off > min(cut_offs) else own
        pairs.append([filtered(own, cut_off) for own, cut_off in zip(pairs[0], cut_offs)])
    return any(_is_in(*sorted((sosfiltfilt(slow, own) for own in pair), key=len), rate) for pair in pairs)


def _is_in(short: np.ndarray, long: np.ndarray, rate: float) -> bool:
    """Whether TWICE of the pieces of the shorter series are in the longer one, at some lag."""
    size, margin = min(int(PIECE * rate), len(short) // 2), min(int(MARGIN * rate), len(short) // 4)
    spline, least = make_interp_spline(np.arange(len(long)), long, k=5), max(STILL * short.std(), 1e-9 * np.max(np.abs(short)))
    starts = np.linspace(margin, len(short) - margin - size, PIECES).astype(int)
    found = ((start, _there(short[start : start + size], long, spline)) for start in starts if short[start : start + size].std() > least)
    later = np.sort([lag - start for start, lag in found if lag is not None])
    return bool(np.any(later[TWICE - 1 :] - later[: len(later) - TWICE + 1] < APART * rate))


def _there(piece: np.ndarray, long: np.ndarray, spline: BSpline) -> float | None:
    """Samples by which a piece lies behind the beginning of ``long`` (as a ``spline`` over its samples), None where it is not in it."""
    piece = (piece - piece.mean()) / piece.std()
    samples, way = np.arange(len(piece)), np.linspace(-0.5, 0.5, len(piece))
    lag, longer = float(_lag(piece, long)), 0.0
    for _ in range(STEPS):
        place = np.clip(lag + samples + longer * way, 0, len(long) - 1)
        value, slope = spline(place), spline(place, nu=1)
        (gain, *ahead, _), *_ = np.linalg.lstsq(np.stack([value, slope, slope * way, np.ones(len(piece))], axis=1), piece, rcond=None)
        if float(np.std(piece - gain * value)) <= SAME:
            return lag
        if gain == 0.0:
            break
        lag, longer = (was + float(np.clip(more / gain, -1.0, 1.0)) for was, more in zip((lag, longer), ahead))
    return None


def _lag(piece: np.ndarray, long: np.ndarray) -> int:
    """Samples by which a part without a mean lies behind the beginning of ``long`` where their correlation is largest."""
    products = correlate(long - long.mean(), piece, mode="valid", method="fft")
    sums, squares = (np.concatenate([[0.0], np.cumsum((long - long.mean()) ** power)]) for power in (1, 2))
    count = len(piece)
    spread = (squares[count:] - squares[:-count]) - (sums[count:] - sums[:-count]) ** 2 / count
    return int(np.argmax(products / np.sqrt(np.maximum(spread, max(1e-12 * spread.max(), 1e-300)))))
