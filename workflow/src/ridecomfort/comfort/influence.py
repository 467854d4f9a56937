"""What of a run's comfort is owed to its speed, its lateral position, the road's friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy import stats

from ..errors import InputError
from .agreement import spearman

BINS = 60
"""Equal shares of the runs by one factor; 4,000 runs leave 66 in each."""

NEIGHBOURS = 8
"""Runs at least, next to one another by a factor, among which that factor is taken to act along a line."""

LEAST_RUNS = 16

BACKFITS = 8
"""Rounds in which the additive model is fitted; independent factors need few."""

MATTERS = 0.05
"""Share of the variance from which an influence is said to matter."""


def verdict(lower: float, upper: float) -> str:
    """What an interval of ``first_order`` says of a factor: "matters", "does not matter" or "cannot be said"."""
    if not (np.isfinite(lower) and np.isfinite(upper)):
        return "cannot be said"
    return "matters" if lower >= MATTERS else "does not matter" if upper < MATTERS else "cannot be said"


def first_order(factors, measure, bins: int = BINS) -> np.ndarray:
    """Shares of the variance of a measure (run,) owed to each of the ``factors`` (factor, run) alone.

    First-order Sobol' indices from given runs with independent factors: an additive model, a
    mean for each of ``bins`` equal shares of the runs by each factor, fitted to all factors
    together, so that what one does does not blur the others; the variance of a factor's
    means less what scatter adds to it, and what the factor does within its shares, of which
    runs next to one another tell by how much less they scatter. Close to 0, and by chance a
    little below, where a factor alone does not matter. NaN for a constant measure.
    """
    factors, measure = np.atleast_2d(np.asarray(factors, float)), np.asarray(measure, float)
    cells, fine = _cells(factors, bins)
    return _shares(factors, measure, cells, fine, _degrees(cells // fine))


def _cells(factors: np.ndarray, bins: int) -> tuple[np.ndarray, int]:
    """The cell of neighbours that each run is in, by each factor, and of how many cells each of up to ``bins`` equal shares consists."""
    runs = factors.shape[1]
    if runs < LEAST_RUNS:
        raise InputError(f"{runs} runs are too few to tell an influence; expected at least {LEAST_RUNS}")
    bins = min(bins, max(2, runs // 10))
    fine = max(1, runs // (bins * NEIGHBOURS))
    return np.argsort(np.argsort(factors, axis=1, kind="stable"), axis=1) * (bins * fine) // runs, fine


def _degrees(labels: np.ndarray) -> list[float]:
    """What noise of variance one adds to the squares of the means of each factor in the joint fit, whose factors are not quite orthogonal."""
    counts = [np.bincount(label) for label in labels]
    member = np.concatenate([np.eye(len(count))[label] for label, count in zip(labels, counts)], axis=1)
    inverse = np.linalg.pinv(member.T @ member, hermitian=True)
    found, first = [], 0
    for count in counts:
        own = slice(first, first + len(count))
        centre = np.eye(len(count)) - count / labels.shape[1]
        found.append(float(np.trace(count[:, None] * (centre @ inverse[own, own] @ centre.T))))
        first += len(count)
    return found


def _shares(factors: np.ndarray, measure: np.ndarray, cells: np.ndarray, fine: int, degrees: Sequence[float]) -> np.ndarray:
    """``first_order`` from the ``_cells`` that the runs are in, whose shares have these ``_degrees``."""
    rest = measure - measure.mean()
    total = rest.var(ddof=1)
    if total == 0.0:
        return np.full(len(cells), np.nan)
    labels = cells // fine
    counts = [np.bincount(label) for label in labels]
    alone = [np.zeros(len(count)) for count in counts]
    for _ in range(BACKFITS):
        for i, (label, count) in enumerate(zip(labels, counts)):
            step = np.bincount(label, rest) / np.maximum(count, 1)
            alone[i] += step
            rest = rest - step[label]
    free = [np.count_nonzero(count) - 1 for count in counts]
    left = len(rest) - sum(free) - 1
    scatter = rest @ rest / left
    squares = []
    for factor, cell, count, means, own, taken in zip(factors, cells, counts, alone, degrees, free):
        within = len(rest) - taken - 1
        noise = _scatter(factor, rest, cell) * within / left  # the means of the other factors have taken of it, too
        squares.append(count @ means**2 - own * noise + within * (scatter - noise))
    return np.array(squares) / len(rest) / total


def _scatter(factor: np.ndarray, values: np.ndarray, cell: np.ndarray) -> float:
    """Variance of values (run,) about a line over the factor in each cell."""
    count = np.bincount(cell)
    x, y = (each - (np.bincount(cell, each) / np.maximum(count, 1))[cell] for each in (factor, values))
    square = np.bincount(cell, x**2)
    has_slope = square > 0.0
    y = y - (np.bincount(cell, x * y) / np.where(has_slope, square, 1.0))[cell] * x
    return y @ y / (len(y) - np.count_nonzero(count) - np.count_nonzero(has_slope))


def influence(measure, samples: xr.Dataset, *, groups: int = 50, bins: int = BINS) -> xr.Dataset:
    """Influence of every variable of ``samples`` (dim run) on a measure of comfort (run,).

    Returns, over ``factor`` and ``bound`` (estimate, lower, upper: 95 % by a
    jackknife over ``groups`` of runs), ``spearman``, the direction and strength of a
    monotonic influence, and ``first_order``, the share of the variance that the factor
    explains alone. ``unexplained`` is what is left: interactions and all that is not sampled.
    """
    measure = np.asarray(measure, float)
    if len(measure) < LEAST_RUNS:
        raise InputError(f"{len(measure)} runs are too few to tell an influence; expected at least {LEAST_RUNS}")
    factors = list(samples.data_vars)
    values = [np.asarray(samples[name], float) for name in factors]
    if any(len(each) != len(measure) for each in values):
        raise InputError(f"{len(measure)} values of the measure for {len(values[0])} samples", place="influence")
    values = np.array(values)
    cells, fine = _cells(values, bins)
    degrees = _degrees(cells // fine)
    figures = {
        "spearman": np.array([_jackknife(lambda runs: spearman(x[runs], measure[runs]), len(x), groups) for x in values]),
        "first_order": _jackknife(
            lambda runs: _shares(values[:, runs], measure[runs], cells[:, runs], fine, degrees), len(measure), groups
        ),
    }
    answer = xr.Dataset(
        {key: (("factor", "bound"), table) for key, table in figures.items()},
        coords={"factor": factors, "bound": ["estimate", "lower", "upper"]},
    )
    answer["spearman"].attrs = {"units": "1", "long_name": "rank correlation with the factor"}
    answer["first_order"].attrs = {"units": "1", "long_name": "share of the variance explained by the factor alone"}
    answer["unexplained"] = 1.0 - float(figures["first_order"][:, 0].sum())
    answer["unexplained"].attrs = {"units": "1", "long_name": "share of the variance that no factor explains alone"}
    return answer


def measures(thresholds: xr.Dataset, iso2631: xr.Dataset, iri: xr.Dataset) -> dict[str, np.ndarray]:
    """What each run (run,) was like by each method, from the comfort datasets of a site.

    ``a_v``: mean of the total value over the site in m/s2; ``a_x``, ``a_y``, ``a_z``: percent of
    the sections outside the band of public transport; ``iri``: percent that are fair, mediocre or poor in their whole length at the
    run's speed.
    """
    levels = iso2631["window_mean"]
    answer = {"a_v": levels.mean([dim for dim in levels.dims if dim != "run"]).values}
    for axis in thresholds["axis"].values:
        answer[str(axis)] = thresholds["run_share"].sel(axis=axis, style="PT").values
    answer["iri"] = iri["run_share"].sel(quality=["F", "M", "P"]).sum("quality").values
    return answer


def _jackknife(function, runs: int, groups: int) -> np.ndarray:
    """What a function of the indices of independent runs gives, (..., 3): for all runs, with its 95 % interval.

    A bootstrap repeats runs, which makes the scatter within a bin too small; leaving
    every ``groups``-th run out does not.
    """
    estimate = function(np.arange(runs))
    groups = min(groups, runs // 2)
    group = np.arange(runs) % groups
    left = np.array([function(np.flatnonzero(group != each)) for each in range(groups)])
    error = np.sqrt((groups - 1) / groups * np.sum((left - left.mean(axis=0)) ** 2, axis=0))
    half = stats.t.isf(0.025, groups - 1) * error
    return np.stack([estimate, estimate - half, estimate + half], axis=-1)
