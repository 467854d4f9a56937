"""Comfort after ISO 2631-1: weighting, quantities, total value, bands along a road.

The door to the method; the parts lie in ``weighting``, ``streaming``, ``quantities``,
``total``, ``bands``, ``exposure`` and ``seat``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import xarray as xr

from ..errors import InputError
from . import bands, quantities, runs, sections, signals, weighting
from .quantities import metrics, running_rms
from .seat import Behind, Seat
from .total import overall, total_value
from .weighting import weight

__all__ = ["evaluate", "metrics", "overall", "running_rms", "running_total_value", "total_value", "weight"]


def running_total_value(
    a_x,
    a_y,
    a_z,
    rate: float,
    time_constant: float = 1.0,
    method: str = "linear",
    *,
    weightings: tuple[str, str, str] = ("Wd", "Wd", "Wk"),
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    before: str = "rest",
    seat: Seat | None = None,
    weighted: Callable[[int, np.ndarray, np.ndarray], None] | None = None,
):
    """Running vibration total value a_v(t) in m/s2, of the shape of ``a_x``.

    Accelerations of a seated person in m/s2 at ``rate`` Hz, last axis time, each
    run finite up to its end and NaN behind it. a_v is the root of the sum of
    k^2 a_w^2 over the axes, a_w the running rms (eq:combi; ISO 2631-1:1997 6.3.1, 6.5).
    ``before``: as in ``weight``. ``seat``: the accelerations are those of the floor, and a_z
    goes through this seat; without it they are taken to be those of the seat, as in the paper.
    ``weighted`` is shown what is weighted on the way: number of the axis, indices of runs,
    and their weighted accelerations (run, time) in m/s2 (``doses.Doses.weighted``).
    """
    rate = signals.check_rate(rate)
    axes = [signals.time_last(axis, rate, "m/s2") for axis in (a_x, a_y, a_z)]
    shape = axes[0][0].shape
    for name, (values, _) in zip("yz", axes[1:]):
        if values.shape != shape:
            raise InputError(f"a_{name} has the shape {values.shape}, a_x {shape}; expected equal shapes")
    filters = [weighting.named(name) for name in weightings]
    if seat is not None:
        filters[2] = Behind(filters[2], seat)
    tables = [signals.rows(values) for values, _ in axes]
    lengths = np.minimum.reduce([length for _, length in tables])
    squares = np.zeros_like(tables[0][0])
    for axis, ((table, length), filter_, factor) in enumerate(zip(tables, filters, factors)):
        for rows, found in weighting.spectral(table, length, rate, filter_, before):
            if weighted is not None:
                weighted(axis, rows, found)
            squares[rows, : found.shape[1]] += np.square(factor * found)
    quantities.running_root(squares, lengths, rate, time_constant, method)
    restore = axes[0][1]
    return restore(squares.reshape(shape), name="a_v", time_constant=time_constant, averaging=method)


def evaluate(
    shards: Iterable[xr.Dataset],
    limits: Mapping | None = None,
    length: float = sections.LENGTH,
    *,
    sliding: bool = False,
) -> xr.Dataset:
    """Sections in each comfort band for the mean run, and their probability over the runs.

    ``shards``: datasets with dims run and s and the running total value ``a_v`` in
    m/s2, taken one after another. ``limits``: as ``bands.edges``. A window is of a
    band where a_v lies within it in the whole window; bands overlap, so a window
    may be of two. Windows are sequential or ``sliding``.

    Returns the comfort dataset ``iso2631``: dims band, window, s, run. Beside what
    all methods have, ``window_mean`` (run, window), the mean of a_v over each window of each run;
    of sliding windows only over every one that does not overlap the last (run, section).
    """
    table = bands.edges(limits)
    mean, counts, shares, numbers, levels, along = runs.Mean(), None, [], [], [], None
    for number, s, (signal,) in runs.checked(shards, ["a_v"]):
        if along is None:
            along = sections.windows(s, length, sliding=sliding)
            apart = sections.windows(s, length)
            counts = np.zeros((len(table), len(along)), np.int64)
        mean.add(signal)
        found = np.array([along.whole(_within(signal, *edge)) for edge in table.values()])
        counts += found.sum(axis=1)
        shares.append(found.sum(axis=2))
        levels.append(apart.mean(signal).astype(np.float32))
        numbers.append(number)
    number = np.concatenate(numbers)
    found = np.array([along.whole(_within(mean.value(), *edge)) for edge in table.values()])
    lower, upper = np.array(list(table.values())).T
    variables = {
        "a_v": ("s", mean.value()),
        "band_lower": ("band", lower, {"units": "m/s2", "long_name": "lower edge of the band"}),
        "band_upper": ("band", upper, {"units": "m/s2", "long_name": "upper edge of the band"}),
        "window_mean": (("run", "section" if sliding else "window"), np.concatenate(levels)),
    }
    variables |= runs.detections(found, counts, len(number), along, ("band",), np.concatenate(shares, axis=-1))
    return runs.dataset(
        variables, {"band": list(table), "s": s, "run": number}, along, len(number), method="iso2631"
    )


def _within(signal: np.ndarray, lower: float, upper: float) -> np.ndarray:
    return (signal >= signal.dtype.type(lower)) & (signal < signal.dtype.type(upper))
