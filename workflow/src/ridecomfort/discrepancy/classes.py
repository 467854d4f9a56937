"""The error by how a drive goes: classes of speed, of curvature, of accelerations, of what suspensions and tyres do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
import xarray as xr

from . import judged

CLASSES = 5
"""Classes of equal duration that a condition is divided into."""

GAP = 0.1
"""Share of what a condition spans that nothing may lie in for the edge of two classes to be put in its middle: between two steady speeds."""

ALIKE = 0.05
"""Share of a level by which that of the next class must be above it; else the two are one."""

SLOW = 1.0
"""Hz up to which a condition may change; its classes are of how the drive goes, not of single waves."""


class Driven(Protocol):
    """A drive with ``rate`` in Hz, ``error`` and ``signal`` (signal, sample) of what is judged, and ``series`` by name."""

    rate: float
    error: np.ndarray
    signal: np.ndarray
    series: Mapping[str, np.ndarray]


def by_condition(drives: Sequence[Driven], bands: Sequence[tuple[float, float]]) -> xr.Dataset:
    """Mean squares by classes of each ``condition`` that all drives have, in SI units.

    ``condition_error`` and ``condition_measured(condition, class, signal, band)`` in the unit of the signal squared, nil in a class that holds
    nothing; ``condition_share(condition, class)`` of the time; ``condition_level(condition, class)``, the mean of the condition, nan where it
    holds nothing; ``condition_edge(condition, edge)``. Edges: ``edges``.
    """
    known = [conditions(drive.series, drive.rate) for drive in drives]
    names = [name for name in known[0] if all(name in own for own in known)]
    edge = np.stack([edges(np.concatenate([own[name] for own in known])) for name in names])
    power = np.zeros((2, len(names), CLASSES, len(drives[0].error), len(bands)))
    samples, levels = np.zeros((2, len(names), CLASSES))
    for drive, own in zip(drives, known):
        which = [_class(own[name], of_it) for name, of_it in zip(names, edge)]
        for n, classes in enumerate(which):
            samples[n] += np.bincount(classes, minlength=CLASSES)
            levels[n] += np.bincount(classes, own[names[n]], minlength=CLASSES)
        for k, band in enumerate(bands):
            for source, series in enumerate((drive.error, drive.signal)):
                for i, row in enumerate(judged.band(series, drive.rate, band) ** 2):
                    for n, classes in enumerate(which):
                        power[source, n, :, i, k] += np.bincount(classes, row, minlength=CLASSES)
    levels = np.where(samples > 0, levels / np.maximum(samples, 1), np.nan)
    error, measured = power / np.maximum(samples, 1)[None, :, :, None, None]
    by_class = ("condition", "class", "signal", "band")
    return xr.Dataset(
        {
            "condition_edge": (("condition", "edge"), edge),
            "condition_level": (("condition", "class"), levels),
            "condition_share": (("condition", "class"), samples / samples.sum(axis=1, keepdims=True)),
            "condition_error": (by_class, error),
            "condition_measured": (by_class, measured),
        },
        {"condition": names},
    )


def conditions(series: Mapping[str, np.ndarray], rate: float) -> dict[str, np.ndarray]:
    """What a drive with these series at ``rate`` (Hz) does at every sample, by name of the condition: (sample,) in SI units."""
    speed = series["v_x"]
    found = {"speed": speed}
    if "yaw_rate" in series:
        found["curvature"] = np.abs(_slow(series["yaw_rate"], rate)) / np.maximum(speed, 1.0)
    for name, signal in (("lateral_acceleration", "a_y"), ("longitudinal_acceleration", "a_x")):
        if signal in series:
            found[name] = np.abs(_slow(series[signal], rate))
    for name in ("suspension_velocity", "tyre_velocity"):
        if name in series:
            found[name] = np.sqrt(np.maximum(_slow(series[name] ** 2, rate), 0.0))
    return found


def edges(values: np.ndarray) -> np.ndarray:
    """Edges (CLASSES + 1,) of classes of equal duration of a condition.

    An edge lies in the middle of a gap that is near: steady speeds of 50 and 80 km/h are told apart at 65, not within what one of them wavers.
    Classes whose levels are ALIKE are one, the others empty: an edge between them would be no condition.
    """
    ordered = np.sort(values)
    at = np.linspace(0, 1, CLASSES + 1)
    found = np.quantile(ordered, at)
    wide = GAP * (ordered[-1] - ordered[0])
    for k in range(1, CLASSES):
        first, last = (int((at[k] + side / (2 * CLASSES)) * (len(ordered) - 1)) for side in (-1, 1))
        steps = np.diff(ordered[first : last + 1])
        if steps.size and steps.max() > wide:
            gap = first + int(steps.argmax())
            found[k] = 0.5 * (ordered[gap] + ordered[gap + 1])
    for k in range(1, CLASSES):
        start, middle, end = np.searchsorted(ordered, [found[k - 1], found[k], found[k + 1] if k + 1 < CLASSES else np.inf])
        below, above = ordered[start:middle], ordered[middle:end]
        if below.size and above.size and above.mean() < (1 + ALIKE) * below.mean():
            found[k] = found[k - 1]
    return found


def _class(values: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """The class (sample,) that values lie in."""
    return np.clip(np.searchsorted(edge, values, "right") - 1, 0, CLASSES - 1)


def _slow(series: np.ndarray, rate: float) -> np.ndarray:
    """The running mean over 1/SLOW seconds, or over all of a shorter series."""
    count = min(max(1, int(rate / SLOW)), len(series))
    weight = np.convolve(np.ones(len(series)), np.ones(count), "same")
    return np.convolve(series, np.ones(count), "same") / weight
