"""What of a run's comfort is owed to its speed, its lateral position, the road's friction."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import stats

from ..errors import InputError
from .agreement import spearman

BINS = 60
"""Equal shares of the runs by one factor; 4,000 runs leave 66 in each."""

LEAST_RUNS = 16


def first_order(factor, measure, bins: int = BINS) -> float:
    """Share of the variance of a measure (run,) that is the mean at a given factor (run,): a first-order Sobol' index.

    From given runs: the variance of the means over ``bins`` equal shares of the
    runs by the factor, less what the scatter within them adds to it. Close to 0, and by chance a
    little below, where the factor alone does not matter. NaN for a constant measure.
    """
    factor, measure = np.asarray(factor, float), np.asarray(measure, float)
    bins = min(bins, len(factor) // 4)
    if bins < 2:
        raise InputError(f"{len(factor)} runs are too few to tell an influence; expected at least {LEAST_RUNS}")
    total = measure.var(ddof=1)
    if total == 0.0:
        return float("nan")
    parts = np.array_split(measure[np.argsort(factor, kind="stable")], bins)
    sizes = np.array([len(part) for part in parts])
    means = np.array([part.mean() for part in parts])
    scatter = np.array([part.var(ddof=1) for part in parts])
    between = np.sum(sizes * (means - measure.mean()) ** 2) / len(measure)
    return float((between - np.mean(scatter) * (bins - 1) / len(measure)) / total)


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
    functions = {"spearman": spearman, "first_order": lambda x, y: first_order(x, y, bins)}
    figures = {
        name: np.array([_jackknife(function, factor, measure, groups) for factor in values])
        for name, function in functions.items()
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
    the sections outside the band of public transport; ``iri``: percent fair or worse at the run's speed.
    """
    answer = {"a_v": iso2631["window_mean"].mean("window").values}
    for axis in thresholds["axis"].values:
        answer[str(axis)] = thresholds["run_share"].sel(axis=axis, style="PT").values
    answer["iri"] = iri["run_share"].sel(quality=["F", "M", "P"]).sum("quality").values
    return answer


def _jackknife(function, factor: np.ndarray, measure: np.ndarray, groups: int) -> tuple[float, float, float]:
    """A figure of two series of independent runs with its 95 % interval.

    A bootstrap repeats runs, which makes the scatter within a bin too small; leaving
    every ``groups``-th run out does not.
    """
    estimate = function(factor, measure)
    groups = min(groups, len(measure) // 2)
    group = np.arange(len(measure)) % groups
    left = np.array([function(factor[group != each], measure[group != each]) for each in range(groups)])
    error = np.sqrt((groups - 1) / groups * np.sum((left - left.mean()) ** 2))
    half = stats.t.isf(0.025, groups - 1) * error
    return estimate, estimate - half, estimate + half
