"""Whether drives held out ask for the sizes that the others were fitted to, or for others than their intervals allow."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.stats import chi2

from ..errors import InputError
from . import evidence, probe, realign, refit
from .experiment import Frame, Size
from .refit import Fit
from .rung import Rung, roles

SELDOM = 0.01
"""Probability below which a disagreement is no chance."""

NEGLIGIBLE = 1e-10
"""Share of the largest eigenvalue below which what drives say of the sizes is rounding."""


def birge_ratio(rung: Rung, fit: Fit, frame: Frame, sizes: Sequence[Size], each: Callable = map) -> float:
    """Times by which held-out drives miss the fitted ``sizes`` beyond the errors of both, by which intervals are widened (Birge 1932, Physical
    Review 40:207); 1 where they may miss them by chance, and where none is held out.

    Noise cannot tell what alignment, a road's file or a model that is not quite the car does to sizes; drives at another speed
    or on other roads, on which that is otherwise, do. The score of the held-out drives at the fitted sizes is nil but for the errors of both.
    """
    held_out, moving = roles(rung.experiment)[1], [size for size in sizes if refit.is_within(size, fit.values)]
    if not (held_out and moving):
        return 1.0
    try:
        residuals, check, experiment = realign.aligned(rung.experiment, fit.values, held_out)
        sooner, base = probe.coarsely(experiment, fit.values, residuals)
        raw = probe.secants(sooner, fit.values, base, moving, each)
    except (InputError, ValueError):
        return 1.0
    columns = check.flats([raw[size.key] for size in moving])
    normal, score = evidence.product(columns, columns), evidence.product(columns, check.flat(residuals))
    fitted, own = _errors(fit, frame, [size.key for size in moving])
    each_own = np.split(columns, np.flatnonzero(np.diff(check.drives())) + 1, axis=1)
    alone = sum(one @ own @ one for one in (evidence.product(part, part) for part in each_own))
    unit = np.sqrt(np.maximum(np.diag(normal), np.finfo(float).tiny))
    variance, vectors = np.linalg.eigh((normal + normal @ fitted @ normal + alone) / np.outer(unit, unit))
    kept = variance > NEGLIGIBLE * variance[-1]
    missed = float(np.sum((vectors.T[kept] @ (score / unit)) ** 2 / variance[kept]))
    count = int(kept.sum())
    return float(np.sqrt(missed / count)) if count and chi2.sf(missed, count) < SELDOM else 1.0


def _errors(fit: Fit, frame: Frame, keys: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Covariance of the fitted sizes in probes, and that of what one drive has of its own to say of them (its path, clock and mounting), which
    ``refit.intervals`` hold as well; nil where one drive was fitted."""
    (fitted, _), (along, drives) = refit.both_ways(fit, frame, keys)
    values, vectors = np.linalg.eigh(along)
    of_drives = (vectors * np.maximum(values, 0.0)) @ vectors.T
    return fitted + of_drives, drives * of_drives
