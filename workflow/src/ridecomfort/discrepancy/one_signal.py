"""Signs that one signal of a record, or all rates, are wrong by themselves, in scale or time: repeats differ in them, or the model does, until these
come in time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..drive.turning import GAIN
from ..vocabulary import SIGNALS
from . import unlike
from .balance import SHARED_Z
from .car import Car
from .experiment import Frame
from .floor import repeats
from .shared import shared_power
from .unlike import FARTHEST, LATE, ROUNDS, delayed, too_large, too_late

RATES = SIGNALS[3:]
"""The signals of a gyroscope."""

ALL_BUT_NIL = 0.8
"""Share of what repeats have in common of their errors that must be gone with one signal in time."""


def of_repeats(experiment: Car, frame: Frame, residuals: Mapping[int, np.ndarray]) -> list[str]:
    """Signals, in words, that one of the records of a ``frame`` has otherwise than its repeats (``unlike.of_repeats``), by their ``residuals`` (channel, sample)."""
    def signals(index: int) -> unlike.Signals:
        record, measured = experiment.records[index], experiment.measured(index)
        return unlike.Signals(record.name, record.place, measured, measured + residuals[index], record.rate)

    groups = repeats(experiment, frame.indices).values()
    return [said for group in groups for said in unlike.of_repeats([signals(index) for index in group], experiment.channels)]


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
            return [f"{name} comes {too_late(late)} beside {goes}: its filter, or its channel?"]
        gain, left = _to_scale(experiment, frame, simulated, channel, free)
        if abs(gain) > GAIN and is_all(left):
            return [f"{name} is {too_large(gain)} beside {goes}: its scale, or its unit?"]
    rates = [channel for channel, name in enumerate(experiment.channels) if name in RATES]
    late, left = _in_time(experiment, frame, simulated, rates, free) if rates else (0.0, {})
    if abs(late) > LATE and is_all(left):
        return [f"the rates come {too_late(late)} beside {goes}: the filter of the gyroscope, or its channel?"]
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


def _lag(one: np.ndarray, other: np.ndarray, rate: float) -> float:
    """Seconds by which another signal comes later than one, from where they are most alike within FARTHEST, a parabola between the samples."""
    reach = int(np.ceil(FARTHEST * rate)) + 1
    one, other = (np.diff(row) for row in (one, other))  # white rather than slow
    products = np.array([one[max(-k, 0) : one.size - max(k, 0)] @ other[max(k, 0) : other.size - max(-k, 0)] for k in range(-reach, reach + 1)])
    best = int(np.clip(products[1:-1].argmax() + 1, 1, 2 * reach - 1))
    before, there, behind = products[best - 1 : best + 2]
    curve = before - 2.0 * there + behind
    return (best - reach + (0.5 * (before - behind) / curve if curve < 0 else 0.0)) / rate
