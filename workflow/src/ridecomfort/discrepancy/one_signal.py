"""Signs that one signal of a record, or all rates, are wrong by themselves, in scale or time: repeats differ in them, or the model does, until these
come in time.

Repeats meet the same road in the same car, so that what the model lacks is alike in all of them. An instrument, or the channel that it is
recorded by, may be another in one of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..drive.turning import GAIN, STANDARD_ERRORS
from ..vocabulary import SIGNALS
from .balance import SHARED_Z
from .car import Car
from .experiment import Frame
from .floor import repeats
from .judged import judged
from .shared import shared_power

RATES = SIGNALS[3:]
"""The signals of a gyroscope."""

LATE = 0.004
"""s by which one signal must come later than the others."""

INDEPENDENT = 10.0
"""Independent values of a signal in a second."""

FARTHEST = 0.05
"""s up to which a signal is looked for in time."""

ALL_BUT_NIL = 0.8
"""Share of what repeats have in common of their errors that must be gone with one signal in time."""

ROUNDS = 6
"""How often a time is sought anew from where one was found."""


def of_repeats(experiment: Car, frame: Frame, residuals: Mapping[int, np.ndarray]) -> list[str]:
    """Signals, in words, whose gain or time beside the model is in one of the records of a ``frame`` another than in its repeats, by their ``residuals``
    (channel, sample), where all of these drove: elsewhere the model may lack something else."""
    said = []
    for group in repeats(experiment, frame.indices).values():
        places = [experiment.records[index].place for index in group]
        start, end = max(place[0] for place in places), min(place[-1] for place in places)
        if end <= start:
            continue
        found = [_gains_and_delays(experiment, index, residuals[index], (place >= start) & (place <= end)) for index, place in zip(group, places)]
        gains, delays, gain_errors, delay_errors = (np.stack(part) for part in zip(*found))
        delays = delays - np.median(delays, axis=1, keepdims=True)  # of the whole record it is one of the clock
        for values, errors, least, words in ((gains, gain_errors, GAIN, _scaled), (delays, delay_errors, LATE, _delayed)):
            apart = values - (np.median(values, axis=0) if len(group) > 2 else values[::-1])
            is_apart = np.abs(apart) - STANDARD_ERRORS * np.hypot(errors, np.median(errors, axis=0)) > least
            said += [words(experiment, group, row, channel, apart[row, channel]) for channel, row in zip(*np.nonzero(is_apart.T))]
    return said


def _scaled(experiment: Car, group: Sequence[int], row: int, channel: int, apart: float) -> str:
    return f"{_beside(experiment, group, row, channel)} is {100 * abs(apart):.1f} % too {'large' if apart > 0 else 'small'}, if these are right: its scale, or its unit?"


def _delayed(experiment: Car, group: Sequence[int], row: int, channel: int, apart: float) -> str:
    return f"{_beside(experiment, group, row, channel)} comes {1e3 * abs(apart):.0f} ms too {'late' if apart > 0 else 'early'}, if these are right: its filter, or its channel?"


def _beside(experiment: Car, group: Sequence[int], row: int, channel: int) -> str:
    names = [experiment.records[index].name for index in group]
    others = ", ".join(name for number, name in enumerate(names) if number != row)
    return f"{names[row]}: {experiment.channels[channel]}, beside what the model does there and in {others},"


def _gains_and_delays(experiment: Car, index: int, residual: np.ndarray, inside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """By how much each signal of a record is too large (1) and too late (s) beside the model, in the band that is judged and in the samples ``inside``,
    and the standard errors of these, (channel,) each."""
    record = experiment.records[index]
    measured, simulated = (judged(series, record.rate, experiment.channels) for series in (experiment.measured(index), experiment.measured(index) + residual))
    power, late = (lambda series: np.maximum(np.sum(series**2, axis=1), np.finfo(float).tiny)), np.zeros(len(simulated))
    for _ in range(ROUNDS):
        in_time = np.stack([delayed(row, record.rate * own) for row, own in zip(simulated, late)])
        slope, left = (series[:, inside] for series in (np.gradient(in_time, 1.0 / record.rate, axis=1), in_time - measured))
        late = np.clip(late + np.sum(left * slope, axis=1) / power(slope), -FARTHEST, FARTHEST)
    error, in_time = np.sum(left**2, axis=1) / (INDEPENDENT * inside.sum() / record.rate), in_time[:, inside]
    gain = -np.sum(left * in_time, axis=1) / power(in_time)
    return gain, late, np.sqrt(error / power(in_time)), np.sqrt(error / power(slope))


def of_all(experiment: Car, frame: Frame, residuals: Mapping[int, np.ndarray], free: Sequence[Mapping[int, np.ndarray]]) -> list[str]:
    """The signal (or the rates), in words, with which in time, or at another scale, nearly all is gone that the records of a ``frame`` have in common of
    their ``residuals`` (channel, sample), of a calibrated model; ``free``: columns of what is calibrated, which is fitted anew."""
    before, z = shared_power(frame, _fitted(frame, {index: residuals[index] for index in frame.indices}, free)[1])
    if not z > SHARED_Z:
        return []
    simulated = {index: experiment.measured(index) + residuals[index] for index in frame.indices}
    is_all = lambda left: 1.0 - shared_power(frame, left)[0] / before > ALL_BUT_NIL
    goes = "the other signals of the fitted drives, and nearly all of their error goes with that"
    for channel, name in enumerate(experiment.channels):
        late, left = _in_time(experiment, frame, simulated, [channel], free)
        if abs(late) > LATE and is_all(left):
            return [f"{name} comes {1e3 * abs(late):.0f} ms too {'late' if late > 0 else 'early'} beside {goes}: its filter, or its channel?"]
        gain, left = _to_scale(experiment, frame, simulated, channel, free)
        if abs(gain) > GAIN and is_all(left):
            return [f"{name} is {100 * abs(gain):.1f} % too {'large' if gain > 0 else 'small'} beside {goes}: its scale, or its unit?"]
    rates = [channel for channel, name in enumerate(experiment.channels) if name in RATES]
    late, left = _in_time(experiment, frame, simulated, rates, free) if rates else (0.0, {})
    if abs(late) > LATE and is_all(left):
        return [f"the rates come {1e3 * abs(late):.0f} ms too {'late' if late > 0 else 'early'} beside {goes}: the filter of the gyroscope, or its channel?"]
    return []


def _to_scale(
    experiment: Car, frame: Frame, simulated: Mapping[int, np.ndarray], channel: int, free: Sequence[Mapping[int, np.ndarray]]
) -> tuple[float, dict[int, np.ndarray]]:
    """Share by which one signal was recorded too large, and the residuals with that and what is ``free`` fitted."""
    start = {index: simulated[index] - experiment.measured(index) for index in frame.indices}
    alone = {index: np.where(np.arange(len(part))[:, None] == channel, part, 0.0) for index, part in simulated.items()}
    amounts, left = _fitted(frame, start, [alone, *free])
    return float(amounts[0]), left


def _fitted(
    frame: Frame, residuals: Mapping[int, np.ndarray], columns: Sequence[Mapping[int, np.ndarray]]
) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Amounts of columns that explain residuals best, (column,), and what these then are."""
    amounts = -np.linalg.lstsq(frame.flats(columns).T, frame.flat(residuals), rcond=None)[0] if columns else np.empty(0)
    return amounts, {index: part + sum(amount * column[index] for amount, column in zip(amounts, columns)) for index, part in residuals.items()}


def _in_time(
    experiment: Car, frame: Frame, simulated: Mapping[int, np.ndarray], channels: Sequence[int], free: Sequence[Mapping[int, np.ndarray]]
) -> tuple[float, dict[int, np.ndarray]]:
    """Seconds that some signals were recorded later than the others, and the residuals with that and what is ``free`` fitted."""
    measured = {index: experiment.measured(index) for index in frame.indices}
    rate = {index: experiment.records[index].rate for index in frame.indices}
    late, now = 0.0, dict(simulated)
    for _ in range(ROUNDS):
        further = float(np.median([_lag(now[index][k], measured[index][k], rate[index]) for index in frame.indices for k in channels]))
        late = float(np.clip(late + further, -FARTHEST, FARTHEST))
        if abs(late) <= LATE:
            break
        put = lambda parts: {index: _later(parts[index], channels, late * rate[index]) for index in frame.indices}
        columns, start = [put(column) for column in free], put(simulated)
        _, left = _fitted(frame, {index: start[index] - measured[index] for index in frame.indices}, columns)
        now = {index: left[index] + measured[index] for index in frame.indices}
        if abs(further) < 0.05 * LATE:
            break
    return late, {index: now[index] - measured[index] for index in frame.indices}


def _later(series: np.ndarray, channels: Sequence[int], samples: float) -> np.ndarray:
    """Signals (channel, sample), some of them later by so many samples."""
    return np.stack([delayed(row, samples) if channel in channels else row for channel, row in enumerate(series)])


def delayed(row: np.ndarray, samples: float) -> np.ndarray:
    """A signal (sample,) later by so many samples, by its spectrum; what joins its ends, which is no motion, taken out before."""
    line = np.linspace(row[0], row[-1], row.size)
    phase = np.exp(-2j * np.pi * np.fft.rfftfreq(row.size) * samples)
    return np.fft.irfft(np.fft.rfft(row - line) * phase, row.size) + line


def _lag(one: np.ndarray, other: np.ndarray, rate: float) -> float:
    """Seconds by which another signal comes later than one, from where they are most alike within FARTHEST, a parabola between the samples."""
    reach = int(np.ceil(FARTHEST * rate)) + 1
    one, other = (np.diff(row) for row in (one, other))  # white rather than slow
    products = np.array([one[max(-k, 0) : one.size - max(k, 0)] @ other[max(k, 0) : other.size - max(-k, 0)] for k in range(-reach, reach + 1)])
    best = int(np.clip(products[1:-1].argmax() + 1, 1, 2 * reach - 1))
    before, there, behind = products[best - 1 : best + 2]
    curve = before - 2.0 * there + behind
    return (best - reach + (0.5 * (before - behind) / curve if curve < 0 else 0.0)) / rate
