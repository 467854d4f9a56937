"""An error that comes back after the same way, or the same time, again and again: order analysis of what a model leaves.

A wheel, a shaft or a slab of the road makes a line in the spectrum over the way driven, at every speed in the same
place, whatever the angle at which it began to turn in each drive; a fan, an engine that idles or an instrument that hums makes one over
time. Neither what repeats share nor a force with one phase for all drives shows it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_erosion, median_filter, uniform_filter1d
from scipy.optimize import minimize_scalar
from scipy.stats import gamma

from .experiment import Frame, Record
from .propose import LEVEL, SURE
from .selection import Selection

LONGEST = {"m": 7.0, "s": 0.33}
"""Periods of way and of time above which it is none of these, but a bend, a driver or the body on its springs."""

AROUND = 101
"""Bins of the spectrum whose median a line is held against."""


LOBE, BINS = 3, 12
"""Bins to either side of a line that its own power reaches to, and bins over which spectra of drives at two speeds are held together."""

STANDARD_ERRORS = 3.0
"""Standard errors that are added to the share of an error that repeats have in common."""


@dataclass(frozen=True)
class Line:
    """What comes back every ``period`` in a ``channel``, in ``unit`` m of way or s of time; ``p_value``: the probability that
    any line of noise is so strong on the fitted records, and there on those held out if there are any; ``width``: by how much a period may be another and look alike."""

    channel: str
    period: float
    unit: str
    p_value: float
    width: float = 0.0

    def turns(self, radius: float) -> float:
        """How often it comes in a turn of wheels of this ``radius`` in m, if after a way."""
        return 2.0 * np.pi * radius / self.period

    def words(self, radius: float) -> str:
        """The line in words; ``radius`` of the wheels in m."""
        if self.unit == "s":
            how, what = f"s at any speed, {1.0 / self.period:.3g} Hz", "a machine that runs evenly, or the instrument hums"
        else:
            how = f"m of way, {self.turns(radius):.3g} times a turn of the wheels"
            what = "something turns with the wheels, or the road repeats itself"
        return f"an error of {self.channel} comes back every {self.period:.3g} {how} (p = {self.p_value:.1g}): {what}"


def left_by(selection: Selection) -> Line | None:
    """The line in what the last model of a search leaves."""
    return line(selection.frame, selection.states[-1].fit.residuals, selection.check_frame, selection.check)


def line(
    frame: Frame, residuals: Mapping[int, np.ndarray], check_frame: Frame | None, check: Mapping[int, np.ndarray]
) -> Line | None:
    """The strongest line of all channels in the residuals (channel, sample) of a frame, if it is sure and drives held out have it, too.

    Where all of an error came from one road, the power of a bin over that of its neighbourhood would be distributed exponentially,
    though it is a mean over repeats; where none of it did, that mean would come near one. How much did is seen from the neighbourhood.
    """
    channels = frame.experiment.channels
    found, count = [], 0
    for unit, longest in LONGEST.items():
        best = (0.0, 0, 0.0)
        for indices in _by_site(frame).values():
            records = [frame.experiment.records[i] for i in indices]
            often, strength, common = _strength(records, [_white(frame, i, residuals) for i in indices], unit)
            if not often.size:
                continue
            heard = np.all([_heard(record, often, unit) for record in records], axis=0)
            seen = (often > 1.0 / longest) & binary_erosion(heard, iterations=AROUND // 2)  # beyond the band there is nothing to compare with
            if not seen.any():
                continue
            count += strength.shape[0] * int(seen.sum())
            surprise = np.where(seen, -_log_chance(strength, common, len(records)), 0.0)
            channel, k = np.unravel_index(np.argmax(surprise), surprise.shape)
            best = max(best, (float(surprise[channel, k]), int(channel), float(often[k])))
        if best[0] > 0:
            found.append((*best, unit))
    for surprise, channel, often, unit in sorted(found, reverse=True):
        held_out = [] if check_frame is None else [_at(check_frame, i, check, channel, often, unit) for i in check_frame.indices]
        held_out = [own for own in held_out if np.isfinite(own)]
        if held_out:
            again = float(np.mean(held_out)) - np.log(3.0)  # the strongest of three bins
            if np.exp(-again) > LEVEL:
                continue
            both = _together(surprise, again, _coherence(frame, residuals, check_frame, check, channel, often, unit))
            # Whether the one is strong or the other is all the same: of all ways to be so unlikely together.
            surprise = max(surprise, both - np.log1p(both))
        p_value = float(np.clip(count * np.exp(-surprise), np.finfo(float).tiny, 1.0))
        if p_value <= SURE:
            often, width = _nearer(frame, residuals, channel, often, unit)
            return Line(channels[channel], 1.0 / often, unit, p_value, width / often**2)
    return None


def _together(fitted: float, held_out: float, coherence: float) -> float:
    """Negative logarithm of the probability that noise is so strong on fitted and on held-out drives, from those of either alone, where this
    share of the one follows from the other: one road makes peaks in both."""
    less, more = sorted((fitted, held_out))
    if less <= coherence * more:
        return fitted
    return max(fitted, (less + more - 2.0 * np.sqrt(coherence * less * more)) / (1.0 - coherence))


def _coherence(
    frame: Frame, residuals: Mapping[int, np.ndarray], check_frame: Frame, check: Mapping[int, np.ndarray], channel: int, often: float, unit: str
) -> float:
    """Share of the power around what comes back so often that a held-out drive has in common with a fitted one of its site, the largest of
    all pairs; the bins of a few at a time, over which what another speed does to their phases is alike."""
    found = [0.0]
    for i in frame.indices:
        for j in check_frame.indices:
            pair = frame.experiment.records[i], check_frame.experiment.records[j]
            if pair[0].site != pair[1].site:
                continue
            white = [own[[channel]] for own in (_white(frame, i, residuals), _white(check_frame, j, check))]
            every, bins = _spectra(pair, white, unit)
            near = np.abs(np.arange(every.size) - np.searchsorted(every, often))
            kept = [own[0, (near > LOBE) & (near <= AROUND // 2)] for own in bins]
            one, other = (own[: own.size // BINS * BINS].reshape(-1, BINS) for own in kept)
            powers = [np.sum(np.abs(own) ** 2, axis=1) for own in (one, other)]
            shared = np.abs(np.sum(one * other.conj(), axis=1)) / np.maximum(np.sqrt(np.prod(powers, axis=0)), np.finfo(float).tiny)
            found.append(float(np.mean(shared) ** 2) if shared.size else 1.0)
    return max(found)


def _nearer(frame: Frame, residuals: Mapping[int, np.ndarray], channel: int, often: float, unit: str) -> tuple[float, float]:
    """How often it comes back by all samples of the records that hear it, which say it to a part of a bin, and the width of a bin."""
    axes, series = [], []
    for index in frame.indices:
        record = frame.experiment.records[index]
        if _heard(record, np.array([often]), unit)[0]:
            axes.append(_axis(record, unit))
            series.append(_white(frame, index, residuals)[channel] * np.hanning(len(axes[-1])))
    width = 1.0 / max(float(np.ptp(axis)) for axis in axes)
    power = lambda rate: sum(abs(np.exp(-2j * np.pi * rate * axis) @ own) ** 2 for axis, own in zip(axes, series))
    # The maximum that is meant lies in the lobe of the strongest bin, which is two bins wide to either side.
    tried = often + width * np.linspace(-1.0, 1.0, 21)
    best = tried[np.argmax([power(rate) for rate in tried])]
    found = minimize_scalar(lambda rate: -power(rate), bounds=(best - 0.1 * width, best + 0.1 * width), method="bounded", options={"xatol": 1e-3 * width})
    return float(found.x), width


def _by_site(frame: Frame) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for index in frame.indices:
        found.setdefault(frame.experiment.records[index].site, []).append(index)
    return found


def _white(frame: Frame, index: int, residuals: Mapping[int, np.ndarray]) -> np.ndarray:
    return frame.flat_of(index, residuals[index]).reshape(len(frame.experiment.channels), -1)


def _axis(record: Record, unit: str) -> np.ndarray:
    """The way (m) or the time (s) of every sample."""
    return record.place if unit == "m" else np.arange(len(record.place)) / record.rate


def _heard(record: Record, often: np.ndarray, unit: str) -> np.ndarray:
    """Whether what comes back so often (1/m or 1/s, by ``unit``) lies in the band of a record."""
    speed = float(np.ptp(record.place)) * record.rate / max(len(record.place) - 1, 1) if unit == "m" else 1.0
    return (often * speed > record.band[0]) & (often * speed < record.band[1])


def _log_chance(strength: np.ndarray, common: np.ndarray, repeats: int) -> np.ndarray:
    """Logarithm of the probability that noise is so strong in the mean over ``repeats``, of whose power the share ``common`` is the same in all.

    As if of one road; or, if that is less, as a sum of independent exponentials none of which is larger than the largest eigenvalue of
    the coherence of repeats: a gamma distribution.
    """
    over = repeats * strength / (1.0 + (repeats - 1) * common)
    return np.minimum(-strength, np.maximum(gamma.logsf(over, repeats), -over))  # it is no less than that, where the logarithm of nil fails


def _common(bins: Sequence[np.ndarray], power: np.ndarray) -> np.ndarray:
    """Share of the power of a neighbourhood that is the same in all records, (channel, bin), no less than it may surely be; ``bins``: spectra
    (channel, bin) by record, ``power``: the mean of their power."""
    pairs = [(one * other.conj()).real for number, one in enumerate(bins) for other in bins[:number]]
    if not pairs:
        return np.ones_like(power)
    around = lambda values: uniform_filter1d(values, AROUND, axis=1, mode="nearest")
    shared = around(np.mean(pairs, axis=0)) / np.maximum(around(power), np.finfo(float).tiny)
    return np.clip(shared + STANDARD_ERRORS / np.sqrt(2.0 * AROUND * len(pairs)), 0.0, 1.0)


def _strength(records: Sequence[Record], white: Sequence[np.ndarray], unit: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How often (1/m or 1/s, by ``unit``); the power that comes back so often against that around it, mean over records, and the share of
    the power around it that records have in common, both (channel, bin); over the way, or the time from the start, that these have in
    common. No bins where that is too short."""
    often, bins = _spectra(records, white, unit)
    if not often.size:
        return often, np.empty((len(white[0]), 0)), np.empty((len(white[0]), 0))
    power, count = np.mean([np.abs(own) ** 2 for own in bins], axis=0), len(bins)
    common = _common(bins, power)
    free = count / (1.0 + (count - 1) * common**2)  # exponentials whose mean varies as much
    around = median_filter(power, size=(1, AROUND), mode="nearest") * free / gamma.median(free)
    return often, power / np.where(around > 0, around, np.inf), common


def _spectra(records: Sequence[Record], white: Sequence[np.ndarray], unit: str) -> tuple[np.ndarray, list[np.ndarray]]:
    """How often (1/m or 1/s, by ``unit``), and the spectra (channel, bin) of these records over the way, or the time from the start, that they
    have in common; no bins where that is too short."""
    axes = [_axis(record, unit) for record in records]
    first, last = max(axis[0] for axis in axes), min(axis[-1] for axis in axes)
    spacing = min(float(np.median(np.diff(axis))) for axis in axes)
    even = np.arange(first, last, spacing)
    if even.size < 2 * AROUND:
        return np.empty(0), [np.empty((len(series), 0)) for series in white]
    window = np.hanning(even.size)
    bins = [np.fft.rfft(np.stack([np.interp(even, axis, row) for row in series]) * window, axis=1) for axis, series in zip(axes, white)]
    return np.fft.rfftfreq(even.size, spacing), bins


def _at(frame: Frame, index: int, residuals: Mapping[int, np.ndarray], channel: int, often: float, unit: str) -> float:
    """Strength in a record of a line that comes back so often, the largest of three bins; nan where the record does not hear it."""
    record = frame.experiment.records[index]
    if not _heard(record, np.array([often]), unit)[0]:
        return float("nan")
    every, strength, _ = _strength([record], [_white(frame, index, residuals)], unit)
    if not every.size:
        return float("nan")
    k = int(np.argmin(np.abs(every - often)))
    return float(strength[channel, max(k - 1, 0) : k + 2].max())
