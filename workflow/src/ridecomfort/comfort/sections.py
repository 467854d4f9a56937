"""Sections of a road that are critical in their whole length (sec:th_methdology)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..errors import InputError
from ..vocabulary import describe

LENGTH = 5.0
"""m; length of a critical section, an average car's (sec:ride_comfort_results)."""


@dataclass(frozen=True)
class Windows:
    """Windows over equally or unequally spaced places: starts in m, first sample and sample behind the last."""

    start: np.ndarray
    first: np.ndarray
    behind: np.ndarray
    length: float

    def __len__(self) -> int:
        return len(self.start)

    def whole(self, condition: np.ndarray) -> np.ndarray:
        """Whether a condition (..., s) holds at every sample of each window, (..., window)."""
        size = self.behind[0] - self.first[0]
        if np.array_equal(self.first, self.first[0] + size * np.arange(len(self))) and np.all(
            self.behind - self.first == size
        ):
            part = condition[..., self.first[0] : self.behind[-1]]
            return part.reshape(*condition.shape[:-1], len(self), size).all(axis=-1)
        failures = np.concatenate(
            [np.zeros(condition.shape[:-1] + (1,), np.int64), np.cumsum(~condition, axis=-1)], axis=-1
        )
        return failures[..., self.behind] == failures[..., self.first]

    def mean(self, signal: np.ndarray) -> np.ndarray:
        """Mean of a signal (..., s) over the samples of each window, (..., window)."""
        total = np.concatenate(
            [np.zeros(signal.shape[:-1] + (1,)), np.cumsum(signal, axis=-1, dtype=float)], axis=-1
        )
        return (total[..., self.behind] - total[..., self.first]) / (self.behind - self.first)


def windows(s, length: float = LENGTH, *, sliding: bool = False) -> Windows:
    """Windows of ``length`` metres over the places ``s`` (m, ascending).

    Sequential from the first place on, or with ``sliding`` one that begins at
    every place. A window holds the places from its start up to, without, its end;
    what is left behind the last whole window is not evaluated.
    Raises InputError where ``s`` does not ascend, is too coarse for the length or shorter than it.
    """
    s = np.asarray(s, float)
    if s.ndim != 1 or len(s) < 2 or not np.all(np.diff(s) > 0.0):
        raise InputError("expected at least two ascending places in m", place="s")
    if not (np.isfinite(length) and length > 0.0):
        raise InputError(f"{length!r} is not a length; expected more than 0 m", place="length")
    # Each place stands for the road up to the next one, the last for as much as the one before it.
    end = 2 * s[-1] - s[-2]
    slack = 1e-6 * length
    if sliding:
        start = s[s + length <= end + slack]
    else:
        start = s[0] + length * np.arange(int((end - s[0] + slack) / length))
    if not start.size:
        raise InputError(
            f"{end - s[0]:.4g} m of road from {s[0]:g} m on, expected room for one section of {length:g} m "
            "(`space` and comfort: critical_length in config/study.yaml)",
            place="s",
        )
    first = np.searchsorted(s, start - slack)
    behind = np.searchsorted(s, start + length - slack)
    empty = np.flatnonzero(behind <= first)
    if empty.size:
        raise InputError(f"no sample between {start[empty[0]]:g} m and {start[empty[0]] + length:g} m", place="s")
    return Windows(start, first, behind, float(length))


def critical(signal, s, threshold, length: float = LENGTH, *, sliding: bool = False) -> xr.Dataset:
    """Windows and whether the signal passes the threshold in the whole of each.

    ``signal`` (..., s): array, or DataArray with the dimension ``s``. ``threshold``:
    a number that the signal must lie above, an array of such numbers over ``s``,
    or a pair (lower, upper) of either, outside of which it must lie.

    Returns ``critical`` (..., window) and ``window_start`` (window) in m.
    Raises InputError for gaps in the signal, thresholds that are no numbers and lengths that do not fit.
    Source: sec:th_methdology, read with sec:ride_comfort_results.
    """
    values, dims, coords = _over_s(signal, s)
    lower, upper = _band(threshold, values.shape[-1])
    outside = values > upper if lower is None else (values < lower) | (values > upper)
    return _dataset(outside, windows(s, length, sliding=sliding), dims, coords)


def within(signal, s, lower, upper, length: float = LENGTH, *, sliding: bool = False) -> xr.Dataset:
    """Windows and whether the signal lies in [lower, upper) in the whole of each; else as ``critical``."""
    values, dims, coords = _over_s(signal, s)
    inside = (values >= np.asarray(lower)) & (values < np.asarray(upper))
    return _dataset(inside, windows(s, length, sliding=sliding), dims, coords)


def stretches(found: np.ndarray, start: np.ndarray, length: float) -> list[tuple[float, float]]:
    """Beginnings and ends in m of the stretches that critical windows (window,) cover together."""
    answer: list[tuple[float, float]] = []
    for begin in np.asarray(start, float)[np.asarray(found, bool)]:
        if answer and begin <= answer[-1][1] + 1e-6 * length:
            answer[-1] = (answer[-1][0], float(begin + length))
        else:
            answer.append((float(begin), float(begin + length)))
    return answer


def _over_s(signal, s) -> tuple[np.ndarray, tuple, dict]:
    if isinstance(signal, xr.DataArray):
        dim = "s" if "s" in signal.dims else signal.dims[-1]
        signal = signal.transpose(..., dim)
        dims = signal.dims[:-1]
        coords = {name: coord for name, coord in signal.coords.items() if dim not in coord.dims}
        values = signal.values
    else:
        values = np.asarray(signal)
        dims, coords = tuple(f"dim_{axis}" for axis in range(values.ndim - 1)), {}
    if values.ndim == 0 or values.shape[-1] != np.size(s):
        raise InputError(f"has the shape {values.shape}; expected {np.size(s)} places last", place="signal")
    if not np.isfinite(values).all():
        place = int(np.argwhere(~np.isfinite(values))[0][-1])
        raise InputError(f"has a gap at s = {float(np.asarray(s)[place]):g} m", place="signal")
    return values, dims, coords


def _band(threshold, places: int):
    pair = isinstance(threshold, (tuple, list)) or (np.shape(threshold)[:1] == (2,) and places != 2)
    if not pair:
        limit = np.asarray(threshold, float)
        if limit.ndim and limit.shape[-1] != places:
            raise InputError(f"{limit.shape[-1]} thresholds for {places} places", place="threshold")
        _check_numbers(limit)
        return None, limit
    if len(threshold) != 2:
        raise InputError(f"{threshold!r} is not a pair (lower, upper)", place="threshold")
    lower, upper = (np.asarray(limit, float) for limit in threshold)
    _check_numbers(lower, upper)
    if np.any(lower > upper):
        raise InputError("the lower threshold lies above the upper one", place="threshold")
    return lower, upper


def _check_numbers(*limits: np.ndarray) -> None:
    for limit in limits:
        if np.isnan(limit).any():
            raise InputError("nan, expected a number", place="threshold")


def _dataset(condition: np.ndarray, along: Windows, dims: tuple, coords: dict) -> xr.Dataset:
    answer = xr.Dataset(
        {"critical": ((*dims, "window"), along.whole(condition)), "window_start": ("window", along.start)},
        coords={**coords, "window": np.arange(len(along))},
    )
    answer.attrs["critical_length"] = along.length
    return describe(answer)
