"""What a residual would be if its driver had kept to the measured path to the last millimetre, without driving again.

A path that is missed by millimetres changes a drive in proportion: how is seen once, by asking for some centimetres more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import coo_array, csr_array

from ..vehicle.driver import PREVIEW_TIME
from .leftover import MOVED, hats
from .replay import Replay

KNOT_INTERVAL, FORGOTTEN = 0.4, 10
"""s between the points of a drive at which another path is asked for, and how many of them it takes a vehicle to forget one."""

RIDGE = 1e-3
"""Share of the largest answer to a knot below which the path does not follow it."""


@dataclass(frozen=True)
class Steered:
    """For a replay and what has the same ``time`` and ``compared``. ``path``: change of the driven path (time, knot) in m per m that is asked
    for at a knot; ``residual``: of the residual (6 * compared, knot); ``factor``: of the normal equations that bring a path to one that is
    asked for (``scipy.linalg.cho_factor``)."""

    path: csr_array
    residual: csr_array
    factor: tuple

    def made_good(self, missing: np.ndarray) -> np.ndarray:
        """Change of the residual (6, compared) when the path comes to lie so much farther left, ``missing`` (time,) in m."""
        asked = cho_solve(self.factor, self.path.T @ missing)
        return (self.residual @ asked).reshape(6, -1)


def steered(again: Replay, vehicle, effects=()) -> Steered | None:
    """How a drive of a calibrated ``vehicle`` with its ``effects`` answers to the path that is asked for, by driving it a dozen times; None
    where no path was measured, or the simulator tells none. Raises InputError when it does not arrive."""
    run = again.run(vehicle, effects)
    if "lateral" not in again.astray(run):
        return None
    kept, time = again.compared, again.time
    at = time[0] + KNOT_INTERVAL * np.arange(max(2, int((time[-1] - time[0]) / KNOT_INTERVAL) + 2))
    base, base_path = again.residual(again.sample(run))[:, kept], again.driven(run)["e"]
    paths, residuals = [], []
    for colour in range(min(FORGOTTEN, len(at))):
        asked = _asked(again, at, colour)
        tried = asked.run(vehicle, effects)
        # The driver answers before a knot, by as much as he is asked early.
        answers = np.floor((time + PREVIEW_TIME - at[0]) / KNOT_INTERVAL + 1 - colour).astype(int) // FORGOTTEN * FORGOTTEN + colour
        answers = np.where(answers < len(at), answers, -1)
        seen = np.flatnonzero(answers >= 0)
        paths.append((again.driven(tried)["e"][seen] - base_path[seen], seen, answers[seen]))
        change = again.residual(asked.sample(tried))[:, kept] - base
        seen = np.flatnonzero(answers[kept] >= 0)
        residuals += [(row[seen], k * kept.sum() + seen, answers[kept][seen]) for k, row in enumerate(change)]
    path, residual = _matrix(paths, (len(kept), len(at))), _matrix(residuals, (6 * kept.sum(), len(at)))
    normal = (path.T @ path).toarray()
    return Steered(path, residual, cho_factor(normal + RIDGE * normal.diagonal().max() * np.eye(len(at))))


def _asked(again: Replay, at: np.ndarray, colour: int) -> Replay:
    """The same, asked for a path that lies farther left at every knot of a colour."""
    change = np.zeros(len(at))
    change[colour::FORGOTTEN] = MOVED["lateral"]
    lateral, u = again.demand["lateral"], again.demand["speed"]["u"].values
    early = np.interp(again.time - PREVIEW_TIME, again.time, again.place)
    more = xr.DataArray(np.interp(u, early, hats(again.time, at) @ change), {"u": u}, "u")
    return replace(again, demand={**again.demand, "lateral": lateral + more})


def _matrix(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]], shape: tuple[int, int]) -> csr_array:
    values, rows, columns = (np.concatenate(part) for part in zip(*parts))
    return csr_array(coo_array((values / MOVED["lateral"], (rows, columns)), shape=shape))
