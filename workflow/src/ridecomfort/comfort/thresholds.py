"""Thresholds of acceleration by driving style (sec:thresholding)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import xarray as xr

from ..errors import InputError
from . import runs, sections
from .limits import Band, bands


def evaluate(
    shards: Iterable[xr.Dataset],
    limits: Mapping[str, Mapping] | None = None,
    length: float = sections.LENGTH,
    *,
    sliding: bool = False,
) -> xr.Dataset:
    """Critical sections of the mean run and their probability over the runs, by axis and style.

    ``shards``: datasets with dims run and s and the accelerations in m/s2, taken
    one after another. ``limits``: ``bands``. A window is critical where the signal
    lies outside the band in its whole length; windows are sequential or ``sliding``.

    Returns the comfort dataset ``thresholds``: dims axis, style, window, s, run.
    """
    table = bands(limits)
    found = detect(runs.checked(shards, list(table)), table, length, "m/s2", sliding)
    return found.rename({"quantity": "axis"})


def detect(
    stream: Iterable[tuple[np.ndarray, np.ndarray, list[np.ndarray]]],
    table: Mapping[str, Mapping[str, Band]],
    length: float,
    unit: str,
    sliding: bool = False,
) -> xr.Dataset:
    """Sections outside bands, by ``quantity`` and ``style``, of signals that come as ``runs.checked`` gives them."""
    quantities, styles = list(table), list(next(iter(table.values())))
    edges = np.array([[(band.lower, band.upper) for band in _in_order(table, name, styles)] for name in quantities])
    means = [runs.Mean() for _ in quantities]
    counts, shares, numbers, along = None, [], [], None
    for number, s, values in stream:
        if along is None:
            along = sections.windows(s, length, sliding=sliding)
            counts = np.zeros((len(quantities), len(styles), len(along)), np.int64)
        share = np.empty((len(quantities), len(styles), len(number)))
        for i, signal in enumerate(values):
            means[i].add(signal)
            for j in range(len(styles)):
                found = along.whole(_outside(signal, *edges[i, j]))
                counts[i, j] += found.sum(axis=0)
                share[i, j] = found.sum(axis=1)
        shares.append(share)
        numbers.append(number)
    mean = [each.value() for each in means]
    found = np.array([[along.whole(_outside(mean[i], *edge)) for edge in edges[i]] for i in range(len(quantities))])
    number, dims = np.concatenate(numbers), ("quantity", "style")
    variables = {name: ("s", mean[i]) for i, name in enumerate(quantities)}
    variables |= runs.detections(found, counts, len(number), along, dims, np.concatenate(shares, axis=-1))
    variables["lower"] = (dims, edges[..., 0], {"units": unit, "long_name": "lower threshold"})
    variables["upper"] = (dims, edges[..., 1], {"units": unit, "long_name": "upper threshold"})
    variables["source"] = (dims, [[table[name][style].source for style in styles] for name in quantities], {"long_name": "where the threshold is from"})
    coords = {"quantity": quantities, "style": styles, "s": s, "run": number}
    return runs.dataset(variables, coords, along, len(number), method="thresholds")


def _in_order(table: Mapping[str, Mapping[str, Band]], name: str, styles: list[str]) -> list[Band]:
    if set(table[name]) != set(styles):
        raise InputError(f"has the styles {', '.join(table[name])}; expected {', '.join(styles)}", place=name)
    return [table[name][style] for style in styles]


def _outside(signal: np.ndarray, lower: float, upper: float) -> np.ndarray:
    # Thresholds in the signal's own type: a float32 at the printed 0.9 is not above it.
    return (signal < signal.dtype.type(lower)) | (signal > signal.dtype.type(upper))
