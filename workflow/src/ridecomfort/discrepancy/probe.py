"""Columns of a least-squares problem: how the residuals change with a parameter or with an effect that is switched on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..effects.in_python import ActFails
from ..errors import InputError
from . import experiment as exp
from .experiment import Candidate, Experiment, Frame, Size

Job = tuple[str, int]
"""A candidate and the number of its shape."""

Raw = Mapping[str, Mapping[int, np.ndarray]]
"""Change of the residuals per probe of each size, by record."""


@dataclass(frozen=True)
class Probe:
    """The change of the residuals per probe of every size of a candidate in one shape, over as many as that is tried with, by key; what cannot be
    simulated, or changes nothing, is left out. Called with (candidate, number of its shape); a pool can be handed it. Raises ActFails for a
    mistake in an effect's file."""

    experiment: Experiment
    values: Mapping[str, float]
    residuals: Mapping[int, np.ndarray]

    def __call__(self, job: Job) -> dict[str, dict[int, np.ndarray]]:
        candidate = next(c for c in self.experiment.candidates if c.name == job[0])
        columns, reach = {}, candidate.reach(job[1])
        for size in candidate.sizes:
            try:
                moved = self._moved(candidate, size, job[1])
            except ActFails:
                raise
            except (InputError, ValueError):
                continue
            column = {i: ((moved[i] - self.residuals[i]) / reach).astype(np.float32) for i in moved}
            if any(np.any(part) for part in column.values()):
                columns[size.key] = column
        return columns

    def refusal(self, job: Job) -> str:
        """Why no size of a candidate can be simulated in a shape; empty where one can."""
        candidate, why = next(c for c in self.experiment.candidates if c.name == job[0]), ""
        for size in candidate.sizes:
            try:
                self._moved(candidate, size, job[1])
                return ""
            except (InputError, ValueError) as problem:
                why = str(problem)
        return why

    def _moved(self, candidate: Candidate, size: Size, shape: int) -> dict[int, np.ndarray]:
        """The residuals with one size of a candidate as large as that is tried with in a shape."""
        return exp.simulate(self.experiment, {**self.values, **candidate.at({size.key: candidate.reach(shape)}, shape)}, self.residuals)


def coarsely(
    experiment: Experiment, values: Mapping[str, float], residuals: Mapping[int, np.ndarray]
) -> tuple[Experiment, Mapping[int, np.ndarray]]:
    """An experiment to probe and to fit in from these values, and its residuals there: in steps twice as long, which changes most columns by
    less than half a percent, where the model can be driven so."""
    try:
        return experiment.coarser(values, residuals)
    except (InputError, ValueError):
        return experiment, residuals


@dataclass(frozen=True)
class _Secant:
    experiment: Experiment
    values: Mapping[str, float]
    residuals: Mapping[int, np.ndarray]
    steps: Mapping[str, float]

    def __call__(self, size: Size) -> dict[int, np.ndarray]:
        value, step = self.values.get(size.key, size.neutral), self.steps.get(size.key, 1.0)
        inward = step if size.lower <= value + step * size.probe <= size.upper else -step
        for own in (inward, -inward, 0.25 * inward):  # a vehicle that drives at its size may not a probe farther on
            try:
                return exp.secant(self.experiment, self.values, self.residuals, size, own)
            except (InputError, ValueError) as problem:
                refused = problem
        raise refused


def secants(
    experiment: Experiment, values: Mapping[str, float], residuals: Mapping[int, np.ndarray], sizes: Sequence[Size],
    each: Callable = map, steps: Mapping[str, float] | None = None,
) -> dict[str, dict[int, np.ndarray]]:  # fmt: skip
    """Change of the residuals per probe of every size from its value, into its bounds, by key; over ``steps`` (probes), where these are
    given."""
    found = each(_Secant(experiment, values, residuals, steps or {}), sizes)
    return {size.key: column for size, column in zip(sizes, found)}


def white(frame: Frame, raw: Mapping[str, Mapping[int, np.ndarray]]) -> dict[str, np.ndarray]:
    """Columns in the white frame, by key."""
    return dict(zip(raw, frame.flats(list(raw.values()))))
