"""How many runs are enough: the interval of a probability against the number of runs."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import stats

from ..errors import InputError
from . import probability

SCHEMES = ("latin_hypercube", "monte_carlo")

LEAST_DESIGNS = 8
"""Smaller designs of one size that a width is told from."""

LEAST_SIZE = 20
"""Runs in the smallest design that is looked at."""


def interval_width(
    critical, samples: xr.Dataset, *, seed: int = 0, confidence: float = probability.CONFIDENCE
) -> xr.Dataset:
    """Width of the interval of a section's probability of being critical, by number of runs and sampling scheme.

    ``critical`` (run, window) of the runs at hand and the ``samples`` (dim run) they were
    driven with. Smaller studies are parts of this one: of a sliced Latin hypercube
    (``sample.latin_hypercube``) each block of ``size`` runs is itself a Latin hypercube of that size, and runs
    drawn at random from all of it are a plain Monte Carlo sample of a finite population. How far their
    estimates scatter is counted; nothing is simulated again and nothing is interpolated.

    Returns, over ``size``: ``width`` (scheme, size), the interval of ``confidence`` by the standard
    deviation of the estimates, and ``wilson`` (size), that of the Wilson interval at the
    probabilities found, which knows of no scheme; root mean squares over the sections whose outcome is open
    (their number is the attribute ``windows``). ``designs`` (size): studies of that size there were.

    Raises InputError where no section is open or the runs hold too few smaller designs.
    """
    critical = np.asarray(critical, bool)
    runs = len(critical)
    if samples.sizes["run"] != runs:
        raise InputError(f"{runs} runs for {samples.sizes['run']} samples", place="interval_width")
    share = critical.mean(axis=0)
    open_ = (share > 0.0) & (share < 1.0)
    if not open_.any():
        raise InputError("every section is critical in all runs or in none: nothing to estimate", place="critical")
    sizes = slice_sizes(samples)
    if not sizes:
        raise InputError(f"{runs} runs do not fall into at least {LEAST_DESIGNS} smaller designs", place="samples")
    outcome, share = critical[:, open_].astype(float), share[open_]
    rng = np.random.default_rng(seed)
    span = 2.0 * stats.norm.isf((1.0 - confidence) / 2.0)
    width, wilson = np.empty((len(SCHEMES), len(sizes))), np.empty(len(sizes))
    for j, size in enumerate(sizes):
        shuffled = outcome[rng.permutation(runs)]
        for i, runs_in_order in enumerate((outcome, shuffled)):
            means = runs_in_order.reshape(runs // size, size, -1).mean(axis=1)
            width[i, j] = span * np.sqrt(means.var(axis=0, ddof=1).mean())
        low, high = probability.wilson(share * size, size, confidence)
        wilson[j] = np.sqrt(np.mean((high - low) ** 2))
    answer = xr.Dataset(
        {
            "width": (("scheme", "size"), width),
            "wilson": ("size", wilson),
            "designs": ("size", runs // np.array(sizes)),
        },
        coords={"scheme": list(SCHEMES), "size": sizes},
    )
    meaning = f"width of the {100 * confidence:g} % interval of a probability"
    answer["width"].attrs = {"units": "1", "long_name": meaning}
    answer["wilson"].attrs = {"units": "1", "long_name": "width of the Wilson interval"}
    answer["designs"].attrs = {"units": "1", "long_name": "number of designs that the scatter is told from"}
    answer["size"].attrs = {"units": "1", "long_name": "number of runs"}
    answer.attrs["windows"] = int(open_.sum())
    return answer


def slice_sizes(samples: xr.Dataset) -> list[int]:
    """Sizes, ascending, of which every block of consecutive runs is a Latin hypercube by itself, as far as they help.

    Told from the samples (dim run) alone: in each block every input lies in each of ``size`` equally probable
    parts of all its values once, but for one that is held at a value. For a plain Monte Carlo sample there are none.
    """
    runs = samples.sizes["run"]
    varied = [values for values in samples.data_vars.values() if np.ptp(values.values) > 0.0]
    if not varied:
        return []
    ranks = np.array([stats.rankdata(values, method="ordinal") - 1 for values in varied])
    answer = []
    for size in range(LEAST_SIZE, runs // LEAST_DESIGNS + 1):
        if runs % size == 0:
            part = np.sort((ranks * size // runs).reshape(len(ranks), -1, size), axis=-1)
            if np.all(part == np.arange(size)):
                answer.append(size)
    return answer


def by_root(sizes, width) -> float:
    """The w in w / sqrt(size), which widths (size,) of either scheme follow at last; NaN without any width.

    Small designs count for more, there are more of them.
    """
    sizes, width = np.asarray(sizes, float), np.asarray(width, float)
    known = np.isfinite(width) & (width > 0.0)
    if not known.any():
        return float("nan")
    return float(np.exp(np.average(np.log(width[known] * np.sqrt(sizes[known])), weights=1.0 / sizes[known])))


def runs_needed(width: float, share: float = 0.5, confidence: float = probability.CONFIDENCE) -> int:
    """The least number of plain Monte Carlo runs whose Wilson interval about ``share`` is no wider than ``width``."""
    if not 0.0 < width < 1.0:
        raise InputError(f"{width!r} is not a width; expected between 0 and 1", place="width")
    low, high = 1, 1
    while _wilson_width(high, share, confidence) > width:
        high *= 2
    while low < high:
        middle = (low + high) // 2
        if _wilson_width(middle, share, confidence) > width:
            low = middle + 1
        else:
            high = middle
    return high


def _wilson_width(runs: int, share: float, confidence: float) -> float:
    lower, upper = probability.wilson(share * runs, runs, confidence)
    return float(upper - lower)
