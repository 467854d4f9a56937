"""One drive for all that repeat it: a first look at many candidates need not simulate each of them on every repeat.

At the same place of the same road at nearly the same speed an effect changes the signals in nearly the same way. What is borrowed so tells
which candidates are worth a look of their own on every drive. Of the others it tells how little speaks for them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .experiment import Experiment, Frame
from .probe import Raw

ALIKE = 0.8
"""Correlation in the white frame, mean over what is fitted, from which on the columns of one record may stand for those of another."""


def exemplars(frame: Frame, raw: Raw) -> dict[int, int]:
    """The record that each one of a frame may borrow columns from, the longest first, or itself; ``raw``: columns by key that are known of
    all, by which it is judged who is like whom."""
    records, found = frame.experiment.records, {}
    for index in sorted(frame.indices, key=lambda index: (-len(records[index].place), index)):
        like = (other for other in dict.fromkeys(found.values()) if _likeness(frame, raw, other, index) >= ALIKE)
        found[index] = next(like, index)
    return found


def borrowed(experiment: Experiment, found: Mapping[int, int], raw: Raw) -> Raw:
    """Columns by key that are known of exemplars alone, for all records ``found`` beside these; nil where the exemplar did not drive."""
    return {key: {index: at_places(experiment, parts[other], other, index) for index, other in found.items()} for key, parts in raw.items()}


def at_places(experiment: Experiment, column: np.ndarray, other: int, index: int) -> np.ndarray:
    """A column (channel, sample) of another record at the places of a record."""
    if other == index:
        return column
    own, its = (experiment.records[number].place for number in (index, other))
    return np.stack([np.interp(own, its, row, left=0.0, right=0.0) for row in column]).astype(column.dtype)


def _likeness(frame: Frame, raw: Raw, other: int, index: int) -> float:
    """How alike the columns of a record and those that it would borrow of another are, from -1 to 1; 0 for different sites."""
    experiment = frame.experiment
    if not raw or experiment.records[index].site != experiment.records[other].site:
        return 0.0
    pairs = [(parts[index], at_places(experiment, parts[other], other, index)) for parts in raw.values()]
    white = [[frame.flat_of(index, part) for part in pair] for pair in pairs]
    alike = [float(own @ its) / np.sqrt(float(own @ own) * float(its @ its)) for own, its in white if own.any() and its.any()]
    return float(np.mean(alike)) if alike else 0.0
