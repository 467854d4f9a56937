"""What alignment may have left of a drive's clock, place, path and mounting, and how it would show in the signals.

None of it is known better than the drive itself tells, so a fit of the vehicle must ask for it
again: what the vehicle and an error of the record can both explain is known of neither.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import coo_array, csr_array, hstack, vstack

from ..vehicle.driver import PREVIEW_TIME, SPEED_PREVIEW_TIME
from . import mounting
from .replay import CLOCK_LEFT, Replay, Simulated

KNOTS, KNOTS_ALONG = 25.0, 50.0
"""m between the points at which alignment looks for errors of the path and of the place along it; drivers and
satellite fixes wander no faster."""

FINE_KNOTS = {"lateral": 10.0, "speed": 25.0}
"""m between the points at which a fit asks again for the path and the speed: a path that is smoother than the true one
makes side forces smaller, and a fit would answer with another friction."""

LEFT = {"lateral": 0.02, "speed": 0.02, "along": 0.01}
"""m, m/s and m; usual size of what alignment leaves at a knot."""

GAIN_LEFT = 0.005
"""Usual difference between the gains of an instrument's axes; data sheets promise half a percent."""

APART = 100.0
"""m between knots that are moved in the same simulation: their effects fade before they meet."""

MOVED = {"lateral": 0.02, "speed": 0.05}
"""m and m/s that a knot is moved by to see what it does."""

LOOK_AHEAD = {"lateral": PREVIEW_TIME, "speed": SPEED_PREVIEW_TIME}
"""s that the driver model is asked for a change before it is wanted."""

FLOOR = 0.01
"""NRMSE of a signal that noise alone leaves, against which expected sizes count."""

INDEPENDENT = 0.1
"""s; residuals closer than this count as one observation against the expected sizes."""


@dataclass(frozen=True)
class Leftover:
    """``columns``: change of the residual (6 * compared, error) per error; ``expected``: usual sizes of the errors.

    Errors: clock (s), the seven of the mounting, the gains of the six signals, then knots: of the place along ("along", m), of the path
    ("lateral", m, to the left) and of the speed ("speed", m/s); ``parts`` says where each begins and ends.
    """

    columns: csr_array
    expected: np.ndarray
    parts: Mapping[str, slice]

    def through(self, passing: csr_array) -> Leftover:
        """The same, each signal passed through a filter, a matrix over its samples."""
        count = self.columns.shape[0] // 6
        parts = [passing @ self.columns[k * count : (k + 1) * count] for k in range(6)]
        return replace(self, columns=csr_array(vstack(parts)))

    def scaled(self, signals: list[int], scale: np.ndarray, share: float) -> Projection:
        """The projection for residuals of some signals (rows of SIGNALS) divided by ``scale`` (signal,).

        ``share``: weight of one observation against the expected sizes.
        """
        count = self.columns.shape[0] // 6
        rows = (np.asarray(signals)[:, None] * count + np.arange(count)).ravel()
        columns = csr_array(self.columns[rows].multiply(1 / np.repeat(scale, count)[:, None]))
        return Projection(columns, share / self.expected**2, self.parts)


class Projection:
    """Takes the errors that explain a residual best, the usual sizes in mind, out of it."""

    def __init__(self, columns: csr_array, prior: np.ndarray, parts: Mapping[str, slice]):
        self.columns, self.prior, self.parts = columns, prior, parts
        self.driven = np.zeros(prior.size)
        self._normal = (columns.T @ columns).toarray() + np.diag(prior)
        self._all = cho_factor(self._normal)
        self._timed = cho_factor(self._normal[1:, 1:])

    def about(self, driven: np.ndarray) -> Projection:
        """The same where these of the errors are driven already: the usual sizes still count from nought."""
        other = copy(self)
        other.driven = driven
        return other

    def change(self, rows: np.ndarray, clock: bool = True) -> np.ndarray:
        """What is left of a small change of the residual, (signal, sample, n); ``clock``: whether it is free to move."""
        flat = rows.reshape(-1, rows.shape[-1])
        right = self.columns.T @ flat
        if clock:
            errors = cho_solve(self._all, right)
        else:
            errors = np.concatenate([np.zeros((1, right.shape[1])), cho_solve(self._timed, right[1:])])
        return (flat - self.columns @ errors).reshape(rows.shape)

    def errors(self, residual: np.ndarray) -> np.ndarray:
        """The errors that a residual (signal, sample) asks for; the clock no further off than CLOCK_LEFT."""
        right = self.columns.T @ residual.ravel() - self.prior * self.driven
        errors = cho_solve(self._all, right)
        if abs(errors[0]) > CLOCK_LEFT:
            errors[0] = np.copysign(CLOCK_LEFT, errors[0])
            errors[1:] = cho_solve(self._timed, right[1:] - self._normal[1:, 0] * errors[0])
        return errors

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """The residual (signal, sample) without them."""
        return residual - (self.columns @ self.errors(residual)).reshape(residual.shape)


def leftover(again: Replay, vehicle, effects=(), *, driven: bool = True) -> Leftover:
    """Columns of all errors of a drive, about a vehicle that fits it roughly; those of path and speed if ``driven``."""
    simulated = again(vehicle, effects)
    axes = np.eye(6)[:, :, None] * simulated.signals
    fixed = np.concatenate([simulated.slopes[None], -mounting.responses(simulated), -axes])[:, :, again.compared]
    expected = [np.concatenate([[CLOCK_LEFT], mounting.LEFT, np.full(6, GAIN_LEFT)])]
    columns = [csr_array(fixed.reshape(len(fixed), -1).T)]
    parts, first = {}, len(fixed)
    for name in ("along", "lateral", "speed") if driven else ("along",):
        at = knots(again, FINE_KNOTS.get(name, KNOTS_ALONG))
        if name == "along":
            columns.append(moved_along(again, simulated, at))
        else:
            columns.append(-moved(again, name, vehicle, effects, at, simulated))
        expected.append(np.full(len(at), LEFT[name]))
        parts[name] = slice(first, first + len(at))
        first += len(at)
    return Leftover(hstack(columns, format="csr"), np.concatenate(expected), parts)


def corrected(again: Replay, projection: Projection, residual: np.ndarray) -> tuple[Replay, Projection]:
    """The same drive with the driver asked for the path and the speed that a residual asks for, and what is left then."""
    errors = projection.errors(residual)
    demand, driven = dict(again.demand), projection.driven.copy()
    for name, spacing in FINE_KNOTS.items():
        part = projection.parts[name]
        demand[name] = demand[name] + _asked(again, name, knots(again, spacing), errors[part])
        driven[part] += errors[part]
    return replace(again, demand=demand), projection.about(driven)


def moved_along(again: Replay, simulated: Simulated, at: np.ndarray) -> csr_array:
    """Change of the signals (6 * compared, knot) per metre that a place is farther on at a knot."""
    kept = again.compared
    speed = np.gradient(again.place, again.time)[kept]
    near = hats(again.place[kept], at)
    return csr_array(vstack([near.multiply((slope / speed)[:, None]) for slope in simulated.slopes[:, kept]]))


def moved(again: Replay, name: str, vehicle, effects, at: np.ndarray, base: Simulated) -> csr_array:
    """Change of the signals (6 * compared, knot) per m that the path lies farther left at a knot, or per m/s of speed.

    Other roughness under the wheels, another bend of the path, another acceleration: all that the simulator makes
    of it. Knots that are APART are moved together, since the vehicle forgets each before it comes to the next.
    """
    kept = again.compared
    samples, spacing = kept.sum(), at[1] - at[0]
    colours = min(int(np.ceil(APART / spacing)), len(at))
    # The driver answers a change before its knot, by as much as it is asked for early.
    place = again.place[kept] + LOOK_AHEAD[name] * np.gradient(again.place, again.time).max()
    rows, columns, values = [], [], []
    for colour in range(colours):
        change = np.zeros(len(at))
        change[colour::colours] = MOVED[name]
        demand = {**again.demand, name: again.demand[name] + _asked(again, name, at, change)}
        tried = replace(again, demand=demand)(vehicle, effects)
        difference = (tried.signals - base.signals)[:, kept] / MOVED[name]
        knot = np.floor((place - at[0]) / spacing + 1 - colour).astype(int) // colours * colours + colour
        seen = np.flatnonzero((knot >= 0) & (knot < len(at)))
        for signal in range(6):
            rows.append(signal * samples + seen)
            columns.append(knot[seen])
            values.append(difference[signal, seen])
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return csr_array(coo_array(entries, shape=(6 * samples, len(at))))


def knots(again: Replay, spacing: float) -> np.ndarray:
    """Equidistant places in m from the first to the last of a drive, about ``spacing`` apart."""
    return np.linspace(again.place[0], again.place[-1], max(2, int(round(np.ptp(again.place) / spacing)) + 1))


def hats(position: np.ndarray, at: np.ndarray) -> csr_array:
    """Values at positions of the piecewise linear functions that are one at a knot each, (position, knot)."""
    spacing = at[1] - at[0]
    left = np.clip(((position - at[0]) / spacing).astype(int), 0, len(at) - 2)
    part = np.clip((position - at[left]) / spacing, 0.0, 1.0)
    rows = np.arange(len(position))
    return csr_array(
        (np.concatenate([1 - part, part]), (np.tile(rows, 2), np.concatenate([left, left + 1]))),
        shape=(len(position), len(at)),
    )


def _asked(again: Replay, name: str, at: np.ndarray, change: np.ndarray) -> xr.DataArray:
    """What to ask the driver for over u, so that the change is driven at the knots."""
    u = again.demand["speed"]["u"].values
    early = np.interp(again.time - LOOK_AHEAD[name], again.time, again.place)
    return xr.DataArray(np.interp(u, early, hats(again.place, at) @ change), {"u": u}, "u")
