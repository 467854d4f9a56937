"""The noise floor: what no model of this road and car could explain, known from drives that repeat one another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from operator import add
from typing import NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import resample_poly

from .experiment import Experiment, Record
from .spectrum import Spectrum, cross_spectrum


DENSER = 4
"""Times as many samples as recorded, from which repeats are compared at equal place."""

LEAST = 0.02
"""Sum over the channels of the explainable shares of their errors, below which nothing is there to be explained."""


class Own(NamedTuple):
    """What a repeat has of its own at equal place: ``inside`` (sample,), where another drove as well; ``noise`` (channel, sample) there, its power
    that of one drive's noise; and ``common`` (channel,), the mean square there of what those that drove there share, by chance below nil."""

    inside: np.ndarray
    noise: np.ndarray
    common: np.ndarray


def deviations(records: Sequence[Record], residuals: Sequence[np.ndarray]) -> list[np.ndarray]:
    """What every repeat has of its own at equal place, (channel, sample), its power that of one drive's noise: the ``noise`` of ``apart``."""
    return [own.noise for own in apart(records, residuals)]


def apart(records: Sequence[Record], residuals: Sequence[np.ndarray]) -> list[Own]:
    """What every repeat has of its own of its residual (channel, sample).

    Residuals are compared on the places of each record in turn, everywhere with those that reach there: a short one tells nothing of the rest of
    the way, where noise may be another. What no other reaches is left out. With n repeats a deviation from the mean holds (n - 1)/n of the power,
    which is made up for.
    """
    splines = [make_interp_spline(*_rising(*denser(record.place, residual))) for record, residual in zip(records, residuals)]
    found = []
    for record, residual in zip(records, residuals):
        reached = np.stack([(record.place >= other.place[0]) & (record.place <= other.place[-1]) for other in records])
        inside = reached.sum(axis=0) > 1
        place, reached = record.place[inside], reached[:, inside]
        count = reached.sum(axis=0)
        total, square = np.zeros((2, len(residual), place.size))
        for spline, there in zip(splines, reached):
            own = spline(place[there]).T
            total[:, there] += own
            square[:, there] += own**2
        noise = (residual[:, inside] - total / count) * np.sqrt(count / (count - 1))
        # The mean product of two of them: noise of one knows nothing of another's.
        found.append(Own(inside, noise, np.mean((total**2 - square) / (count * (count - 1)), axis=1)))
    return found


def denser(place: np.ndarray, residual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places and a residual (channel, sample) at DENSER times as many instants.

    Between the samples as they are a spline, or a line, loses up to half of the power at the highest frequencies that are judged.
    """
    count = residual.shape[-1]
    instants = np.arange(DENSER * (count - 1) + 1) / DENSER
    return np.interp(instants, np.arange(count), place), resample_poly(residual, DENSER, 1, axis=-1)[..., : len(instants)]


def _rising(place: np.ndarray, residual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    kept = np.concatenate([[True], np.diff(np.maximum.accumulate(place)) > 1e-9])
    return place[kept], residual[:, kept].T


def repeats(experiment: Experiment, indices: Iterable[int]) -> dict[str, list[int]]:
    """Those of these records that repeat one another, by condition: at least two in each list."""
    driven: dict[str, list[int]] = {}
    for index in sorted(indices):
        driven.setdefault(experiment.records[index].condition, []).append(index)
    return {condition: own for condition, own in driven.items() if len(own) > 1}


def floor(experiment: Experiment, cleaned: Mapping[int, np.ndarray]) -> dict[str, Spectrum]:
    """Spectrum of the noise of every condition that was driven at least twice, from its residuals less nuisances.

    Its records weigh alike, however long, as in the squares of an error (``squares``) that it is held against.
    """
    return {
        record.condition: reduce(add, (cross_spectrum([part], record.rate, record.lowest) for part in parts)) * (1.0 / len(parts))
        for record, parts in own_noises(experiment, cleaned)
    }


def own_noises(experiment: Experiment, cleaned: Mapping[int, np.ndarray]) -> list[tuple[Record, list[np.ndarray]]]:
    """``deviations`` of every condition that was driven at least twice, from its residuals less nuisances, with the first of its records."""
    groups = [([experiment.records[i] for i in own], [cleaned[i] for i in own]) for own in repeats(experiment, cleaned).values()]
    return [(records[0], deviations(records, parts)) for records, parts in groups]


def assumed(record: Record) -> np.ndarray:
    """Mean square (channel,) within the band of the noise that is known of a record beforehand; nil, (1,), where none is."""
    if not record.noise:
        return np.zeros(1)
    lowest = np.maximum(record.band[0], record.lowest or 0.0)
    return np.square(record.noise) * (record.band[1] - lowest)


def squares(experiment: Experiment, cleaned: Mapping[int, np.ndarray]) -> np.ndarray:
    """Mean square of the residuals within the band, (record, channel), less their mean."""
    return np.stack(
        [
            _power([part - part.mean(axis=1, keepdims=True)], experiment.records[index])
            for index, part in sorted(cleaned.items())
        ]
    )


def _power(parts: Sequence[np.ndarray], record: Record) -> np.ndarray:
    return cross_spectrum(parts, record.rate, record.lowest).power(record.band, record.rate)


def explained_share(before: np.ndarray, after: np.ndarray, first: np.ndarray, floor_squares: np.ndarray) -> float:
    """Fall of the error from ``before`` to ``after`` as a share of what was explainable at ``first``; nan where nothing was.

    All are mean squares (record, channel), ``floor_squares`` those of the floor; records are averaged, channels weigh alike. A
    channel whose floor came out above its error counts against the others: clipped, chance would pass for error.
    """
    if not first.size:
        return float("nan")
    before, after, first, floor_squares = (values.mean(axis=0) for values in (before, after, first, floor_squares))
    explainable = np.sum((first - floor_squares) / first)
    return float(np.sum((before - after) / first) / explainable) if explainable > LEAST else float("nan")
