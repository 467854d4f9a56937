"""How large the candidates may be that a search did not accept: what the drives exclude of them beside its last model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from ..identifiability import CONFIDENCE
from . import evidence, refit
from .experiment import Candidate, Frame
from .probe import Job

LEAST = 1.0
"""White norm of what the largest plausible size does, noise being one in every direction, below which it shows on no drive."""

ALIKE = 1e-9
"""Least eigenvalue of the correlations of a candidate's columns for its sizes to be told from one another."""


@dataclass(frozen=True)
class Excluded:
    """A ``size`` of an effect by one step of least squares, in its ``unit``: the drives exclude what lies outside of its 90 % ``interval``, nan where
    they do not tell it from another of the effect; both nan where no plausible one would show on them. ``plausible``: the range of what is."""

    effect: str
    parameter: str
    unit: str
    size: float
    interval: tuple[float, float]
    plausible: tuple[float, float]


def of_all(
    frame: Frame, residual: np.ndarray, columns: Mapping[tuple[Job, str], np.ndarray], candidates: Mapping[str, Candidate], best: Mapping[str, Job]
) -> tuple[Excluded, ...]:
    """What is excluded of every size of the candidates ``best`` (in their best shape).

    The white ``residual`` (element,) and ``columns`` per probe have all projected out that is fitted anyway. One step takes an effect for linear, as
    small sizes are; errors may depend on one another where drives come by the same place (``refit.clustered``).
    """
    numbers = refit.numbered(frame.blocks())
    return tuple(one for name, job in best.items() for one in _of(candidates[name], job, residual, columns, numbers))


def _of(candidate: Candidate, job: Job, residual: np.ndarray, columns: Mapping[tuple[Job, str], np.ndarray], numbers: np.ndarray) -> list[Excluded]:
    sizes = [size for size in candidate.sizes if (job, size.key) in columns]
    rows = np.stack([columns[job, size.key] for size in sizes])
    normal = evidence.product(rows, rows)
    unit = np.sqrt(np.where(np.diag(normal) > 0, np.diag(normal), 1.0))
    values, vectors = np.linalg.eigh(normal / np.outer(unit, unit))
    kept = values > ALIKE
    bread = (vectors[:, kept] / values[kept]) @ vectors[:, kept].T / np.outer(unit, unit)
    step = -bread @ evidence.product(rows, residual)
    covariance, places = refit.clustered(bread, rows, residual + step.astype(rows.dtype) @ rows, numbers, len(sizes), np.zeros_like(bread))
    half = student.ppf(0.5 + CONFIDENCE / 2, max(places - len(sizes), 1)) * np.sqrt(np.diag(covariance))
    told = []
    for size, moved, wide, norm in zip(sizes, step, half if kept.all() else np.full(len(sizes), np.nan), np.sqrt(np.diag(normal))):
        farthest = max(abs(end - size.neutral) for end in (size.lower, size.upper))
        shows = 1.0 if norm * farthest >= LEAST * abs(size.probe) else np.nan
        value, own = shows * (size.neutral + float(moved) * size.probe), float(wide) * abs(size.probe)
        parameter = size.key.partition(".")[2]
        told.append(Excluded(candidate.name, parameter, size.unit, value, (value - own, value + own), (float(size.lower), float(size.upper))))
    return told
