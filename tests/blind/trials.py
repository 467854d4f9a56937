"""Blind trials: drives with a hidden effect, made from seeds, handed to the search without the truth about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.ndimage import gaussian_filter1d

from ridecomfort import simulate
from ridecomfort.calibrate import BOUNDS
from ridecomfort.discrepancy import car as cars
from ridecomfort.drive import align
from ridecomfort.effects import library
from ridecomfort.effects.contract import COMPILED
from ridecomfort.calibrated import with_values
from ridecomfort.vocabulary import DRIVE, SIGNALS
from tests.vehicle.roads import rough

LENGTH, SPEED, SLOWER = 700.0, 22.0, 0.75
"""m of road, m/s of the repeats, share of it at which the drive held out goes."""

ACCELEROMETER, GYROSCOPE = 0.006, 0.0004
"""m/s2 and rad/s rms of instrument noise at 100 Hz: a good automotive IMU (60 ug and 0.003 deg/s per root Hz)."""

PATH_ERROR, PATH_LENGTH = 0.02, 30.0
"""m by which the recorded path is wrong (rms), and over which length."""

BACKGROUND = 0.1
"""kappa of every effect of the background."""

SHAPES = Path(__file__).parent / "shapes"
"""Effects that only a truth has."""

SENSOR = (-0.1, 0.05, 0.6)


@dataclass(frozen=True)
class Trial:
    """``measured``: what the search is given. ``truth``: what only the score may see."""

    measured: dict[str, tuple]
    truth: dict


def a_road(rng) -> xr.Dataset:
    """Rough, bent road with some patches and a few potholes."""
    u = np.arange(0.0, LENGTH + 0.05, 0.1)
    v = np.linspace(-2.0, 2.0, 41)
    elevation = rough(u[:, None], v[None, :], seed=int(rng.integers(2**31)), roughness=24e-6)
    for _ in range(12):
        place, depth, length = rng.uniform(60, LENGTH - 40), rng.uniform(-0.03, 0.015), rng.uniform(0.4, 3.0)
        across = np.exp(-0.5 * ((v - rng.uniform(-1, 1)) / 0.5) ** 2)
        elevation += depth * np.exp(-0.5 * ((u - place) / (0.4 * length)) ** 2)[:, None] * across
    bend = gaussian_filter1d(rng.standard_normal(u.size), 300)
    level = np.zeros(u.size)
    return xr.Dataset(
        {
            "elevation": (("u", "v"), elevation),
            "curvature": ("u", 0.004 * bend / bend.std()),
            "slope": ("u", level),
            "bank": ("u", level),
        },
        coords={"u": u, "v": v},
    )


def make(
    seed: int,
    car,
    effects: Mapping[str, Mapping[str, float]],
    kappa: float = 1.0,
    *,
    step: float = 0.0005,
    clock: float = 0.0,
    gain: float = 0.0,
    scanner: float = 0.0,
    path_error: float = PATH_ERROR,
    background: Sequence[str] = (),
    aligned: bool = False,
) -> Trial:
    """Three repeats and a slower drive of a car that has ``effects``, scaled to ``kappa``.

    kappa is the rms of what the effects change and calibration cannot take up, over the rms of the noise floor, in the
    worst channel and the band that ride is judged in. ``effects`` give the direction: sizes are scaled from
    neutral, within what is plausible; shapes of ``tests/blind/shapes`` may be among them. ``clock`` (s) and ``gain`` spoil the
    record, ``scanner`` (m rms) the road that is handed over, ``path_error`` (m rms) the recorded path; each effect of
    the ``background`` is there at a kappa of BACKGROUND. ``aligned``: drives are handed over as alignment leaves them.
    """
    rng = np.random.default_rng(seed)
    road = a_road(rng)
    course = simulate.prepare(road)
    hidden = {name: float(rng.uniform(lower + 0.2 * (upper - lower), upper - 0.2 * (upper - lower))) for name, (lower, upper) in BOUNDS.items()}
    true_car, _ = with_values(car, {}, hidden)
    demands = [_demand(rng, road.u.values, speed) for speed in (SPEED, SPEED, SPEED, SLOWER * SPEED)]
    every = tuple(effects) + tuple(background)
    drive = lambda vehicle, sizes, demand: simulate.run(
        course, vehicle, effects={**_quiet(every), **sizes}, effects_folder=SHAPES, sensor=SENSOR, step=step, **demand
    )
    noises = [_noise(rng, drive, true_car, demand, path_error) for demand in demands]
    scale, reached = _scale(drive, true_car, effects, kappa, demands[0], noises[0][0]) if effects else (0.0, 0.0)
    sizes = scaled(effects, scale)
    known = library.find(SHAPES)
    for name in background:
        one = {name: known[name].effect.values()}
        sizes |= scaled(one, _scale(drive, true_car, one, BACKGROUND, demands[0], noises[0][0])[0])
    drives = []
    for k, (demand, (noise, error)) in enumerate(zip(demands, noises)):
        record = drive(true_car, sizes, demand)
        for channel, name in enumerate(SIGNALS):
            record[name] = (1 + gain) * record[name] + noise[channel][: record.sizes["time"]]
        record["e"] = record["e"] + np.interp(record["s"], road.u.values, error)
        record = record[list(DRIVE)].isel(time=slice(200, None)).assign_attrs(
            name=f"drive_{k + 1}", role="check" if k == 3 else "fit", gravity=0, cut_off=45.0, place_measured=1,
            lateral_position=0.0, sensor_x=SENSOR[0], sensor_y=SENSOR[1], sensor_z=SENSOR[2],
        )  # fmt: skip
        if clock:
            record["s"] = record["s"] + clock * record["v_x"]
        drives.append(record)
    if scanner:
        road = road.assign(elevation=road["elevation"] + scanner * rng.standard_normal(road["elevation"].shape))
    if aligned:
        scanned = simulate.prepare(road)
        drives = [align.align(record, scanned, car, simulate=simulate.run) for record in drives]
    truth = {"effects": sizes, "scale": scale, "car": hidden, "kappa": kappa, "reached": reached}
    return Trial({"trial": (road, drives)}, truth)


def _quiet(names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Effects that do nothing, so that one compiled kernel serves for all simulations of a trial."""
    known = library.find(SHAPES)
    return {name: dict(known[name].effect.neutral) for name in names if known[name].effect.port in COMPILED}


def scaled(effects, factor: float) -> dict[str, dict[str, float]]:
    """Sizes at ``factor`` of the way from neutral to those given, within what is plausible."""
    known, sizes = library.find(SHAPES), {}
    for name, given in effects.items():
        sizes[name] = {}
        for parameter in known[name].effect.parameters:
            value = parameter.neutral + factor * (given.get(parameter.name, parameter.typical) - parameter.neutral)
            if parameter.neutral == parameter.typical:
                value = given.get(parameter.name, parameter.typical)
            sizes[name][parameter.name] = float(np.clip(value, *parameter.plausible))
    return sizes


def _demand(rng, u, speed) -> dict:
    wander = gaussian_filter1d(rng.standard_normal(u.size), 300)
    pace = gaussian_filter1d(rng.standard_normal(u.size), 500)
    path = rng.normal(0.0, 0.1) + 0.03 * wander / wander.std()
    target = speed + rng.normal(0, 0.2) + 0.1 * pace / pace.std()
    over_u = {"coords": {"u": u}, "dims": "u"}
    return {"speed": xr.DataArray(target, **over_u), "lateral": xr.DataArray(path, **over_u)}


def _noise(rng, drive, vehicle, demand, path_error):
    """Noise (6, time) with which a drive is recorded, what a wrong path makes of it included, and the error of the path over u."""
    u = demand["lateral"].u.values
    error = gaussian_filter1d(rng.standard_normal(u.size), PATH_LENGTH / 0.1)
    error *= path_error / error.std()
    record = drive(vehicle, {}, demand)
    white = rng.standard_normal((6, record.sizes["time"] + 500))
    return white * np.array([ACCELEROMETER] * 3 + [GYROSCOPE] * 3)[:, None], error


def _signals(record) -> np.ndarray:
    """Signals (6, time) in the band that is judged."""
    values = np.stack([record[name].values for name in SIGNALS])
    bins = np.fft.rfft(values - values.mean(axis=1, keepdims=True), axis=1)
    frequency = np.fft.rfftfreq(values.shape[1], 0.01)
    lowest = np.array([cars.LOWEST_OF_DRIVER.get(name, cars.LOWEST) for name in SIGNALS])
    return np.fft.irfft(np.where(frequency > lowest[:, None], bins, 0.0), values.shape[1], axis=1)


def _scale(drive, vehicle, effects, kappa, demand, noise) -> tuple[float, float]:
    """Factor of the sizes at which what calibration leaves of the effect is kappa times the noise in the worst channel, and
    the kappa that is reached: a plausible size may be too small for it."""
    base = _signals(drive(vehicle, {}, demand))
    error = {**demand, "lateral": demand["lateral"] + PATH_ERROR}
    lost = _signals(drive(vehicle, {}, error))
    count = min(base.shape[1], lost.shape[1])
    floor = np.sqrt((lost[:, 200:count] - base[:, 200:count]).var(axis=1) + noise[:, :count].var(axis=1))
    columns = []
    steps = {name: 0.02 * (upper - lower) for name, (lower, upper) in BOUNDS.items()}
    steps |= {name: 0.01 * vehicle[name] for name in cars.UNCERTAIN}
    for name, change in steps.items():
        moved = _signals(drive(with_values(vehicle, {}, {name: vehicle[name] + change})[0], {}, demand))
        columns.append(((moved[:, 200:count] - base[:, 200 : moved.shape[1]][:, : count - 200]) / floor[:, None]).ravel())
    matrix = np.stack(columns, axis=1)
    factor, found = 1.0, 0.0
    for turn in range(4):
        changed = _signals(drive(vehicle, scaled(effects, factor), demand))
        span = min(count, changed.shape[1])
        change = (changed[:, 200:span] - base[:, 200:span]) / floor[:, None]
        rows = matrix.reshape(6, -1, len(steps))[:, : span - 200].reshape(-1, len(steps))
        left = change.ravel() - rows @ np.linalg.lstsq(rows, change.ravel(), rcond=None)[0]
        found = np.sqrt(np.mean(left.reshape(6, -1) ** 2, axis=1)).max()
        if turn < 3:
            factor *= kappa / max(found, 1e-12)
    return float(factor), float(found)
