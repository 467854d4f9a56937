"""Where the grid of a road holds heights: its edges, the holes in it, and what lies beyond."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ..errors import InputError

NOTCH = 1.0
"""m along the road; an edge is not told from notches no longer than a hole that may be filled."""


def outside(elevation: np.ndarray) -> np.ndarray:
    """True for cells (u, v) that lie to the right or left of every height of their cross section.

    Cross sections without any height lie outside as a whole.
    """
    known = np.isfinite(elevation)
    reached_from_right = np.logical_or.accumulate(known, axis=1)
    reached_from_left = np.logical_or.accumulate(known[:, ::-1], axis=1)[:, ::-1]
    return ~(reached_from_right & reached_from_left)


def holes(elevation: np.ndarray) -> np.ndarray:
    """True for cells (u, v) without a height that lie between heights of their cross section."""
    return ~np.isfinite(elevation) & ~outside(elevation)


def sides(elevation: np.ndarray, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Right and left end in m of the heights of each cross section (u,), notches of up to ``NOTCH`` m along bridged."""
    inside = ~outside(elevation)
    some = inside.any(axis=1)
    right = np.where(some, v[inside.argmax(axis=1)], v[-1])
    left = np.where(some, v[len(v) - 1 - inside[:, ::-1].argmax(axis=1)], v[0])
    # The middle of a notch of n cross sections sees a whole one at (n + 1) / 2 to either side; what has widened by that is taken back.
    size = 2 * int(0.5 * NOTCH / (u[1] - u[0]) + 0.5 + 1e-6) + 1
    bridged = lambda ends: ndimage.minimum_filter1d(ndimage.maximum_filter1d(ends, size, mode="nearest"), size, mode="nearest")
    return -bridged(-right), bridged(left)


def extend(elevation: np.ndarray, v: np.ndarray, bank: np.ndarray, offset: float = 0.0) -> np.ndarray:
    """Heights (u, v) in m with every cell outside the road filled.

    A cell takes the height of the nearest cell across that has one, carried on
    with the cross slope ``bank`` (u) and raised by ``offset`` m: what OpenCRG's
    grid_nan_mode 2 gives. A cross section without any height takes the nearest
    one along the road that has. Holes inside the road stay. Raises InputError for a road without any height.
    """
    beyond = outside(elevation)
    if not beyond.any():
        return elevation
    relative = elevation - bank[:, None] * v
    filled_rows = np.flatnonzero(~beyond.all(axis=1))
    if not filled_rows.size:
        raise InputError("holds no height at all, expected some", place="road")
    rows = np.arange(len(relative))
    after = np.searchsorted(filled_rows, rows).clip(max=filled_rows.size - 1)
    before = (after - 1).clip(min=0)
    nearer = rows - filled_rows[before] < np.abs(filled_rows[after] - rows)
    nearest = np.where(nearer & (filled_rows[before] <= rows), filled_rows[before], filled_rows[after])
    nearest[filled_rows] = filled_rows
    inside = ~beyond[nearest]
    first = inside.argmax(axis=1)
    last = len(v) - 1 - inside[:, ::-1].argmax(axis=1)
    column = np.clip(np.arange(len(v)), first[:, None], last[:, None])
    carried = relative[nearest[:, None], column] + offset
    return np.where(beyond, carried + bank[:, None] * v, elevation)
