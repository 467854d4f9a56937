"""Where a road differs from what lies around: dips, bumps and joints of its own, and cells that were treated."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy import ndimage

from ..vocabulary import describe
from . import clean, edges

REACH = 5.0
"""m along the road over whose median a dip or bump is looked for."""

FLOOR = 0.005
"""m; the least depth or height of a dip or bump."""

THRESHOLD = 6.0
"""Robust standard deviations (1.4826 MAD) that its deepest or highest cell lies away from the median."""

SPREAD = 0.5
"""Share of the threshold down to which the cells around the deepest one belong to it."""

JOINT_REACH = 1.2
"""m along the road over whose median a joint is looked for: three times the length of the longest and more."""

JOINT_FLOOR = 0.001
"""m; the least depth or height of a joint, in the median across the road."""

JOINT_THRESHOLD = 3.0
"""Times the level that nine tenths of the cross sections stay below, that a joint reaches: most medians are zero."""

_BLOCK = 1000
"""Cross sections over which the spread is taken."""

KINDS = ("dip", "bump", "joint", "outlier kept", "outlier repaired", "hole filled")


def deviation(road: xr.Dataset, *, reach: float = REACH) -> np.ndarray:
    """Height (u, v) in m of each cell above the median of its track over ``reach`` m; NaN outside the road."""
    u, v = road.u.values, road.v.values
    spacing = (u[-1] - u[0]) / (len(u) - 1)
    heights = edges.extend(road.elevation.values, v, road.bank.values) - road.bank.values[:, None] * v
    window, longer = (2 * max(1, round(length / 2 / spacing)) + 1 for length in (reach, max(reach, REACH)))
    # A running mean takes the climb away, which a median near the ends would mistake for a step.
    level = ndimage.uniform_filter1d(np.nanmean(heights, axis=1), longer, mode="reflect")
    relative = heights - level[:, None]
    away = relative - ndimage.median_filter(np.nan_to_num(relative), (min(window, len(u)), 1), mode="nearest")
    return np.where(np.isfinite(road.elevation.values), away, np.nan)


def find(road: xr.Dataset, away: np.ndarray | None = None) -> xr.Dataset:
    """Dips, bumps and joints of a road, and what was treated: a row for each, in the order along the road.

    Returns ``kind`` (`KINDS`), ``u_middle`` and ``v_middle``, ``length`` along u and
    ``width`` across, ``height`` of the deepest or highest cell (negative: a dip)
    and ``cells``, over the dimension ``defect``. A dip or bump deviates from the
    median of `REACH` m of its own track (``away`` if given, else `deviation`) by
    `FLOOR` and `THRESHOLD` robust standard deviations of up to 2000 cross sections around; longer
    unevenness, such as settlements and most patches, is that of the road. A joint
    deviates over half the width at once from the median of `JOINT_REACH` m, by
    `JOINT_FLOOR` and by `JOINT_THRESHOLD` times what nine tenths of the cross
    sections around do; its ``height`` is the median across. Treated cells (variable ``treated``) are
    listed by what was done to them. In grids coarser than `clean.COARSEST` only
    these are.
    """
    u, v = road.u.values, road.v.values
    spacing = (u[-1] - u[0]) / (len(u) - 1), (v[-1] - v[0]) / (len(v) - 1)
    away = deviation(road) if away is None else away
    treated = road.treated.values if "treated" in road else np.zeros(away.shape, dtype=np.int8)
    known = np.where(np.isfinite(away) & (treated == clean.MEASURED), away, 0.0)
    rows: list[tuple] = []
    if max(spacing) <= clean.COARSEST:
        limits = _limits(np.where(treated == clean.MEASURED, away, np.nan), FLOOR, 1.4826 * THRESHOLD)[:, None]
        for kind, heights in (("dip", -known), ("bump", known)):
            rows += _components(kind, heights > SPREAD * limits, heights > limits, known)
        joints = _joints(deviation(road, reach=JOINT_REACH))
        rows = [row for row in rows if not any(_part_of(row, joint) for joint in joints)] + joints
    for kind, flag in zip(KINDS[3:], (clean.KEPT, clean.OUTLIER, clean.FILLED)):
        rows += _components(kind, treated == flag, treated == flag, np.nan_to_num(away))
    rows.sort(key=lambda row: row[1])
    columns = list(zip(*rows)) or [()] * 7
    names = ("kind", "u_middle", "v_middle", "length", "width", "height", "cells")
    scale = (None, *spacing, *spacing, None, None)
    found = {}
    for name, column, factor in zip(names, columns, scale):
        values = np.array(column, dtype=str if name == "kind" else int if name == "cells" else float)
        found[name] = ("defect", values if factor is None else values * factor)
    found["u_middle"] = ("defect", found["u_middle"][1] + u[0])
    found["v_middle"] = ("defect", found["v_middle"][1] + v[0])
    return describe(xr.Dataset(found))


def _joints(away: np.ndarray) -> list[tuple]:
    """What deviates across half of the road's width or more, as `_components` gives it."""
    known = np.isfinite(away)
    usable = known.any(axis=1)
    across = np.zeros((len(away), 1))
    across[usable, 0] = np.nanmedian(away[usable], axis=1)
    limits = _limits(across, JOINT_FLOOR, JOINT_THRESHOLD, quantile=0.9)[:, None]
    rows = []
    for sign in (-1.0, 1.0):
        for _, middle, _, length, _, height, _ in _components(
            "joint", sign * across > SPREAD * limits, sign * across > limits, across
        ):
            deepest = away[int(middle - 0.5 * length + 1) : int(middle + 0.5 * length + 1)]
            columns = np.flatnonzero((sign * deepest > SPREAD * abs(height)).any(axis=0))
            width = int(columns[-1] - columns[0]) + 1
            rows.append(("joint", middle, 0.5 * (columns[0] + columns[-1]), length, width, height, length * width))
    return rows


def _part_of(row: tuple, joint: tuple) -> bool:
    """Whether a dip or bump is nothing but a part of a joint."""
    beyond = abs(row[1] - joint[1]) + 0.5 * (row[3] - joint[3])
    return beyond <= 2 and 0.0 < row[5] / joint[5] < 1.0 / SPREAD


def _limits(away: np.ndarray, floor: float, threshold: float, quantile: float = 0.5) -> np.ndarray:
    """Deviation (u) in m from which something is found: so many times a quantile of those around, or the floor."""
    limits = np.empty(len(away))
    for start in range(0, len(away), _BLOCK):
        block = np.abs(away[max(start - _BLOCK // 2, 0) : start + _BLOCK + _BLOCK // 2])
        block = block[np.isfinite(block)]
        spread = np.quantile(block, quantile) if block.size else 0.0
        limits[start : start + _BLOCK] = max(threshold * spread, floor)
    return limits


def _components(kind: str, member: np.ndarray, core: np.ndarray, heights: np.ndarray) -> list[tuple]:
    """Kind, middle, extent, height and number of cells of each connected group of members with a core; in cells."""
    labels, _ = ndimage.label(member, structure=np.ones((3, 3)))
    rows = []
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        inside = labels[box] == number
        if not (inside & core[box]).any():
            continue
        values = heights[box][inside]
        extent = [part.stop - part.start for part in box]
        middle = [0.5 * (part.start + part.stop - 1) for part in box]
        rows.append((kind, *middle, *extent, float(values[np.abs(values).argmax()]), int(inside.sum())))
    return rows
