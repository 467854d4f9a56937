"""From the clock of an instrument to the uniform time of a drive."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit
from scipy.ndimage import uniform_filter1d
from scipy.sparse import csr_array

from ..errors import InputError

LARGEST_JITTER, NEIGHBOURS, FARTHEST_STAMP = 0.2, 11, 0.5
"""Largest rms distance of NEIGHBOURS consecutive time stamps from a uniform clock, in sampling intervals, for inertial signals, and the largest of
one alone. A sample that is missing moves all that follow; a stamp that a computer gave late moves itself alone."""

SLOWEST_RATE = 2.0
"""Hz; accelerations that are recorded more slowly hold nothing of ride comfort: the time is in another unit."""

LARGEST_SHIFT = 0.02
"""Distance in intervals within which samples stand on a clock: at 20 Hz and 100 Hz sampling a phase of 1.4 degrees."""

LARGEST_GAP = 0.25
"""s; longest pause in a slow quantity (speed, place): over it, 0.5 m/s2 bends a line of place by less than 4 mm."""

HALF_WIDTH, KAISER = 5, 4.0
"""Half width of the anti-alias filter in periods of twice its cut-off, and shape of its window: flat (to 0.1 dB) to 0.7 of the
cut-off, -0.4 dB at 0.8, -6 dB at the cut-off, -26 dB at 1.2 and closed (-45 dB) from 1.3 of it, as simulated drives are recorded."""


FINE = 32
"""Points an interval at which the filter is tabulated: between them it is straight to one in ten thousand."""


def rate_of(time: np.ndarray) -> float:
    """Samples a second of uniform time stamps (s)."""
    return float((len(time) - 1) / (time[-1] - time[0]))


def stamp(time: float) -> str:
    """A time in s as it is told to a user, to the microsecond; to the millisecond where it counts from 1970."""
    return f"{round(float(time), 6) + 0.0:.13g}"


def integral(values: np.ndarray, over: np.ndarray) -> np.ndarray:
    """Integral of values over what they stand at, from the first on, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(over))])


def check_clock(time: np.ndarray, *, file=None, place: str = "time") -> None:
    """Raise InputError unless the time stamps are finite and strictly increasing (samples count from 1)."""
    if time.ndim != 1 or len(time) < 2:
        raise InputError(f"{time.size} time stamps (expected a column of at least 2)", file=file, place=place)
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise InputError(f"sample {bad[0] + 1} holds {time[bad[0]]} (expected a number)", file=file, place=place)
    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        i = back[0]
        raise InputError(
            f"the clock does not advance at sample {i + 2}: {stamp(time[i + 1])} s after {stamp(time[i])} s "
            "(expected strictly increasing time)",
            file=file,
            place=place,
        )


def uniform_clock(time: np.ndarray) -> tuple[float, float, np.ndarray]:
    """Start in s and interval in s of nearly uniform time stamps, and how far each lies behind them in intervals, (sample,)."""
    index = np.arange(len(time))
    interval, start = np.polyfit(index, time - time[0], 1)
    return time[0] + start, interval, (time - time[0] - start) / interval - index


def require_uniform(time: np.ndarray, *, file=None, place: str = "time") -> tuple[float, float, float]:
    """Start in s and interval in s of time stamps, and their jitter: the largest distance of any from this clock in intervals. Raises InputError
    where it is beyond FARTHEST_STAMP, or that of NEIGHBOURS beyond LARGEST_JITTER."""
    start, interval, late = uniform_clock(time)
    alone = np.abs(late)
    together = np.sqrt(np.maximum(uniform_filter1d(late**2, min(NEIGHBOURS, len(late)), mode="nearest"), 0.0))
    if alone.max() > FARTHEST_STAMP or together.max() > LARGEST_JITTER:
        gaps = np.diff(time)
        widest = int(np.argmax(np.abs(gaps - np.median(gaps))))
        raise InputError(
            f"irregular sampling: sample {int(alone.argmax()) + 1}, at {stamp(time[alone.argmax()])} s, lies {late[alone.argmax()]:+.2g} intervals from a "
            f"uniform clock, and a step of {gaps[widest]:.4g} s follows on {stamp(time[widest])} s where {np.median(gaps):.4g} s is usual (expected time "
            f"stamps within {FARTHEST_STAMP:g} intervals of a uniform clock, {NEIGHBOURS} in a row within {LARGEST_JITTER:g} rms; where "
            "samples are lost, cut the record; where a computer stamped them late, write their number over the rate)",
            file=file,
            place=place,
        )
    return start, interval, float(alone.max())


def _kernel(distance: np.ndarray, interval: float, cut_off: float) -> np.ndarray:
    """Windowed sinc (Kaiser) at distances in intervals; rows sum to one."""
    kernel = _windowed_sinc(distance, interval, cut_off)
    return kernel / kernel.sum(axis=-1, keepdims=True)


def _windowed_sinc(distance: np.ndarray, interval: float, cut_off: float) -> np.ndarray:
    """The filter at distances in intervals, nil beyond its half width."""
    width = HALF_WIDTH / (2 * cut_off * interval)
    window = np.i0(KAISER * np.sqrt(np.clip(1 - (distance / width) ** 2, 0, None))) * (np.abs(distance) <= width)
    return np.sinc(2 * cut_off * interval * distance) * window


def _half_width(interval: float, cut_off: float) -> int:
    """Whole intervals that hold half of the filter."""
    return int(np.ceil(HALF_WIDTH / (2 * cut_off * interval)))


def band_limited(start: float, interval: float, values: np.ndarray, time: np.ndarray, cut_off: float) -> np.ndarray:
    """Uniform samples low-passed at ``cut_off`` (Hz) and evaluated at any times, without delay.

    Windowed-sinc interpolation: conversion of the sampling rate by any ratio, with the anti-alias
    filter in the same step. At the ends the record is continued by its first and last value.
    """
    half = _half_width(interval, cut_off)
    taps = np.arange(-half + 1, half + 1)
    result = np.empty(len(time))
    for first in range(0, len(time), 8192):  # bounds the memory of the tap matrix
        part = slice(first, first + 8192)
        place = (time[part] - start) / interval
        whole = np.floor(place).astype(int)
        kernel = _kernel((place - whole)[:, None] - taps, interval, cut_off)
        result[part] = np.einsum("ij,ij->i", kernel, values[np.clip(whole[:, None] + taps, 0, len(values) - 1)])
    return result


def low_pass(values: np.ndarray, interval: float, cut_off: float) -> np.ndarray:
    """Uniform samples (time, channel) through the same filter as ``band_limited``, on their own clock."""
    half = _half_width(interval, cut_off)
    return _convolve(np.ascontiguousarray(values), _kernel(np.arange(-half, half + 1.0), interval, cut_off))


def low_pass_matrix(count: int, interval: float, cut_off: float) -> csr_array:
    """``low_pass`` of ``count`` samples as a sparse matrix, for signals that are mostly zero."""
    half = _half_width(interval, cut_off)
    offsets = np.arange(-half, half + 1)
    taps = _kernel(offsets.astype(float), interval, cut_off)
    rows = np.repeat(np.arange(count), offsets.size)
    columns = np.clip(rows + np.tile(offsets, count), 0, count - 1)
    return csr_array((np.tile(taps, count), (rows, columns)), shape=(count, count))


@njit(cache=True, nogil=True, fastmath=True)
def _convolve(values, taps):
    """Symmetric taps on (time, channel); the ends are held."""
    count, channels = values.shape
    half = len(taps) // 2
    result = np.zeros((count, channels))
    for n in range(count):
        for j in range(len(taps)):
            m = min(max(n + j - half, 0), count - 1)
            for c in range(channels):
                result[n, c] += taps[j] * values[m, c]
    return result


def resampled(values: np.ndarray, interval: float, places: np.ndarray, cut_off: float) -> np.ndarray:
    """(channel, time) at fractional indices, low-passed as by ``band_limited``: (channel, place).

    Only what is asked for is filtered, so the samples may be as dense as they come.
    """
    kernel, _ = _tables(interval, cut_off)
    sums, total = _weighted(np.ascontiguousarray(values), places, kernel)
    return sums / total


def resampled_slopes(values: np.ndarray, interval: float, places: np.ndarray, cut_off: float) -> np.ndarray:
    """Time derivatives of ``resampled``, (channel, place)."""
    kernel, slope = _tables(interval, cut_off)
    values = np.ascontiguousarray(values)
    sums, total = _weighted(values, places, kernel)
    turned, drift = _weighted(values, places, slope)
    return (turned - drift / total * sums) / total / interval


@lru_cache
def _tables(interval: float, cut_off: float) -> tuple[np.ndarray, np.ndarray]:
    """The kernel of ``band_limited`` and its slope per interval at a place FINE points an interval behind a sample: (point, tap)."""
    half = _half_width(interval, cut_off)
    kernel = _windowed_sinc(np.arange(-half * FINE, (half + 1) * FINE + 1) / FINE, interval, cut_off)
    taps = FINE * np.arange(1, 2 * half + 1) - np.arange(FINE + 1)[:, None]
    return kernel[taps], -np.gradient(kernel, 1 / FINE)[taps]


@njit(cache=True, nogil=True, fastmath=True)
def _weighted(values, places, table):
    """Sums of (channel, time) around every place, weighted by a ``table`` (point, tap) that is straight between its points,
    (channel, place), and the sums of the weights; the ends are held."""
    channels, count = values.shape
    points, taps = table.shape
    sums = np.zeros((channels, len(places)))
    total = np.zeros(len(places))
    weights = np.empty(taps)
    for i in range(len(places)):
        whole = int(np.floor(places[i]))
        first = whole - taps // 2 + 1
        at = (places[i] - whole) * (points - 1)
        k = min(int(at), points - 2)
        before, behind = table[k], table[k + 1]
        part = at - k
        all_of_them = 0.0
        for j in range(taps):
            weights[j] = before[j] + part * (behind[j] - before[j])
            all_of_them += weights[j]
        total[i] = all_of_them
        inside = first >= 0 and first + taps <= count
        for c in range(channels):
            found = 0.0
            if inside:
                own = values[c, first : first + taps]
                for j in range(taps):
                    found += weights[j] * own[j]
            else:
                for j in range(taps):
                    found += weights[j] * values[c, min(max(first + j, 0), count - 1)]
            sums[c, i] = found
    return sums, total


def resample_inertial(
    time, values, new_time, rate: float, *, at_most: float = np.inf, file=None, place=None
) -> tuple[np.ndarray, float, float]:
    """Inertial signal on ``new_time`` (uniform, ``rate`` Hz), the jitter of its own clock in intervals,
    and the cut-off in Hz that it was low-passed at, ``at_most`` the one given.

    Values that already stand on the new clock pass unchanged where they may; half their rate is then
    taken for the cut-off of the instrument.
    """
    start, interval, jitter = require_uniform(time, file=file, place=place)
    first = int(round((new_time[0] - start) / interval))
    taken = slice(first, first + len(new_time))
    stands = len(time[taken]) == len(new_time) and np.abs(time[taken] - new_time).max() < LARGEST_SHIFT * interval
    if stands and at_most >= 0.5 * rate:
        return values[taken].copy(), jitter, 0.5 * rate
    cut_off = min(0.45 * min(rate, 1 / interval), at_most)
    return band_limited(start, interval, values, new_time, cut_off), jitter, cut_off


def resample_slow(time, values, new_time, *, file=None, place=None) -> np.ndarray:
    """Speed or place on ``new_time``, linear between time stamps that may jitter but not pause."""
    gaps = np.diff(time)
    i = int(gaps.argmax())
    if gaps[i] > LARGEST_GAP:
        raise InputError(
            f"a pause of {gaps[i]:.3g} s at {stamp(time[i])} s (expected none beyond {LARGEST_GAP:g} s)",
            file=file,
            place=place,
        )
    return np.interp(new_time, time, values)
