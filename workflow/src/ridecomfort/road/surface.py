"""Heights of a road surface at any (u, v)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numba import njit

from . import edges


@njit(forceinline=True)
def _cell(position, origin, spacing, count):
    """Index of the cell a position falls in and the place inside it (0 to 1), clamped to the grid."""
    place = (position - origin) / spacing
    if not place > 0.0:  # also NaN, which must not become an index
        return 0, 0.0
    if place >= count - 1:
        return count - 2, 1.0
    index = int(place)
    return index, place - index


@njit(forceinline=True, error_model="numpy", _nrt=False)
def linear(elevation, u0, du, v0, dv, u, v):
    """Height in m by bilinear interpolation, clamped to the grid at its borders (OpenCRG 1.2)."""
    i, p = _cell(u, u0, du, elevation.shape[0])
    j, q = _cell(v, v0, dv, elevation.shape[1])
    right = elevation[i, j] + p * (elevation[i + 1, j] - elevation[i, j])
    left = elevation[i, j + 1] + p * (elevation[i + 1, j + 1] - elevation[i, j + 1])
    return right + q * (left - right)


@njit(forceinline=True, error_model="numpy", _nrt=False)
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


# Products and sums are fused, as in the vehicle's kernel: cubic gains half its speed.
@njit(cache=True, nogil=True, fastmath={"contract"})
def _linear_at(elevation, u0, du, v0, dv, u, v, heights):
    for k in range(u.size):
        heights[k] = linear(elevation, u0, du, v0, dv, u[k], v[k])


@njit(cache=True, nogil=True, fastmath={"contract"})
def _cubic_at(elevation, u0, du, v0, dv, u, v, heights):
    for k in range(u.size):
        heights[k] = cubic(elevation, u0, du, v0, dv, u[k], v[k])


def grid(road: xr.Dataset) -> tuple[np.ndarray, float, float, float, float]:
    """What kernels take: elevation (u, v) in m, C-contiguous float64, then u0, du, v0 and dv in m.

    Every height is finite: beyond the edges of the road it is that of the nearest
    cell across, carried on with the cross slope (`edges.extend`), so that a wheel
    that leaves the road rolls on level ground. Raises ValueError where the road
    has holes; `clean.fill` closes them.
    """
    elevation = edges.extend(road.elevation.values, road.v.values, road.bank.values)
    if not np.isfinite(elevation).all():
        raise ValueError("the road has holes inside its edges; fill them first (road.clean.fill)")
    return np.ascontiguousarray(elevation, dtype=np.float64), *_axis(road.u.values), *_axis(road.v.values)


def height(road: xr.Dataset, u, v, *, interpolation: str | None = None) -> np.ndarray:
    """Heights in m at positions u and v in m, broadcast against each other.

    Interpolates as the road's attribute ``interpolation`` says, ``linear`` or
    ``cubic``, unless named here. Beyond the borders of the grid the attributes
    ``border_mode_u`` and ``border_mode_v`` rule (none: NaN, zero, keep, repeat,
    reflect) with their offsets, smoothing zones and closed tracks, as in OpenCRG
    1.2 (crgEvaluv2z); with ``border_bank`` ``held``, heights that repeat or reflect
    across carry the bank of the border, not that of their place. Beyond the edges of the road ``edges`` rules: ``keep`` the
    nearest height across, or ``none``: NaN. Positions that are not finite give NaN.
    """
    interpolation = interpolation or road.attrs.get("interpolation", "linear")
    attrs = road.attrs
    elevation, banks = road.elevation.values, road.bank.values
    if attrs.get("edges", "keep") == "keep":
        elevation = edges.extend(elevation, road.v.values, banks)
    elevation = np.ascontiguousarray(elevation, dtype=np.float64)
    u0, du = _axis(road.u.values)
    v0, dv = _axis(road.v.values)
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    u = _close(u, attrs)
    u_end, v_end = float(road.u[-1]), float(road.v[-1])
    mode_u, mode_v = attrs.get("border_mode_u", "keep"), attrs.get("border_mode_v", "keep")
    beyond_u, beyond_v = (u < u0) | (u > u_end), (v < v0) | (v > v_end)
    inner_u, inner_v = _fold(u, u0, u_end, mode_u), _fold(v, v0, v_end, mode_v)
    heights = np.empty(u.size)
    at = _cubic_at if interpolation == "cubic" else _linear_at
    at(elevation, u0, du, v0, dv, np.ravel(inner_u), np.ravel(inner_v), heights)
    heights = heights.reshape(u.shape)
    if attrs.get("border_bank") == "held" and mode_v in ("repeat", "reflect"):
        heights = heights + np.interp(inner_u, road.u.values, banks) * (np.clip(v, v0, v_end) - inner_v)
    offset = attrs.get("border_offset_u", 0.0) * beyond_u + attrs.get("border_offset_v", 0.0) * beyond_v
    if mode_u == "keep" and mode_v == "zero":
        end = np.where(u < u0, 0, -1)
        ends = np.array([attrs.get("reference_height_start", 0.0), attrs.get("reference_height_end", 0.0)])
        heights = np.where(beyond_u & beyond_v, ends[end] + banks[end] * np.clip(v, v0, v_end), heights)
    along = beyond_u & (mode_u in ("keep", "zero"))
    ruling = np.where(along, mode_u, np.where(beyond_v, mode_v, ""))
    heights = np.select([ruling == "keep", ruling == "zero"], [heights + offset, offset], heights)
    nowhere = (beyond_u & (mode_u == "none")) | (beyond_v & (mode_v == "none")) | ~np.isfinite(u + v)
    return _smooth(np.where(nowhere, np.nan, heights), inner_u, u0, u_end, attrs)


def reference_line(road: xr.Dataset, u) -> xr.Dataset:
    """The reference line at positions u in m: x, y, heading, curvature, slope and bank by linear interpolation."""
    u = np.asarray(u, dtype=np.float64)
    names = ("x", "y", "heading", "curvature", "slope", "bank")
    dims = tuple(f"dim_{k}" for k in range(u.ndim))
    return xr.Dataset({name: (dims, np.interp(u, road.u.values, road[name].values)) for name in names})


def _axis(positions: np.ndarray) -> tuple[float, float]:
    """Origin and spacing of equidistant positions."""
    return float(positions[0]), float(positions[-1] - positions[0]) / (len(positions) - 1)


def _close(u: np.ndarray, attrs) -> np.ndarray:
    """Positions on a closed track brought back to its first round."""
    if "closed_from" not in attrs:
        return u
    first, last = attrs["closed_from"], attrs["closed_to"]
    away = (u < first) | (u > last)
    round_trip = np.fmod(u - first, last - first)
    return np.where(away, np.where(round_trip > 0, round_trip + first, round_trip + last), u)


def _fold(position: np.ndarray, start: float, end: float, mode: str) -> np.ndarray:
    """Positions brought back into the grid by repeating or reflecting it."""
    if mode == "repeat":
        inside = start + np.mod(position - start, end - start)
    elif mode == "reflect":
        length = end - start
        inside = start + length - np.abs(np.mod(position - start, 2 * length) - length)
    else:
        return position
    return np.where((position < start) | (position > end), inside, position)


def _smooth(heights: np.ndarray, u: np.ndarray, start: float, end: float, attrs) -> np.ndarray:
    """Heights drawn towards that of the reference line's ends within the smoothing zones, the latter of which prevails."""
    smoothed = heights
    for side, distance in (("start", u - start), ("end", end - u)):
        zone = attrs.get(f"smooth_{side}", 0.0)
        if zone:
            base = attrs[f"reference_height_{side}"]
            scale = np.clip(distance / zone, 0.0, 1.0)
            smoothed = np.where(distance <= zone, base + (heights - base) * scale, smoothed)
    return smoothed
