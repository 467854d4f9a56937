"""What is kept of many runs, shard after shard: the mean over them, and how often each window is critical.

Runs are added one by one in their order, so that the result is the same bit for
bit however they are cut into shards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr
from numba import njit

from ..errors import InputError
from ..vocabulary import describe
from . import probability, sections


CLASSES = {
    "axis": "axis of the body",
    "style": "driving style: public transport, normal, aggressive",
    "band": "comfort band of ISO 2631-1, mildest first",
    "quality": "class of ride quality by the IRI, best first",
}
"""What the names along the dimensions of the comfort datasets are."""


class Mean:
    """The mean over runs of a signal at every place."""

    def __init__(self) -> None:
        self.runs = 0
        self._total: np.ndarray | None = None

    def add(self, values: np.ndarray) -> None:
        """Take in runs, ``values`` (run, s)."""
        if self._total is None:
            self._total = np.zeros(values.shape[1])
        _add(self._total, values)
        self.runs += len(values)

    def value(self) -> np.ndarray:
        """The mean (s,) of all runs so far."""
        return self._total / self.runs


@njit(cache=True)
def _add(total, values):
    for run in range(values.shape[0]):
        for place in range(values.shape[1]):
            total[place] += values[run, place]


def checked(shards: Iterable[xr.Dataset], names: Sequence[str]):
    """The shards one after another, each as (runs, s, arrays (run, s) of the named signals).

    Raises InputError when there is no run, a signal has a gap, or shards differ in ``s``.
    """
    s, seen = None, 0
    for shard in shards:
        here = shard["s"].values
        if s is None:
            s = here
        elif not np.array_equal(s, here):
            raise InputError("shards of one site do not cover the same places s")
        signals = [shard[name].transpose("run", "s").values for name in names]
        for name, values in zip(names, signals):
            if not np.isfinite(values).all():
                run = shard["run"].values[int(np.argwhere(~np.isfinite(values))[0][0])]
                raise InputError(f"{name} has a gap", place=f"run {run}")
        seen += len(signals[0])
        yield shard["run"].values, s, signals
    if not seen:
        raise InputError("there is no run to evaluate")


def detections(
    critical: np.ndarray,
    counts: np.ndarray,
    runs: int,
    windows: sections.Windows,
    dims: tuple[str, ...],
    per_run: np.ndarray,
) -> dict[str, tuple]:
    """Variables common to all methods, by name.

    ``critical`` (..., window) of the mean run, ``counts`` (..., window) of critical
    runs, ``per_run`` (..., run) the number of critical windows of each run.
    """
    lower, upper = probability.wilson(counts, runs)
    found = critical.sum(axis=-1)
    return {
        "window_start": ("window", windows.start),
        "critical": ((*dims, "window"), critical.astype(np.int8)),
        "exceedance_probability": ((*dims, "window"), counts / runs),
        "exceedance_lower": ((*dims, "window"), lower),
        "exceedance_upper": ((*dims, "window"), upper),
        "critical_count": (dims, found.astype(np.int32)),
        "critical_share": (dims, 100.0 * found / max(len(windows), 1)),
        "run_share": ((*dims, "run"), (100.0 * per_run / max(len(windows), 1)).astype(np.float32)),
    }


def dataset(variables: dict, coords: dict, windows: sections.Windows, runs: int, **attributes) -> xr.Dataset:
    """The comfort dataset of one method, with units and long names."""
    answer = xr.Dataset(variables, coords={**coords, "window": np.arange(len(windows), dtype=np.int32)})
    for name, meaning in CLASSES.items():
        if name in answer.coords:
            answer[name].attrs["long_name"] = meaning
    answer.attrs = {
        "runs": runs,
        "merging": "mean over the runs at each place; exceedance_probability beside it",
        "critical_length": windows.length,
        **attributes,
    }
    return describe(answer)
