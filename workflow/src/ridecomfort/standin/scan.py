"""A stand-in laser scan of a road, made from a seed, as a mobile mapping vehicle would record it (sec:road_surf)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numba import njit
from scipy.interpolate import CubicSpline

from ..road import surface
from ..road.survey import POSE, Profiles, locate


@dataclass(frozen=True)
class Scanner:
    """A scanner, how it is driven, and what goes wrong. SI units.

    Points, rates and accuracy are the paper's (sec:road_surf); height noise is
    taken as the standard deviation. Errors of the trajectory are those of a
    post-processed inertial navigation with base station: judgement.
    """

    points: int = 900
    width: float = 4.0
    rate: float = 800.0
    trajectory_rate: float = 200.0
    speed: float = 20.0
    mounted: float = 2.0
    noise: float = 1e-4
    position_noise: float = 5e-4
    position_drift: float = 0.01
    attitude_noise: float = 5e-5
    outlier_share: float = 1e-4
    dropout_share: float = 1e-3
    gaps_per_km: float = 2.0
    leaves: int = 2


def trajectory(road: xr.Dataset, seed: int, scanner: Scanner = Scanner()) -> tuple[xr.Dataset, xr.Dataset]:
    """The path of the scanner over a road as it was, and as it was measured: `survey.POSE` over ``time``.

    It follows the reference line from 2 m after its start to 2 m before its end,
    wanders 0.1 m, bounces 5 mm and rolls and pitches by 0.2 degrees. The measured
    one has white noise and a drift over about a minute.
    """
    rng = np.random.default_rng([seed, 1])
    u = road.u.values
    time = np.arange(0.0, (u[-1] - u[0] - 4.0) / scanner.speed, 1 / scanner.trajectory_rate)
    along = u[0] + 2.0 + scanner.speed * time
    heading = np.interp(along, u, road.heading.values)
    beside = 0.1 * np.sin(2 * np.pi * along / 180.0 + rng.uniform(0, 6))
    pose = {
        "x": np.interp(along, u, road.x.values) - beside * np.sin(heading),
        "y": np.interp(along, u, road.y.values) + beside * np.cos(heading),
        "z": CubicSpline(u[::50], surface.height(road, u[::50], 0.0))(along) + scanner.mounted,
        "heading": heading + np.gradient(beside, along),
        "roll": np.arctan(np.interp(along, u, road.bank.values)) + 0.0035 * _motion(rng, time, 0.9),
        "pitch": 0.0035 * _motion(rng, time, 1.3) - np.arctan(np.interp(along, u, road.slope.values)),
    }
    pose["z"] = pose["z"] + 0.005 * _motion(rng, time, 1.2)
    true = xr.Dataset({name: ("time", pose[name]) for name in POSE}, coords={"time": time})
    measured = true.copy(deep=True)
    for name in POSE:
        is_position = name in ("x", "y", "z")
        noise = scanner.position_noise if is_position else scanner.attitude_noise
        measured[name] = measured[name] + noise * rng.standard_normal(time.size)
        if is_position:
            measured[name] = measured[name] + scanner.position_drift * _motion(rng, time, 1 / 60)
    return true, measured


def _motion(rng: np.random.Generator, time: np.ndarray, frequency: float) -> np.ndarray:
    """A smooth random motion of about unit rms around a frequency in Hz."""
    frequencies = frequency * rng.uniform(0.7, 1.3, 5)
    phases = rng.uniform(0, 2 * np.pi, 5)
    return np.sin(2 * np.pi * np.outer(time, frequencies) + phases).sum(axis=1) * np.sqrt(2 / 5)


def profiles(
    road: xr.Dataset, true: xr.Dataset, seed: int, scanner: Scanner = Scanner(), *, block: int = 1000
) -> Iterator[Profiles]:
    """The profiles that a scanner on the true path records, ``block`` at a time.

    With noise, outliers (5 mm to 0.5 m), lost points, gaps of some profiles and
    leaves that cross the beam. Equal seeds give equal profiles, whatever the block.
    """
    elevation, *axes = surface.grid(road)
    line = [np.ascontiguousarray(road[name].values) for name in ("x", "y", "heading")]
    pose = CubicSpline(true.time.values, np.stack([true[name].values for name in POSE], axis=1))
    across = np.linspace(-scanner.width / 2, scanner.width / 2, scanner.points)
    count = int(true.time.values[-1] * scanner.rate)
    rng = np.random.default_rng([seed, 2])
    gaps = rng.integers(0, count, rng.poisson(scanner.gaps_per_km * true.time.values[-1] * scanner.speed / 1000))
    leaves = [_leaf(rng, count, scanner) for _ in range(scanner.leaves)]
    guess = 0
    for start in range(0, count, block):
        index = np.arange(start, min(start + block, count))
        time = index / scanner.rate
        height = np.empty((index.size, scanner.points))
        guess = _look(pose(time), across, elevation, *axes, *line, guess, height)
        for k, row in enumerate(index):
            disturb = np.random.default_rng([seed, 3, row])
            height[k] += scanner.noise * disturb.standard_normal(scanner.points)
            chance = disturb.random(scanner.points)
            wild = chance < scanner.outlier_share
            size = np.exp(disturb.uniform(np.log(0.005), np.log(0.5), wild.sum()))
            height[k, wild] += disturb.choice([-1, 1], wild.sum()) * size
            height[k, chance > 1 - scanner.dropout_share] = np.nan
            if any(gap <= row < gap + 6 for gap in gaps):
                height[k] = np.nan
            for first, left, long, wide, high in leaves:
                if first <= row < first + long:
                    height[k, left : left + wide] += high
        yield Profiles(time, across, height)


def _leaf(rng: np.random.Generator, count: int, scanner: Scanner) -> tuple:
    """First profile and point of a leaf 70 to 180 mm wide, how many of them it covers, and its height in m."""
    wide = int(np.ceil(rng.uniform(0.07, 0.18) / scanner.width * (scanner.points - 1)))
    return rng.integers(count), rng.integers(scanner.points - wide), rng.integers(2, 8), wide, rng.uniform(0.1, 0.6)


@njit(cache=True)
def _look(poses, across, elevation, u0, du, v0, dv, line_x, line_y, heading, guess, height):
    """Heights above the scanner at which its beams meet the road; two corrections of where they do."""
    for k in range(len(poses)):
        ch, sh = np.cos(poses[k, 3]), np.sin(poses[k, 3])
        cr, sr = np.cos(poses[k, 4]), np.sin(poses[k, 4])
        cp, sp = np.cos(poses[k, 5]), np.sin(poses[k, 5])
        u, _ = locate(poses[k, 0], poses[k, 1], line_x, line_y, heading, du, guess)
        guess = min(max(int(u / du + 0.5), 0), len(line_x) - 1)
        up = -2.0
        for j in range(len(across)):
            for _ in range(3):
                ahead = sp * (sr * across[j] + cr * up)
                left = cr * across[j] - sr * up
                x = poses[k, 0] + ch * ahead - sh * left
                y = poses[k, 1] + sh * ahead + ch * left
                u, v = locate(x, y, line_x, line_y, heading, du, guess)
                ground = surface.cubic(elevation, u0, du, v0, dv, u0 + u, v)
                up += (ground - poses[k, 2] - cp * (sr * across[j] + cr * up)) / (cp * cr)
            height[k, j] = up
    return guess
