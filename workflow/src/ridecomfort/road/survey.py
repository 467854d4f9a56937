"""From the raw profiles of a laser scanner and its trajectory to the grid of a road (sec:road_surf)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from numba import njit
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ..errors import InputError
from ..vocabulary import describe
from . import crg, smoothing

POSE = ("x", "y", "z", "heading", "roll", "pitch")
"""Position in m and attitude in rad of the scanner over ``time``: what a trajectory holds."""

KNOTS = 5.0
"""m between the points that the Catmull-Rom spline of the reference line passes through."""

FOLLOWED = 20.0
"""m; waves of the trajectory's height and roll that slope and bank keep half of."""

REJECTED = 6.0
"""Robust standard deviations (1.4826 MAD) from the median of its cell beyond which a point is dropped."""

REJECTED_FLOOR = 0.002
"""m that a point may always lie from the median of its cell."""

_LEAST = 3
"""Points that make a height."""

_CARRIED = 10
"""Cross sections behind the latest profile that may still gain points."""

_STEP = 0.002
"""m that the scanner must have moved for another profile to count: standing adds nothing."""


class Profiles(NamedTuple):
    """Consecutive laser profiles: ``time`` (n) in s, ``across`` (m) in m to the left of the scanner,
    ``height`` (n, m) in m above it, NaN where the beam did not return."""

    time: np.ndarray
    across: np.ndarray
    height: np.ndarray


@dataclass(frozen=True)
class Line:
    """A reference line in equal steps: ``u``, ``x``, ``y``, ``z`` in m, ``heading`` in rad, ``slope`` and ``bank``.

    ``z`` is the height of the scanner, followed over `FOLLOWED` m; ``slope`` its
    rise, ``bank`` its roll.
    """

    u: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    heading: np.ndarray
    slope: np.ndarray
    bank: np.ndarray


@dataclass(frozen=True)
class Report:
    """What became of the points of a scan: their number, how many were dropped as outliers or fell beside the
    grid or had no return, and how many cells of the grid stayed without a height."""

    profiles: int
    points: int
    outliers: int
    beside: int
    lost: int
    empty_cells: int

    def line(self) -> str:
        """What a log should say."""
        return (
            f"{self.points} points of {self.profiles} profiles, {self.lost} without return, {self.outliers} dropped as"
            f" outliers of their cell, {self.beside} beside the grid; {self.empty_cells} cells without a height"
        )


def smooth_trajectory(trajectory: xr.Dataset) -> tuple[xr.Dataset, dict[str, smoothing.Choice]]:
    """A trajectory (time) without the noise that cross-validation finds in it, and the stiffness of each channel.

    The paper's lambda_x, lambda_y and lambda_z are ``choices["x"].penalty`` and so
    on, in s4. Raises InputError unless time runs forward in equal steps and every
    value is a number.
    """
    time = trajectory.time.values
    steps = np.diff(time)
    if len(time) < 10 or not steps.min() > 0 or np.ptp(steps) > 1e-3 * steps.mean():
        raise InputError("expected at least 10 equal steps forward", place="trajectory.time")
    smoothed, choices = trajectory.copy(), {}
    for name in POSE:
        values = trajectory[name].values
        if not np.isfinite(values).all():
            first = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InputError(f"{values[first]} at {time[first]:g} s, expected numbers", place=f"trajectory.{name}")
        values = np.unwrap(values) if name == "heading" else values
        choices[name] = smoothing.cross_validate((values - values[0])[:, None], steps.mean())
        found = smoothing.smooth((values - values[0])[:, None], steps.mean(), choices[name].wavelength)[:, 0]
        smoothed[name] = ("time", found + values[0])
    return smoothed, choices


def reference_line(trajectory: xr.Dataset, *, spacing: float = 0.1, knots: float = KNOTS) -> Line:
    """The Catmull-Rom spline through a smoothed trajectory, in steps of ``spacing`` m along it.

    Its knots lie ``knots`` m apart. Raises InputError for a trajectory shorter than four knots.
    """
    x, y = trajectory.x.values, trajectory.y.values
    moved = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    keep = np.concatenate([[True], np.diff(np.maximum.accumulate(np.floor(moved / 0.01))) > 0])
    moved, x, y = moved[keep], x[keep], y[keep]
    if moved[-1] < 3 * knots:
        raise InputError(f"{moved[-1]:g} m long, expected at least {3 * knots:g} m", place="trajectory")
    at = np.linspace(0.0, moved[-1], int(moved[-1] / knots) + 1)
    points = np.stack([np.interp(at, moved, x), np.interp(at, moved, y)], axis=1)
    spline = CubicHermiteSpline(at, points, np.gradient(points, at, axis=0, edge_order=2))
    fine = np.linspace(0.0, moved[-1], int(moved[-1] / 0.02) + 2)
    speed = np.linalg.norm(spline(fine, 1), axis=1)
    length = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    u = spacing * np.arange(int(length[-1] / spacing) + 1)
    parameter = np.interp(u, length, fine)
    line_x, line_y = spline(parameter).T
    tangent = spline(parameter, 1)
    followed = {}
    for name in ("z", "roll"):
        along = np.interp(parameter, moved, trajectory[name].values[keep])
        followed[name] = smoothing.smooth(along[:, None], spacing, FOLLOWED)[:, 0]
    return Line(
        u=u,
        x=line_x,
        y=line_y,
        z=followed["z"],
        heading=np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0])),
        slope=np.gradient(followed["z"], spacing),
        bank=np.tan(followed["roll"]),
    )


def grid(
    profiles: Iterable[Profiles],
    trajectory: xr.Dataset,
    *,
    spacing: tuple[float, float] = (0.1, 0.1),
    width: float = 4.0,
) -> tuple[xr.Dataset, Report]:
    """The road that a scan saw: a plane fitted to the points of each cell, read at its middle.

    ``profiles`` stream by, a block at a time; only those around the scanner are
    held. ``trajectory`` has `POSE` over ``time``, of the scanner itself. The grid
    has ``spacing`` m along u and v and reaches ``width`` m across. Points further
    than `REJECTED` robust standard deviations from the median of their cell are
    dropped; cells with fewer than three points stay NaN. Height, slope and bank
    follow the trajectory; ``u`` starts where the first points lie. Raises InputError
    for a trajectory that cannot be used or that does not span the profiles.
    """
    smoothed, choices = smooth_trajectory(trajectory)
    line = reference_line(smoothed, spacing=spacing[0])
    pose = CubicSpline(smoothed.time.values, np.stack([smoothed[name].values for name in POSE], axis=1))
    half = round(0.5 * width / spacing[1])
    v = spacing[1] * np.arange(-half, half + 1)
    heights = np.full((len(line.u), len(v)), np.nan)
    counts = np.zeros(5, dtype=np.int64)
    held = np.empty((5, 0))
    finished, guess, last = 0, 0, np.array([np.inf, np.inf])
    for block in profiles:
        first, final = smoothed.time.values[[0, -1]]
        if block.time[0] < first or block.time[-1] > final:
            raise InputError(
                f"from {block.time[0]:g} to {block.time[-1]:g} s, trajectory from {first:g} to {final:g} s",
                place="profiles.time",
            )
        poses = pose(block.time)
        moving = _moving(poses, last, _STEP)
        counts[0] += len(block.time)
        points, guess, reached = _place(
            poses[moving], block.across, block.height[moving], line.x, line.y, line.heading, line.z, line.bank,
            spacing[0], v[0], spacing[1], len(v), guess, counts,
        )  # fmt: skip
        held = np.concatenate([held, points], axis=1)
        complete = min(reached - _CARRIED, len(line.u))
        if complete > finished:
            held = _settle(held, finished, complete, heights, counts)
            finished = complete
    _settle(held, finished, len(line.u), heights, counts)
    seen = np.flatnonzero(np.isfinite(heights).any(axis=1))
    if not seen.size:
        raise InputError("no point lies within the grid around the trajectory", place="profiles")
    part = slice(seen[0], seen[-1] + 1)
    report = Report(*(int(n) for n in counts), int(np.isnan(heights[part]).sum()))
    elevation = heights + line.z[:, None] + line.bank[:, None] * v
    lambdas = ", ".join(f"{name} {choices[name].wavelength:.3g} s" for name in ("x", "y", "z"))
    road = xr.Dataset(
        {
            "elevation": (("u", "v"), elevation),
            **{name: ("u", getattr(line, name)) for name in ("x", "y", "heading", "slope", "bank")},
            "curvature": ("u", crg.curvature(line.x, line.y, spacing[0])),
        },
        coords={"u": line.u, "v": v},
        attrs={
            "interpolation": "linear",
            "edges": "keep",
            "treatment": f"trajectory smoothed, cut-off by cross-validation: {lambdas}\n{report.line()}",
        },
    )
    road = road.isel(u=part)
    return describe(road.assign_coords(u=road.u - road.u[0])), report


def _settle(held: np.ndarray, first: int, end: int, heights: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Heights of the cross sections from ``first`` to ``end`` from their points; gives back the others."""
    now = held[0] < end
    _fit(held[:, now & (held[0] >= first)], first, end, heights, counts)
    return held[:, ~now]


@njit(cache=True)
def _moving(poses, last, step):
    """True for poses that lie at least a step from the one before that counted."""
    counted = np.zeros(len(poses), dtype=np.bool_)
    for k in range(len(poses)):
        if np.hypot(poses[k, 0] - last[0], poses[k, 1] - last[1]) >= step:
            counted[k] = True
            last[0], last[1] = poses[k, 0], poses[k, 1]
    return counted


@njit(cache=True)
def locate(x, y, line_x, line_y, heading, spacing, guess):
    """Position (u, v) in m of a point along and to the left of a line in equal steps, found near index ``guess``."""
    n = len(line_x)
    i = guess
    for _ in range(20):
        c, s = np.cos(heading[i]), np.sin(heading[i])
        along = (x - line_x[i]) * c + (y - line_y[i]) * s
        left = (y - line_y[i]) * c - (x - line_x[i]) * s
        ahead = min(i + 1, n - 1)
        behind = max(i - 1, 0)
        bend = (heading[ahead] - heading[behind]) / (spacing * max(ahead - behind, 1))
        along /= max(1.0 - bend * left, 0.1)
        step = int(np.floor(along / spacing + 0.5))
        target = min(max(i + step, 0), n - 1)
        if target == i:
            break
        i = target
    return i * spacing + along, left


@njit(cache=True)
def _place(poses, across, height, line_x, line_y, heading, z, bank, du, v0, dv, nv, guess, counts):
    """Points as rows: cross section, column, offsets in m from the middle of the cell, height above the plane there."""
    n, m = height.shape
    points = np.empty((5, n * m))
    used = 0
    reached = 0
    rows = len(line_x)
    for k in range(n):
        ch, sh = np.cos(poses[k, 3]), np.sin(poses[k, 3])
        cr, sr = np.cos(poses[k, 4]), np.sin(poses[k, 4])
        cp, sp = np.cos(poses[k, 5]), np.sin(poses[k, 5])
        u, _ = locate(poses[k, 0], poses[k, 1], line_x, line_y, heading, du, guess)
        guess = min(max(int(u / du + 0.5), 0), rows - 1)
        lowest = rows
        for j in range(m):
            up = height[k, j]
            counts[1] += 1
            if not np.isfinite(up):
                counts[4] += 1
                continue
            ahead = sp * (sr * across[j] + cr * up)
            left = cr * across[j] - sr * up
            x = poses[k, 0] + ch * ahead - sh * left
            y = poses[k, 1] + sh * ahead + ch * left
            above = poses[k, 2] + cp * (sr * across[j] + cr * up)
            u, v = locate(x, y, line_x, line_y, heading, du, guess)
            row, column = int(np.floor(u / du + 0.5)), int(np.floor((v - v0) / dv + 0.5))
            lowest = min(lowest, row)
            if row < 0 or row >= rows or column < 0 or column >= nv:
                counts[3] += 1
                continue
            points[0, used], points[1, used] = row, column
            points[2, used], points[3, used] = u - row * du, v - (v0 + column * dv)
            points[4, used] = above - z[row] - bank[row] * v
            used += 1
        if lowest < rows:
            reached = lowest
    return points[:, :used], guess, reached


@njit(cache=True)
def _fit(points, first, end, heights, counts):
    """Planes through the points of each cell without its outliers, read at the middle of the cell."""
    nv = heights.shape[1]
    cells = (end - first) * nv
    start = np.zeros(cells + 1, dtype=np.int64)
    for k in range(points.shape[1]):
        start[int(points[0, k] - first) * nv + int(points[1, k]) + 1] += 1
    start = np.cumsum(start)
    order = np.empty(points.shape[1], dtype=np.int64)
    place = start[:-1].copy()
    for k in range(points.shape[1]):
        cell = int(points[0, k] - first) * nv + int(points[1, k])
        order[place[cell]] = k
        place[cell] += 1
    for cell in range(cells):
        of_cell = order[start[cell] : start[cell + 1]]
        if len(of_cell) >= _LEAST:
            heights[first + cell // nv, cell % nv] = _plane(points[2], points[3], points[4], of_cell, counts)


@njit(cache=True)
def _plane(du, dv, z, chosen, counts):
    """Height at the origin of the least-squares plane through the chosen points without outliers.

    Outliers are dropped twice: those far from the median, then those far from the plane through the others.
    """
    level, slope_u, slope_v = np.median(z[chosen]), 0.0, 0.0
    away = np.empty(len(chosen))
    for _ in range(2):
        for k, point in enumerate(chosen):
            away[k] = abs(z[point] - level - slope_u * du[point] - slope_v * dv[point])
        limit = max(REJECTED * 1.4826 * np.median(away), REJECTED_FLOOR)
        level, slope_u, slope_v = _least_squares(du, dv, z, chosen, away <= limit)
    counts[2] += np.sum(away > limit)
    return level


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
