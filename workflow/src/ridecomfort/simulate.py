"""Simulated drives: a vehicle on a road, as an instrument on the body would record it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import xarray as xr
from numba import njit
from numba.core.errors import NumbaError

from .drive.sampling import HALF_WIDTH, KAISER
from .effects import compose, in_python, library
from .errors import InputError
from .road import edges, surface
from .vehicle import driver
from .vehicle.constants import Constants, constants, wheel_table
from .vehicle.ground import Surface
from .vehicle.motion import COLUMNS, SENSED
from .vehicle.parameters import Vehicle
from .vocabulary import describe

STEP = 0.001
"""s; a_z then differs by less than 0.5 % rms from its limit (tests/vehicle/test_convergence.py)."""

RATE = 100.0
"""Hz of the records, as the paper's instrument."""

FARTHEST = 1e7
"""m or m/s beyond which a simulated drive has lost all measure."""

FASTEST_CHANGE = 1e4
"""m/s2 of the sensor beyond which it has, too."""

AROUND, TIGHTEST, HARDEST = 10.0, 0.25, 15.0
"""m around a place within which a bend is looked for, and 1/m, or m/s2 at the speed that is asked for there, from which on no car follows it."""

OVERHANG = 2.0
"""m of road kept free beyond the axles at either end."""


@dataclass(frozen=True)
class Course:
    """A road made ready to be driven on many times."""

    surface: Surface
    elevation: np.ndarray
    u: np.ndarray
    curvature: np.ndarray
    road: xr.Dataset

    def on_u(self, target: float | np.ndarray | xr.DataArray, what: str) -> np.ndarray:
        """A number, an array on the u of the road, or a DataArray over u as values on the u of the road; ends are held."""
        if isinstance(target, xr.DataArray):
            if target.dims != ("u",):
                raise InputError(f"has dimensions {target.dims}, expected ('u',)", place=what)
            own = target.u.values
            values = target.values.astype(float) if np.array_equal(own, self.u) else np.interp(self.u, own, target.values)
        else:
            values = np.asarray(target, dtype=float)
            if values.shape not in ((), self.u.shape):
                raise InputError(f"has the shape {values.shape}, expected a number, a value for each of the {self.u.size} u of the road, or a DataArray over u", place=what)
            values = np.broadcast_to(values, self.u.shape)
        if not np.isfinite(values).all():
            raise InputError("is not finite everywhere", place=what)
        return values

    @cached_property
    def spacing(self) -> np.ndarray:
        """Way in m for which each point of the road stands, (u,)."""
        return np.gradient(self.u)

    def otherwise(self) -> Course:
        """The same with the other interpolation between the points: linear for cubic, cubic for linear."""
        return replace(self, surface=self.surface._replace(smooth=not self.surface.smooth))


def prepare(road: xr.Dataset, interpolation: str | None = None) -> Course:
    """The road made ready for `run`, worth it when driving on it more than once.

    ``interpolation``: "cubic" or "linear"; by default what the road says (`surface.INTERPOLATION` where it does not).
    """
    surface.require(road, "elevation", "bank", "curvature")
    elevation, u0, du, v0, dv = surface.grid(road)
    smooth = (interpolation or road.attrs.get("interpolation", surface.INTERPOLATION)) == "cubic"
    return Course(
        Surface(u0, 1.0 / du, v0, 1.0 / dv, smooth),
        elevation,
        road.u.values,
        driver.smooth_curvature(road),
        road,
    )


def run(
    road: xr.Dataset | Course,
    vehicle: Vehicle,
    *,
    speed: float | xr.DataArray,
    lateral: float | xr.DataArray = 0.0,
    friction: float = 1.0,
    effects=(),
    effects_folder=None,
    sensor: tuple[float, float, float] = (0.0, 0.0, 0.0),
    start: float | None = None,
    end: float | None = None,
    step: float = STEP,
    rate: float = RATE,
) -> xr.Dataset:
    """One drive along the road: the drive's variables over time, with roll and pitch.

    ``speed`` (m/s) and ``lateral`` (m, positive to the left) are what the driver aims for: a
    number, an array on the u of the road or a DataArray over u. ``friction`` of the road, 1 when dry. ``effects``: names, or
    a mapping of name to {parameter: value}. ``sensor``: its place in m relative to the centre
    of gravity of the sprung mass. ``start`` and ``end``: m along the reference line; the whole
    road by default. ``step`` of the integration in s, ``rate`` of the records in Hz. A sensor stays at its place on the body
    where an effect moves the centre of gravity, and ``s`` is told of where that of ``vehicle`` lies.

    Accelerations are those of the sensor in body axes without gravity. They and the rates are band-limited below
    half the rate before they are sampled, as an instrument does it: of a roll rate on a rough road some percent of what is
    sampled at 25 to 40 Hz would else be folded down from above 50 Hz. What an instrument gets wrong, it does before that.

    Raises InputError for a road with holes, for an effect that does not exist or does not work, and for what cannot be driven.
    """
    if not isinstance(vehicle, Vehicle):
        raise InputError(f"{vehicle!r:.60}, expected a Vehicle, as `vehicle.parameters.read` gives it from its file", place="vehicle")
    course = road if isinstance(road, Course) else prepare(road)
    chosen = library.choose(effects, effects_folder)
    changed = vehicle
    for entry, sizes in chosen:
        if entry.effect.port == "vehicle":
            changed = in_python.answer(entry, sizes, changed)
    fixed = _on_body(sensor, vehicle, changed)
    back = fixed[0] - sensor[0]
    start, end = (None if place is None else place - back for place in (start, end))
    believed = course.on_u(lateral, "lateral")
    driven = believed
    for entry, sizes in chosen:
        if entry.effect.port == "path":
            driven = in_python.answer(entry, sizes, driven.copy(), course.u)  # an act may change it in place
    every = _every(step, rate)
    sensing = [(entry, sizes) for entry, sizes in chosen if entry.effect.port == "sensor"]
    own = 1 if sensing else every
    record = _record(course, changed, course.on_u(speed, "speed"), driven, friction, chosen, fixed, start, end, step, own)
    if driven is not believed:
        record[:, COLUMNS.index("e")] -= np.interp(record[:, COLUMNS.index("s")], course.u, driven - believed)
    record[:, COLUMNS.index("s")] += back
    drive = xr.Dataset(
        {name: xr.Variable("time", column) for name, column in zip(COLUMNS, record.T, strict=True)},
        coords={"time": np.arange(len(record)) * own / (every * rate)},
        attrs={"sensor_x": sensor[0], "sensor_y": sensor[1], "sensor_z": sensor[2], "vehicle": vehicle.name},
    )
    for entry, sizes in sensing:
        drive = in_python.answer(entry, sizes, drive)
    return describe(_sampled(drive, every) if own < every else drive)


def runs(
    road: xr.Dataset | Course,
    vehicle: Vehicle,
    *,
    speed: xr.DataArray,
    speed_deviation,
    lateral_position,
    road_friction,
    effects=(),
    effects_folder=None,
    step: float = STEP,
    rate: float = RATE,
    progress=None,
) -> xr.Dataset:
    """Many drives: the drive's variables over (run, time) in float32, NaN after the end of a run.

    ``speed``: profile of the site over u in m/s, to which each ``speed_deviation`` is added;
    ``lateral_position`` in m and ``road_friction``: one value a run. ``progress`` is called
    with the number of runs done after each.
    """
    course = road if isinstance(road, Course) else prepare(road)
    profile = course.on_u(speed, "speed")
    records = []
    for number, (deviation, lateral, friction) in enumerate(
        zip(speed_deviation, lateral_position, road_friction, strict=True), start=1
    ):
        target = xr.DataArray(np.maximum(profile + float(deviation), driver.SLOWEST), {"u": course.u}, "u")
        drive = run(
            course, vehicle, speed=target, lateral=float(lateral), friction=float(friction),
            effects=effects, effects_folder=effects_folder, step=step, rate=rate,
        )  # fmt: skip
        records.append(np.stack([drive[name].values for name in COLUMNS]).astype(np.float32))
        if progress is not None:
            progress(number)
    longest = max(record.shape[1] for record in records)
    table = np.full((len(COLUMNS), len(records), longest), np.nan, dtype=np.float32)
    for k, record in enumerate(records):
        table[:, k, : record.shape[1]] = record
    return describe(
        xr.Dataset(
            {name: (("run", "time"), table[i]) for i, name in enumerate(COLUMNS)},
            coords={"run": np.arange(len(records)), "time": np.arange(longest) / rate},
        )
    )


def check_on_road(road: xr.Dataset, vehicle: Vehicle, lateral, u=None, *, beyond: float = 0.0, file=None, place: str = "") -> None:
    """Raise InputError where a wheel leaves the road: heights are only held there, and the drive comes out too smooth.

    ``lateral``: positions of the vehicle in m to the left of the reference line, a number or (n,), each at its ``u`` in m where it
    is known: the road then ends with the heights there (`edges.sides`), else with its grid. ``beyond``: m by which a wheel may. ``file`` and ``place`` are what the message names first.
    """
    lateral, half = np.atleast_1d(lateral), max(vehicle["track_front"], vehicle["track_rear"]) / 2
    right, left = np.full(lateral.shape, float(road.v[0])), np.full(lateral.shape, float(road.v[-1]))
    if u is not None:
        ends = edges.sides(road.elevation.transpose("u", "v").values, road.u.values, road.v.values)
        right, left = (np.interp(np.atleast_1d(u), road.u.values, end) for end in ends)
    over = np.maximum(lateral + half - left, right - (lateral - half))
    worst = int(np.argmax(over))
    if over[worst] > beyond + 1e-6:
        where = "" if u is None else f" at u = {np.atleast_1d(u)[worst]:.1f} m"
        raise InputError(
            f"{lateral[worst]:.2f} m{where}, with wheels {half:.3g} m to either side, expected on the road, "
            f"{right[worst]:g} to {left[worst]:g} m",
            file=file,
            place=": ".join(part for part in (place, "lateral position") if part),
        )


def _on_body(sensor, before: Vehicle, after: Vehicle) -> tuple[float, float, float]:
    """Place relative to the centre of gravity of a vehicle whose centre of gravity lay elsewhere ``before``."""
    x, y, z = sensor
    back = after["cg_to_front_axle"] - before["cg_to_front_axle"]
    return x + back, y, z - (after["cg_height"] - before["cg_height"])


def _every(step: float, rate: float) -> int:
    """Steps between records."""
    every = round(1.0 / (rate * step))
    if every < 1 or abs(every * rate * step - 1.0) > 1e-9:
        raise InputError(f"{step!r} s does not divide the interval of {1 / rate:g} s between records", place="step")
    return every


def _sampled(drive: xr.Dataset, every: int) -> xr.Dataset:
    """Every so many records of a drive, its signals through the low pass before that."""
    names = [COLUMNS[k] for k in range(len(COLUMNS))[SENSED]]
    values = np.ascontiguousarray([drive[name].values for name in names])
    sampled = drive.isel(time=slice(None, None, every)).copy()
    filtered = np.empty((sampled.sizes["time"], len(names)))
    _low_pass(values, values.shape[1], _taps(every), every, filtered)
    return sampled.assign({name: ("time", column) for name, column in zip(names, filtered.T)})


def _record(course, vehicle, speed, lateral, friction, chosen, sensor, start, end, step, every) -> np.ndarray:
    """Columns of COLUMNS after every so many steps, shape (records, columns)."""
    if np.ndim(friction) or not friction > 0:
        raise InputError(f"{friction!r:.60}, expected a positive number", place="friction")
    front = vehicle["cg_to_front_axle"]
    rear = vehicle["wheelbase"] - front
    first, last = course.u[0] + rear + OVERHANG, course.u[-1] - front - OVERHANG
    start = first if start is None else max(start, first)
    end = last if end is None else min(end, last)
    targets = np.stack([speed, lateral, course.curvature], axis=1)
    along = (course.u >= start) & (course.u <= end)
    if not (start < end and along.any()):
        raise InputError(f"nothing of the road lies between {start:g} m and {end:g} m", place="start, end")
    slowest = targets[along, 0].min()
    if not slowest >= driver.SLOWEST:
        raise InputError(f"falls to {slowest:g} m/s, expected at least {driver.SLOWEST:g} m/s", place="speed")
    seconds = 1.2 * np.sum(course.spacing[along] / targets[along, 0]) + 5.0

    connected = compose.in_company(chosen)
    entries = [entry for entry, _ in connected]
    compiled = compose.compose(entries)
    steps = int(seconds / step)
    record = np.empty((len(COLUMNS), steps // every + 1)).T  # each column by itself in memory, as it is read
    sensed = np.empty((6, steps))
    try:
        records, steps = compiled.drive(
            *_of_vehicle(tuple(vehicle.values.items())), course.surface, course.elevation, targets, float(friction),
            float(start), float(end), float(step), every, tuple(float(place) for place in sensor),
            compose.parameters(connected), compiled.state_count, record, sensed,
        )  # fmt: skip
    except NumbaError as problem:
        raise compose.refusal(entries, problem) from None
    record = record[:records]
    is_short = record[-1, 0] < end - 2.0 * targets[:, 0].max() * every * step
    # What is no number is behind the end, too, and a car that blew up may have come to a stand by it.
    is_lost = is_short and (record[-1, 2] > driver.SLOWEST or np.abs(sensed[:3, :steps]).max() > FASTEST_CHANGE)
    if is_lost or not (np.abs(record[:, :3]) < FARTHEST).all() or not np.isfinite(sensed[:, :steps]).all():
        raise InputError(
            f"the simulated drive did not stay finite{_last_seen(record, course, speed)}; is a parameter or an effect out of reason, or the friction too low "
            "for the grade or the bend?",
            place=f"vehicle {vehicle.name}",
        )
    if is_short:
        raise InputError(
            f"the drive came to a stand at {record[-1, 0]:.1f} m of {end:.1f} m; "
            "is the friction too low for the grade or the bend, or does an effect brake it?",
            place=f"vehicle {vehicle.name}",
        )
    if every == 1:
        record[:, SENSED] = sensed[:, :records].T
    else:
        _low_pass(sensed, steps, _taps(every), every, record[:, SENSED])
    return record


def _last_seen(record: np.ndarray, course: Course, speed: np.ndarray) -> str:
    """Where a drive was at last on its road, in words, with the radius there if no vehicle could follow it at the ``speed`` (m/s, (u,))."""
    places = record[np.isfinite(record[:, 0]) & (record[:, 0] >= course.u[0]) & (record[:, 0] <= course.u[-1]), 0]
    if not places.size:
        return ""
    near = np.abs(course.u - places[-1]) < AROUND
    around = np.abs(course.curvature[near])
    is_too_hard = around.max(initial=0.0) > TIGHTEST or np.max(speed[near] ** 2 * around, initial=0.0) > HARDEST
    bend = f", where the road bends with a radius of {1.0 / around.max():.2g} m: are its headings in rad" if is_too_hard else ""
    return f" at u = {places[-1]:.0f} m{bend}"


@lru_cache
def _of_vehicle(values: tuple[tuple[str, float], ...]) -> tuple[Constants, np.ndarray]:
    """What the kernel needs of a vehicle with these values; a model is driven with the same ones many times."""
    vehicle = Vehicle("", dict(values))
    return constants(vehicle), wheel_table(vehicle)


@lru_cache
def _taps(every: int) -> np.ndarray:
    """A low pass at the rate of the steps: -0.4 dB at 0.40 of the records' rate, -6 dB at half, -26 dB at 0.60, closed (-45 dB) from 0.65."""
    half = HALF_WIDTH * every
    taps = np.sinc(np.arange(-half, half + 1) / every) * np.kaiser(2 * half + 1, KAISER)
    return taps / taps.sum()


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def _low_pass(values, steps, taps, every, filtered):
    """Convolve the first ``steps`` of (channels, steps) with symmetric taps at every record; the ends are held."""
    middle = len(taps) // 2
    for k in range(len(filtered)):
        first = k * every - middle
        for c in range(len(values)):
            total = 0.0
            if first >= 0 and first + len(taps) <= steps:
                part = values[c, first : first + len(taps)]
                for j in range(len(taps)):
                    total += taps[j] * part[j]
            else:
                for j in range(len(taps)):
                    total += taps[j] * values[c, min(max(first + j, 0), steps - 1)]
            filtered[k, c] = total
