"""One search of a calibration: least squares within bounds, with as few simulations as it takes.

The method is the trust-region reflective one of scipy. Its Jacobian is made by differences, a simulation for every parameter
and drive, where nothing is known yet; from then on it is carried from point to point by what every step shows (Broyden
1965, Math. Comp. 19:577), and made anew where a step shows that it is wrong and, where the search has to be exact, at
its end: unless a step with that one promises no more than the tolerance, the search goes on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, lsq_linear

from .errors import InputError
from .problem import Problem

UNSEEN = 1e-9
"""NRMSE over the whole width of the bounds below which a parameter counts as without effect and is left alone."""

MOST_TRIALS = 50
"""Trial points of one search; a well-posed one takes fewer than 15."""

WRONG = 0.5
"""Share of what a step was to change that may come out otherwise before the Jacobian is made anew."""


@dataclass(frozen=True)
class Descent:
    """Where a search ended: ``point``, its ``cost`` and ``nrmse`` (drive, signal), why it ``stopped``, ``evaluations``.

    ``path``: the point and the cost after each iteration, the start first. ``jacobian`` (residual, parameter): as known
    at the end, zero for parameters that were not free.
    """

    point: np.ndarray
    cost: float
    nrmse: np.ndarray
    stopped: str
    evaluations: int
    path: Sequence[tuple[np.ndarray, float]]
    jacobian: np.ndarray


def descend(
    task: Problem,
    start: np.ndarray,
    free: Sequence[int],
    tolerance: float,
    *,
    known: np.ndarray | None = None,
    exact: bool = False,
) -> Descent:
    """Least squares over the ``free`` parameters from ``start``, to a relative change of cost or step below ``tolerance``.

    ``known`` is a Jacobian (residual, parameter) to begin with, of a point near enough. ``exact``: ``jacobian`` is that
    of differences at the end, and by it no step lowers the cost by more than the tolerance.
    """
    before, path = task.evaluations, []
    start = np.clip(start, 1e-6, 1 - 1e-6)
    free = np.asarray(free, dtype=int)
    slope = np.zeros((task.flat(start).size, free.size)) if known is None else known[:, free].copy()
    new = np.linalg.norm(slope, axis=0) <= UNSEEN
    slope[:, new] = task.jacobian(start, free[new])
    seen = np.linalg.norm(slope, axis=0) > UNSEEN
    free, slope = free[seen], slope[:, seen]

    def full(part: np.ndarray) -> np.ndarray:
        point = np.array(start, dtype=float)
        point[free] = part
        return point

    def residual(part: np.ndarray) -> np.ndarray:
        """Infinite where a vehicle cannot be driven, from which the search turns back; where it starts it must be."""
        try:
            return task.flat(full(part))
        except InputError:
            if np.array_equal(part, start[free]):
                raise
            return np.full(slope.shape[0], np.inf)

    def end(part: np.ndarray, message: str) -> Descent:
        jacobian = np.zeros((slope.shape[0], len(task.parameters)))
        jacobian[:, free] = slope
        point = full(part)
        cost = 0.5 * float(np.sum(task.flat(point) ** 2))
        return Descent(point, cost, task.nrmse(point), message, task.evaluations - before, path, jacobian)

    if not free.size:
        return end(start[free], "no signal depends on the parameter")
    last, moved = start[free], residual(start[free])

    def carried(part: np.ndarray) -> np.ndarray:
        nonlocal slope, last, moved
        now, step = residual(part), part - last
        if step.any() or not path:
            path.append((full(part), 0.5 * float(now @ now)))
        if step.any():
            promised = slope @ step
            missed = now - moved - promised
            if np.linalg.norm(missed) > WRONG * np.linalg.norm(promised):
                slope = task.jacobian(full(part), free)
            else:
                slope = slope + np.outer(missed, step / (step @ step))
        last, moved = part.copy(), now
        return slope

    part, trials = last, MOST_TRIALS
    while True:
        found = least_squares(
            residual, part, jac=carried, bounds=(0.0, 1.0), method="trf", ftol=tolerance, xtol=tolerance, gtol=None,
            max_nfev=trials,
        )  # fmt: skip
        part, trials = found.x, trials - found.nfev
        if not exact:
            break
        slope, last, moved = task.jacobian(full(part), free), part, residual(part)
        if trials < 1 or _promised(slope, moved, part) < tolerance * found.cost:
            break
    return end(part, found.message.strip("`. ").replace("`", ""))


def _promised(slope: np.ndarray, residual: np.ndarray, part: np.ndarray) -> float:
    """By how much the best step within the bounds would lower the cost, were the residual linear."""
    upper = np.linalg.qr(np.column_stack([slope, residual]), mode="r")
    best = lsq_linear(upper[:, :-1], -upper[:, -1], bounds=(-part, 1.0 - part))
    return 0.5 * float(upper[:, -1] @ upper[:, -1]) - best.cost
