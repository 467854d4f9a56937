"""Whether the horizontal axes of an instrument are exchanged, or point the other way: it is then turned in yaw by quarters, which gravity does
not show and the small steps of alignment (``mounting.fit``) find late, or not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..vocabulary import SIGNALS, VARIABLES
from . import record
from .place import STANDS_STILL
from .replay import Replay, Simulated

PAIRS = (("a_x", "a_y"), ("roll_rate", "pitch_rate"))
"""Signals along the vehicle and across it, to the left, that an instrument which is turned in yaw tells of one another."""

LEAST, TIMES = 0.3, 2.0
"""Correlation (mean over the PAIRS) from which on a turn is likely, that of a drive at a wrong place staying below (``align.LOWEST``), and
times that of the axes as they are: that of an instrument turned by 63 deg, which takes all rounds of alignment or more."""


ANOTHER, OWN = 0.8, 0.3
"""Correlation with the model's motion in another direction from which on, and with that in its own up to which, a signal is taken for the other."""


def correlation(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Correlation (signal,) about nil of two series (signal, sample), nil where one of them is."""
    power = np.sqrt(np.sum(one**2, axis=-1) * np.sum(other**2, axis=-1))
    return np.sum(one * other, axis=-1) / np.where(power > 0, power, 1.0)


def taken_for(measured: np.ndarray, simulated: np.ndarray, signals: Sequence[str]) -> list[str]:
    """For each of these signals (signal, sample) another of the same unit which the model moves as it does, where its own moves otherwise;
    empty where there is none. Of all but their means: where they are slow, in bends and as the car is braked, they differ most."""
    one, other = (each - each.mean(axis=-1, keepdims=True) for each in (measured, simulated))
    found = []
    for name, row in zip(signals, one):
        alike = dict(zip(signals, np.abs(correlation(row, other)).tolist()))
        likely = [each for each in signals if VARIABLES[each].unit == VARIABLES[name].unit and alike[each] > ANOTHER and alike[name] < OWN]
        found.append(max(likely, key=alike.get, default=""))
    return found


def exchanged(name: str, other: str) -> str:
    """Words on a signal that is taken for another."""
    return f"{name} does what the model does in {other}: are columns exchanged, or is the sensor turned?"


def agreement(again: Replay, simulated: Simulated) -> np.ndarray:
    """Correlation of record and model, mean over the PAIRS, (4,): as recorded, and of an instrument that is turned to the left by one, two, and
    three quarters. What either does not move in counts nothing; accelerations hold gravity where those of the record do."""
    own, quarter = _correlations(again, simulated)
    right, left = own.mean(), quarter.mean()
    return np.array([right, left, -right, -left])


def put_right(again: Replay, simulated: Simulated) -> tuple[float, float]:
    """The same mean with every sign put right, and of an instrument that is turned by the best angle of all."""
    own, quarter = _correlations(again, simulated)
    return float(np.abs(own).mean()), float(np.hypot(own.mean(), quarter.mean()))


def _correlations(again: Replay, simulated: Simulated) -> tuple[np.ndarray, np.ndarray]:
    """Correlations of record and model, (pair, 2): of each of the PAIRS with itself, and as it is told after a quarter to the left."""
    measured, model = _both(again, simulated)
    moves, kept = model.std(axis=1) > STANDS_STILL * measured.std(axis=1), again.compared

    def alike(name: str, of: str) -> float:
        one, other = (values[SIGNALS.index(own), kept] for values, own in ((measured, name), (model, of)))
        return float(correlation(one - one.mean(), other - other.mean())) if moves[SIGNALS.index(of)] else 0.0

    own = [[alike(along, along), alike(across, across)] for along, across in PAIRS]
    quarter = [[-alike(across, along), alike(along, across)] for along, across in PAIRS]
    return np.array(own), np.array(quarter)


def _both(again: Replay, simulated: Simulated) -> tuple[np.ndarray, np.ndarray]:
    """Signals of record and model, (6, sample) each; accelerations hold gravity where those of the record do."""
    measured, model = again.measured(), simulated.signals.copy()
    if again.drive.attrs["gravity"]:
        measured[:3], model[:3] = record.felt(again.drive), record.specific_force(model[:3], simulated.roll, simulated.pitch)
    return measured, model


def words(again: Replay, simulated: Simulated) -> str:
    """Words on axes that agree far better with the model after a turn by quarters, with what to change; empty where they do not."""
    found = agreement(again, simulated)
    quarters = int(np.argmax(found))
    if quarters == 0 or found[quarters] < max(LEAST, TIMES * found[0]):
        return ""
    signs = {1: ("-", ""), 2: ("-", "-"), 3: ("", "-")}[quarters]
    told = [
        f"{name} = {sign}{own}"
        for along, across in PAIRS
        for name, sign, own in zip((along, across), signs, (along, across) if quarters == 2 else (across, along))
    ]
    angle = 90 * quarters if quarters < 3 else -90
    return (
        f"the instrument looks turned by {angle:+d} deg in yaw: {', '.join(name for pair in PAIRS for name in pair)} correlate with the model by "
        f"{found[quarters]:.2f} then, by {found[0]:.2f} as recorded "
        f"(if so, exchange `columns`, and `factor` where there is a minus: {', '.join(told)})"
    )


def columns(again: Replay, simulated: Simulated) -> str:
    """Words on signals that are taken for others; empty where none is."""
    measured, model = (values[:, again.compared] for values in _both(again, simulated))
    return "; ".join(exchanged(name, other) for name, other in zip(SIGNALS, taken_for(measured, model, SIGNALS)) if other)
