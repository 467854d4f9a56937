"""The height of a cell of a road's grid from the points of a scan that fell into it."""

from __future__ import annotations

import numpy as np
from numba import njit

REJECTED = 6.0
"""Robust standard deviations (1.4826 MAD) from the other points of its cell beyond which a point is dropped."""

REJECTED_FLOOR = 0.002
"""m that a point may always lie from the others."""

_LEAST = 3
"""Points that make a height."""

_SPREAD = 0.3
"""Share of a cell along u that points must spread over to speak for its height: one profile alone does not."""

_CURVED = 20
"""Points from which the curvature of the cell is fitted too."""

_PIVOT = 5e-4
"""Least weighted variance of a term, in cells, that tells it from those before it: curvature from slope and level."""


@njit(cache=True)
def fit(points, first, end, size, heights, support, counts):
    """Heights and support of the cells of cross sections ``first`` to ``end``, written into (u, v) arrays.

    ``points`` (5, n) holds cross section, column, place u and v in the cell in m
    from its middle, and height. The height of a cell is that at its middle of a
    quadratic through its points (a plane, or their mean, where they are few or
    in line), the nearest of which weigh most: that of the road at the node, not
    its average over the cell, so that a narrow dip keeps its depth. Outliers are
    dropped twice before: points far from the median, then points far from a plane
    through the others. ``counts[2]`` gains their number. ``support`` is the number
    of points left, 0 where they lie within `_SPREAD` of the cell along u.
    """
    nv = heights.shape[1]
    cells = (end - first) * nv
    start = np.zeros(cells + 1, dtype=np.int64)
    for k in range(points.shape[1]):
        start[int(points[0, k] - first) * nv + int(points[1, k]) + 1] += 1
    start = np.cumsum(start)
    order = np.empty(points.shape[1], dtype=np.int64)
    free = start[:-1].copy()
    for k in range(points.shape[1]):
        cell = int(points[0, k] - first) * nv + int(points[1, k])
        order[free[cell]] = k
        free[cell] += 1
    normal, right = np.empty((6, 6)), np.empty(6)
    for cell in range(cells):
        of_cell = order[start[cell] : start[cell + 1]]
        if len(of_cell) >= _LEAST:
            i, j = first + cell // nv, cell % nv
            level, support[i, j], kept = _plane(points[2], points[3], points[4], of_cell, size, counts)
            if support[i, j] >= _CURVED:
                level = _quadratic(points[2], points[3], points[4], of_cell, kept, size, level, normal, right)
            heights[i, j] = level


@njit(cache=True)
def _plane(du, dv, z, chosen, size, counts):
    """Height at the origin of the plane through the points without outliers, support, and which points are left."""
    level, slope_u, slope_v = np.median(z[chosen]), 0.0, 0.0
    away = np.empty(len(chosen))
    for _ in range(2):
        for k, point in enumerate(chosen):
            away[k] = abs(z[point] - level - slope_u * du[point] - slope_v * dv[point])
        limit = max(REJECTED * 1.4826 * np.median(away), REJECTED_FLOOR)
        level, slope_u, slope_v = _least_squares(du, dv, z, chosen, away <= limit)
    kept = away <= limit
    counts[2] += len(chosen) - np.sum(kept)
    nearest, furthest = np.inf, -np.inf
    for k, point in enumerate(chosen):
        if kept[k]:
            nearest, furthest = min(nearest, du[point]), max(furthest, du[point])
    return level, np.sum(kept) if furthest - nearest >= _SPREAD * size[0] else 0, kept


@njit(cache=True)
def _least_squares(du, dv, z, chosen, used):
    """Level and slopes of the plane through the used points; level only where they do not spread over the cell."""
    n = 0
    mean_u = mean_v = mean_z = 0.0
    for k, point in enumerate(chosen):
        if used[k]:
            n += 1
            mean_u += du[point]
            mean_v += dv[point]
            mean_z += z[point]
    mean_u, mean_v, mean_z = mean_u / n, mean_v / n, mean_z / n
    uu = uv = vv = uz = vz = 0.0
    for k, point in enumerate(chosen):
        if used[k]:
            a, b, c = du[point] - mean_u, dv[point] - mean_v, z[point] - mean_z
            uu += a * a
            uv += a * b
            vv += b * b
            uz += a * c
            vz += b * c
    determinant = uu * vv - uv * uv
    if n < 2 * _LEAST or determinant < 1e-4 * uu * vv or min(uu, vv) < n * 1e-5:
        return mean_z, 0.0, 0.0
    slope_u, slope_v = (uz * vv - vz * uv) / determinant, (vz * uu - uz * uv) / determinant
    return mean_z - slope_u * mean_u - slope_v * mean_v, slope_u, slope_v


@njit(cache=True)
def _quadratic(du, dv, z, chosen, kept, size, level, normal, right):
    """Height at the origin of the quadratic through the kept points, less the terms that they do not determine.

    Weighted by Tukey's biweight in each direction, 1 in the middle and 0 at the border of the cell. By Cholesky's
    method, whose pivots are the variances of each term that those before it leave over; an infinite one drops it.
    """
    normal[:], right[:] = 0.0, 0.0
    total = 0.0
    for k, point in enumerate(chosen):
        if kept[k]:
            a, b = du[point] / size[0], dv[point] / size[1]
            weight = ((1.0 - 4.0 * a * a) * (1.0 - 4.0 * b * b)) ** 2
            total += weight
            terms = (1.0, a, b, a * b, a * a, b * b)
            for i in range(6):
                for j in range(i + 1):
                    normal[i, j] += weight * terms[i] * terms[j]
                right[i] += weight * terms[i] * (z[point] - level)
    for i in range(6):
        for j in range(i + 1):
            left = normal[i, j]
            for k in range(j):
                left -= normal[i, k] * normal[j, k]
            if i > j:
                normal[i, j] = left / normal[j, j]
            elif left <= total * _PIVOT:
                normal[i, i] = np.inf
            else:
                normal[i, i] = np.sqrt(left)
        for k in range(i):
            right[i] -= normal[i, k] * right[k]
        right[i] /= normal[i, i]
    for i in range(5, -1, -1):
        for k in range(i + 1, 6):
            right[i] -= normal[k, i] * right[k]
        right[i] /= normal[i, i]
    return level + right[0]
