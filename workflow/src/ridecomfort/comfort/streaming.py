"""Frequency weightings as causal filters: fitted for streaming, and bilinear as in the paper.

A causal filter cannot have both the magnitude and the phase of the analogue
response up to the Nyquist frequency. Here the magnitude is exact and the phase
close at low frequencies; ``weighting.weight`` has both.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy import signal
from scipy.interpolate import AAA
from scipy.optimize import minimize_scalar

from ..errors import InputError
from . import signals, weighting
from .weighting import Weighting

HIGHEST = 0.45
"""Share of the sampling rate up to which the magnitude is fitted."""

DEVIATION = 0.005
"""dB; half of what the causal filters are allowed over 0.5 to 80 Hz."""

PHASE_SHARE = 0.2
"""Share of the sampling rate up to which the phase is made to follow the analogue one."""


@dataclass(frozen=True)
class Cascade:
    """A weighting as second-order sections, ``sos`` (section, 6) as in scipy.signal, at ``rate`` Hz."""

    weighting: Weighting
    rate: float
    sos: np.ndarray = field(repr=False)

    def response(self, frequency) -> np.ndarray:
        """Complex response at frequencies in Hz."""
        return signal.freqz_sos(self.sos, np.atleast_1d(frequency), fs=self.rate)[1].reshape(np.shape(frequency))

    def filter(self, acceleration) -> np.ndarray:
        """Weighted samples (..., time) in m/s2 of a whole signal in m/s2, from rest."""
        return signal.sosfilt(self.sos, np.asarray(acceleration, float), axis=-1)

    def deviation(self, frequency) -> np.ndarray:
        """Magnitude against the analogue response at frequencies in Hz, in dB."""
        return 20.0 * np.log10(np.abs(self.response(frequency)) / self.weighting.factor(frequency))

    def lag(self, frequency) -> np.ndarray:
        """Phase by which it lags behind the analogue response at frequencies in Hz, in rad, -pi to pi."""
        return -np.angle(self.response(frequency) / self.weighting.response(frequency))


class Stream:
    """A causal weighting that takes a signal piece by piece and remembers where it was.

    Starts at rest. ``channels`` is the shape before the axis of time.
    """

    def __init__(self, name: str | Weighting, rate: float, channels: tuple[int, ...] = ()) -> None:
        self.cascade = fitted(name, rate)
        self._state = np.zeros((len(self.cascade.sos), *channels, 2))

    def feed(self, acceleration) -> np.ndarray:
        """Weighted samples in m/s2 of the next piece (..., time) in m/s2."""
        signals.check_units(acceleration, "m/s2")
        piece = np.asarray(acceleration, float)
        if not np.isfinite(piece).all():
            raise InputError("holds a value that is not finite", place="acceleration")
        answer, self._state = signal.sosfilt(self.cascade.sos, piece, axis=-1, zi=self._state)
        return answer


def fitted(name: str | Weighting, rate: float) -> Cascade:
    """Second-order sections whose magnitude is the analogue one within 0.01 dB up to ``HIGHEST`` times the rate.

    Poles and zeros far below the rate are matched (z = exp(p T)). What remains is
    smooth: its square is a rational function of the cosine of the angle, found by
    the AAA algorithm (Nakatsukasa, Sete and Trefethen 2018), whose roots are
    poles and zeros inside the unit circle. An all-pass section of first order
    then brings the phase close. Raises InputError where no such filter is found
    (rates below about twice the corner frequencies).
    """
    return _fitted(weighting.named(name), signals.check_rate(rate))


@lru_cache(maxsize=64)
def _fitted(analogue: Weighting, rate: float) -> Cascade:
    for terms in range(4, 9):
        try:
            found = _with_terms(analogue, rate, terms)
        except (ValueError, np.linalg.LinAlgError):
            continue
        frequency = _frequencies(analogue, rate, 1500)
        if np.max(np.abs(found.deviation(frequency))) <= DEVIATION:
            return _phased(found)
    raise InputError(f"no causal filter of {analogue.name} within {DEVIATION:g} dB at {rate:g} Hz", place="rate")


def _frequencies(analogue: Weighting, rate: float, count: int) -> np.ndarray:
    low = min(analogue.f1 / 4, 0.01 * rate)
    return np.concatenate(
        [np.geomspace(low, 0.01 * rate, count // 5), np.linspace(0.01 * rate, HIGHEST * rate, count)[1:]]
    )


def _with_terms(analogue: Weighting, rate: float, terms: int) -> Cascade:
    zeros, poles = (
        np.exp(roots[np.abs(roots) < 2 * np.pi * PHASE_SHARE * rate] / rate) for roots in analogue.zeros_poles()
    )
    frequency = _frequencies(analogue, rate, 300)
    angle = 2 * np.pi * frequency / rate
    circle = np.exp(1j * angle)[:, None]
    matched = np.prod(circle - zeros, axis=1) / np.prod(circle - poles, axis=1)
    rest = (analogue.factor(frequency) / np.abs(matched)) ** 2
    rest /= rest.max()
    with warnings.catch_warnings():
        # The number of terms is given: that the fit does not go on to rounding is meant.
        warnings.simplefilter("ignore", RuntimeWarning)
        fit = AAA(np.cos(angle), rest, rtol=1e-12, max_terms=terms, clean_up=False)
    zeros = np.concatenate([zeros, _inside(fit.roots())])
    poles = np.concatenate([poles, _inside(fit.poles())])
    excess = len(poles) - len(zeros)
    zeros, poles = np.append(zeros, np.zeros(max(excess, 0))), np.append(poles, np.zeros(max(-excess, 0)))
    unscaled = np.abs(signal.freqz_zpk(zeros, poles, 1.0, angle)[1])
    gain = np.exp(np.mean(np.log(analogue.factor(frequency) / unscaled)))
    return Cascade(analogue, rate, signal.zpk2sos(zeros, poles, gain))


def _inside(cosines: np.ndarray) -> np.ndarray:
    """The z inside the unit circle with (z + 1/z) / 2 equal to each of ``cosines``."""
    cosines = np.asarray(cosines, complex)
    z = cosines - np.sqrt(cosines**2 - 1)
    z = np.where(np.abs(z) < 1, z, 1 / z)
    if np.any(np.abs(z) > 1 - 1e-9):
        raise ValueError("a root on the unit circle")
    return z


def _phased(cascade: Cascade) -> Cascade:
    """The cascade behind an all-pass that delays it to the phase of the analogue filter, where it leads."""
    frequency = np.linspace(0.01, PHASE_SHARE, 100) * cascade.rate
    lead = -np.unwrap(cascade.lag(frequency))
    lead -= 2 * np.pi * np.round(lead[0] / (2 * np.pi))

    def section(delay):
        a = (1.0 - delay) / (1.0 + delay)
        return np.array([[a, 1.0, 0.0, 1.0, a, 0.0]])

    def error(delay):
        lag = -np.unwrap(np.angle(signal.freqz_sos(section(delay), frequency, fs=cascade.rate)[1]))
        return np.max(np.abs(lead - lag))

    best = minimize_scalar(error, bounds=(0.0, 3.0), method="bounded")
    if best.fun >= np.max(np.abs(lead)):
        return cascade
    return Cascade(cascade.weighting, cascade.rate, np.concatenate([cascade.sos, section(best.x)]))


def bilinear(name: str | Weighting, rate: float) -> Cascade:
    """The paper's filter: the bilinear transform without prewarping (eq:transf, with the sampling period).

    It bends the frequency axis: its magnitude falls to nothing at half the rate.
    """
    analogue, rate = weighting.named(name), signals.check_rate(rate)
    zeros, poles = analogue.zeros_poles()
    # H(s) = gain s^2 / ... : the leading coefficient, taken at one frequency.
    at = 2j * np.pi * analogue.f1
    gain = (analogue.response(analogue.f1) / (np.prod(at - zeros) / np.prod(at - poles))).real
    return Cascade(analogue, rate, signal.zpk2sos(*signal.bilinear_zpk(zeros, poles, gain, rate)))
