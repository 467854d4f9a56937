"""Whether what speaks for an effect on one repeat does so by what the effect does on the others.

A model is driven with what its record says of speed, path and foot. Noise of these is in the residual, and in what an effect does that answers to
them: links against diving take back what noise made of the pitch, on every repeat and on drives held out. What is missing is missing on every
repeat alike; the noise of one is not that of another.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .exemplar import at_places
from .experiment import Frame
from .floor import repeats

LIKE = 0.5
"""Correlation, in the white frame, of what an effect does on repeats from which on these can bear one another out: what turns or is shifted has a phase
of its own in each."""


class Borne(NamedTuple):
    """What is left of the evidence for a column where every repeat has that of the others at equal place in place of its own: its ``share`` of what
    would be if the column were what is missing, and its ``z``. nan where no drive was repeated, or repeats are not LIKE."""

    share: float = float("nan")
    z: float = float("nan")


def borne_out(frame: Frame, residuals: Mapping[int, np.ndarray], column: Mapping[int, np.ndarray]) -> Borne:
    """How far repeats bear a column (record: (channel, sample)) out among themselves."""
    own = cross = like = powers = own_power = its_power = 0.0
    for group in repeats(frame.experiment, frame.indices).values():
        for index in group:
            mine, residual = frame.flat_of(index, column[index]), frame.flat_of(index, residuals[index])
            others = [frame.flat_of(index, at_places(frame.experiment, column[other], other, index)) for other in group if other != index]
            its = np.mean(others, axis=0)
            own, cross, like = own + mine @ residual, cross + its @ residual, like + mine @ its
            own_power, its_power, powers = own_power + mine @ mine, its_power + its @ its, powers + np.mean([part @ part for part in others])
    is_like = like > LIKE * np.sqrt(own_power * powers) > 0.0
    return Borne(float((cross / like) / (own / own_power)), float(np.sign(own) * cross / np.sqrt(its_power))) if is_like and own else Borne()
