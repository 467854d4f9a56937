"""What one of several repeats records otherwise than the others: a single signal of another scale, or at another time.

Repeats meet the same road in the same car, so that what the model lacks is alike in all of them. An instrument, or the channel that it is
recorded by, may be another in one of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..drive.sampling import rate_of
from ..drive.turning import GAIN, STANDARD_ERRORS
from .explain import repeats
from .judged import judged

LATE = 0.004
"""s by which one signal must come later than the others."""

INDEPENDENT = 10.0
"""Independent values of a signal in a second."""

FARTHEST = 0.05
"""s up to which a signal is looked for in time."""

ROUNDS = 6
"""How often a time is sought anew from where one was found."""


class Signals(NamedTuple):
    """What a drive of this ``name`` ``measured`` and what its model ``simulated``, (signal, sample) each, at which ``place`` in m, and at how many Hz."""

    name: str
    place: np.ndarray
    measured: np.ndarray
    simulated: np.ndarray
    rate: float


def of_comparison(comparison: xr.Dataset) -> list[str]:
    """``of_repeats`` of all drives of a comparison (``compare.compare``) that repeat one another, in its last state."""
    rows, rate = comparison.isel(state=-1), rate_of(comparison["time"].values)
    found = []
    for number, name in enumerate(comparison["drive"].values):
        row = rows.isel(drive=number)
        kept = np.isfinite(row["residual"]).all("signal").values
        series = {own: row[own].transpose("signal", "time").values[:, kept] for own in ("measured", "residual")}
        found.append(Signals(str(name), row["s"].values[kept], series["measured"], series["measured"] + series["residual"], rate))
    names = comparison["signal"].values.tolist()
    return [said for group in repeats(comparison) for said in of_repeats([found[number] for number in group], names)]


def of_repeats(drives: Sequence[Signals], channels: Sequence[str]) -> list[str]:
    """Signals, in words, whose gain or time beside the model is in one of several repeats another than in the others, where all of these drove:
    elsewhere the model may lack something else."""
    start, end = max(drive.place[0] for drive in drives), min(drive.place[-1] for drive in drives)
    if end <= start:
        return []
    found = [_gains_and_delays(drive, channels, (drive.place >= start) & (drive.place <= end)) for drive in drives]
    gains, delays, gain_errors, delay_errors = (np.stack(part) for part in zip(*found))
    delays = delays - np.median(delays, axis=1, keepdims=True)  # of the whole record it is one of the clock
    said = []
    for values, errors, least, words in ((gains, gain_errors, GAIN, _is_scaled), (delays, delay_errors, LATE, _is_late)):
        apart = values - (np.median(values, axis=0) if len(drives) > 2 else values[::-1])
        is_apart = np.abs(apart) - STANDARD_ERRORS * np.hypot(errors, np.median(errors, axis=0)) > least
        for channel, row in zip(*np.nonzero(is_apart.T)):
            others = ", ".join(drive.name for number, drive in enumerate(drives) if number != row)
            beside = f"{drives[row].name}: {channels[channel]}, beside what the model does there and in {others},"
            said.append(f"{beside} {words(apart[row, channel])}")
    return said


def _is_scaled(apart: float) -> str:
    return f"is {too_large(apart)}, if these are right: its scale, or its unit?"


def _is_late(apart: float) -> str:
    return f"comes {too_late(apart)}, if these are right: its filter, or its channel?"


def too_large(share: float) -> str:
    """A share by which a signal is too large, in words; negative where it is too small."""
    return f"{100 * abs(share):.1f} % too {'large' if share > 0 else 'small'}"


def too_late(seconds: float) -> str:
    """A time by which a signal comes too late, in words; negative where it comes too early."""
    return f"{1e3 * abs(seconds):.0f} ms too {'late' if seconds > 0 else 'early'}"


def along(left: np.ndarray, column: np.ndarray, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """How much of a ``column`` (signal, sample) is in what is ``left`` of signals that last so many ``seconds``, and the standard error of that, (signal,) each."""
    power = np.maximum(np.sum(column**2, axis=1), np.finfo(float).tiny)
    return np.sum(left * column, axis=1) / power, np.sqrt(np.sum(left**2, axis=1) / power / (INDEPENDENT * seconds))


def _gains_and_delays(drive: Signals, channels: Sequence[str], inside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """By how much each signal of a drive is too large (1) and too late (s) beside the model, in the band that is judged and in the samples ``inside``,
    and the standard errors of these, (channel,) each."""
    measured, simulated = (judged(series, drive.rate, channels) for series in (drive.measured, drive.simulated))
    late, seconds = np.zeros(len(simulated)), inside.sum() / drive.rate
    for _ in range(ROUNDS):
        in_time = np.stack([delayed(row, drive.rate * own) for row, own in zip(simulated, late)])
        left = (in_time - measured)[:, inside]
        further, late_error = along(left, np.gradient(in_time, 1.0 / drive.rate, axis=1)[:, inside], seconds)
        late = np.clip(late + further, -FARTHEST, FARTHEST)
    less, gain_error = along(left, in_time[:, inside], seconds)
    return -less, late, gain_error, late_error


def delayed(row: np.ndarray, samples: float) -> np.ndarray:
    """A signal (sample,) later by so many samples, by its spectrum: a spline between the samples of a record (``record.late`` is for denser ones) would
    lose what is fast. What joins its ends, which is no motion, is taken out before."""
    line = np.linspace(row[0], row[-1], row.size)
    phase = np.exp(-2j * np.pi * np.fft.rfftfreq(row.size) * samples)
    return np.fft.irfft(np.fft.rfft(row - line) * phase, row.size) + line
