"""From which frequency on an error says something of the vehicle, and series cut to bands."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.fft import dct, idct

LOWEST = 0.8
"""Hz; slower errors are drifts of instruments and what the driver makes of the path."""

LOWEST_OF_DRIVER = {"a_x": 1.5, "yaw_rate": 1.5}
"""Hz; what is slower in these the driver makes, whose foot and hands no record holds."""

IN_WORDS = f"{LOWEST:g} Hz on ({min(LOWEST_OF_DRIVER.values()):g} Hz for longitudinal acceleration and yaw rate)"
"""The same for notes of tables."""


def lowest(signals: Sequence[str]) -> np.ndarray:
    """Hz from which on each signal is judged, (signal,)."""
    return np.array([LOWEST_OF_DRIVER.get(str(signal), LOWEST) for signal in signals])


def judged(series: np.ndarray, rate: float, signals: Sequence[str]) -> np.ndarray:
    """Series (..., signal, sample) at ``rate`` Hz without what is too slow to say something of the vehicle."""
    return _kept(series, rate, lambda frequency: frequency >= lowest(signals)[:, None])


AGAINST = -0.3
"""Correlation with the model below which a signal is taken for one of the wrong sign."""

TIMES, ALIKE = 5.0, 0.5
"""Times by which the rms of a signal may differ from that of a model which it goes with (correlation above ALIKE): degrees are 57 radians."""


def correlation(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Correlation (signal,) about nil of two series (signal, sample), nil where one of them is."""
    power = np.sqrt(np.sum(one**2, axis=-1) * np.sum(other**2, axis=-1))
    return np.sum(one * other, axis=-1) / np.where(power > 0, power, 1.0)


def ratio(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """rms (signal,) of a series (signal, sample) over that of another; 1 where one of them is nil."""
    powers = np.sum(one**2, axis=-1), np.sum(other**2, axis=-1)
    are_there = (powers[0] > 0) & (powers[1] > 0)
    return np.sqrt(np.where(are_there, powers[0], 1.0) / np.where(are_there, powers[1], 1.0))


def doubt(name: str, found: float, times: float) -> str:
    """What is said of a signal with this correlation with the model and so many times its rms; empty where nothing is."""
    if found < AGAINST:
        return f"{name} runs against the model (correlation {found:.2f}): is its sign right?"
    if found > ALIKE and not 1.0 / TIMES < times < TIMES:
        return f"{name} is {times:.3g} times what the model does: is its unit right?"
    return ""


def band(series: np.ndarray, rate: float, edges: tuple[float, float]) -> np.ndarray:
    """Series (..., sample) at ``rate`` Hz with nothing left outside of a band (Hz)."""
    return _kept(series, rate, lambda frequency: (frequency >= edges[0]) & (frequency < edges[1]))


def _kept(series: np.ndarray, rate: float, is_kept: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Series with the frequencies (Hz) that are kept alone, as if they went on mirrored at their ends: braking from one end to the other,
    repeated, would be a jump of all frequencies."""
    frequency = 0.5 * rate * np.arange(series.shape[-1]) / series.shape[-1]
    return idct(np.where(is_kept(frequency), dct(series, axis=-1), 0.0), axis=-1)
