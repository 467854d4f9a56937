"""Where across the road a drive went, and how its place wandered: found by the roughness that the wheels met."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array

from . import place
from .replay import Replay, Simulated, replay

STEP = 0.1
"""m; the roughness under a tyre is another one a tenth of a metre aside."""

KNOWN, UNKNOWN = 0.4, 1.2
"""m searched to both sides of the recorded path, or of the reference line where none is recorded."""

SEARCHED = 45.0
"""s of a drive that its path is looked for with."""

HALF_VEHICLE = 0.9
"""m that the path keeps from the edges of the road."""

KNOTS = 50.0
"""m between the points at which a wandering is estimated; drivers and satellite fixes wander no faster."""

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
    reach = KNOWN if known else UNKNOWN
    left = float(surface["v"][-1]) - HALF_VEHICLE - highest
    right = float(surface["v"][0]) + HALF_VEHICLE - lowest
    trials = np.arange(-round(reach / STEP), round(reach / STEP) + 1) * STEP
    trials = trials[(trials >= right) & (trials <= left)]
    if trials.size < 3:
        return 0.0

    def misfit(lateral: float) -> float:
        again = replay(work, road, simulate, lateral_correction=float(lateral), options=options)
        return place.misfit(again, again(vehicle))

    best = trials[int(np.argmin([misfit(trial) for trial in trials]))]
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
    weight = 1 / (residual.var(axis=1) + 1e-10)
    speed = np.gradient(again.place, again.time)[kept]
    columns = (simulated.slopes[:, kept] / speed, again.aside(vehicle)[:, kept])
    knots = np.linspace(again.place[0], again.place[-1], max(2, int(round(np.ptp(again.place) / KNOTS)) + 1))
    hats = _hats(again.place[kept], knots)
    share = (again.time[1] - again.time[0]) / INDEPENDENT
    prior = np.diag(np.repeat([EXPECTED_ALONG**-2, expected_aside**-2], len(knots)))
    squares = [[share * np.einsum("s,st,st->t", weight, one, other) for other in columns] for one in columns]
    scores = [share * np.einsum("s,st,st->t", weight, one, residual) for one in columns]

    def solve(used: np.ndarray) -> np.ndarray:
        blocks = [[(hats.T @ (hats * (used * square)[:, None])).toarray() for square in row] for row in squares]
        right = np.concatenate([hats.T @ (used * score) for score in scores])
        return -np.linalg.solve(np.block(blocks) + prior, right).reshape(2, -1)

    even = (again.time[kept] / SECOND).astype(int) % 2 == 0
    held_out = [(~used, [hats @ values for values in solve(used)]) for used in (even, ~even)]
    trusted = []
    for i in range(2):
        explained = -sum(np.sum(out * scores[i] * guess[i]) for out, guess in held_out)
        possible = sum(np.sum(out * squares[i][i] * guess[i] ** 2) for out, guess in held_out)
        trusted.append(np.clip(explained / (possible + 1e-300), 0.0, 1.0))
    along, aside = (share * values for share, values in zip(trusted, solve(np.ones(kept.sum()))))
    everywhere = _hats(again.place, knots)
    return everywhere @ (along - along.mean()), everywhere @ aside


def _hats(position: np.ndarray, knots: np.ndarray) -> csr_array:
    """Values at positions of the piecewise linear functions that are one at a knot each, (position, knot)."""
    spacing = knots[1] - knots[0]
    left = np.clip(((position - knots[0]) / spacing).astype(int), 0, len(knots) - 2)
    part = np.clip((position - knots[left]) / spacing, 0.0, 1.0)
    rows = np.arange(len(position))
    return csr_array(
        (np.concatenate([1 - part, part]), (np.tile(rows, 2), np.concatenate([left, left + 1]))),
        shape=(len(position), len(knots)),
    )
