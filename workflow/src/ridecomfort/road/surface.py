"""Heights of a road surface at any (u, v), and its reference line at any u."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import xarray as xr
from numba import njit

from ..errors import InputError
from . import edges

BORDER_MODES = ("none", "zero", "keep", "repeat", "reflect")
"""What lies beyond the grid, numbered as OpenCRG's border_mode_u and border_mode_v."""

_NONE, _ZERO, _KEEP, _REPEAT, _REFLECT = range(5)

INTERPOLATION = "cubic"
"""Between the points of a road that does not say itself: the paper's (sec:road_surf). A road from `crg.read` does: OpenCRG's."""

LINE = ("x", "y", "heading", "curvature", "slope", "bank")
"""What the reference line is made of, in the order in which compiled code takes and gives it."""

_AT_NODE = 1e-9
"""Share of a cell within which a position is that of a cross section."""


class Borders(NamedTuple):
    """How a road asks to be evaluated at its borders (see `height`): what compiled code takes."""

    u_end: float
    v_end: float
    mode_u: int
    mode_v: int
    offset_u: float
    offset_v: float
    closed: bool
    closed_from: float
    closed_to: float
    held_bank: bool
    smooth_start: float
    smooth_end: float
    height_start: float
    height_end: float


def borders(road: xr.Dataset) -> Borders:
    """What the attributes of a road say of its borders; by default the nearest height is kept along and across."""
    attrs = road.attrs
    return Borders(
        u_end=float(road.u[-1]),
        v_end=float(road.v[-1]),
        mode_u=BORDER_MODES.index(attrs.get("border_mode_u", "keep")),
        mode_v=BORDER_MODES.index(attrs.get("border_mode_v", "keep")),
        offset_u=float(attrs.get("border_offset_u", 0.0)),
        offset_v=float(attrs.get("border_offset_v", 0.0)),
        closed="closed_from" in attrs,
        closed_from=float(attrs.get("closed_from", 0.0)),
        closed_to=float(attrs.get("closed_to", 0.0)),
        held_bank=attrs.get("border_bank") == "held",
        smooth_start=float(attrs.get("smooth_start", 0.0)),
        smooth_end=float(attrs.get("smooth_end", 0.0)),
        height_start=float(attrs.get("reference_height_start", 0.0)),
        height_end=float(attrs.get("reference_height_end", 0.0)),
    )


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
def _spline(a, b, c, d, p):
    """Catmull-Rom spline from b to c, at the share p of the way."""
    return b + 0.5 * p * (c - a + p * (2.0 * a - 5.0 * b + 4.0 * c - d + p * (3.0 * (b - c) + d - a)))


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
    return _spline(r0, r1, r2, r3, p)


@njit(forceinline=True, error_model="numpy")
def _close(u, at):
    """A position on a closed track brought back to its first round."""
    if not at.closed or at.closed_from <= u <= at.closed_to:
        return u
    round_trip = np.fmod(u - at.closed_from, at.closed_to - at.closed_from)
    return round_trip + (at.closed_from if round_trip > 0.0 else at.closed_to)


@njit(forceinline=True, error_model="numpy")
def _fold(position, start, end, mode):
    """A position brought back into the grid by repeating or reflecting it."""
    if start <= position <= end:
        return position
    length = end - start
    if mode == _REPEAT:
        return start + (position - start) % length
    if mode == _REFLECT:
        return start + length - abs((position - start) % (2.0 * length) - length)
    return position


@njit(error_model="numpy", fastmath={"contract"})
def _bordered(elevation, bank, u0, du, v0, dv, at, smooth, u, v):
    """Height in m where the borders may have a say: beyond them, or within a smoothing zone."""
    if not math.isfinite(u + v):
        return np.nan
    beyond_u, beyond_v = u < u0 or u > at.u_end, v < v0 or v > at.v_end
    if (beyond_u and at.mode_u == _NONE) or (beyond_v and at.mode_v == _NONE):
        return np.nan
    ruling = _REPEAT
    if beyond_u and at.mode_u <= _KEEP:
        ruling = at.mode_u
    elif beyond_v:
        ruling = at.mode_v
    inner_u, inner_v = _fold(u, u0, at.u_end, at.mode_u), _fold(v, v0, at.v_end, at.mode_v)
    within = min(max(v, v0), at.v_end)
    i, p = _cell(inner_u, u0, du, bank.size)
    slant = bank[i] + p * (bank[i + 1] - bank[i])
    if ruling == _ZERO:
        height = 0.0
    elif beyond_u and beyond_v and at.mode_u == _KEEP and at.mode_v == _ZERO:
        height = (at.height_start if u < u0 else at.height_end) + slant * within
    else:
        if smooth:
            height = cubic(elevation, u0, du, v0, dv, inner_u, inner_v)
        else:
            height = linear(elevation, u0, du, v0, dv, inner_u, inner_v)
        if at.held_bank and at.mode_v >= _REPEAT:
            height += slant * (within - inner_v)
    if ruling <= _KEEP:
        height += at.offset_u * beyond_u + at.offset_v * beyond_v
    # Within both smoothing zones that of the end prevails.
    if at.smooth_end > 0.0 and at.u_end - inner_u <= at.smooth_end:
        return at.height_end + (height - at.height_end) * max(at.u_end - inner_u, 0.0) / at.smooth_end
    if at.smooth_start > 0.0 and inner_u - u0 <= at.smooth_start:
        return at.height_start + (height - at.height_start) * max(inner_u - u0, 0.0) / at.smooth_start
    return height


# Products and sums are fused, as in the vehicle's kernel: cubic gains half its speed.
@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})
def _heights(elevation, bank, u0, du, v0, dv, at, smooth, u, v, heights):
    plain = at.smooth_start <= 0.0 and at.smooth_end <= 0.0
    for k in range(u.size):
        along, across = _close(u[k], at), v[k]
        if not (plain and u0 <= along <= at.u_end and v0 <= across <= at.v_end):
            heights[k] = _bordered(elevation, bank, u0, du, v0, dv, at, smooth, along, across)
        elif smooth:
            heights[k] = cubic(elevation, u0, du, v0, dv, along, across)
        else:
            heights[k] = linear(elevation, u0, du, v0, dv, along, across)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def along(line, u0, du, at, smooth, u):
    """The reference line at one position, as `reference_line` gives it: `LINE`, from ``line`` (u, `LINE`)."""
    if not math.isfinite(u):
        return np.nan, np.nan, np.nan, np.nan, np.nan, np.nan
    count = line.shape[0]
    u = _close(u, at)
    folded = _fold(u, u0, at.u_end, at.mode_u)
    over = u - min(max(u, u0), at.u_end)
    i, p = _cell(u, u0, du, count)
    j, q = _cell(folded, u0, du, count)
    if smooth:
        before, after, last = max(i - 1, 0), min(i + 2, count - 1), count - 2
        # One more point beyond either end, straight on.
        x0, y0 = line[before, 0], line[before, 1]
        if i == 0:
            x0, y0 = 2.0 * x0 - line[1, 0], 2.0 * y0 - line[1, 1]
        x3, y3 = line[after, 0], line[after, 1]
        if i == last:
            x3, y3 = 2.0 * x3 - line[last, 0], 2.0 * y3 - line[last, 1]
        x = _spline(x0, line[i, 0], line[i + 1, 0], x3, p)
        y = _spline(y0, line[i, 1], line[i + 1, 1], y3, p)
        # The derivative of the spline weighs the segments before, at and behind the position.
        heading = (
            (0.5 + p * (1.5 * p - 2.0)) * line[before, 2]
            + (0.5 + p * (3.0 - 3.0 * p)) * line[i, 2]
            + p * (1.5 * p - 1.0) * line[min(i + 1, last), 2]
        )
        curvature = _spline(line[before, 3], line[i, 3], line[i + 1, 3], line[after, 3], p)
        slope = (
            (0.5 + q * (1.5 * q - 2.0)) * line[max(j, 1), 4]
            + (0.5 + q * (3.0 - 3.0 * q)) * line[j + 1, 4]
            + q * (1.5 * q - 1.0) * line[min(j + 2, count - 1), 4]
        )
        bank = _spline(line[max(j - 1, 0), 5], line[j, 5], line[j + 1, 5], line[min(j + 2, count - 1), 5], q)
    else:
        x = line[i, 0] + p * (line[i + 1, 0] - line[i, 0])
        y = line[i, 1] + p * (line[i + 1, 1] - line[i, 1])
        begun = i + (p >= 1.0 - _AT_NODE)
        heading, curvature = line[begun, 2], line[begun, 3]
        slope = line[j + (q > _AT_NODE), 4]
        bank = line[j, 5] + q * (line[j + 1, 5] - line[j, 5])
    if over != 0.0:
        x, y, curvature = x + over * math.cos(heading), y + over * math.sin(heading), 0.0
        if at.mode_u == _NONE:
            slope = bank = np.nan
        elif at.mode_u == _ZERO:
            slope = bank = 0.0
        elif at.mode_u == _KEEP:
            slope = 0.0
        elif at.mode_u == _REFLECT and math.floor((u - u0) / (at.u_end - u0)) % 2.0 == 1.0:
            slope = -slope
    return x, y, heading, curvature, slope, bank


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})
def _line(line, u0, du, at, smooth, u, found):
    for k in range(u.size):
        found[0, k], found[1, k], found[2, k], found[3, k], found[4, k], found[5, k] = along(line, u0, du, at, smooth, u[k])


def smoothed_ends(road: xr.Dataset, heights: np.ndarray) -> np.ndarray:
    """Heights (u, ...) of the cross sections of a road, with the smoothing zones at its ends that its file asks for.

    There they go over into the height of the reference line at the end, as in OpenCRG 1.2 (crgEvaluv2z).
    """
    at, u = borders(road), road.u.values.reshape(-1, *[1] * (heights.ndim - 1))
    before_end, from_start = at.u_end - u, u - u[0]
    at_end = (at.smooth_end > 0.0) & (before_end <= at.smooth_end)
    at_start = (at.smooth_start > 0.0) & (from_start <= at.smooth_start) & ~at_end  # within both, that of the end prevails
    for zone, length, level, away in (
        (at_end, at.smooth_end, at.height_end, before_end), (at_start, at.smooth_start, at.height_start, from_start),
    ):  # fmt: skip
        if zone.any():
            heights = np.where(zone, level + (heights - level) * (away / length), heights)
    return heights


def require(road: xr.Dataset, *names: str) -> None:
    """Raise InputError where a road lacks one of these variables."""
    if missing := [name for name in names if name not in road]:
        raise InputError(f"no {missing[0]!r}, expected {', '.join(names)}", place="road")


def grid(road: xr.Dataset) -> tuple[np.ndarray, float, float, float, float]:
    """What kernels take: elevation (u, v) in m, C-contiguous float64, then u0, du, v0 and dv in m.

    Every height is finite: beyond the edges of the road it is that of the nearest
    cell across, carried on with the cross slope (`edges.extend`), so that a wheel
    that leaves the road meets no step. Smoothing zones are put in (`smoothed_ends`). Raises InputError where the road
    has holes (`clean.fill` closes them), or lacks a channel.
    """
    require(road, "elevation", "bank")
    elevation = edges.extend(road.elevation.transpose("u", "v").values, road.v.values, road.bank.values)
    unknown = ~np.isfinite(elevation)
    if unknown.any():
        i, j = np.argwhere(unknown)[0]
        raise InputError(
            f"no height at u = {road.u.values[i]:g} m, v = {road.v.values[j]:g} m, expected a road without holes inside its edges "
            "(road.clean.fill closes them)",
            place="road",
        )
    return np.ascontiguousarray(smoothed_ends(road, elevation), dtype=np.float64), *_axis(road.u.values), *_axis(road.v.values)


def height(road: xr.Dataset, u, v, *, interpolation: str | None = None) -> np.ndarray:
    """Heights in m at positions u and v in m, broadcast against each other.

    Interpolates as the road's attribute ``interpolation`` says, ``linear`` or
    ``cubic`` (`INTERPOLATION` without it), unless named here. Beyond the borders of the grid the attributes
    ``border_mode_u`` and ``border_mode_v`` rule (none: NaN, zero, keep, repeat,
    reflect) with their offsets, smoothing zones and closed tracks, as in OpenCRG
    1.2 (crgEvaluv2z); with ``border_bank`` ``held``, heights that repeat or reflect
    across carry the bank of the border, not that of their place. Beyond the edges of
    the road ``edges`` rules: ``keep`` the nearest height across, or ``none``: NaN.
    Positions that are not finite give NaN. Raises InputError where the road lacks a channel.
    """
    require(road, "elevation", "bank")
    interpolation = interpolation or road.attrs.get("interpolation", INTERPOLATION)
    elevation, bank = road.elevation.transpose("u", "v").values, road.bank.values
    if road.attrs.get("edges", "keep") == "keep":
        elevation = edges.extend(elevation, road.v.values, bank)
    elevation, bank = (np.ascontiguousarray(values, dtype=np.float64) for values in (elevation, bank))
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    heights = np.empty(u.size)
    axes = *_axis(road.u.values), *_axis(road.v.values)
    _heights(elevation, bank, *axes, borders(road), interpolation == "cubic", np.ravel(u), np.ravel(v), heights)
    return heights.reshape(u.shape)


def reference_line(road: xr.Dataset, u, *, interpolation: str | None = None) -> xr.Dataset:
    """The reference line at positions u in m: x and y in m, heading in rad, curvature in 1/m, slope and bank.

    Interpolates as `height` does. ``linear`` is OpenCRG's polygon: x, y and bank
    are linear, heading and slope those of the segment, curvature that of the cross
    section where it begins (crgEvaluv2xy, crgEvaluv2pk). ``cubic`` leads splines
    through x, y, curvature and bank; heading and slope turn as the splines do.

    Beyond its ends the line goes straight on, or round where the track is closed;
    slope and bank are those of the heights there, as ``border_mode_u`` has them
    (none: NaN, zero: 0, keep: level with the bank of the end, repeat and reflect:
    of the place that is repeated). Smoothing zones are left aside. Positions that
    are not finite give NaN.
    """
    interpolation = interpolation or road.attrs.get("interpolation", INTERPOLATION)
    line = np.stack([road[name].values for name in LINE], axis=1).astype(np.float64, copy=False)
    u = np.asarray(u, dtype=np.float64)
    found = np.empty((len(LINE), u.size))
    _line(line, *_axis(road.u.values), borders(road), interpolation == "cubic", np.ravel(u), found)
    dims = tuple(f"dim_{k}" for k in range(u.ndim))
    return xr.Dataset({name: (dims, values.reshape(u.shape)) for name, values in zip(LINE, found)})


def _axis(positions: np.ndarray) -> tuple[float, float]:
    """Origin and spacing of equidistant positions."""
    return float(positions[0]), float(positions[-1] - positions[0]) / (len(positions) - 1)
