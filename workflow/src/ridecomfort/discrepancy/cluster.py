"""Which refitted candidates the data do not tell from the best, and where they differ most."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from . import evidence, refit
from . import experiment as exp
from .experiment import Experiment, Frame
from .selection import Trial
from .tries import implausible

APART = 2.0
"""z of the difference of two refits below which the data do not tell them apart."""

SAME_PORT = 0.5
"""Correlation beyond which two that act at one port and do equally well are taken for one another; elsewhere evidence.SAME."""

COMPARABLE = 0.5
"""Share of the best one's gain that another must reach to be taken for it."""

BETTER = 1.5
"""Times the white power by which two refits differ on any drive that was made, from which on one that was not is told instead."""


def cluster(
    experiment: Experiment, frames: Sequence[Frame], before: Mapping[str, float], winner: Trial, trials: Sequence[Trial],
    columns: Mapping[tuple, np.ndarray],
) -> tuple[tuple[str, ...], dict[str, float], dict[str, str]]:  # fmt: skip
    """Names of the candidates like the winner, canonical correlations of all with it, and for each of the first the
    drive on which it differs most from the winner, of those that were made and of others like the first.

    ``frames``: of the fitted and, where there are any, of the held-out records. ``before``: values of the model that both
    were added to. ``columns``: projected columns by ((candidate, shape), key). What does as well by changing the
    signals otherwise is not like the winner: both may be missing. Nor is what would do as well with a size that is not plausible.
    """
    by_name = {candidate.name: candidate for candidate in experiment.candidates}
    rows = lambda name: np.stack([row for (job, _), row in columns.items() if job[0] == name])
    like, correlation, apart = [], {}, {}
    for trial in trials:
        if trial is winner:
            continue
        correlation[trial.name] = evidence.canonical_correlation(rows(winner.name), rows(trial.name))
        if trial.gain < COMPARABLE * winner.gain or implausible(by_name[trial.name], trial.fit.values):
            continue
        z, power, changes = [], {}, []
        for frame in frames:
            base, one, other = (
                exp.simulate(experiment, values, frame.indices) for values in (before, winner.fit.values, trial.fit.values)
            )
            changes.append(frame.flats([{i: part[i] - base[i] for i in part} for part in (one, other)]))
            z.append(refit.advantage(frame, one, other)[1])
            power |= {i: float(np.mean(frame.whitening[i](one[i] - other[i]) ** 2)) for i in frame.indices}
        one, other = np.concatenate(changes, axis=1).astype(float)
        alike = max(correlation[trial.name], one @ other / np.sqrt((one @ one) * (other @ other)))
        port = by_name[trial.name].port
        at_one = port and port == by_name[winner.name].port
        if alike > (SAME_PORT if at_one else evidence.SAME) and sum(z) / np.sqrt(len(z)) < APART:
            like.append(trial.name)
            apart[trial.name] = _where_apart(experiment, frames[0], winner, trial, power)
    return tuple(like), correlation, apart


def _where_apart(experiment: Experiment, frame: Frame, winner: Trial, trial: Trial, power: Mapping[int, float]) -> str:
    """The drive on which two refits differ most, whose white ``power`` is known by record; one that was not made if it is BETTER."""
    made, first = max(power, key=power.get), frame.indices[0]
    whitening = replace(frame.whitening[first], scale=None)
    others = experiment.would_differ(winner.fit.values, trial.fit.values, first)
    not_made = {name: float(np.mean(whitening(difference) ** 2)) for name, difference in others.items()}
    best = max(not_made, key=not_made.get, default=None)
    own = experiment.records[first].name
    return f"{own}, at {best}" if best and not_made[best] > BETTER * power[made] else experiment.records[made].name
