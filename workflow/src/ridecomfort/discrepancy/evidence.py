"""Which of many candidates an error holds: a score test on white residuals, with a p-value honest over all of them.

Everything here is plain arrays. A residual is what the model makes minus what was
measured, so a candidate that is missing stands in it with the opposite sign of its column.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

RESAMPLES = 1999
"""Draws of the bootstrap; the smallest p-value is one over one more."""

SAME = 0.8
"""Canonical correlation beyond which two candidates are one cluster."""

SEEN = 1e-3
"""Share of a column's rms that must be left after projection for it to count as seen."""


@dataclass(frozen=True)
class Evidence:
    """Per candidate column: ``statistic`` (studentised score), and the share ``absorbed`` by what is free anyway.
    Per group: ``p_value`` over the whole library by blocks, ``white_p_value`` were the noise white, and ``group_gain``, the fall of the white
    sum of squares by all its columns together."""

    statistic: np.ndarray
    absorbed: np.ndarray
    p_value: np.ndarray
    white_p_value: np.ndarray
    group_gain: np.ndarray
    projected: np.ndarray
    """The columns after projection, (column, sample)."""
    residual: np.ndarray
    """The residual after projection."""


def basis(columns: np.ndarray) -> np.ndarray:
    """Orthonormal rows that span ``columns`` (column, sample); those without power or repeated are left out."""
    power = np.sqrt(np.sum(columns**2, axis=1))
    columns = columns[power > 0] / power[power > 0, None]
    if not len(columns):
        return columns
    values, vectors = np.linalg.eigh(columns @ columns.T)
    kept = values > max(1e-9, len(columns) * np.finfo(values.dtype).eps) * values[-1]
    return (vectors[:, kept] / np.sqrt(values[kept])).T @ columns


def without(rows: np.ndarray, free: np.ndarray) -> np.ndarray:
    """``rows`` (..., sample) less their projection on the orthonormal rows ``free``."""
    if not len(free):
        return rows
    along = (rows @ free.T) @ free
    return np.subtract(rows, along, out=along)


def score_test(
    residual: np.ndarray,
    free: np.ndarray,
    columns: np.ndarray,
    blocks: Sequence[np.ndarray],
    *,
    group: Sequence[int] | None = None,
    sign: Sequence[int] | None = None,
    resamples: int = RESAMPLES,
    seed: Sequence[int] = (0,),
) -> Evidence:
    """Test every column against a white residual, free directions projected out.

    ``residual`` (sample,), ``free`` (direction, sample), ``columns`` (column, sample) are white; each of ``blocks`` (sample,)
    numbers samples that may depend on one another; the test is done with each. ``group``: number of the candidate that a column
    belongs to, by default each its own. ``sign``: 1 where only a positive amount is physical, 0 where both
    are. The statistic is the sum of the scores of all blocks over the root of the sum of their squares; the
    bootstrap turns the signs of whole blocks and takes the largest of all statistics, so that the p-value
    holds for the best of the library (wild bootstrap, Liu 1988; max-T, Westfall and Young 1993). It is made
    for each of the ``blocks`` (short ones see rare events better), and the smaller p-value pays for it (Bonferroni).

    Few blocks may agree by chance where their scores are small, which is no evidence in white noise; and scores that are large
    there are none where blocks disagree. Who asks both (the larger p-value) is safe from either.
    """
    count = len(columns)
    group = np.arange(count) if group is None else np.asarray(group)
    sign = np.zeros(count) if sign is None else np.asarray(sign)
    directions = basis(free)
    power = np.einsum("ij,ij->i", columns, columns)
    columns = without(columns, directions)
    residual = without(residual, directions).astype(columns.dtype)
    products = columns * residual
    left = np.einsum("ij,ij->i", columns, columns)
    seen = left > SEEN**2 * power
    safe = np.where(seen, left, 1.0)
    score = np.where(seen, -np.sum(products, axis=1), 0.0)
    statistics, p_value = [], []
    numbers = [np.unique(block, return_inverse=True)[1] for block in blocks]
    by_block = [_block_sums(products, labels) for labels in numbers]
    for which, sums in enumerate(by_block):
        statistic, by_group = _bootstrap(
            np.where(seen[:, None], -sums, 0.0), group, sign, resamples, np.random.default_rng([*seed, which])
        )
        statistics.append(statistic)
        p_value.append(by_group)
    white = np.where(seen, score / np.sqrt(safe), 0.0)
    alike = _correlation(columns, np.where(seen, left, np.inf))
    of_white = _white_test(white, alike, group, sign, resamples, np.random.default_rng([*seed, len(blocks)]))
    number = group.max() + 1
    gains = np.array([_group_gain(columns, residual, np.flatnonzero((group == g) & seen), sign) for g in range(number)])
    return Evidence(
        statistic=statistics[0],
        absorbed=1 - left / np.where(power > 0, power, 1.0),
        p_value=np.minimum(len(blocks) * np.min(p_value, axis=0), 1.0),
        white_p_value=of_white,
        group_gain=gains,
        projected=columns,
        residual=residual,
    )


def _block_sums(products: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Sums over the samples of every block, (column, block)."""
    sums = np.zeros((len(products), numbers.max() + 1))
    for row, values in zip(sums, products):
        row += np.bincount(numbers, values, minlength=len(row))
    return sums


def _bootstrap(sums, group, sign, resamples, rng) -> tuple[np.ndarray, np.ndarray]:
    """Statistic of every column, and p-values over the library of every group."""
    root = np.sqrt(np.sum(sums**2, axis=1))
    scaled = sums / np.where(root > 0, root, 1.0)[:, None]
    observed = scaled.sum(axis=1)
    turned = rng.choice([-1.0, 1.0], (resamples, sums.shape[1])) @ scaled.T
    return observed, _over_library(observed, turned, group, sign)


def _white_test(observed, correlation, group, sign, resamples, rng) -> np.ndarray:
    """p-values over the library of every group for scores ``observed`` (column,) of unit variance and this correlation."""
    values, vectors = np.linalg.eigh(correlation)
    drawn = rng.standard_normal((resamples, len(observed))) @ (vectors * np.sqrt(np.maximum(values, 0.0))).T
    return _over_library(observed, drawn, group, sign)


def _correlation(columns: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Correlation of columns (column, sample) of these powers (column,); nil with those of infinite power."""
    root = 1.0 / np.sqrt(power)
    return product(columns, columns) * np.outer(root, root)


def _over_library(observed: np.ndarray, drawn: np.ndarray, group, sign) -> np.ndarray:
    """How often the largest of all statistics (draw, column) where nothing is missing is no less than that of each group."""
    number = group.max() + 1
    largest = np.stack([_largest(drawn[:, group == g], sign[group == g]) for g in range(number)], axis=1)
    seen = np.array([_largest(observed[None, group == g], sign[group == g])[0] for g in range(number)])
    over_all = largest.max(axis=1)
    return (1 + np.sum(over_all[:, None] >= seen, axis=0)) / (len(drawn) + 1)


def _largest(statistics: np.ndarray, sign: np.ndarray) -> np.ndarray:
    return np.max(np.where(sign > 0, statistics, np.abs(statistics)), axis=1)


def _group_gain(columns, residual, own, sign) -> float:
    """Fall of the sum of squares with all columns of a group free, one-sided ones not below zero."""
    if not own.size:
        return 0.0
    part = columns[own]
    both = np.concatenate([part, -part[sign[own] == 0]])
    normal = both @ both.T
    scale = np.sqrt(np.diag(normal))
    factor, inverse = square_root(normal / np.outer(scale, scale))
    right = inverse @ (-(both @ residual) / scale)
    amounts, rest = nnls(factor, right)
    return float(right @ right - rest**2)


def square_root(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A factor whose square is ``normal``, to stand for long columns in a least-squares problem, and its inverse transposed."""
    values, vectors = np.linalg.eigh(normal)
    values = np.maximum(values, 1e-10)
    return (vectors * np.sqrt(values)).T, (vectors / np.sqrt(values)).T


def product(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """``one @ other.T``, summed piece by piece in double precision where the rows are of single precision."""
    pieces = range(0, one.shape[-1], 16384)
    return sum((one[..., k : k + 16384] @ other[..., k : k + 16384].T).astype(float) for k in pieces)


def canonical_correlation(one: np.ndarray, other: np.ndarray) -> float:
    """Largest correlation between any mix of the rows ``one`` and any mix of ``other`` (row, sample)."""
    one, other = basis(one), basis(other)
    if not len(one) or not len(other):
        return 0.0
    return float(min(1.0, np.linalg.svd(one @ other.T, compute_uv=False)[0]))


def phase_randomised(series: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A series (channel, sample) with the same cross-spectrum and random phases: a decoy that explains nothing."""
    bins = np.fft.rfft(series, axis=-1)
    phase = rng.uniform(0, 2 * np.pi, bins.shape[-1])
    phase[0] = 0.0
    return np.fft.irfft(bins * np.exp(1j * phase), series.shape[-1], axis=-1).astype(series.dtype)
