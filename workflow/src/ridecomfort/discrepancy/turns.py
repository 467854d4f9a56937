"""An error that comes back after the same way, or the same time, again and again: order analysis of what a model leaves.

A wheel, a shaft or a slab of the road makes a line in the spectrum over the way driven, at every speed in the same
place, whatever the angle at which it began to turn in each drive; a fan, an engine that idles or an instrument that hums makes one over
time. Neither what repeats share nor a force with one phase for all drives shows it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_erosion, median_filter

from .experiment import Frame, Record
from .propose import LEVEL, SURE

LONGEST = {"m": 7.0, "s": 0.33}
"""Periods of way and of time above which it is none of these, but a bend, a driver or the body on its springs."""

AROUND = 101
"""Bins of the spectrum whose median a line is held against."""


@dataclass(frozen=True)
class Line:
    """What comes back every ``period`` in a ``channel``, in ``unit`` m of way or s of time; ``p_value``: the probability that
    any line of noise is so strong on the fitted records."""

    channel: str
    period: float
    unit: str
    p_value: float

    def words(self, radius: float) -> str:
        """The line in words; ``radius`` of the wheels in m."""
        if self.unit == "s":
            how, what = f"s at any speed, {1.0 / self.period:.3g} Hz", "a machine that runs evenly, or the instrument hums"
        else:
            how = f"m of way, {2.0 * np.pi * radius / self.period:.2f} times a turn of the wheels"
            what = "something turns with the wheels, or the road repeats itself"
        return f"an error of {self.channel} comes back every {self.period:.3g} {how} (p = {self.p_value:.1g}): {what}"


def line(
    frame: Frame, residuals: Mapping[int, np.ndarray], check_frame: Frame | None, check: Mapping[int, np.ndarray]
) -> Line | None:
    """The strongest line of all channels in the residuals (channel, sample) of a frame, if it is sure and drives held out have it, too.

    Where all of an error came from one road, the power of a bin over that of its neighbourhood would be distributed exponentially,
    though it is a mean over repeats; so it is taken to be.
    """
    channels = frame.experiment.channels
    found, count = [], 0
    for unit, longest in LONGEST.items():
        best = (0.0, 0, 0.0)
        for indices in _by_site(frame).values():
            records = [frame.experiment.records[i] for i in indices]
            often, strength = _strength(records, [_white(frame, i, residuals) for i in indices], unit)
            if not often.size:
                continue
            heard = np.all([_heard(record, often, unit) for record in records], axis=0)
            seen = (often > 1.0 / longest) & binary_erosion(heard, iterations=AROUND // 2)  # beyond the band there is nothing to compare with
            if not seen.any():
                continue
            count += strength.shape[0] * int(seen.sum())
            strength = np.where(seen, strength, 0.0)
            channel, k = np.unravel_index(np.argmax(strength), strength.shape)
            best = max(best, (float(strength[channel, k]), int(channel), float(often[k])))
        if best[0] > 0:
            found.append((*best, unit))
    for strength, channel, often, unit in sorted(found, reverse=True):
        p_value = min(1.0, count * float(np.exp(-strength)))
        if p_value > SURE:
            return None
        held_out = [] if check_frame is None else [_at(check_frame, i, check, channel, often, unit) for i in check_frame.indices]
        held_out = [own for own in held_out if np.isfinite(own)]
        mean = float(np.mean(held_out)) if held_out else float("nan")
        if not held_out or 3.0 * np.exp(-mean) <= LEVEL:  # the strongest of three bins
            return Line(channels[channel], 1.0 / often, unit, p_value)
    return None


def _by_site(frame: Frame) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for index in frame.indices:
        found.setdefault(frame.experiment.records[index].site, []).append(index)
    return found


def _white(frame: Frame, index: int, residuals: Mapping[int, np.ndarray]) -> np.ndarray:
    return frame.flat_of(index, residuals[index]).reshape(len(frame.experiment.channels), -1)


def _heard(record: Record, often: np.ndarray, unit: str) -> np.ndarray:
    """Whether what comes back so often (1/m or 1/s, by ``unit``) lies in the band of a record."""
    speed = float(np.ptp(record.place)) * record.rate / max(len(record.place) - 1, 1) if unit == "m" else 1.0
    return (often * speed > record.band[0]) & (often * speed < record.band[1])


def _strength(records: Sequence[Record], white: Sequence[np.ndarray], unit: str) -> tuple[np.ndarray, np.ndarray]:
    """How often (1/m or 1/s, by ``unit``), and the power that comes back so often against that around it, mean over records,
    (channel, bin); over the way, or the time from the start, that these have in common. No bins where that is too short."""
    axes = [record.place if unit == "m" else np.arange(len(record.place)) / record.rate for record in records]
    first, last = max(axis[0] for axis in axes), min(axis[-1] for axis in axes)
    spacing = min(float(np.median(np.diff(axis))) for axis in axes)
    even = np.arange(first, last, spacing)
    if even.size < 2 * AROUND:
        return np.empty(0), np.empty((len(white[0]), 0))
    power = 0.0
    for axis, series in zip(axes, white):
        there = np.stack([np.interp(even, axis, row) for row in series])
        power = power + np.abs(np.fft.rfft(there * np.hanning(even.size), axis=1)) ** 2
    around = median_filter(power, size=(1, AROUND), mode="nearest") / np.log(2.0)
    return np.fft.rfftfreq(even.size, spacing), power / np.where(around > 0, around, np.inf)


def _at(frame: Frame, index: int, residuals: Mapping[int, np.ndarray], channel: int, often: float, unit: str) -> float:
    """Strength in a record of a line that comes back so often, the largest of three bins; nan where the record does not hear it."""
    record = frame.experiment.records[index]
    if not _heard(record, np.array([often]), unit)[0]:
        return float("nan")
    every, strength = _strength([record], [_white(frame, index, residuals)], unit)
    if not every.size:
        return float("nan")
    k = int(np.argmin(np.abs(every - often)))
    return float(strength[channel, max(k - 1, 0) : k + 2].max())
