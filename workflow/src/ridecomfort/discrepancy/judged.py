"""From which frequency on an error says something of the vehicle, and series cut to bands."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.fft import dct, idct
from scipy.signal import csd, welch

from ..drive import axes
from ..drive.axes import correlation
from .response import SEGMENT

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


AGAINST, SURELY_AGAINST = -0.3, -(0.5**0.5)
"""Correlation with the model below which a signal is taken for one of the wrong sign: where COHERENT of its power answers to what the model
does, and anyway, since turned round it would be more than half what the model says."""

COHERENT = 0.8
"""Share of the power of a signal that must be coherent with the model for its sign to be told: what else moves it (hands, noise, links that
steer) may run against the model, too."""

TIMES, ALIKE = 5.0, 0.5
"""Times by which the rms of a signal may differ from that of a model which it goes with (correlation above ALIKE): a rate in deg/s is 57 times one in
rad/s."""


def ratio(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """rms (signal,) of a series (signal, sample) over that of another; 1 where one of them is nil."""
    powers = np.sum(one**2, axis=-1), np.sum(other**2, axis=-1)
    are_there = (powers[0] > 0) & (powers[1] > 0)
    return np.sqrt(np.where(are_there, powers[0], 1.0) / np.where(are_there, powers[1], 1.0))


def coherence(one: np.ndarray, other: np.ndarray, rate: float) -> np.ndarray:
    """Share (signal,) of the power of a series (signal, sample) at ``rate`` Hz that is coherent with another, whatever filter lies between."""
    length = min(int(SEGMENT * rate), one.shape[-1] // 4)
    common = {"fs": rate, "nperseg": length, "detrend": False}
    powers = [welch(each, **common)[1] for each in (one, other)]
    product = powers[0] * powers[1]
    found = np.abs(csd(one, other, **common)[1]) ** 2 / np.where(product > 0, product, 1.0)
    count = 2 * one.shape[-1] // length - 1  # segments overlap by half; of nothing in common one of them would show all, some a part of it
    found = np.maximum((count * found - 1.0) / (count - 1.0), 0.0)
    return np.sum(found * powers[0], axis=-1) / np.maximum(np.sum(powers[0], axis=-1), np.finfo(float).tiny)


def against(measured: np.ndarray, simulated: np.ndarray, rate: float, signals: Sequence[str]) -> np.ndarray:
    """Correlation (signal,) of series (signal, sample) at ``rate`` Hz that speaks most for a wrong sign, of what is judged of them or of all
    but their means; 0 where none does.

    The latter tells a sign in bends. It is not asked of what is judged to be right: a bank that the road's file has not turns slow
    parts round.
    """
    pair = np.stack([measured, simulated])
    fast, whole = judged(pair, rate, signals), pair - pair.mean(axis=-1, keepdims=True)
    found, slow = _told_against(*fast, rate), _told_against(*whole, rate)
    return np.where(correlation(*fast) > ALIKE, found, np.minimum(found, slow))


def _told_against(one: np.ndarray, other: np.ndarray, rate: float) -> np.ndarray:
    """Correlation (signal,) where it speaks for a wrong sign, else 0."""
    alike = correlation(one, other)
    is_told = (alike < AGAINST) & (coherence(one, other, rate) > COHERENT) | (alike < SURELY_AGAINST)
    return np.where(is_told, alike, 0.0)


def doubt(name: str, other: str, turned: float, found: float, times: float) -> str:
    """What is said of a signal that goes with an ``other`` (``axes.taken_for``), is ``turned`` round (``against``), or has this correlation with the
    model and so many times its rms; empty where nothing is."""
    if other:
        return axes.exchanged(name, other)
    if turned < 0.0:
        return f"{name} runs against the model (correlation {turned:.2f}): is its sign right?"
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
