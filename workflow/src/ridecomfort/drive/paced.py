"""What a residual would be if its driver had kept to a speed to the last millimetre a second, without driving again.

A speed that is missed by millimetres a second changes a drive in proportion, alike at every place: how is seen once, by asking for a speed that
swings at all frequencies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.signal import csd, welch

from ..vocabulary import SIGNALS
from .replay import Replay
from .sampling import rate_of

SLOWEST, SWING = 0.05, 0.02
"""Hz from which on the speed that is asked for swings, and by how much (m/s, rms)."""

WINDOW = 10.0
"""s of the spectra that the answer is taken from."""

COHERENT = 0.5
"""Coherence with the speed below which a signal is taken not to answer to it: what bends make of it goes by the place."""

SEED = 1
"""Of the phases of the swing."""


@dataclass(frozen=True)
class Paced:
    """For a replay and what has the same ``compared``: what the six signals do per m/s at every frequency of so many samples as there are in
    ``length``, (6, frequency)."""

    answer: np.ndarray
    length: int
    compared: np.ndarray

    def made_good(self, missing: np.ndarray) -> np.ndarray:
        """Change of the residual (6, compared) when the vehicle comes to drive so much faster, ``missing`` (time,) in m/s."""
        change = fft.irfft(self.answer * fft.rfft(missing, self.length), self.length, axis=-1)
        return change[:, : missing.size][:, self.compared]


def paced(again: Replay, vehicle, effects=()) -> Paced | None:
    """How a drive of a calibrated ``vehicle`` with its ``effects`` answers to its speed, by driving it twice; None where its accelerometer does
    not tell what its driver's foot does. Raises InputError when it does not arrive."""
    if again.by_foot is None:
        return None
    rate, upper = rate_of(again.time), again.by_foot[1]
    swinging = again.corrected({"speed": _swing(again.time.size, rate, upper)})
    runs = [one.run(vehicle, effects) for one in (again, swinging)]
    before, after = (np.vstack([again.sample(run).signals, again.driven(run)["v_x"]])[:, again.compared] for run in runs)
    change, faster = np.split(after - before, [len(SIGNALS)])
    faster = faster[0]
    length = min(faster.size, int(WINDOW * rate))
    frequency, own = welch(faster, rate, nperseg=length)
    together, powers = csd(faster, change, rate, nperseg=length)[1], welch(change, rate, nperseg=length)[1]
    answer = np.where(np.abs(together) ** 2 > COHERENT * own * powers, together / own, 0.0)
    long = fft.next_fast_len(again.time.size, real=True)
    at = fft.rfftfreq(long, 1 / rate)
    known = (at <= upper) * np.stack([np.interp(at, frequency, row.real) + 1j * np.interp(at, frequency, row.imag) for row in answer])
    return Paced(known, long, again.compared)


def _swing(count: int, rate: float, upper: float) -> np.ndarray:
    """A speed (time,) in m/s that swings at all frequencies from SLOWEST to beyond ``upper``, alike."""
    frequency = fft.rfftfreq(count, 1 / rate)
    phases = np.exp(2j * np.pi * np.random.default_rng(SEED).random(frequency.size))
    swing = fft.irfft(((frequency > SLOWEST) & (frequency < 1.2 * upper)) * phases, count)
    return SWING * swing / swing.std()
