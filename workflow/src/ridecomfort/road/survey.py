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
from . import cells, crg, smoothing

POSE = ("x", "y", "z", "heading", "roll", "pitch")
"""Position in m and attitude in rad of the scanner over ``time``: what a trajectory holds."""

KNOTS = 5.0
"""m between the points that the Catmull-Rom spline of the reference line passes through."""

FOLLOWED = 20.0
"""m; waves of the trajectory's height and roll that slope and bank keep half of."""

_CARRIED = 10
"""Cross sections behind the latest profile that may still gain points."""

_ASKEW = np.radians(30.0)
"""rad that the heading may lie off the motion on the whole: no vehicle drives so, but an azimuth taken for it does."""

_TILT = 0.7
"""rad; no vehicle rolls or pitches as far on a road, but degrees taken for radians do."""

_LEAP = {"x": (0.5, 100.0), "y": (0.5, 100.0), "z": (0.2, 10.0)}
"""m, for noise, and m/s that the scanner may be displaced from one position to the next; more is a leap of the positioning."""

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
    on, in s4. Raises InputError unless time runs forward in equal steps, every
    value is a number, and position and attitude are such as a vehicle can have.
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
        if name in _LEAP:
            far = np.abs(np.diff(values)) > _LEAP[name][0] + _LEAP[name][1] * steps.mean()
            if far.any():
                k = int(far.argmax())
                problem = f"leaps by {values[k + 1] - values[k]:.3g} m at {time[k + 1]:g} s ({far.sum()} such places)"
                raise InputError(f"{problem}, expected an unbroken path", place=f"trajectory.{name}")
        elif name != "heading" and np.abs(values).max() > _TILT:
            k = int(np.abs(values).argmax())
            problem = f"{values[k]:.3g} rad at {time[k]:g} s, expected less than {_TILT:g} (or are these degrees?)"
            raise InputError(problem, place=f"trajectory.{name}")
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
    """The road that a scan saw: a surface fitted to the points of each cell (`cells.fit`), read at its middle.

    ``profiles`` stream by, a block at a time; only those around the scanner are
    held. ``trajectory`` has `POSE` over ``time``, of the scanner itself. The grid
    has ``spacing`` m along u and v and reaches ``width`` m across. Outliers of
    their cell are dropped; cells with fewer than three points stay NaN. ``support`` (u, v) counts
    the points that agree on the height of a cell, none where they are those of a
    single profile: `clean.clean` keeps the dips that many points saw, however
    small. Height, slope and bank follow the trajectory; ``u`` starts where the
    first points lie. Raises InputError for a trajectory that cannot be used, that
    heads elsewhere than it moves or does not span the profiles, and for profiles
    out of order or too few.
    """
    smoothed, choices = smooth_trajectory(trajectory)
    _check_heading(smoothed)
    line = reference_line(smoothed, spacing=spacing[0])
    pose = CubicSpline(smoothed.time.values, np.stack([smoothed[name].values for name in POSE], axis=1))
    half = round(0.5 * width / spacing[1])
    v = spacing[1] * np.arange(-half, half + 1)
    heights = np.full((len(line.u), len(v)), np.nan)
    support = np.zeros(heights.shape, dtype=np.int32)
    counts = np.zeros(5, dtype=np.int64)
    held = np.empty((5, 0))
    finished, guess, last = 0, 0, np.array([np.inf, np.inf])
    first, final = smoothed.time.values[[0, -1]]
    latest = -np.inf
    for block in profiles:
        if not block.time.size:
            continue
        _check_block(block, latest, first, final)
        latest = block.time[-1]
        poses = pose(block.time)
        moving = _moving(poses, last, _STEP)
        counts[0] += len(block.time)
        points, guess, reached = _place(
            poses[moving], block.across, block.height[moving], line.x, line.y, line.heading, line.z, line.slope, line.bank,
            spacing[0], v[0], spacing[1], len(v), guess, counts,
        )  # fmt: skip
        held = np.concatenate([held, points], axis=1)
        complete = min(reached - _CARRIED, len(line.u))
        if complete > finished:
            held = _settle(held, finished, complete, spacing, heights, support, counts)
            finished = complete
    _settle(held, finished, len(line.u), spacing, heights, support, counts)
    seen = np.flatnonzero(np.isfinite(heights).any(axis=1))
    if not seen.size:
        raise InputError("no point lies within the grid around the trajectory", place="profiles")
    part = slice(seen[0], seen[-1] + 1)
    if seen[-1] - seen[0] < 2:
        raise InputError(f"{counts[0]} profiles reach over {seen[-1] - seen[0] + 1} cross sections, expected 3", place="profiles")
    report = Report(*(int(n) for n in counts), int(np.isnan(heights[part]).sum()))
    elevation = heights + line.z[:, None] + line.bank[:, None] * v
    lambdas = ", ".join(f"{name} {choices[name].wavelength:.3g} s" for name in ("x", "y", "z"))
    road = xr.Dataset(
        {
            "elevation": (("u", "v"), elevation),
            "support": (("u", "v"), support),
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


def _check_heading(trajectory: xr.Dataset) -> None:
    """InputError where the heading is not the direction of motion, within `_ASKEW`."""
    motion = np.arctan2(np.gradient(trajectory.y.values), np.gradient(trajectory.x.values))
    moving = np.hypot(np.gradient(trajectory.x.values), np.gradient(trajectory.y.values)) > _STEP
    off = np.angle(np.exp(1j * (trajectory.heading.values - motion)))[moving]
    if off.size and np.median(np.abs(off)) > _ASKEW:
        raise InputError(
            f"{np.degrees(np.median(np.abs(off))):.0f} degrees off the direction of motion, expected radians"
            " counterclockwise from x (or is it an azimuth?)",
            place="trajectory.heading",
        )


def _check_block(block: Profiles, latest: float, first: float, final: float) -> None:
    """InputError unless the profiles follow one another from ``latest`` within the trajectory, at known places across."""
    steps = np.diff(block.time, prepend=latest)
    if not (steps >= 0).all():
        k = int(np.flatnonzero(~(steps >= 0))[0])
        before = block.time[k - 1] if k else latest
        after = f" after {before:g} s" if np.isfinite(before) else ""
        raise InputError(f"{block.time[k]:g} s{after}, expected times that rise", place="profiles.time")
    if not (first <= block.time[0] and block.time[-1] <= final):
        raise InputError(
            f"from {block.time[0]:g} to {block.time[-1]:g} s, trajectory from {first:g} to {final:g} s",
            place="profiles.time",
        )
    if not np.isfinite(block.across).all():
        raise InputError("not a number at every point", place="profiles.across")
    returned = block.height[np.isfinite(block.height)]
    if returned.size and np.median(returned) > 0.0:
        problem = f"{np.median(returned):.3g} m on the whole from {block.time[0]:g} to {block.time[-1]:g} s"
        raise InputError(f"{problem}, expected the road below the scanner (negative)", place="profiles.height")


def _settle(held: np.ndarray, first: int, end: int, size: tuple, heights, support, counts) -> np.ndarray:
    """Heights and support of the cross sections from ``first`` to ``end`` from their points; gives back the others."""
    now = held[0] < end
    cells.fit(held[:, now & (held[0] >= first)], first, end, size, heights, support, counts)
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
def _place(poses, across, height, line_x, line_y, heading, z, slope, bank, du, v0, dv, nv, guess, counts):
    """Points as rows: cross section, column, offsets in m from the middle of the cell, height above the plane there.

    The plane rises with the line too: a cell whose points lie on one side of its middle, or too close together to tell
    their slope, would else be off by the grade times their distance from it.
    """
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
            points[4, used] = above - z[row] - slope[row] * points[2, used] - bank[row] * v
            used += 1
        if lowest < rows:
            reached = lowest
    return points[:, :used], guess, reached
