"""Frequency weightings of ISO 2631-1 and ISO 8041: the analogue response, applied exactly.

The product of four stages of second order (eq:highpass to eq:h_s with the slips
put right, docs/method.md): band limits, acceleration-velocity transition, upward step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy import fft

from ..errors import InputError
from . import signals

INFINITE = float("inf")

TAIL = 1e-9
"""What is left of the slowest transient where the zero padding ends, relative to its start."""

EXACT = 0.45
"""Share of the sampling rate up to which magnitude and phase are the analogue ones; the magnitude is up to 0.5."""

SIZE_STEP = 2048
"""Samples; transforms come in few lengths, so that drives of similar length go together."""

BLOCK_BYTES = 2**23
"""Signals are transformed in blocks of about this size, so that they stay in the cache."""


@dataclass(frozen=True)
class Weighting:
    """Parameters of one weighting: corner frequencies in Hz, quality factors, gain.

    A stage whose frequencies are infinite is absent. Source: ISO 8041-1:2017
    table 3; ISO 2631-1:1997 annex A table A.1.
    """

    name: str
    f1: float
    f2: float
    f3: float
    f4: float
    q4: float
    f5: float = INFINITE
    q5: float = INFINITE
    f6: float = INFINITE
    q6: float = INFINITE
    gain: float = 1.0
    q1: float = 2**-0.5
    q2: float = 2**-0.5

    def response(self, frequency) -> np.ndarray:
        """Complex response of the analogue filter at frequencies in Hz."""
        p = 2j * np.pi * np.asarray(frequency, dtype=float)
        w1, w2, w3, w4, w5, w6 = (2 * np.pi * f for f in (self.f1, self.f2, self.f3, self.f4, self.f5, self.f6))
        answer = self.gain * p**2 / (p**2 + p * w1 / self.q1 + w1**2)
        answer = answer / (1 + p / (self.q2 * w2) + (p / w2) ** 2)
        if np.isfinite(self.f4):
            answer = answer * (1 + p / w3) / (1 + p / (self.q4 * w4) + (p / w4) ** 2)
        if np.isfinite(self.f6):
            step = (1 + p / (self.q5 * w5) + (p / w5) ** 2) / (1 + p / (self.q6 * w6) + (p / w6) ** 2)
            answer = answer * step * (w5 / w6) ** 2
        return answer

    def factor(self, frequency) -> np.ndarray:
        """Weighting factor, the magnitude of the response, at frequencies in Hz."""
        return np.abs(self.response(frequency))

    def zeros_poles(self) -> tuple[np.ndarray, np.ndarray]:
        """Zeros and poles of the analogue filter in rad/s."""
        zeros = [0.0, 0.0]
        poles = [*_pair(self.f1, self.q1), *_pair(self.f2, self.q2)]
        if np.isfinite(self.f4):
            poles += _pair(self.f4, self.q4)
        if np.isfinite(self.f3):
            zeros.append(-2 * np.pi * self.f3)
        if np.isfinite(self.f6):
            zeros += _pair(self.f5, self.q5)
            poles += _pair(self.f6, self.q6)
        return np.array(zeros, complex), np.array(poles, complex)

    @property
    def memory(self) -> float:
        """Seconds after which the transient of the slowest pole has fallen to ``TAIL``."""
        return float(np.log(1 / TAIL) / np.min(-self.zeros_poles()[1].real))


def _pair(frequency: float, quality: float) -> list[complex]:
    return list(np.roots([1.0, 2 * np.pi * frequency / quality, (2 * np.pi * frequency) ** 2]))


WEIGHTINGS = {
    weighting.name: weighting
    for weighting in (
        Weighting("Wb", 0.4, 100, 16, 16, 0.55, 2.5, 0.9, 4.0, 0.95, gain=1.024),
        Weighting("Wc", 0.4, 100, 8, 8, 0.63),
        Weighting("Wd", 0.4, 100, 2, 2, 0.63),
        Weighting("We", 0.4, 100, 1, 1, 0.63),
        Weighting("Wf", 0.08, 0.63, INFINITE, 0.25, 0.86, 0.0625, 0.8, 0.1, 0.8),
        Weighting("Wj", 0.4, 100, INFINITE, INFINITE, INFINITE, 3.75, 0.91, 5.32, 0.91),
        Weighting("Wk", 0.4, 100, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91),
        Weighting("Wm", 10**-0.1, 100, 1 / (0.028 * 2 * np.pi), 1 / (0.028 * 2 * np.pi), 0.5),
    )
}
"""Wb vertical in rail vehicles (ISO 2631-4), Wc seat back, Wd horizontal, We rotation,
Wf motion sickness, Wj recumbent head, Wk vertical, Wm buildings (ISO 2631-2)."""


def named(weighting: str | Weighting) -> Weighting:
    """The weighting of a name such as "Wk"; InputError for a name that is none."""
    if isinstance(weighting, Weighting):
        return weighting
    try:
        return WEIGHTINGS[weighting]
    except (KeyError, TypeError):
        known = ", ".join(WEIGHTINGS)
        raise InputError(f"{weighting!r} is not a frequency weighting; expected one of {known}") from None


def weight(acceleration, rate: float, weighting: str | Weighting, *, before: str = "rest"):
    """Frequency-weighted acceleration in m/s2, of the shape and type of ``acceleration``.

    ``acceleration`` in m/s2, equally sampled at ``rate`` Hz, last axis time; an
    array or a DataArray (dimension ``time``; unit and rate are checked). Runs of
    different length may be padded with NaN at their end, which stays. The
    analogue response multiplies the spectrum of the signal, padded with zeros
    until the slowest transient has died away, so that nothing wraps round.

    ``before`` says what came before the first sample: "rest", nothing (a test
    signal, a drive that begins at rest), or "mirror", the beginning of the signal
    reversed in time (a recording cut out of a longer drive or with an offset).

    Raises InputError for gaps, other units and unknown weightings.
    Source: eq:highpass to eq:eva_transfer; ISO 2631-1:1997 annex A, ISO 8041-1:2017 5.6.
    """
    weighting = named(weighting)
    return filtered(acceleration, signals.check_rate(rate), weighting, before, frequency_weighting=weighting.name)


def filtered(acceleration, rate: float, filter_, before: str, **attributes):
    """A signal in m/s2 behind any filter that has a complex ``response`` and a ``memory`` in s; as ``weight``."""
    values, restore = signals.time_last(acceleration, rate, "m/s2")
    table, lengths = signals.rows(values)
    answer = np.empty_like(table)
    for rows, part in spectral(table, lengths, rate, filter_, before):
        answer[rows, : part.shape[1]] = part
    blank(answer, lengths)
    return restore(answer.reshape(values.shape), **attributes)


def spectral(table: np.ndarray, lengths: np.ndarray, rate: float, filter_, before: str):
    """Rows filtered in the frequency domain, a few at a time: (their indices, their filtered samples).

    What lies behind ``lengths`` is not data and counts as zero. The length of the
    transform follows from each row alone, so that its result is the same bit for
    bit whatever rows and padding come with it.
    """
    if before not in ("rest", "mirror"):
        raise InputError(f"{before!r} is unknown; expected 'rest' or 'mirror'", place="before")
    memory = int(np.ceil(filter_.memory * rate))
    leads = np.clip(lengths - 1, 0, memory) if before == "mirror" else np.zeros_like(lengths)
    sizes = -(-(lengths + leads + memory) // SIZE_STEP) * SIZE_STEP
    for size, lead in np.unique(np.stack([sizes, leads], axis=1), axis=0):
        length = fft.next_fast_len(int(size), real=True)
        gain = sampled_response(filter_, length, rate)
        alike = np.flatnonzero((sizes == size) & (leads == lead))
        step = max(1, BLOCK_BYTES // (length * table.itemsize))
        for first in range(0, len(alike), step):
            rows = alike[first : first + step]
            samples = int(lengths[rows].max())
            data = table[rows, :samples]
            if before == "mirror":
                # No weighting passes a constant, a seat passes all of it: the mean goes, and what is passed of it comes back without a transient.
                levels = _means(data, lengths[rows])[:, None]
                data -= levels
            if lengths[rows].min() < samples:
                data[np.arange(samples) >= lengths[rows, None]] = 0
            if lead:
                data = np.concatenate([data[:, lead:0:-1], data], axis=1)
            spectrum = fft.rfft(data, length, axis=-1)
            spectrum *= gain.astype(spectrum.dtype)
            answer = fft.irfft(spectrum, length, axis=-1, overwrite_x=True)[:, lead : lead + samples]
            if before == "mirror" and gain[0]:
                answer += gain[0].real * levels
            yield rows, answer


def sampled_response(filter_, length: int, rate: float) -> np.ndarray:
    """Response at the frequencies of a real transform of ``length`` samples at ``rate`` Hz.

    The analogue one, but for the phase above ``EXACT`` times the rate, which bends to be
    a multiple of pi at half the rate. A jump there, from the response to its mirror image, would ring
    through the signal in both directions of time.
    """
    share = fft.rfftfreq(length)
    gain = filter_.response(share * rate)
    last = np.angle(filter_.response(0.5 * rate))
    bend = np.clip((share - EXACT) / (0.5 - EXACT), 0.0, 1.0)
    return gain * np.exp(1j * (np.pi * np.round(last / np.pi) - last) * bend**2 * (3.0 - 2.0 * bend))


@njit(cache=True)
def _means(table, lengths):
    answer = np.zeros(table.shape[0], table.dtype)
    for row in range(table.shape[0]):
        total = 0.0
        for sample in range(lengths[row]):
            total += table[row, sample]
        answer[row] = total / max(lengths[row], 1)
    return answer


def blank(table: np.ndarray, lengths: np.ndarray) -> None:
    """Write NaN behind the data of every row."""
    for row in np.flatnonzero(lengths < table.shape[1]):
        table[row, lengths[row] :] = np.nan
