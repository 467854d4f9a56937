"""Records aligned anew for a model: what it lacked before had its part in their clocks and paths.

A clock that is 2 ms off makes every size some percent small. A model and a trial beside it are aligned equally often, or
the trial would pass for better because of that; an accepted effect may be aligned for more often (``rung.climb``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from . import experiment as exp
from .experiment import Experiment, Frame

ROUNDS, CLOSE = 3, 1e-3
"""How often at most, and the share of the white loss that one round must take to be followed by another."""


def aligned(
    experiment: Experiment, values: Mapping[str, float], indices: Sequence[int], least: Frame | None = None
) -> tuple[Mapping[int, np.ndarray], Frame, Experiment]:
    """Residuals of records at these values, their frame, and the experiment in which they are aligned for the model; in frames with no more power
    than ``least``, if that is given (``experiment.frame``)."""
    experiment, residuals = experiment.retuned(values, indices, exactly=True)
    frame = exp.frame(experiment, residuals, exp.nuisances(experiment, values, residuals), least=least)
    moved, experiment = closer(experiment, values, residuals, frame)
    if moved is residuals:
        return residuals, frame, experiment
    # What a path does is another on another path: frames that keep the nuisances of before hold sizes back.
    anew = [index for index in moved if moved[index] is not residuals[index]]
    nuisances = {**frame.nuisances, **exp.nuisances(experiment, values, anew)}
    frame = exp.frame(experiment, moved, nuisances, frame.all_cleaned(moved), least)
    residuals, experiment = closer(experiment, values, moved, frame)
    return residuals, frame, experiment


def closer(
    experiment: Experiment, values: Mapping[str, float], residuals: Mapping[int, np.ndarray], frame: Frame
) -> tuple[Mapping[int, np.ndarray], Experiment]:
    """Residuals with those records realigned that this brings closer in ``frame``, and the experiment in which they are."""
    loss = _losses(frame, residuals)
    for _ in range(ROUNDS):
        before = sum(loss.values())
        amounts = frame.all_amounts(residuals)
        realigned, moved = experiment.realigned(amounts).retuned(values, list(residuals))
        after = _losses(frame, moved)
        better = [i for i in residuals if after[i] < loss[i]]
        if better and len(better) < len(residuals):
            realigned = experiment.taking(realigned, better)
        if better:
            experiment, residuals = realigned, {i: moved[i] if i in better else residuals[i] for i in residuals}
            loss |= {i: after[i] for i in better}
        if before - sum(loss.values()) < CLOSE * before:
            break
    return residuals, experiment


def _losses(frame: Frame, residuals: Mapping[int, np.ndarray]) -> dict[int, float]:
    return exp.by_record(frame.experiment, lambda i: float(np.sum(frame.flat_of(i, residuals[i]) ** 2)), residuals)
