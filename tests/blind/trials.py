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
from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import explain, judged, opening
from ridecomfort.discrepancy.car import Car
from ridecomfort.discrepancy.realign import ROUNDS
from ridecomfort.drive import align
from ridecomfort.drive.sensor import TOLD_OF, displacement
from ridecomfort.errors import InputError
from ridecomfort.effects import library
from ridecomfort.effects.contract import COMPILED
from ridecomfort.calibrated import with_values
from ridecomfort.vocabulary import DRIVE, SIGNALS
from tests.vehicle.roads import rough

LENGTH, SPEED, SLOWER = 700.0, 22.0, 0.75
"""m of road, m/s of the repeats, share of it at which the drive held out goes."""

RATE = 100.0
"""Hz, of the records."""

ACCELEROMETER, GYROSCOPE = 0.03, 0.001
"""m/s2 and rad/s rms of noise at RATE: instrument, mount and engine, in the band that is judged 4 to 30 % of what the road makes, of the little yaw
rate 50 to 110 %."""

PATH_ERROR, PATH_LENGTH = 0.02, 30.0
"""m by which the recorded path is wrong (rms), and over which length."""

FOOT = 0.8
"""Hz, about which a brisk foot moves."""

BACKGROUND = 0.1
"""kappa of every effect of the background."""

WIDE = 25.0
"""Probes by which a parameter may usually be wrong: half of its bounds."""

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
    interpolation: str = "cubic",
    foot: float = 0.0,
    speed_noise: float = 0.0,
) -> Trial:
    """Three repeats and a slower drive of a car that has ``effects``, each scaled to ``kappa``.

    kappa is the rms of what an effect changes and neither alignment nor calibration can take up, over the rms of the noise floor,
    in the worst channel and the band that ride is judged in (``Remains``). ``effects`` give the direction: sizes are scaled from
    neutral, within what is plausible; shapes of ``tests/blind/shapes`` may be among them. ``clock`` (s) and ``gain`` spoil the
    record, ``scanner`` (m rms) the road that is handed over, ``path_error`` (m rms) the recorded path; each effect of
    the ``background`` is there at a kappa of BACKGROUND, if a plausible size comes up to it (``truth`` says how far). ``aligned``: drives are
    handed over as alignment leaves them.
    ``interpolation``: of the true road between its points, where the one that is handed over is cubic. ``foot`` (m/s2 rms): how briskly
    the pedals are moved, each drive otherwise (``by_foot``). ``speed_noise`` (m/s rms at RATE): of the recorded speed.
    """
    rng = np.random.default_rng(seed)
    of_foot = np.random.default_rng([seed, 1])
    road = a_road(rng)
    course = simulate.prepare(road, interpolation)
    hidden = {name: float(rng.uniform(lower + 0.2 * (upper - lower), upper - 0.2 * (upper - lower))) for name, (lower, upper) in BOUNDS.items()}
    true_car, _ = with_values(car, {}, hidden)
    demands = [_demand(rng, road.u.values, speed) for speed in (SPEED, SPEED, SPEED, SLOWER * SPEED)]
    every = tuple(effects) + tuple(background)
    for demand in demands:
        demand["speed"] = demand["speed"] + by_foot(of_foot, road.u.values, demand["speed"], foot)
    told_of = {name: car[name] for name in TOLD_OF}
    forward, up = displacement(told_of, true_car)
    sensor = SENSOR[0] + forward, SENSOR[1], SENSOR[2] + up
    drive = lambda vehicle, sizes, demand: simulate.run(
        course, vehicle, effects={**_quiet(every), **sizes}, effects_folder=SHAPES, sensor=sensor, step=step, **demand
    ).assign_attrs(told_of)
    bare = [drive(true_car, {}, demand) for demand in demands]
    errors = [_path(rng, road.u.values, path_error) for _ in demands]
    noises = [_noise(rng, record) for record in bare]
    known = library.find(SHAPES)
    wanted = [({name: sizes}, kappa) for name, sizes in effects.items()]
    wanted += [({name: known[name].effect.values()}, BACKGROUND) for name in background]
    sizes, reached = {}, []
    if wanted:
        remains = Remains(course, true_car, _recorded(bare[0]), _recorded(bare[0], noises[0], errors[0]))
    for one, its_kappa in wanted:
        factor, found = _scale(remains, lambda own: _recorded(drive(true_car, own, demands[0])), one, its_kappa)
        sizes |= scaled(one, factor)
        reached.append(found)
    drives = []
    for k, (demand, noise, error) in enumerate(zip(demands, noises, errors)):
        record = drive(true_car, sizes, demand)
        for name in SIGNALS:
            record[name] = (1 + gain) * record[name]
        record["v_x"] = record["v_x"] + speed_noise * of_foot.standard_normal(record.sizes["time"])
        drives.append(_recorded(record, noise, error, clock, number=k))
    if scanner:
        road = road.assign(elevation=road["elevation"] + scanner * rng.standard_normal(road["elevation"].shape))
    if aligned:
        scanned = simulate.prepare(road)
        drives = [align.align(record, scanned, car, simulate=simulate.run) for record in drives]
    truth = {"effects": sizes, "car": hidden, "kappa": kappa, "reached": min(reached[: len(effects)], default=0.0)}
    truth["background"] = dict(zip(background, reached[len(effects) :]))
    return Trial({"trial": (road, drives)}, truth)


def alone(trial: Trial) -> tuple[dict[str, tuple], dict]:
    """What the search is given of a trial where no drive was repeated: the first of the repeats and the drive held out, and by site and drive
    the densities of the noise that they hold."""
    ((site, (road, drives)),) = trial.measured.items()
    kept = [drives[0], drives[-1]]
    per_root_hertz = np.sqrt(2.0 / RATE)
    known = {"accelerometer": ACCELEROMETER * per_root_hertz, "gyroscope": GYROSCOPE * per_root_hertz}
    return {site: (road, kept)}, {site: {drive.attrs["name"]: known for drive in kept}}


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


def by_foot(rng, u: np.ndarray, speed, size: float) -> np.ndarray:
    """What a brisk foot on the pedals, which moves about FOOT times a second, adds to a demanded speed (m/s) over u; ``size``: in m/s2, rms.
    The demand holds nine tenths of it and the car does two thirds."""
    period = 1.0 / (2.0 * np.pi * FOOT)
    steps = rng.standard_normal(u.size)
    width = float(speed.mean()) * period / (u[1] - u[0])
    asked = gaussian_filter1d(steps, width) - gaussian_filter1d(steps, 4.0 * width)
    return size * period * asked / asked.std()


def _path(rng, u: np.ndarray, size: float) -> xr.DataArray:
    """By how much the recorded lateral position is wrong, over u."""
    error = gaussian_filter1d(rng.standard_normal(u.size), PATH_LENGTH / (u[1] - u[0]))
    return xr.DataArray(size * error / error.std(), {"u": u}, "u")


def _noise(rng, record: xr.Dataset) -> np.ndarray:
    """Noise (6, time) of a drive about as long as ``record``."""
    white = rng.standard_normal((6, record.sizes["time"] + 500))
    return white * np.array([ACCELEROMETER] * 3 + [GYROSCOPE] * 3)[:, None]


def _recorded(run: xr.Dataset, noise=None, error=None, clock: float = 0.0, number: int = 0) -> xr.Dataset:
    """A simulated run as the record of drive ``number``: with noise (6, time), a wrong path and place, its first 2 s left out."""
    run = run.copy()
    if noise is not None:
        for channel, name in enumerate(SIGNALS):
            run[name] = run[name] + noise[channel][: run.sizes["time"]]
    if error is not None:
        run["e"] = run["e"] + np.interp(run["s"], error.u.values, error.values)
    if clock:
        run["s"] = run["s"] + clock * run["v_x"]
    return run[list(DRIVE)].isel(time=slice(200, None)).assign_attrs(
        name=f"drive_{number + 1}", role="check" if number == 3 else "fit", gravity=0, cut_off=50.0, place_measured=1,
        lateral_position=0.0, sensor_x=SENSOR[0], sensor_y=SENSOR[1], sensor_z=SENSOR[2],
    )  # fmt: skip


class Remains:
    """What of a record neither alignment nor calibration of a car without effects can take up, in units of the noise floor, beyond
    what they leave of one without effects.

    ``course``, ``vehicle``: the true ones. ``bare``: a record of the car without effects, ``noisy`` the same with its noise, of which
    the floor is what remains.
    """

    def __init__(self, course, vehicle, bare: xr.Dataset, noisy: xr.Dataset):
        self.course, self.vehicle = course, vehicle
        own = self._car(bare)
        values = opening.start_values(own)
        residual = own.residual(values, 0)
        moved = [WIDE * exp.secant(own, values, {0: residual}, size, 1.0)[0] for size in own.free]
        nuisances = own.nuisances(values, 0)
        self.nuisances, self.rows = len(nuisances), _judged(np.stack([*nuisances, *moved]))
        self.floor = np.array([ACCELEROMETER] * 3 + [GYROSCOPE] * 3)
        self.bare = None
        self.floor = self.floor * np.sqrt(np.mean(self(noisy) ** 2, axis=1))
        self.bare = self(bare)

    def __call__(self, record: xr.Dataset) -> np.ndarray:
        """Remainder (6, sample)."""
        own = self._car(record)
        amounts, left = self._fit(own)
        for _ in range(ROUNDS):
            own = own.realigned({0: amounts[: self.nuisances]}).retuned(opening.start_values(own), [0])[0]
            amounts, closer = self._fit(own)
            if np.sum(closer**2) >= np.sum(left**2):
                break
            left = closer
        if self.bare is None:
            return left
        count = min(left.shape[1], self.bare.shape[1])
        return left[:, :count] - self.bare[:, :count]

    def _fit(self, own: Car) -> tuple[np.ndarray, np.ndarray]:
        """Likely amounts of the rows, each of its usual size, in a residual, and what they leave of it (6, sample)."""
        residual = _judged(own.residual(opening.start_values(own), 0))
        count = min(residual.shape[1], self.rows.shape[2])
        residual = residual[:, :count] / self.floor[:, None]
        rows = (self.rows[:, :, :count] / self.floor[:, None]).reshape(len(self.rows), -1)
        amounts = np.linalg.solve(rows @ rows.T + np.eye(len(rows)), rows @ residual.ravel())
        return amounts, residual - (amounts @ rows).reshape(6, -1)

    def _car(self, record: xr.Dataset) -> Car:
        return opening.car([opening.Site("trial", self.course, [record])], self.vehicle, library_names=[])


def _judged(series: np.ndarray) -> np.ndarray:
    """Series (..., 6, sample) in the band that is judged, the second at both ends left out."""
    fast = judged.judged(series, RATE, SIGNALS)
    return judged.band(fast, RATE, (0.0, explain.HIGHEST * 0.5 * RATE))[..., 100:-100]


def _scale(remains: Remains, drive, effects, kappa: float) -> tuple[float, float]:
    """Factor of the sizes at which kappa is reached in the worst channel, and the kappa that is reached: a plausible size may
    be too small for it."""
    factor, reached = 1.0, (0.0, 0.0)
    for _ in range(4):
        try:
            found = float(np.sqrt(np.mean(remains(drive(scaled(effects, factor))) ** 2, axis=1)).max())
        except InputError:  # so much of it that the car does not arrive
            factor *= 0.5
            continue
        reached = factor, found
        factor *= kappa / max(found, 1e-12)
    return reached
