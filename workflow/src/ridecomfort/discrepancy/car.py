"""Measured drives and the vehicle that is meant to explain them, as an Experiment."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr
from scipy.interpolate import BSpline

from .. import calibrate
from .. import simulate as simulator
from ..drive.record import unstack, upward
from ..drive.replay import Replay, Simulated, replay
from ..effects import library
from ..effects.contract import COMPILED
from ..calibrated import apply, with_values
from ..vehicle.parameters import PARAMETERS
from ..vocabulary import SIGNALS, STANDARD_GRAVITY, VARIABLES
from . import pool
from .candidates import candidate
from .experiment import Candidate, Record, Size
from .explain import INSTRUMENT, SAME_SPEED
from .judged import LOWEST, LOWEST_OF_DRIVER

CALIBRATION_PROBE = 0.02
"""Share of the bounds' width that a calibrated parameter is probed with."""

HIGHEST = 0.85
"""Share of the records' own cut-off up to which errors are judged."""

BLOCK = 1.0
"""s at the mean speed; white errors farther apart are independent."""

KNOTS = 30.0
"""m between the knots of what alignment may still get wrong of the place along and across the road. Paths wander within some
ten metres; a vehicle that is pushed aside by a centimetre meets another road, so that a path which is straighter than the driven
one makes evidence for whatever pushes (lift, cross-wind), and sizes too small and too sure."""

CLOCK, PATH, OTHERWISE, GAIN, TILT, BIAS = 0.002, 0.05, 0.7, 0.02, 0.02, (0.1, 0.1, 0.1, 0.01, 0.01, 0.01)
"""Usual sizes of what alignment leaves: s, m, share of the way to the other interpolation, 1, rad, and m/s2 or rad/s."""

ASTRAY, CORRECTED = {"speed": 0.01, "lateral": 0.003}, 2
"""m/s and m (rms) that a model may be off the measured speed and path before its driver is corrected, and how often that is done."""

SETTLING = 1.5
"""s after the run-in that are left out too: at rest on level ground a vehicle with an effect stands otherwise."""

RUN_OUT = 0.5
"""s at the end that are left out: low-pass filters of records and of simulations end there without knowing what comes."""

UNCERTAIN = {
    "roll_inertia": 0.1,
    "pitch_inertia": 0.1,
    "yaw_inertia": 0.1,
    "cg_height": 0.1,
    "damping_front": 0.15,
    "damping_rear": 0.15,
    "anti_roll_stiffness_front": 0.15,
    "anti_roll_stiffness_rear": 0.15,
    "cornering_stiffness": 0.15,
}
"""Parameters that no calibration fits but nobody knows better than to this share: they must not pass for an effect."""

BETWEEN, OF_FORCE, OF_RATES = -12, -11, -10
"""Where the road's other interpolation and the two gains stand among the nuisances of a record, from their end: three tilts and
six biases follow."""

@dataclass(frozen=True)
class Site:
    """A road with the aligned drives on it, ready to be driven on."""

    name: str
    course: object
    drives: Sequence[xr.Dataset]


@dataclass
class Car:
    """Drives on one or several sites beside a vehicle with ``effects`` (those the model already has)."""

    records: list[Record]
    replays: list[Replay]
    vehicle: object
    effects: Mapping[str, Mapping[str, float]]
    free: tuple[Size, ...]
    candidates: tuple[Candidate, ...]
    quiet: Mapping[str, Mapping[str, float]]
    """Effects that are in every simulation at neutral values, so that one compiled kernel serves for all of them."""
    channels: tuple[str, ...] = SIGNALS
    each_record: Callable = map
    exactness: Mapping[int, np.ndarray] = field(default_factory=dict)
    """By record, what a residual (6, sample) lacks because the step of integration is not nil."""
    driven: Mapping[int, tuple[Mapping[str, float], Simulated]] = field(default_factory=dict)
    """By record, the values at which its replay was driven last, and what the model did."""

    def looking_for(self, candidates: Sequence[Candidate], folder) -> Car:
        """The same with these candidates, whose effects are in the files of a folder."""
        known = library.find(folder)
        names = {size.key.partition(".")[0] for candidate in candidates for size in candidate.sizes}
        quiet = {name: known[name].effect.neutral for name in names}
        replays = [replace(again, options={**again.options, "effects_folder": folder}) for again in self.replays]
        return replace(self, candidates=tuple(candidates), quiet=quiet, replays=replays)

    def residual(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """Simulated minus measured signals (6, sample) behind the run-in of the model."""
        again, run = self._driven(values, index)
        return self._residual(index, again, again.sample(run))

    def _residual(self, index: int, again: Replay, simulated: Simulated) -> np.ndarray:
        return again.residual(simulated)[:, again.compared] + self.exactness.get(index, 0.0)

    def simulated(self, values: Mapping[str, float], index: int) -> Simulated:
        """What the model does on a drive."""
        known, simulated = self.driven.get(index, (None, None))
        if known == dict(values):
            return simulated
        again, run = self._driven(values, index)
        return again.sample(run)

    def _driven(self, values: Mapping[str, float], index: int) -> tuple[Replay, xr.Dataset]:
        """A drive along the measured path at the measured speed, with the replay whose driver did so.

        An effect that moves a vehicle aside makes it meet another road, unless its driver makes up for it as the measured one did.
        """
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        again, effects = self.replays[index], {**self.quiet, **effects}
        run = again.run(vehicle, effects)
        for _ in range(CORRECTED):
            astray = again.astray(run)
            if all(np.sqrt(np.mean(missing[again.compared] ** 2)) < ASTRAY[name] for name, missing in astray.items()):
                break
            again = again.corrected(astray)
            run = again.run(vehicle, effects)
        return again, run

    def nuisances(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """What alignment and the road's file leave open, each at its usual size, (direction, 6, sample): slow errors of the
        clock and of the path, the road between its points, gains, tilts and biases."""
        again = self.replays[index]
        kept = again.compared
        simulated = self.simulated(values, index)
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        splines = _splines(again.place[kept], KNOTS)
        up = STANDARD_GRAVITY * upward(simulated.roll, simulated.pitch)[:, kept]
        force = simulated.signals[:3, kept] + up * float(again.drive.attrs.get("gravity", 0))
        rates = simulated.signals[3:, kept]
        rows = np.zeros((2 * len(splines) - BETWEEN, len(SIGNALS), kept.sum()), np.float32)
        aside = again.aside(vehicle, {**self.quiet, **effects})
        for own, slow in ((rows, simulated.slopes[:, kept]), (rows[len(splines) :], aside[:, kept])):
            for row, spline in zip(own, splines):
                there = spline > 0
                row[:, there] = spline[there] * slow[:, there]
        rows[BETWEEN] = (self._otherwise(again, vehicle, effects) - simulated.signals)[:, kept]
        rows[OF_FORCE, :3], rows[OF_RATES, 3:] = force, rates
        for row, axis in zip(rows[OF_RATES + 1 :], np.eye(3)):
            row[:3], row[3:] = np.cross(axis, force.T).T, np.cross(axis, rates.T).T
        rows[-len(SIGNALS) :] = np.eye(len(SIGNALS))[:, :, None]
        rows *= _usual(len(rows))[:, None, None]
        return rows

    def _otherwise(self, again: Replay, vehicle, effects) -> np.ndarray:
        """The signals (6, time) on a road that is interpolated the other way, or as they are where there is only one."""
        if isinstance(again.road, simulator.Course):
            again = replace(again, road=again.road.otherwise())
        return again(vehicle, {**self.quiet, **effects}).signals

    def between(self, amounts: np.ndarray) -> float:
        """Share of the way from the road's interpolation to the other one that these amounts of the nuisances (direction,) stand for."""
        return -OTHERWISE * float(amounts[BETWEEN])

    def gains(self, amounts: np.ndarray) -> tuple[float, float]:
        """Gains of the accelerometer and of the gyroscope that these amounts of the nuisances (direction,) stand for."""
        return 1.0 - GAIN * float(amounts[OF_FORCE]), 1.0 - GAIN * float(amounts[OF_RATES])

    def shifts(self, other: Car, index: int) -> np.ndarray:
        """By how many seconds this puts the samples of a record later against their place than ``other`` does, (sample,)."""
        mine, its = self.replays[index], other.replays[index]
        shift = np.interp(its.place, mine.place, mine.time) - mine.time
        return shift[mine.compared]

    def retuned(
        self, values: Mapping[str, float], indices: Sequence[int], exactly: bool = False
    ) -> tuple[Car, dict[int, np.ndarray]]:
        """The same with drivers who bring the model to the measured speed and path at these values, and the residuals then.

        ``exactly``: with what the step makes wrong at these values made good in the residuals from now on. The error falls with the
        square of the step: half a step takes three quarters of it, and four thirds of that change are all of it. On a quiet record,
        0.05 percent of the power of a_y is enough to pass for tyres that envelop 6 cm.
        """

        def driven(index: int) -> tuple[Replay, Simulated, np.ndarray | float]:
            again, run = self._driven(values, index)
            simulated = again.sample(run)
            return again, simulated, self._missing(values, again, simulated) if exactly else self.exactness.get(index, 0.0)

        found = dict(zip(indices, self.each_record(driven, indices)))
        retuned = replace(
            self,
            replays=[found[index][0] if index in found else again for index, again in enumerate(self.replays)],
            exactness={**self.exactness, **{index: missing for index, (_, _, missing) in found.items()}},
            driven={**self.driven, **{index: (dict(values), simulated) for index, (_, simulated, _) in found.items()}},
        )
        return retuned, {index: retuned._residual(index, again, simulated) for index, (again, simulated, _) in found.items()}

    def _missing(self, values: Mapping[str, float], again: Replay, simulated: Simulated) -> np.ndarray | float:
        """What a residual (6, sample) lacks because the step of integration is not nil."""
        fine = _finer(again)
        if fine is again:
            return 0.0
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        return 4.0 / 3.0 * (fine(vehicle, {**self.quiet, **effects}).signals - simulated.signals)[:, again.compared]

    def taking(self, other: Car, indices: Collection[int]) -> Car:
        """The same with these records as ``other`` has them."""
        mixed = lambda mine, its: [its[i] if i in indices else one for i, one in enumerate(mine)]
        driven = {i: known for i, known in self.driven.items() if i not in indices}
        driven |= {i: known for i, known in other.driven.items() if i in indices}
        return replace(
            self, replays=mixed(self.replays, other.replays), records=mixed(self.records, other.records), driven=driven
        )

    def realigned(self, amounts: Mapping[int, np.ndarray]) -> Car:
        """The same with slow errors of the clock (s) and of the path (m) taken out; biases, gains and tilts stay linear."""
        replays, records = list(self.replays), list(self.records)
        for index, found in amounts.items():
            again = replays[index]
            kept = again.compared
            splines = _splines(again.place[kept], KNOTS)
            found = found * _usual(len(found))
            later, left = found[: len(splines)] @ splines, found[len(splines) : 2 * len(splines)] @ splines
            shift = np.interp(again.time, again.time[kept], later)
            place = np.interp(again.time - shift, again.time, again.place)
            lateral, u = again.demand["lateral"], again.demand["speed"]["u"].values
            aside = xr.DataArray(np.interp(u, again.place[kept], left), {"u": u}, "u")
            drive = again.drive.assign(e=again.drive["e"] - np.interp(again.time, again.time[kept], left))
            replays[index] = replace(again, drive=drive, place=place, demand={**again.demand, "lateral": lateral - aside})
            records[index] = replace(records[index], place=place[kept])
        driven = {index: known for index, known in self.driven.items() if index not in amounts}
        return replace(self, replays=replays, records=records, driven=driven)


def car(
    sites: Sequence[Site],
    vehicle,
    *,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    effects_folder=None,
    fitted_on: Sequence[str] | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    uncertain: Mapping[str, float] | None = None,
    library_names: Sequence[str] | None = None,
    simulate: Callable[..., xr.Dataset] = simulator.run,
    noise_density: Mapping[str, Mapping[str, Mapping[str, float]]] | None = None,
    options: Mapping | None = None,
    each_record: Callable = map,
) -> Car:
    """The experiment of these drives. ``vehicle`` and ``effects`` are the calibrated ones.

    Drives of role "fit" on the sites ``fitted_on`` (by default the first) are fitted, the others of those sites and one of
    each speed of the other sites are held out.
    ``bounds``: of calibrated parameters, beside tab:constraints. ``uncertain``: share by which further
    parameters of the vehicle may be wrong (default UNCERTAIN). ``noise_density``: of the instruments by site and drive, as for
    ``explain.explain``. ``library_names``: the effects to look
    among, by default all of the library and of the user's folder but those of the model. ``each_record``: a ``map`` over drives.
    """
    effects = {name: dict(sizes or {}) for name, sizes in (effects or {}).items()}
    fitted_on = list(fitted_on) if fitted_on else [sites[0].name]
    options = {"effects_folder": effects_folder, **(options or {})}

    def tuned(job: tuple[Site, xr.Dataset]) -> Replay:
        site, drive = job
        return replay(drive, site.course, simulate, options=options).tuned(vehicle, effects)

    sites = [site if site.name in fitted_on else replace(site, drives=_once_a_speed(site.drives)) for site in sites]
    ready = iter(each_record(tuned, [(site, drive) for site in sites for drive in site.drives]))
    records, replays = [], []
    for site in sites:
        speeds: list[float] = []
        for drive in site.drives:
            again = next(ready)
            first, last = again.time[again.compared][[0, -1]] + (SETTLING, -RUN_OUT)
            again = replace(again, compared=again.compared & (again.time >= first) & (again.time <= last))
            role = "fit" if site.name in fitted_on and drive.attrs.get("role", "fit") == "fit" else "check"
            density = (noise_density or {}).get(site.name, {}).get(str(drive.attrs["name"]), {})
            noise = tuple(density.get(INSTRUMENT[VARIABLES[name].unit], 0.0) for name in SIGNALS) if density else ()
            records.append(replace(_record(site.name, again, role, speeds, len(sites) > 1), noise=noise))
            replays.append(again)
    known = library.find(effects_folder)
    chosen = [entry for entry, _ in library.choose(effects, effects_folder)]
    for entry in chosen:
        effects[entry.effect.name] = entry.effect.values(effects[entry.effect.name])
    limits = {name: pair for name, pair in {**calibrate.BOUNDS, **(bounds or {})}.items() if "." not in name}
    free = [_calibrated(name, vehicle[name], pair) for name, pair in limits.items()]
    for name, share in (UNCERTAIN if uncertain is None else uncertain).items():
        span = PARAMETERS[name]
        lower, upper = (min(max(vehicle[name] * factor, span.lower), span.upper) for factor in (1 - share, 1 + share))
        if lower < upper:  # what a vehicle has not, as a bar, is no size of it
            free.append(_calibrated(name, vehicle[name], (lower, upper)))
    for entry in chosen:
        own = candidate(entry.effect)
        free += [replace(size, neutral=effects[entry.effect.name][size.key.partition(".")[2]]) for size in own.sizes]
    wanted = sorted(known if library_names is None else library_names)
    candidates = tuple(candidate(known[name].effect) for name in wanted if name not in effects)
    quiet = {n: known[n].effect.neutral for n in wanted if n not in effects and known[n].effect.port in COMPILED}
    sized = tuple(c for c in candidates if c.sizes)
    return Car(records, replays, vehicle, effects, tuple(free), sized, quiet, each_record=each_record)


def opened(
    measured: Mapping[str, tuple], vehicle, *, calibration: xr.Dataset | None = None, effects=None, among=None, workers=None, **settings
) -> Car:
    """The experiment of ``measured`` drives, mapping of site to (road, aligned drives), beside a vehicle and its ``calibration``.

    ``among``: names of the effects to look among; ``workers``: drives side by side, by default one for each core; ``settings`` as for
    ``car``.
    """
    vehicle, effects = apply(calibration, vehicle, effects)
    count = pool.workers() if workers is None else workers
    each = pool.side_by_side(count)
    return car(sites_of(measured), vehicle, effects=effects, library_names=among, each_record=each, **settings)


def _same(speed: float, speeds: Sequence[float]) -> float | None:
    """The first of ``speeds`` at which a drive repeats one at ``speed``."""
    return next((known for known in speeds if abs(known - speed) < SAME_SPEED * known), None)


def _finer(again: Replay) -> Replay:
    """The same at half the step, where the simulator is the study's own."""
    if again.simulate is not simulator.run:
        return again
    return replace(again, options={**again.options, "step": 0.5 * again.options.get("step", simulator.STEP)})


def _once_a_speed(drives: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """The first drive of every mean speed."""
    speeds, kept = [], []
    for drive in drives:
        speed = float(drive["v_x"].mean())
        if _same(speed, speeds) is None:
            speeds.append(speed)
            kept.append(drive)
    return kept


def sites_of(measured: Mapping[str, tuple]) -> list[Site]:
    """Sites from a mapping of name to (road, measured drives): roads are prepared, stacked drives taken apart."""
    return [
        Site(
            name,
            road if isinstance(road, simulator.Course) else simulator.prepare(road),
            unstack(drives) if isinstance(drives, xr.Dataset) else list(drives),
        )
        for name, (road, drives) in measured.items()
    ]


def start_values(experiment: Car) -> dict[str, float]:
    """The values that the calibrated model has."""
    return {size.key: float(np.clip(size.neutral, size.lower, size.upper)) for size in experiment.free}


def _calibrated(name: str, value: float, bounds: Sequence[float]) -> Size:
    lower, upper = map(float, bounds)
    return Size(name, PARAMETERS[name].unit, float(value), lower, upper, CALIBRATION_PROBE * (upper - lower))


def _record(site: str, again: Replay, role: str, speeds: list[float], several: bool) -> Record:
    place, time = again.place[again.compared], again.time[again.compared]
    speed = float(np.ptp(place) / np.ptp(time))
    same = _same(speed, speeds)
    if same is None:
        speeds.append(speed)
    rate = float((len(time) - 1) / np.ptp(time))
    band = (LOWEST, min(HIGHEST * float(again.drive.attrs["cut_off"]), 0.45 * rate))
    name = str(again.drive.attrs["name"])
    return Record(
        f"{site} {name}" if several else name, role, site, f"{site} at {3.6 * (same or speed):.0f} km/h", rate, band,
        place, BLOCK * (same or speed), tuple(LOWEST_OF_DRIVER.get(name, LOWEST) for name in SIGNALS),
    )  # fmt: skip


def _usual(count: int) -> np.ndarray:
    """Usual sizes of ``count`` nuisances of a record."""
    splines = (count + BETWEEN) // 2
    return np.array([CLOCK] * splines + [PATH] * splines + [OTHERWISE, GAIN, GAIN, *[TILT] * 3, *BIAS], np.float32)


def _splines(place: np.ndarray, spacing: float) -> np.ndarray:
    """Cubic B-splines over the place, knots about ``spacing`` apart: slow functions that sum to one, (spline, sample)."""
    pieces = max(1, int(round(np.ptp(place) / spacing)))
    inner = np.linspace(place.min(), place.max(), pieces + 1)
    knots = np.concatenate([np.full(3, inner[0]), inner, np.full(3, inner[-1])])
    return BSpline.design_matrix(np.clip(place, inner[0], inner[-1]), knots, 3).toarray().T
