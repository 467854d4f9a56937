"""Heights of a road surface at any (u, v)."""

from __future__ import annotations

from numba import njit


@njit(inline="always")
def _cell(position, origin, spacing, count):
    """Index of the cell a position falls in and the place inside it (0 to 1), clamped to the grid."""
    place = (position - origin) / spacing
    if place <= 0.0:
        return 0, 0.0
    if place >= count - 1:
        return count - 2, 1.0
    index = int(place)
    return index, place - index


@njit(cache=True)
def linear(elevation, u0, du, v0, dv, u, v):
    """Height in m by bilinear interpolation, clamped to the grid at its borders (OpenCRG 1.2)."""
    i, p = _cell(u, u0, du, elevation.shape[0])
    j, q = _cell(v, v0, dv, elevation.shape[1])
    right = elevation[i, j] + p * (elevation[i + 1, j] - elevation[i, j])
    left = elevation[i, j + 1] + p * (elevation[i + 1, j + 1] - elevation[i, j + 1])
    return right + q * (left - right)


@njit(cache=True)
def cubic(elevation, u0, du, v0, dv, u, v):
    """Height in m by Catmull-Rom splines along u and v, clamped to the grid at its borders (sec:road_surf)."""
    nu, nv = elevation.shape
    i, p = _cell(u, u0, du, nu)
    j, q = _cell(v, v0, dv, nv)
    i0, i3 = max(i - 1, 0), min(i + 2, nu - 1)
    j0, j3 = max(j - 1, 0), min(j + 2, nv - 1)
    a0 = q * (-0.5 + q * (1.0 - 0.5 * q))
    a1 = 1.0 + q * q * (1.5 * q - 2.5)
    a2 = q * (0.5 + q * (2.0 - 1.5 * q))
    a3 = q * q * (0.5 * q - 0.5)
    r0 = a0 * elevation[i0, j0] + a1 * elevation[i0, j] + a2 * elevation[i0, j + 1] + a3 * elevation[i0, j3]
    r1 = a0 * elevation[i, j0] + a1 * elevation[i, j] + a2 * elevation[i, j + 1] + a3 * elevation[i, j3]
    k = i + 1
    r2 = a0 * elevation[k, j0] + a1 * elevation[k, j] + a2 * elevation[k, j + 1] + a3 * elevation[k, j3]
    r3 = a0 * elevation[i3, j0] + a1 * elevation[i3, j] + a2 * elevation[i3, j + 1] + a3 * elevation[i3, j3]
    return r1 + 0.5 * p * (r2 - r0 + p * (2.0 * r0 - 5.0 * r1 + 4.0 * r2 - r3 + p * (3.0 * (r1 - r2) + r3 - r0)))
