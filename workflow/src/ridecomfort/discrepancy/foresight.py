"""What candidates would do in their typical sizes.

The score test sees small ones: a short relaxation length hardly delays what a long one levels, and of one that took half of
an error it saw a hundredth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from . import evidence, probe, refit
from .experiment import Candidate, Experiment, Frame
from .probe import Job, Raw
from .tries import TYPICAL


@dataclass(frozen=True)
class Typical:
    """The change of the residuals per probe of every size of one of the ``candidates`` (by name) in one shape, in steps of typical sizes, by
    key; empty where that cannot be simulated. Called with (candidate, number of its shape); a pool can be handed it."""

    experiment: Experiment
    candidates: Mapping[str, Candidate]
    values: Mapping[str, float]
    residuals: Mapping[int, np.ndarray]

    def __call__(self, job: Job) -> Raw:
        candidate = self.candidates[job[0]]
        start, steps = {**self.values, **candidate.at({}, job[1])}, {size.key: TYPICAL for size in candidate.sizes}
        try:
            return probe.secants(self.experiment, start, self.residuals, candidate.sizes, steps=steps)
        except (InputError, ValueError):
            return {}


def gains(
    frame: Frame, residuals: Mapping[int, np.ndarray], free: np.ndarray, candidates: Mapping[str, Candidate], columns: Mapping[Job, Raw]
) -> dict[Job, float]:
    """Fall of the white loss by plausible sizes of every job that its ``columns`` foresee; ``free``: white directions that are fitted anyway."""
    span, found = evidence.basis(free), {}
    flat = evidence.without(frame.flat(residuals), span)
    for job, own in columns.items():
        sizes = [size for size in candidates[job[0]].sizes if size.key in own]
        if sizes:
            matrix = evidence.without(frame.flats([own[size.key] for size in sizes]), span)
            found[job] = refit.stepped({}, sizes, matrix, flat)[1]
    return found
