"""What a residual would be if its driver had kept to the measured path to the last millimetre, without driving again.

A path that is missed by millimetres changes a drive in proportion: how is seen once, by asking for some centimetres more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import coo_array, csr_array

from .leftover import MOVED, knots, moves
from .replay import Replay

KNOTS, LEAST_KNOTS, APART = 0.4, 3.0, 10
"""s between the points at which the path is asked for, m between them at least, and how many of them a vehicle needs to forget one."""

RIDGE = 1e-3
"""Share of the largest answer to a knot below which the path does not follow it."""


@dataclass(frozen=True)
class Steered:
    """``path``: change of the driven path (time, knot) in m per m that is asked for at a knot; ``residual``: of the residual (6 * compared,
    knot)."""

    path: csr_array
    residual: csr_array
    factor: tuple

    def made_good(self, missing: np.ndarray) -> np.ndarray:
        """Change of the residual (6, compared) when the path comes to lie so much farther left, ``missing`` (time,) in m."""
        asked = cho_solve(self.factor, self.path.T @ missing)
        return (self.residual @ asked).reshape(6, -1)


def steered(again: Replay, vehicle, effects=()) -> Steered | None:
    """How a drive answers to the path that is asked for, by driving it about a dozen times; None where no path was measured, or the
    simulator tells none."""
    run = again.run(vehicle, effects)
    if "lateral" not in again.astray(run):
        return None
    kept, speed = again.compared, float(np.median(again.demand["speed"].values))
    spacing = max(KNOTS * speed, LEAST_KNOTS)
    at = knots(again, spacing)
    base, base_path = again.residual(again.sample(run))[:, kept], _path(again, run)
    paths, residuals = [], []
    for asked, answers in moves(again, "lateral", at, APART * spacing):
        tried = asked.run(vehicle, effects)
        seen = np.flatnonzero(answers >= 0)
        paths.append((_path(again, tried)[seen] - base_path[seen], seen, answers[seen]))
        change = again.residual(asked.sample(tried))[:, kept] - base
        seen = np.flatnonzero(answers[kept] >= 0)
        residuals += [(change[k, seen], k * kept.sum() + seen, answers[kept][seen]) for k in range(len(change))]
    path, residual = _matrix(paths, (len(kept), len(at))), _matrix(residuals, (6 * kept.sum(), len(at)))
    normal = (path.T @ path).toarray()
    return Steered(path, residual, cho_factor(normal + RIDGE * normal.diagonal().max() * np.eye(len(at))))


def _path(again: Replay, run) -> np.ndarray:
    return np.interp(again.place, np.maximum.accumulate(run["s"].values), run["e"].values)


def _matrix(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]], shape: tuple[int, int]) -> csr_array:
    values, rows, columns = (np.concatenate(part) for part in zip(*parts))
    return csr_array(coo_array((values / MOVED["lateral"], (rows, columns)), shape=shape))
