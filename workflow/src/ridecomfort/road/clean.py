"""Measurement failures in the grid of a road: found by a robust local test, repaired on request only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numba import njit
from scipy import ndimage, sparse
from scipy.sparse.linalg import spsolve

from ..errors import InputError
from . import edges, roughness

CHOICES = {"outliers": ("report", "refuse", "repair"), "holes": ("refuse", "fill")}
"""The options of `clean`; the first value of each is its default."""

THRESHOLD = 6.0
"""Robust standard deviations (1.4826 MAD) that a suspect lies away from its surroundings."""

FLOOR = 0.002
"""m; the least deviation of a suspect, so that texture on a smooth road is none."""

SUPPORT = 0.35
"""Share of a suspect's deviation that a neighbour must have, to the same side, to speak for a real defect."""

BUMP = 0.05
"""m; what rises so far and is a few cells long and wide is no road: a leaf, a bird."""

COARSEST = 0.5
"""m; in a coarser grid nothing can be told from the neighbours of a cell."""

LARGEST_HOLE = 1.0
"""m along the road that may be filled."""

_REACH = 2
"""Cells to either side that make the surroundings of a cell."""

_FOLLOWED = 5
"""Cross sections to either side that tilt and height of the road are followed over."""

_BLOCK = 100
"""Cross sections over which the spread of deviations is taken."""

_PASSES = 4
"""Most repetitions: an outlier may hide behind a larger one beside it."""

VOUCHED = 10
"""Points of a scan that must agree on the height of a dip (`survey.grid`, ``support``) for it to be real."""

MEASURED, OUTLIER, FILLED, KEPT = 0, 1, 2, 3
"""What the variable ``treated`` says of a cell; what looks like an outlier and was kept is as measured."""


@dataclass(frozen=True)
class Report:
    """What cleaning a road found and changed.

    ``outliers`` and ``filled`` count cells; ``share_changed`` is that of the
    road's cells (0 to 1), ``largest_change`` in m that of a repaired outlier, at
    ``largest_at`` (u, v). ``spectra`` holds `roughness.analyse` before and after
    (dim ``state``), or is None where the road is too short, or has holes or none of it in a track.
    """

    outliers: int
    filled: int
    share_changed: float
    largest_change: float
    largest_at: tuple[float, float] | None
    spectra: xr.Dataset | None

    def lines(self) -> list[str]:
        """What a log should say."""
        said = [f"{self.outliers} outliers repaired, {self.filled} cells of holes filled: {self.share_changed:.3%} of the road"]
        if self.largest_at is not None:
            u, v = self.largest_at
            said.append(f"largest change {self.largest_change:.4g} m at u = {u:g} m, v = {v:g} m")
        if self.spectra is not None:
            before, after = self.spectra.unevenness.mean("v").values * 1e6
            places = " and ".join(f"{track:g}" for track in self.spectra["v"].values)
            said.append(f"unevenness of the wheel tracks at {places} m, at 0.1 cycles/m {before:.4g} before, {after:.4g} cm3 after")
        return said


def find_outliers(elevation: np.ndarray, vouched: np.ndarray | None = None) -> np.ndarray:
    """True for cells (u, v) that no neighbour speaks for: measurement failures, not defects of the road.

    Deviations are those from the median of the 5 x 5 cells around, after the
    level and tilt of each cross section. A suspect deviates by more than
    `THRESHOLD` robust standard deviations and `FLOOR`. It is an outlier unless two
    of its eight neighbours (one at an edge, or one for which two speak) lie
    `SUPPORT` of its deviation or more to the same side: potholes and joints are
    larger than a cell or two. A smaller dip looks like an outlier in the grid and
    is kept only where ``vouched`` (u, v) is True: many points of a scan saw it. A
    bump above `BUMP` is an outlier unless it extends along the road or across it.
    Repeated without those found until none is, `_PASSES` times at most.
    """
    found = np.zeros(elevation.shape, dtype=bool)
    vouched = found.copy() if vouched is None else vouched
    for _ in range(_PASSES):
        kept = np.where(found, np.nan, elevation)
        level = _level(kept)
        deviation = _deviation(level)
        more = _unsupported(level, deviation, _thresholds(deviation), vouched)
        if not more.any():
            break
        found |= more
    return found


def fill(elevation: np.ndarray, spacing: tuple[float, float], *, inside: np.ndarray | None = None) -> np.ndarray:
    """Heights (u, v) with the holes inside the road closed by a stretched membrane; edges stay NaN.

    The membrane solves Laplace's equation over each hole, held by the heights
    around it. ``inside`` (u, v) tells what belongs to the road: by default what
    lies between heights of its cross section, and cross sections lost as a whole
    as far as their neighbours reach.
    """
    hole = (_inside(elevation) if inside is None else inside) & ~np.isfinite(elevation)
    if not hole.any():
        return elevation
    filled = elevation.copy()
    filled[hole] = _membrane(elevation, hole, spacing)
    return filled


def clean(road: xr.Dataset, **options: str) -> tuple[xr.Dataset, Report]:
    """The road without the measurement failures that the options name, and what was done.

    outliers
        ``report`` how many there are and keep them, ``refuse``, or ``repair``:
        blank and fill them.
    holes
        ``refuse`` or ``fill``, those of repaired outliers apart.

    The road gains ``treated`` (u, v): 0 as measured, 1 a repaired outlier, 2 a
    filled hole, 3 what looks like an outlier and was kept; ``treatment`` gains a
    line for each step. A road with the ``support`` of `survey.grid` is a scan: dips
    that `VOUCHED` points agree on are no outliers, and notches in its edge no longer
    than `LARGEST_HOLE` are holes, for the edge is that of the scanner's swath.
    Raises InputError for what is to be refused.
    """
    chosen = _choose(options)
    elevation = road.elevation.values
    u, v = road.u.values, road.v.values
    spacing = (u[-1] - u[0]) / (len(u) - 1), (v[-1] - v[0]) / (len(v) - 1)
    coarse = bool(max(spacing) > COARSEST)
    too_coarse = f"cells of {spacing[0]:g} m x {spacing[1]:g} m are too coarse to be tested for outliers"
    if coarse and chosen["outliers"] == "refuse":
        raise InputError(f"{too_coarse} (or outliers: report)", place="road.outliers")
    vouched = road.support.values >= VOUCHED if "support" in road else None
    outlier = np.zeros(elevation.shape, dtype=bool) if coarse else find_outliers(elevation, vouched)
    kept = np.zeros_like(outlier)
    inside = _inside(elevation)
    if "support" in road:
        inside = _swath(inside, round(LARGEST_HOLE / spacing[0]))
    hole = inside & ~np.isfinite(elevation)
    said = [road.attrs.get("treatment", "")] if road.attrs.get("treatment") else []
    before = len(said)
    if outlier.any() and chosen["outliers"] != "repair":
        i, j = np.argwhere(outlier)[0]
        where = f"the first at u = {u[i]:g} m, v = {v[j]:g} m"
        if chosen["outliers"] == "refuse":
            raise InputError(f"{outlier.sum()} outliers, {where} (or outliers: repair)", place="road.outliers")
        said.append(f"{outlier.sum()} cells look like outliers, {where}: kept")
        outlier, kept = kept, outlier
    if hole.any() and chosen["holes"] == "refuse":
        i, j = np.argwhere(hole)[0]
        raise InputError(
            f"{hole.sum()} cells without a height (holes), the first at u = {u[i]:g} m, v = {v[j]:g} m (or holes: fill)", place="road.holes"
        )
    _refuse_long(outlier, hole, u, v)
    banking = road.bank.values[:, None] * v
    repaired = fill(np.where(outlier, np.nan, elevation) - banking, spacing, inside=inside) + banking
    repaired = np.where(outlier | hole, repaired, elevation)
    treated = np.select([outlier, hole, kept], [OUTLIER, FILLED, KEPT], MEASURED).astype(np.int8)
    cleaned = road.copy()
    cleaned["elevation"] = (("u", "v"), repaired, road.elevation.attrs)
    cleaned["treated"] = (
        ("u", "v"),
        treated,
        {
            "long_name": "what was done to the height of the cell",
            "flag_values": np.arange(4, dtype=np.int8),
            "flag_meanings": "measured outlier_repaired hole_filled outlier_kept",
        },
    )
    report = _report(road, cleaned, outlier, hole)
    if outlier.any() or hole.any():
        said += report.lines() + ([too_coarse] if coarse else [])
    elif coarse:
        said.append(f"no holes; {too_coarse}")
    elif len(said) == before:
        said.append("no outliers and no holes found")
    cleaned.attrs["treatment"] = "\n".join(said)
    return cleaned, report


def _refuse_long(outlier: np.ndarray, hole: np.ndarray, u: np.ndarray, v: np.ndarray) -> None:
    """InputError where cells (u, v) to be filled follow one another along u for more than `LARGEST_HOLE`."""
    run = _longest_run(outlier | hole)
    spacing = (u[-1] - u[0]) / (len(u) - 1)
    if run.max() * spacing <= LARGEST_HOLE + 1e-9:
        return
    i, j = np.unravel_index(run.argmax(), run.shape)
    found = slice(i + 1 - run[i, j], i + 1), j
    kinds = [kind for kind, cells in (("outliers", outlier), ("holes", hole)) if cells[found].any()]
    raise InputError(
        f"{' and '.join(kinds)} over {run.max() * spacing:g} m to u = {u[i]:g} m, v = {v[j]:g} m; at most {LARGEST_HOLE:g} m are filled",
        place=f"road.{kinds[0]}",
    )


def _choose(options: dict) -> dict:
    for name, value in options.items():
        if name not in CHOICES:
            raise InputError(f"unknown option, expected one of {', '.join(CHOICES)}", place=f"road.{name}")
        if value not in CHOICES[name]:
            raise InputError(f"{value!r}, expected one of {', '.join(CHOICES[name])}", place=f"road.{name}")
    return {name: options.get(name, values[0]) for name, values in CHOICES.items()}


def _report(road, cleaned, outlier, hole) -> Report:
    change = np.abs(np.where(outlier, cleaned.elevation.values - road.elevation.values, 0.0))
    i, j = np.unravel_index(change.argmax(), change.shape)
    try:
        states = [roughness.analyse(state) for state in (road, cleaned)]
        spectra = xr.concat(states, xr.DataArray(["before", "after"], dims="state", name="state"))
    except ValueError:
        spectra = None
    return Report(
        outliers=int(outlier.sum()),
        filled=int(hole.sum()),
        share_changed=float((outlier | hole).sum() / _inside(road.elevation.values).sum()),
        largest_change=float(change.max()),
        largest_at=(float(road.u[i]), float(road.v[j])) if change.max() > 0 else None,
        spectra=spectra,
    )


def _inside(elevation: np.ndarray) -> np.ndarray:
    """True for cells (u, v) between the edges of the road, which empty cross sections take from their neighbours."""
    beyond = edges.outside(elevation)
    empty = beyond.all(axis=1)
    if empty.any() and not empty.all():
        rows = np.arange(len(elevation))
        full = np.flatnonzero(~empty)
        before = full[np.clip(np.searchsorted(full, rows, side="right") - 1, 0, None)]
        after = full[np.clip(np.searchsorted(full, rows), None, full.size - 1)]
        between = (rows > full[0]) & (rows < full[-1])
        beyond = np.where(empty[:, None], beyond[before] | beyond[after] | ~between[:, None], beyond)
    return ~beyond


def _swath(inside: np.ndarray, cells: int) -> np.ndarray:
    """What lies inside (u, v), with notches of up to so many cells along u closed."""
    padded = np.pad(inside, ((cells, cells), (0, 0)), mode="edge")
    closed = ndimage.binary_closing(padded, np.ones((cells + 1, 1)))
    return inside | closed[cells : len(closed) - cells]


def _level(elevation: np.ndarray) -> np.ndarray:
    """Heights above a plane that follows the road: its tilt from how the left half lies above the right one.

    Tilt and height are running medians along u, so that they pass over joints.
    """
    half = elevation.shape[1] // 2
    tilt = _running_median(_median(elevation[:, half : 2 * half] - elevation[:, :half])) / max(half, 1)
    tilted = elevation - tilt[:, None] * np.arange(elevation.shape[1])
    return tilted - _running_median(_median(tilted))[:, None]


def _running_median(values: np.ndarray) -> np.ndarray:
    """Median of `_FOLLOWED` values to either side, fewer at the ends so that it stays centred; NaN is left out."""
    padded = np.full(len(values) + 2 * _FOLLOWED, np.nan)
    padded[_FOLLOWED:-_FOLLOWED] = values
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _FOLLOWED + 1)
    medians = _median(windows)
    for edge in range(min(_FOLLOWED, len(values) // 2)):
        medians[edge] = _median(values[None, : 2 * edge + 1])[0]
        medians[-1 - edge] = _median(values[None, len(values) - 2 * edge - 1 :])[0]
    return np.where(np.isfinite(medians), medians, 0.0)


def _median(values: np.ndarray) -> np.ndarray:
    """Median of the finite values in each row; NaN where there is none."""
    ordered = np.sort(values, axis=1)
    count = np.isfinite(ordered).sum(axis=1)
    low, high = (np.clip(place, 0, None) for place in ((count - 1) // 2, count // 2))
    rows = np.arange(len(values))
    high = np.minimum(high, count.clip(1) - 1)
    return np.where(count > 0, 0.5 * (ordered[rows, low] + ordered[rows, high]), np.nan)


@njit(cache=True)
def _deviation(level):
    """Heights above the median of the cells within reach."""
    nu, nv = level.shape
    deviation = np.full((nu, nv), np.nan)
    near = np.empty((2 * _REACH + 1) ** 2)
    for i in range(nu):
        for j in range(nv):
            if not np.isfinite(level[i, j]):
                continue
            count = 0
            for k in range(max(i - _REACH, 0), min(i + _REACH + 1, nu)):
                for m in range(max(j - _REACH, 0), min(j + _REACH + 1, nv)):
                    if np.isfinite(level[k, m]):
                        near[count] = level[k, m]
                        count += 1
            deviation[i, j] = level[i, j] - np.median(near[:count])
    return deviation


def _thresholds(deviation: np.ndarray) -> np.ndarray:
    """Deviation (u) in m from which a cell is a suspect, from the spread of those around."""
    limits = np.empty(len(deviation))
    for start in range(0, len(deviation), _BLOCK):
        block = np.abs(deviation[max(start - _BLOCK // 2, 0) : start + _BLOCK + _BLOCK // 2])
        known = block[np.isfinite(block)]
        spread = 1.4826 * np.median(known) if known.size else 0.0
        limits[start : start + _BLOCK] = max(THRESHOLD * spread, FLOOR)
    return limits


@njit(cache=True)
def _unsupported(level, deviation, limits, vouched):
    """True for suspects that neither their neighbours nor, for dips, many points of a scan speak for."""
    nu, nv = level.shape
    speakers = np.zeros((nu, nv), dtype=np.int8)
    one = np.zeros((nu, nv, 2), dtype=np.int64)
    at_edge = np.zeros((nu, nv), dtype=np.bool_)
    for i in range(nu):
        for j in range(nv):
            here = deviation[i, j]
            if not abs(here) > limits[i]:
                continue
            for k in range(i - 1, i + 2):
                for m in range(j - 1, j + 2):
                    if k < 0 or m < 0 or k >= nu or m >= nv or not np.isfinite(level[k, m]):
                        at_edge[i, j] = True
                    elif (k != i or m != j) and 1.0 - (level[i, j] - level[k, m]) / here >= SUPPORT:
                        speakers[i, j] += 1
                        one[i, j, 0], one[i, j, 1] = k, m
    alone = np.zeros((nu, nv), dtype=np.bool_)
    for i in range(nu):
        for j in range(nv):
            here = deviation[i, j]
            if abs(here) > limits[i]:
                chain = speakers[i, j] == 1 and (at_edge[i, j] or speakers[one[i, j, 0], one[i, j, 1]] >= 2)
                is_leaf = here > BUMP and not _extends(level, i, j, here)
                seen = here < 0 and vouched[i, j]
                alone[i, j] = is_leaf or not (speakers[i, j] >= 2 or chain or seen)
    return alone


@njit(cache=True)
def _extends(level, i, j, here):
    """Whether most cells three to six away along the road or across it rise with this one: a kerb or a ridge."""
    for along in (0, 1):
        rising = 0
        for distance in (-6, -5, -4, -3, 3, 4, 5, 6):
            k, m = i + along * distance, j + (1 - along) * distance
            if 0 <= k < level.shape[0] and 0 <= m < level.shape[1]:
                rising += 1.0 - (level[i, j] - level[k, m]) / here >= SUPPORT
        if rising >= 4:
            return True
    return False


def _longest_run(hole: np.ndarray) -> np.ndarray:
    """Number of hole cells in a row along u up to and with each cell."""
    run = np.zeros(hole.shape, dtype=int)
    run[0] = hole[0]
    for i in range(1, len(hole)):
        run[i] = (run[i - 1] + 1) * hole[i]
    return run


def _membrane(elevation: np.ndarray, hole: np.ndarray, spacing: tuple[float, float]) -> np.ndarray:
    """Heights of the hole cells, each the weighted mean of its four neighbours."""
    number = np.full(hole.shape, -1)
    number[hole] = np.arange(hole.sum())
    i, j = np.nonzero(hole)
    rows, columns, entries = [], [], []
    diagonal, right_side = np.zeros(i.size), np.zeros(i.size)
    for step_u, step_v, distance in ((1, 0, spacing[0]), (-1, 0, spacing[0]), (0, 1, spacing[1]), (0, -1, spacing[1])):
        k, m = i + step_u, j + step_v
        in_grid = (k >= 0) & (k < hole.shape[0]) & (m >= 0) & (m < hole.shape[1])
        k, m = np.where(in_grid, k, i), np.where(in_grid, m, j)
        weight = 1.0 / distance**2
        known = in_grid & np.isfinite(elevation[k, m])
        unknown = in_grid & hole[k, m]
        diagonal += weight * (known | unknown)
        right_side[known] += weight * elevation[k, m][known]
        rows.append(np.flatnonzero(unknown))
        columns.append(number[k, m][unknown])
        entries.append(np.full(unknown.sum(), -weight))
    matrix = sparse.csc_array(
        (np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=(i.size, i.size)
    )
    return spsolve(matrix + sparse.diags_array(diagonal, format="csc"), right_side)
