"""Signs that the measurement, and not the model, is wrong: noise in the scanned road, clock, gain, sign, instruments that fail."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..drive import turning
from ..drive.axes import correlation, taken_for
from ..drive.turning import GAIN, STANDARD_ERRORS
from . import floor, nuisances
from .car import Car
from .experiment import Frame
from .judged import against, doubt, judged, ratio
from .unlike import along

ROAD_BAND = (0.1, 0.8)
"""Cycles per metre in which the spectrum of a road follows a power law (ISO 8608 holds to 2.83)."""

NOISE_BAND = 2.0
"""Cycles per metre above which a scanner's white noise stands out of a road's falling spectrum."""

EXCESS = 4.0
"""Times that the spectrum must lie above its power law there to be called noise."""

CAUSED = 0.3
"""Share of the explainable error that noise of the road must be able to cause to be suspected."""

CLOCK = 0.002
"""s of standard error of a clock offset beyond which tyre damping cannot be told from delay."""

OTHERWISE = 0.5
"""Share of the way to the other interpolation of the road from which on a record speaks for that."""

SMOOTHER = 1.35
"""Place on the way from cubic interpolation (0) to linear (1) from which on records speak for neither: up to 1.15 where the true
road is linear, 1.5 to 2.2 with noise of 0.1 mm in its file, 1.3 to 2.3 with tyres that envelop 0.2 m."""

APART = 0.5
"""Share of a gain's difference from one by which, and by STANDARD_ERRORS beyond it, a signal of an instrument, gravity or the bends of the road
must disagree for that to have no gain: a vehicle that rolls less makes the rate of roll smaller and no other."""

WANDERING = 0.006
"""s, the median over records, by which a clock wanders against place beyond which it is wrong where alignment has taken out more than LATE
before: 8.6 ms where the clocks of three records jump by 20 ms. Most of what a model lacks makes it wander by up to 3.7 ms, a payload by 7,
and alignment sees none of that."""

LATE = 0.004
"""s between the clock that a record came with and the one at which the model fits it, beyond which the first was wrong. What a model
lacks delays it by up to 3 ms."""


def road_noise(road: xr.Dataset) -> float:
    """Standard deviation in m of white noise in the heights along the road; 0 where none stands out.

    The mean spectrum of all tracks is compared with the continuation of its power law (ISO 8608:2016, annex C).
    """
    heights = road["elevation"].transpose("v", "u").values
    heights = heights[np.isfinite(heights).all(axis=1)]
    spacing = float(road["u"][1] - road["u"][0])
    length = min(1024, heights.shape[1])
    if not len(heights) or length < 128 or 0.5 / spacing <= NOISE_BAND:
        return 0.0
    window = np.hanning(length)
    pieces = [heights[:, k : k + length] for k in range(0, heights.shape[1] - length + 1, length // 2)]
    slope = np.linspace(-0.5, 0.5, length)
    level = [p - p.mean(axis=1, keepdims=True) - np.outer(p @ slope / (slope @ slope), slope) for p in pieces]
    density = np.mean([np.abs(np.fft.rfft(p * window, axis=1)) ** 2 for p in level], axis=(0, 1))
    density *= 2 * spacing / np.sum(window**2)
    wavenumber = np.fft.rfftfreq(length, spacing)
    law = (wavenumber > ROAD_BAND[0]) & (wavenumber < ROAD_BAND[1])
    high = (wavenumber > NOISE_BAND) & (wavenumber < 0.45 / spacing)
    if not (high.any() and (density[law] > 0.0).all()):  # points too far apart to tell, or a road without a law
        return 0.0
    fitted = np.polyfit(np.log(wavenumber[law]), np.log(density[law]), 1)
    expected = np.exp(np.polyval(fitted, np.log(wavenumber[high])))
    if np.median(density[high] / expected) < EXCESS:
        return 0.0
    return float(np.sqrt(max(np.median(density[high] - expected), 0.0) * 0.5 / spacing))


def noise_share(experiment: Car, index: int, values, deviation: float, explainable: np.ndarray, seed: int = 0) -> float:
    """Mean square error that white noise of this ``deviation`` (m) in the road makes in a record, over the explainable one (channel,): the
    median over the channels that have any; nil where none has."""
    again = experiment.replays[index]
    noise = deviation * np.random.default_rng(seed).standard_normal(again.road.elevation.shape)
    noisy = replace(again, road=replace(again.road, elevation=again.road.elevation + noise))
    on_it = replace(experiment, replays=[noisy if number == index else own for number, own in enumerate(experiment.replays)])
    change = on_it.residual(values, index) - experiment.residual(values, index)
    power = floor.squares(experiment, {index: change})[0]
    kept = explainable > 0
    return float(np.median(power[kept] / explainable[kept])) if kept.any() else 0.0


def of_drives(experiment: Car) -> list[str]:
    """Reasons in words to doubt a record, from what its samples show, what its alignment found and how far it turned."""
    reasons = []
    gains = {record.name: again.drive.attrs.get("acceleration_gain", 1.0) for record, again in zip(experiment.records, experiment.replays)}
    for record, again in zip(experiment.records, experiment.replays):
        found = again.drive.attrs
        reasons += [f"{record.name}: {fault}" for fault in found.get("faults", "").split("; ") if fault]
        error, gain = found.get("clock_offset_error", 0.0), gains[record.name]
        if np.isfinite(error) and error > CLOCK:
            reasons.append(f"{record.name}: the clock offset is known to {1e3 * error:.1f} ms only")
        if np.isfinite(gain) and abs(gain - 1.0) > GAIN:
            others = ", ".join(f"{name} {other:.3f}" for name, other in gains.items() if name != record.name and np.isfinite(other))
            beside = f" (on the others: {others})" if others else ""
            reasons.append(f"{record.name}: the accelerometer's gain is {gain:.3f} against gravity{beside}")
        if said := turning.words(again.drive, again.road.road):
            reasons.append(f"{record.name}: {said}")
    return reasons


def of_fit(experiment: Car, frame: Frame, residuals) -> list[str]:
    """Reasons in words to doubt a record of which the model explains all but the noise: clock and gains at which it does so.

    ``frame``: that of the ``residuals``, whose experiment may be aligned otherwise than ``experiment``.
    """
    reasons = []
    for index in frame.indices:
        name = experiment.records[index].name
        late = float(np.median(frame.experiment.shifts(experiment, index)))
        if abs(late) > LATE:
            reasons.append(f"{name}: the model fits at a clock that is {1e3 * late:+.1f} ms off the recorded one")
        gains = nuisances.gains(frame.amounts(index, residuals[index]))
        own, errors = _own_gains(experiment, index, residuals[index])
        drive, road = experiment.replays[index].drive, experiment.replays[index].road.road
        elsewhere = (drive.attrs.get("acceleration_gain", np.nan), 0.0), turning.gyroscope_gain(drive, road)
        for gain, instrument, part, seen in zip(gains, ("accelerometer", "gyroscope"), (slice(3), slice(3, 6)), elsewhere):
            if abs(gain - 1.0) > GAIN and _are_of_one(gain, [*own[part], seen[0]], [*errors[part], seen[1]]):
                reasons.append(f"{name}: the model fits a gain of {gain:.3f} of the {instrument}")
    return reasons


def _own_gains(experiment: Car, index: int, residual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gain of each signal of a record beside the model, in the band that is judged, and its standard error, (6,) each."""
    record = experiment.records[index]
    left = judged(residual, record.rate, experiment.channels)
    simulated = judged(experiment.measured(index) + residual, record.rate, experiment.channels)
    less, error = along(left, simulated, residual.shape[1] / record.rate)
    return 1.0 - less, error


def _are_of_one(gain: float, own: Sequence[float], errors: Sequence[float]) -> bool:
    """Whether the gains of an instrument, by its signals and by what it was held against before (nan where it was not), may all be this one."""
    apart = np.abs(np.array(own) - gain) - STANDARD_ERRORS * np.array(errors)
    return not np.any(apart > APART * abs(gain - 1.0))


def of_clocks(experiment: Car, frame: Frame) -> list[str]:
    """Reasons in words to doubt clocks, where the model fits the records of a ``frame`` at one that wanders against place, as behind a jump."""
    wander = [np.ptp(np.percentile(frame.experiment.shifts(experiment, index), [1, 99])) for index in frame.indices]
    replays = [experiment.replays[index] for index in frame.indices]
    aligned = [again.drive.attrs.get("distance_wander", 0.0) / again.drive["v_x"].values.mean() for again in replays]
    if not (np.median(wander) > WANDERING and np.median(aligned) > LATE):
        return []
    return [f"the model fits at clocks that wander by {1e3 * np.median(wander):.0f} ms against place: does a clock jump or run unevenly?"]


def smoothness(experiment: Car, frame: Frame, residuals) -> float:
    """Where the records place the road between its points: 0 as cubic interpolation, 1 as linear, beyond it smoother still."""
    between = [nuisances.between(frame.amounts(index, residuals[index])) for index in frame.indices]
    return float(np.median([share if is_smooth else 1.0 - share for share, is_smooth in zip(between, _smooth(experiment, frame))]))


def _smooth(experiment: Car, frame: Frame) -> list[bool]:
    """Whether the road of each record of a frame was driven with cubic interpolation, not linear."""
    return [bool(experiment.replays[index].road.surface.smooth) for index in frame.indices]


def of_road(experiment: Car, frame: Frame, place: float) -> list[str]:
    """Words on the road between the points of its file, where the records of a frame place it (``smoothness``) otherwise than it was driven."""
    if place > SMOOTHER:
        return ["the drives fit a road that is smoother than the points of its file: either these hold noise, or the tyres roll over "
                "what lies between them (tyre_enveloping)"]
    smooth = place >= OTHERWISE  # roads that were driven so are the ones that the records place otherwise
    if smooth not in _smooth(experiment, frame):
        return []
    other, why = ("linear", "; noise of its points would look alike") if smooth else ("cubic", "")
    return [f"the drives fit the road better with {other} interpolation between its points (road: options: interpolation: {other}){why}"]


def of_signals(experiment: Car, residuals) -> list[str]:
    """Reasons in words to doubt the column, the sign or the unit of a signal, by what the model does."""
    reasons = []
    for index, residual in residuals.items():
        record, measured = experiment.records[index], experiment.measured(index)
        others = taken_for(measured, measured + residual, experiment.channels)
        turned = against(measured, measured + residual, record.rate, experiment.channels)
        pair = judged(np.stack([measured, measured + residual]), record.rate, experiment.channels)
        for name, *found in zip(experiment.channels, others, turned, correlation(*pair), ratio(*pair)):
            if said := doubt(name, *found):
                reasons.append(f"{record.name}: {said}")
    return reasons
