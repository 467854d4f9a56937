"""Where across the road a drive went, and how its place wandered: found by the roughness that the wheels met."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, hstack

from . import leftover, place
from .replay import Replay, Simulated, replay

STEP = 0.1
"""m; the roughness under a tyre is another one a tenth of a metre aside."""

KNOWN, UNKNOWN = 0.4, 1.2
"""m searched to both sides of the recorded path, and of the reference line where none is recorded or the path is none of those."""

SEARCHED = 45.0
"""s of a drive that its path is looked for with."""

HALF_VEHICLE = 0.9
"""m that the path keeps from the edges of the road."""

EXPECTED_ASIDE, EXPECTED_ASIDE_MEASURED, EXPECTED_ALONG = 0.1, 0.02, 0.03
"""m; usual size of the wandering across the road, where e was recorded, and along it."""

SECOND = 1.0
"""s of a drive that are left out together when a wandering is put to the test."""

INDEPENDENT = 0.1
"""s; residuals closer than this count as one observation against the expected sizes."""


def has_offset(drive: xr.Dataset) -> bool:
    """Whether the drive holds its lateral offset e."""
    return bool(np.isfinite(drive["e"].values).all())


def find_offset(work: xr.Dataset, road, vehicle, simulate, options: Mapping) -> float:
    """m to the left of the recorded path at which model and measurement agree best.

    From SEARCHED seconds in the middle of the drive: a search over both sides, then a bounded
    minimum around the best. The road that the wheels meet aside is another road, so no
    parameter of the vehicle can take its part.
    """
    surface = getattr(road, "road", road)
    length = int(SEARCHED / float(work["time"][1] - work["time"][0]))
    middle = max(0, (work.sizes["time"] - length) // 2)
    work = work.isel(time=slice(middle, middle + length))
    known = np.isfinite(work.attrs["lateral_position"]) or has_offset(work)
    if has_offset(work):
        lowest, highest = float(work["e"].min()), float(work["e"].max())
    else:
        lowest = highest = float(np.nan_to_num(work.attrs["lateral_position"]))
    left = float(surface["v"][-1]) - HALF_VEHICLE - highest
    right = float(surface["v"][0]) + HALF_VEHICLE - lowest

    def misfit(lateral: float) -> float:
        again = replay(work, road, simulate, lateral_correction=float(lateral), options=options)
        return place.misfit(again, again(vehicle))

    for reach in (KNOWN, UNKNOWN) if known else (UNKNOWN,):
        trials = np.arange(-round(reach / STEP), round(reach / STEP) + 1) * STEP
        trials = trials[(trials >= right) & (trials <= left)]
        if trials.size < 3:
            return 0.0
        best = trials[int(np.argmin([misfit(trial) for trial in trials]))]
        if trials[0] < best < trials[-1]:
            break
    bounds = max(best - STEP, trials[0]), min(best + STEP, trials[-1])
    return float(minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 5e-3}).x)


def wander(again: Replay, simulated: Simulated, vehicle, expected_aside: float) -> tuple[np.ndarray, np.ndarray]:
    """Slow corrections of the place along and across the road in m, each over the samples of the drive.

    One Gauss-Newton step for their values at knots, linear between them, drawn to zero by their
    expected sizes. What a wrong model pretends to is taken out by cross-validation: a correction
    counts as far as the one from every other second explains the seconds between. That
    along the road has no mean: a mean is a clock offset.
    """
    kept = again.compared
    residual = again.residual(simulated)[:, kept]
    residual = residual - residual.mean(axis=1, keepdims=True)
    weight = np.repeat(1 / (residual.var(axis=1) + 1e-10), kept.sum())
    residual = residual.ravel()
    at = [leftover.knots(again, spacing) for spacing in (leftover.KNOTS_ALONG, leftover.KNOTS)]
    columns = [
        leftover.moved_along(again, simulated, at[0]),
        leftover.moved(again, "lateral", vehicle, (), at[1], simulated),
    ]
    both, first = csr_array(hstack(columns)), len(at[0])
    share = (again.time[1] - again.time[0]) / INDEPENDENT
    prior = np.diag(np.repeat([EXPECTED_ALONG**-2, expected_aside**-2], [len(knots) for knots in at]))

    def solve(used: np.ndarray) -> list[np.ndarray]:
        weighted = both.multiply((share * used * weight)[:, None]).T.tocsr()
        return np.split(-np.linalg.solve((weighted @ both).toarray() + prior, weighted @ residual), [first])

    even = np.tile((again.time[kept] / SECOND).astype(int) % 2 == 0, len(residual) // kept.sum())
    held_out = [(~used * weight, solve(used)) for used in (even, ~even)]
    corrections = []
    for i, values in enumerate(solve(np.ones(len(residual)))):
        guesses = [(out, columns[i] @ guess[i]) for out, guess in held_out]
        explained = -sum(np.sum(out * residual * guess) for out, guess in guesses)
        possible = sum(np.sum(out * guess**2) for out, guess in guesses)
        trusted = np.clip(explained / (possible + 1e-300), 0.0, 1.0)
        if i == 0:
            values = values - (leftover.hats(again.place[kept], at[0]) @ values).mean()
        corrections.append(trusted * (leftover.hats(again.place, at[i]) @ values))
    along, aside = corrections
    return along, aside
