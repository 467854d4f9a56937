"""Where across the road a drive went, and how its place wandered: found by the roughness that the wheels met."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, hstack

from ..errors import InputError
from . import leftover, place
from .replay import Replay, Simulated, replay

STEP = 0.1
"""m; the roughness under a tyre is another one a tenth of a metre aside."""

KNOWN, WRONG = 0.4, 1.2
"""m searched to both sides of a path that is recorded or told, and where it is none of those."""

COARSE = 0.2
"""m between the paths that are tried where none is known: half of it aside, nine tenths of the agreement are left."""

TIE = 1e-6
"""m by which a path on the edge of what the road allows is still on it."""

END = 0.01
"""m from an end of what is searched at which a path lies at it."""

ELSEWHERE = 1.5
"""Times by which a record has to agree better at a clock beyond the search than within: a body in bounce comes back to it in 0.7 s."""

NO_BETTER = 1e-3
"""Difference in agreement or misfit by which no path is better than another: a road that is even across does not tell."""

MIRRORED = 0.7
"""Share of the misfit on a recorded path that is left on the same path with its sign reversed from which on that is the true one: of an e of the
wrong sign that swings by 6 to 30 cm (rms) 0.06 to 0.5, by 5 cm 0.6 to 0.9; of one of the right sign 1.2 to 18, 0.95 where it drifts by 0.2 m, and 1 where it
is noise."""

SEARCHED = 45.0
"""s of a drive that its path is looked for with."""

HALF_VEHICLE = 0.9
"""m that the path keeps from the edges of the road."""

LEAP = 0.01
"""Share of the samples of a recorded path that may leap to either side off the road."""

EXPECTED_ASIDE, EXPECTED_ASIDE_MEASURED, EXPECTED_ALONG = 0.1, 0.02, 0.03
"""m; usual size of the wandering across the road, where e was recorded, and along it."""

SECOND = 1.0
"""s of a drive that are left out together when a wandering is put to the test."""

INDEPENDENT = 0.1
"""s; residuals closer than this count as one observation against the expected sizes."""


def has_offset(drive: xr.Dataset) -> bool:
    """Whether the drive holds its lateral offset e."""
    return bool(np.isfinite(drive["e"].values).all())


def is_known(drive: xr.Dataset) -> bool:
    """Whether the drive's path was recorded or told."""
    return bool(np.isfinite(drive.attrs["lateral_position"])) or has_offset(drive)


def free(drive: xr.Dataset, road) -> tuple[float, float]:
    """m to the right (negative) and to the left that the drive's path may be moved by on this road: half the vehicle stays on it."""
    surface = getattr(road, "road", road)
    if has_offset(drive):
        lowest, highest = float(drive["e"].min()), float(drive["e"].max())
    else:
        lowest = highest = float(np.nan_to_num(drive.attrs["lateral_position"]))
    return float(surface["v"][0]) + HALF_VEHICLE - lowest, float(surface["v"][-1]) - HALF_VEHICLE - highest


def ends(drive: xr.Dataset, road) -> tuple[float, float]:
    """m to the right (negative) and to the left of the drive's path between which its true one is looked for."""
    right, left = free(drive, road)
    if is_known(drive):
        right, left = max(right, -WRONG), min(left, WRONG)
    return STEP * np.ceil((right - TIE) / STEP), STEP * np.floor((left + TIE) / STEP)


def is_at_an_end(drive: xr.Dataset, road, lateral: float) -> bool:
    """Whether a path that was found (m to the left of the drive's) lies where the search for it ends, or beyond."""
    right, left = ends(drive, road)
    return left - right > 2 * STEP - TIE and not right + END < lateral < left - END


def require_on_road(drive: xr.Dataset, road) -> None:
    """Raise InputError where a path that was recorded or told lies too far off the road for its true one to be looked for there."""
    if not is_known(drive):
        return
    aside = drive["e"].values if has_offset(drive) else drive.attrs["lateral_position"]
    lowest, highest = np.quantile(aside, (LEAP, 1.0 - LEAP))
    v = getattr(road, "road", road)["v"].values
    right, left, reach = float(v[0]) + HALF_VEHICLE, float(v[-1]) - HALF_VEHICLE, WRONG - 2 * STEP + TIE
    if lowest < right - reach or highest > left + reach:
        raise InputError(
            f"its path, as recorded or told, lies {lowest:+.2f} to {highest:+.2f} m to the left of the reference line (expected "
            f"{right:+.2f} to {left:+.2f} m, where half the vehicle keeps on the road; is lateral_position or e right, is the road as wide as the drive?)",
            place=f"drive {drive.attrs['name']}",
        )


def part(drive: xr.Dataset) -> xr.Dataset:
    """The SEARCHED seconds in the middle of the drive that its path is looked for with."""
    length = int(SEARCHED / float(drive["time"][1] - drive["time"][0]))
    middle = max(0, (drive.sizes["time"] - length) // 2)
    return drive.isel(time=slice(middle, middle + length))


def search(
    work: xr.Dataset, road, vehicle, simulate, options: Mapping, *, clock: float, reach: float, tried=None
) -> tuple[float, float, float]:
    """Path and clock together, coarsely: m to the left of the recorded path, s that the inertial signals lag behind, agreement there.

    All paths that the road allows are tried, or those ``tried`` (m). A wrong clock hides the path and a wrong path the clock,
    but one simulation tells all clocks. ``work`` has been moved by ``clock`` (s) already; lags that leave the clock within
    ``reach`` (s) go before those beyond, up to ``place.FARTHEST``. Agreement: ``place.shaken``.
    """
    if tried is None:
        right, left = free(work, road)
        tried = COARSE * np.arange(np.ceil((right - TIE) / COARSE), np.floor((left + TIE) / COARSE) + 1)
    short, found = part(work), (0.0, 0.0, -np.inf)
    farthest = place.FARTHEST if work.attrs["place_measured"] else reach
    for lateral in sorted(map(float, tried), key=abs) or [0.0]:
        again = replay(short, road, simulate, lateral_correction=lateral, options=options)
        lags, agreement = place.shaken(again, again(vehicle), farthest)
        weight = np.where(np.abs(clock + lags) <= reach, 1.0, 1.0 / ELSEWHERE)
        best = int(np.argmax(weight * agreement))
        if weight[best] * agreement[best] > found[2] + NO_BETTER:
            found = lateral, float(lags[best]), float(weight[best] * agreement[best])
    lateral, lag, agreement = found
    return lateral, lag, agreement * (1.0 if abs(clock + lag) <= reach else ELSEWHERE)


def find_offset(work: xr.Dataset, road, vehicle, simulate, options: Mapping, around: float | None = None) -> float:
    """m to the left of the recorded path at which model and measurement agree best.

    From SEARCHED seconds in the middle of the drive: a search over both sides of the recorded path, or of one that lies
    ``around`` (m) to its left, then a bounded minimum around the best. The road that the wheels meet aside is another road, so no
    parameter of the vehicle can take its part.
    """
    right, left = free(work, road)
    work = part(work)

    misfit = lambda lateral: _misfit(work, road, vehicle, simulate, options, float(lateral))
    middle = 0 if around is None else round(around / STEP)
    for reach in (KNOWN, WRONG) if around is None else (COARSE, KNOWN, WRONG):
        trials = np.arange(middle - round(reach / STEP), middle + round(reach / STEP) + 1) * STEP
        trials = trials[(trials >= right - TIE) & (trials <= left + TIE)]
        if trials.size < 3:
            return middle * STEP
        misfits = [misfit(trial) for trial in trials]
        if max(misfits) - min(misfits) < NO_BETTER:
            return middle * STEP
        best = trials[int(np.argmin(misfits))]
        if trials[0] < best < trials[-1]:
            break
    bounds = max(best - STEP, trials[0]), min(best + STEP, trials[-1])
    return float(minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 5e-3}).x)


def _misfit(work: xr.Dataset, road, vehicle, simulate, options: Mapping, lateral: float) -> float:
    again = replay(work, road, simulate, lateral_correction=lateral, options=options)
    return place.misfit(again, again(vehicle))


def mirrored(work: xr.Dataset, road, vehicle, simulate, options: Mapping, lateral: float) -> tuple[xr.Dataset, float, str]:
    """The drive and its path, m to the left of the recorded one (``lateral``), with the sign of its e reversed where the road then fits far
    better, and words on that; else as they are. A path that was not recorded has no sign."""
    other, as_it_is = work.assign(e=-work["e"]).assign_attrs(work.attrs), (work, lateral, "")
    if not has_offset(work):
        return as_it_is
    found = lambda drive, aside: _misfit(part(drive), road, vehicle, simulate, options, float(aside))
    right, left = free(other, road)
    level = 2.0 * float(work["e"].mean()) + lateral  # where its mean is that of the path that was found
    tried = [aside for aside in (0.0, level) if right - TIE <= aside <= left + TIE]
    own = found(work, lateral)
    if not tried or min(misfits := [found(other, aside) for aside in tried]) > own:
        return as_it_is
    aside = find_offset(other, road, vehicle, simulate, options, around=tried[int(np.argmin(misfits))])
    if is_at_an_end(other, road, aside) or (misfit := found(other, aside)) > min(MIRRORED * own, own - NO_BETTER):
        return as_it_is
    said = (
        f"e fits the road better with its sign reversed ({100 * misfit:.2g} % of the variance of the signals is left then, {100 * own:.2g} % as recorded): "
        "is it positive to the left (if not, change the sign of `factor` under `columns`)?"
    )
    return other, aside, said


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
