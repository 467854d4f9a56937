"""An error that comes back after the same way again and again: order analysis of what a model leaves.

A wheel, a shaft or a slab of the road makes a line in the spectrum over the way driven, at every speed in the same
place, whatever the angle at which it began to turn in each drive. Neither what repeats share nor a force with one phase for
all drives shows it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from .experiment import Frame, Record
from .propose import LEVEL, SURE

LONGEST = 7.0
"""m of way above which a period is none of these, but a bend or a driver."""

AROUND = 101
"""Bins of the spectrum whose median a line is held against."""


@dataclass(frozen=True)
class Line:
    """What comes back every ``period`` m in a ``channel``: how often its power is that of its neighbourhood on the fitted records, and on
    those held out (nan without), and the probability that any line of noise is so strong."""

    channel: str
    period: float
    strength: float
    held_out_strength: float
    p_value: float

    def words(self, radius: float) -> str:
        """The line in words; ``radius`` of the wheels in m."""
        order = f"{2.0 * np.pi * radius / self.period:.2f} times a turn of the wheels"
        return f"an error of {self.channel} comes back every {self.period:.3g} m of way, {order} (p = {self.p_value:.1g})"


def line(
    frame: Frame, residuals: Mapping[int, np.ndarray], check_frame: Frame | None, check: Mapping[int, np.ndarray]
) -> Line | None:
    """The strongest line of all channels in the residuals (channel, sample) of a frame, if it is sure and drives held out have it, too.

    Where all of an error came from one road, the power of a bin over that of its neighbourhood would be distributed exponentially,
    though it is a mean over repeats; so it is taken to be.
    """
    channels = frame.experiment.channels
    best, count = (0.0, 0, 0.0), 0
    for indices in _by_site(frame).values():
        records = [frame.experiment.records[i] for i in indices]
        wavenumber, strength = _strength(records, [_white(frame, i, residuals) for i in indices])
        seen = (wavenumber > 1.0 / LONGEST) & np.all([_heard(record, wavenumber) for record in records], axis=0)
        count += strength.shape[0] * int(seen.sum())
        strength = np.where(seen, strength, 0.0)
        channel, k = np.unravel_index(np.argmax(strength), strength.shape)
        best = max(best, (float(strength[channel, k]), int(channel), float(wavenumber[k])))
    found, channel, place = best
    p_value = min(1.0, count * float(np.exp(-found)))
    if p_value > SURE:
        return None
    held_out = [] if check_frame is None else [_at(check_frame, i, check, channel, place) for i in check_frame.indices]
    held_out = [strength for strength in held_out if np.isfinite(strength)]
    mean = float(np.mean(held_out)) if held_out else float("nan")
    if held_out and 3.0 * np.exp(-mean) > LEVEL:  # the strongest of three bins
        return None
    return Line(channels[channel], 1.0 / place, found, mean, p_value)


def _by_site(frame: Frame) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for index in frame.indices:
        found.setdefault(frame.experiment.records[index].site, []).append(index)
    return found


def _white(frame: Frame, index: int, residuals: Mapping[int, np.ndarray]) -> np.ndarray:
    return frame.flat_of(index, residuals[index]).reshape(len(frame.experiment.channels), -1)


def _heard(record: Record, wavenumber: np.ndarray) -> np.ndarray:
    """Whether what comes back so often (1/m) lies in the band of a record."""
    speed = float(np.ptp(record.place)) * record.rate / max(len(record.place) - 1, 1)
    return (wavenumber * speed > record.band[0]) & (wavenumber * speed < record.band[1])


def _strength(records: Sequence[Record], white: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Wavenumbers (1/m), and the power over the way that records have in common against that around it, mean over them, (channel, bin)."""
    first, last = max(record.place[0] for record in records), min(record.place[-1] for record in records)
    spacing = min(float(np.median(np.diff(record.place))) for record in records)
    way = np.arange(first, last, spacing)
    power = 0.0
    for record, series in zip(records, white):
        even = np.stack([np.interp(way, record.place, row) for row in series])
        power = power + np.abs(np.fft.rfft(even * np.hanning(way.size), axis=1)) ** 2
    around = median_filter(power, size=(1, AROUND), mode="nearest") / np.log(2.0)
    return np.fft.rfftfreq(way.size, spacing), power / np.where(around > 0, around, np.inf)


def _at(frame: Frame, index: int, residuals: Mapping[int, np.ndarray], channel: int, place: float) -> float:
    """Strength of a line at a wavenumber (1/m) in a record, the largest of three bins; nan where the record does not hear it."""
    record = frame.experiment.records[index]
    if not _heard(record, np.array([place]))[0]:
        return float("nan")
    wavenumber, strength = _strength([record], [_white(frame, index, residuals)])
    k = int(np.argmin(np.abs(wavenumber - place)))
    return float(strength[channel, max(k - 1, 0) : k + 2].max())
