"""Evidence for effects that act at a few places only, such as a stop that is met once.

How consistent an effect is from place to place says nothing where there is one place. What
remains is the shape: the error there must look like the effect more than the errors of other
places do, if they are held against it in the same way.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from .experiment import Frame

FEW_BLOCKS = 20.0
"""Blocks below which the power of a column counts as that of events (participation number): the signs of so few cannot be turned in enough
ways for one of some hundred columns to stand out. Play in the steering, which turns back at a dozen places, was never sure by them, nor a
stop that three drives meet a few times each, though it took nine tenths of the error."""

HELD = 0.95
"""Share of a column's power that its window holds."""

FINER = 4.0
"""Parts of a block that windows are made of, and of which the second form of the test by blocks, which sees rare events better."""

NEAR = 0.5
"""s around the true place in which shifted columns, its own and others like it, still resemble what is there."""


def participation(columns: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Number of the blocks (numbered by sample) that the power of each column (column, sample) is spread over, (column,).

    The square of the sum over the sum of squares: n for n equal blocks, 1 where one holds all.
    """
    power = _by_block(columns, numbers)
    return power.sum(axis=1) ** 2 / np.maximum(np.sum(power**2, axis=1), 1e-300)


def p_values(
    frame: Frame, residual: np.ndarray, columns: np.ndarray, group: np.ndarray, sign: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """By group: p-value over all groups whose columns act at less than FEW_BLOCKS places (1 for the others), and whether it is one of them.

    ``residual`` (element,) and ``columns`` (column, element) are vectors of ``frame``; ``sign`` is 1 where only positive
    amounts of a column are physical, else 0.
    """
    found, rare = np.ones(group.max() + 1), np.zeros(group.max() + 1, dtype=bool)
    own = np.flatnonzero(participation(columns, frame.blocks()) < FEW_BLOCKS)
    if not own.size:
        return found, rare
    groups, numbers = np.unique(group[own], return_inverse=True)
    marks = windows(columns[own], frame.blocks(FINER))
    like = likeness(frame.parts(residual), frame.parts(columns[own]), [part[:, 0] for part in frame.parts(marks)], sign[own])
    found[groups] = shift_test(like, numbers, int(NEAR * min(frame.experiment.records[i].rate for i in frame.indices)))
    rare[groups] = True
    return found, rare


def windows(columns: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Whether an element lies in one of the fewest blocks that hold HELD of a column's power, (column, element)."""
    labels = np.unique(numbers, return_inverse=True)[1]
    power = _by_block(columns, numbers)
    order = np.argsort(-power, axis=1)
    reached = np.cumsum(np.take_along_axis(power, order, axis=1), axis=1)
    needed = reached - np.take_along_axis(power, order, axis=1) < HELD * reached[:, -1:]
    inside = np.zeros_like(needed)
    np.put_along_axis(inside, order, needed, axis=1)
    return inside[:, labels]


def _by_block(columns: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    labels = np.unique(numbers, return_inverse=True)[1]
    return np.stack([np.bincount(labels, row.astype(float) ** 2) for row in columns])


def likeness(
    residual: Sequence[np.ndarray], columns: Sequence[np.ndarray], marks: Sequence[np.ndarray], sign: np.ndarray
) -> np.ndarray:
    """Share of the error within its window that each column explains when it is moved along the records, (column, shift).

    ``residual`` holds (channel, sample) of every record, ``columns`` (column, channel, sample), ``marks`` the
    samples (column, sample) where the columns have their power. Columns move round in a circle, each record in its own, by
    as many samples in all records, forwards and (the last half) backwards, as far as the shortest one is long. Where only positive amounts are
    physical (``sign`` 1) others explain nothing.
    """
    shifts = min(part.shape[-1] for part in residual)
    both_ways = np.r_[: (shifts + 1) // 2, -(shifts // 2) : 0]
    product, within, power = 0.0, 0.0, 0.0
    for own, rows, inside in zip(residual, columns, marks):
        marked = rows * inside[:, None, :]
        product = product + _moved(marked, own)[:, both_ways]
        within = within + _moved(inside[:, None, :].astype(float), np.sum(own**2, axis=0)[None])[:, both_ways]
        power = power + np.sum(marked**2, axis=(1, 2))
    product = np.where((sign[:, None] > 0) & (product > 0), 0.0, product)
    return product**2 / np.maximum(power[:, None] * within, 1e-300)


def _moved(rows: np.ndarray, series: np.ndarray) -> np.ndarray:
    """Sum over channels and samples of ``series`` times ``rows`` (row, channel, sample) moved by every shift, in a circle."""
    count = series.shape[-1]
    length = next_fast_len(2 * count, real=True)
    bins = np.einsum("rcf,cf->rf", np.conj(rfft(rows, length, axis=-1)), rfft(series, length, axis=-1))
    line = irfft(bins, length, axis=-1)
    round_trip = line[:, :count].copy()
    round_trip[:, 1:] += line[:, length - count + 1 :]
    return round_trip


def shift_test(like: np.ndarray, group: np.ndarray, apart: int) -> np.ndarray:
    """p-value by group over all groups: at which share of the shifts any column is as alike as the group's best is in place.

    ``like`` is what ``likeness`` returns, here in shares of its mean over all shifts, so that a short column is not ahead of a long one. The
    best of all groups counts at every shift (Westfall and Young 1993), but nearer than ``apart`` samples to the place only that of the group
    itself: there its own column makes others alike. All shifts count, the place among them: left out, the
    flanks of a chance peak would not, which are as wide as the column is slow.
    """
    heights = like / np.maximum(like.mean(axis=1, keepdims=True), 1e-300)
    best = np.stack([heights[group == g].max(axis=0) for g in range(group.max() + 1)])
    count = like.shape[1]
    is_near = np.minimum(np.arange(count), count - np.arange(count)) < apart
    return np.mean(np.where(is_near, best, best.max(axis=0)) >= best[:, :1], axis=1)
