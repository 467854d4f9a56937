"""Whether what speaks for an effect on one repeat does so by what the effect does on the others.

A model is driven with what its record says of speed, path and foot. Noise of these is in the residual, and in what an effect does that answers to
them: links against diving take back what noise made of the pitch, on every repeat and on drives held out. What is missing is missing on every
repeat alike; the noise of one is not that of another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from . import evidence
from .exemplar import at_places
from .experiment import Frame
from .floor import repeats

LIKE = 0.5
"""Correlation, in the white frame, of what an effect does on repeats from which on these can bear one another out: what turns or is shifted has a phase
of its own in each."""


class Borne(NamedTuple):
    """What is left of the evidence for a column where every repeat has that of the others at equal place in place of its own: its ``share`` of what
    would be if the column were what is missing, and its ``z``, of what no free direction takes up. nan where no drive was repeated, or repeats are
    not LIKE."""

    share: float = float("nan")
    z: float = float("nan")


def borne_out(
    frame: Frame, residuals: Mapping[int, np.ndarray], column: Mapping[int, np.ndarray], free: Sequence[Mapping[int, np.ndarray]] = ()
) -> Borne:
    """How far repeats bear a column (record: (channel, sample)) out among themselves; ``free``: columns of what is fitted anyway, to which a
    residual says nothing."""
    groups = repeats(frame.experiment, frame.indices).values()
    others = {index: _of_others(frame, column, group, index) for group in groups for index in group}
    if not others:
        return Borne()
    flat = lambda parts: np.concatenate([frame.flat_of(index, parts[index]) for index in others])
    rows = [flat(parts) for parts in (column, residuals, {index: np.mean(parts, axis=0) for index, parts in others.items()})]
    powers, its_power = sum(np.mean([np.sum(frame.flat_of(index, part) ** 2) for part in parts]) for index, parts in others.items()), rows[2] @ rows[2]
    if free:
        rows = evidence.without(np.stack(rows), evidence.basis(np.stack([flat(parts) for parts in free])))
    mine, residual, its = rows
    kept = (its @ its) / its_power if its_power > 0 else 0.0
    own, cross, like = mine @ residual, its @ residual, mine @ its
    is_like = like > LIKE * np.sqrt((mine @ mine) * kept * powers) > 0.0
    return Borne(float((cross / like) / (own / (mine @ mine))), float(np.sign(own) * cross / np.sqrt(its @ its))) if is_like and own else Borne()


def _of_others(frame: Frame, column: Mapping[int, np.ndarray], group: Sequence[int], index: int) -> list[np.ndarray]:
    """What a column does on the other records of a group, at the places of one."""
    return [at_places(frame.experiment, column[other], other, index) for other in group if other != index]
