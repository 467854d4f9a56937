"""What a drive is: uniform time, the quantities of tab:quantities, and the place on the road.

Axes follow ISO 8855 (x forward, y left, z up). Angular rates are those about the
body's axes. A drive whose attribute ``gravity`` is 1 holds specific force, what
an accelerometer reads (+9.8 m/s2 along z at rest); 0 stands for acceleration.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from ..errors import InputError
from ..vehicle.parameters import PARAMETERS
from ..vocabulary import DRIVE, SIGNALS, STANDARD_GRAVITY, VARIABLES, describe
from . import distance, faults, sampling

REASONABLE = {
    "v_x": (-5.0, 90.0),
    "a_x": (-200.0, 200.0),
    "a_y": (-200.0, 200.0),
    "a_z": (-200.0, 200.0),
    "roll_rate": (-10.0, 10.0),
    "pitch_rate": (-10.0, 10.0),
    "yaw_rate": (-10.0, 10.0),
    "s": (-1e6, 1e6),
    "e": (-20.0, 20.0),
}
"""SI; values outside are a wrong unit or a broken sensor, not a road vehicle."""

STEPS = {"v_x": (2.0, 15.0), "e": (2.0, 5.0)}
"""SI; what a speed and a path may change by from one value to the next, at once (the fix of a receiver jumps by a metre or two) and a second
since they last did, for as long as they usually hold a value, as receivers do: more is no motion of a road vehicle."""

FINEST = 1e-6
"""m/s2 or rad/s; no instrument for vehicles tells values apart that lie closer together."""

FEWEST = 3
"""Values that a signal takes on at least: a coarse gyroscope on a straight road still reads nought and a step to either side."""

FASTEST = {"roll_rate": 0.5, "pitch_rate": 0.5, "yaw_rate": 1.5}
"""rad/s (rms); what turns faster all along a drive is in degrees a second, not a road vehicle."""

SAME_RATE = 1e-4
"""Relative difference up to which rates are the same, each told from the times of its drive."""

ROLES = ("fit", "check")
"""A drive is fitted, or kept for checking and never fitted."""

TOLD = {"name", "lateral_position", "place_measured", "cut_off"}
"""Attributes without which a drive was not made by ``from_arrays``."""


def from_arrays(
    quantities: Mapping[str, tuple[np.ndarray, np.ndarray]],
    *,
    name: str = "drive",
    role: str = "fit",
    rate: float = 100.0,
    gravity: bool = True,
    sensor: tuple[float, float, float] = (0.0, 0.0, 0.0),
    lateral_position: float | None = None,
    road_friction: float = 1.0,
    distance_start: float = 0.0,
    file=None,
) -> xr.Dataset:
    """A drive from arrays in SI units, each quantity with its own clock.

    ``quantities`` maps a name of ``vocabulary.DRIVE`` to (time in s, values); all six
    ``SIGNALS`` and at least one of ``v_x`` and ``s`` are needed. The stretch that all
    of them cover is brought to ``rate`` (Hz): inertial signals through an anti-alias
    filter, all through the same, speed and place linearly; what is held of these until the next is known (``distance.unheld``) between its changes.
    ``s`` that is missing is integrated from ``v_x``
    beginning at ``distance_start`` (m), which is the way driven until ``align`` makes a place on the road of it, ``v_x`` that is missing is the
    derivative of ``s``, low-passed where that jitters (``distance.speed_of``).
    ``sensor`` is the place of the accelerometer in m from the centre of gravity.

    Returns a Dataset over ``time`` (s, from 0); attributes name, role, gravity,
    sensor_x/y/z, lateral_position (nan: unknown), road_friction, place_measured, cut_off (Hz, of the anti-alias
    filter; half the rate where nothing was resampled), start_time,
    way_before (m driven since it would begin if ``s`` were left out), ``treatment`` (what was
    done to the data) and ``faults`` (what they show of an instrument that fails). Raises InputError.
    """
    missing = [signal for signal in SIGNALS if signal not in quantities]
    if missing:
        raise InputError(f"no {missing[0]} (expected all of {', '.join(SIGNALS)})", file=file, place=name)
    if "v_x" not in quantities and "s" not in quantities:
        raise InputError("neither v_x nor s (expected at least one)", file=file, place=name)
    unknown = [quantity for quantity in quantities if quantity not in DRIVE]
    if unknown:
        raise InputError(f"unknown quantity {unknown[0]!r} (expected {', '.join(DRIVE)})", file=file, place=name)
    arrays = {}
    for quantity, (time, values) in quantities.items():
        time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
        if values.shape != time.shape:
            raise InputError(
                f"{quantity} has shape {values.shape} where its time has {time.shape}", file=file, place=name
            )
        sampling.check_clock(time, file=file, place=f"time of {quantity}")
        own_rate = sampling.rate_of(time)
        if quantity in SIGNALS and own_rate < sampling.SLOWEST_RATE:  # at the rate of the study it may not fit into memory
            raise InputError(
                f"{own_rate:.3g} samples per second (expected {sampling.SLOWEST_RATE:g} or more; is the unit of time right?)",
                file=file, place=f"time of {quantity}",
            )  # fmt: skip
        _check_values(quantity, time, values, file=file)
        _check_steps(quantity, time, values, file=file)
        arrays[quantity] = time, values
    _check_moves(arrays, file=file)
    if "s" in arrays and "v_x" in arrays:
        distance.check_beside_speed(*arrays["s"], *arrays["v_x"], file=file)
    elif "s" in arrays:
        distance.check_alone(*arrays["s"], file=file)
    arrays, held = distance.unheld(arrays, file=file)
    first = max(time[0] for time, _ in arrays.values())
    last = min(time[-1] for time, _ in arrays.values())
    start, interval, _ = sampling.uniform_clock(arrays["a_z"][0])
    if abs(interval * rate - 1) < 1e-5:  # the clock of the instrument is kept, so that nothing need be filtered
        first = start + np.ceil((first - start) / interval - sampling.LARGEST_SHIFT) * interval
    count = int(np.floor((last - first) * rate + sampling.LARGEST_SHIFT)) + 1
    if count < 2:
        raise InputError(f"the clocks of its quantities overlap by {max(last - first, 0):.3g} s", file=file, place=name)
    time = first + np.arange(count) / rate
    columns, treatment, cut_off = _inertial({name: arrays[name] for name in SIGNALS}, time, rate, file=file)
    treatment += held
    for quantity, (clock, values) in arrays.items():
        if quantity not in SIGNALS:
            columns[quantity] = sampling.resample_slow(clock, values, time, file=file, place=f"time of {quantity}")
    place_measured = "s" in columns
    if not place_measured:
        columns["s"] = distance_start + sampling.integral(columns["v_x"], time)
        treatment.append("s integrated from v_x")
    if "v_x" not in columns:
        columns["v_x"], said = distance.speed_of(columns["s"], time, rate, REASONABLE["v_x"], file=file)
        treatment.append(said)
    if "e" not in columns:
        columns["e"] = np.full(count, np.nan)
    drive = xr.Dataset({key: ("time", columns[key]) for key in DRIVE}, {"time": np.arange(count) / rate})
    drive.attrs.update(
        name=name,
        role=role,
        gravity=int(gravity),
        sensor_x=float(sensor[0]),
        sensor_y=float(sensor[1]),
        sensor_z=float(sensor[2]),
        lateral_position=np.nan if lateral_position is None else float(lateral_position),
        road_friction=float(road_friction),
        place_measured=int(place_measured),
        cut_off=float(cut_off),
        start_time=float(first),
        way_before=_way_before(arrays, first),
        treatment="; ".join(treatment) or "none",
        faults="; ".join(faults.found(arrays)),
    )
    return check(describe(drive), file=file)


def _way_before(arrays: Mapping[str, tuple[np.ndarray, np.ndarray]], first: float) -> float:
    """m driven by v_x between where all but s and e begin and the ``first`` instant (s); 0 where s alone tells of the speed."""
    if "v_x" not in arrays:
        return 0.0
    begins = max(time[0] for name, (time, _) in arrays.items() if name == "v_x" or name in SIGNALS)
    time, speed = arrays["v_x"]
    return float(np.ptp(np.interp([min(begins, first), first], time, sampling.integral(speed, time))))


def _inertial(signals: Mapping[str, tuple[np.ndarray, np.ndarray]], time: np.ndarray, rate: float, *, file) -> tuple[dict, list[str], float]:
    """Inertial signals on one clock (uniform, ``rate`` Hz), what was done to them, and the cut-off in Hz of all of them."""

    def brought(name: str, at_most: float = np.inf) -> tuple[np.ndarray, float, float]:
        return sampling.resample_inertial(*signals[name], time, rate, at_most=at_most, file=file, place=f"time of {name}")

    own = {name: brought(name) for name in signals}
    least = min(cut_off for _, _, cut_off in own.values())
    columns, said = {}, {}
    for name, (clock, _) in signals.items():
        # A simulation passes one filter whatever the signal, so a faster one passes that of the slowest.
        columns[name], jitter, cut_off = own[name] if own[name][2] <= least else brought(name, least)
        if own[name][2] < 0.5 * rate:
            own_rate = (len(clock) - 1) / (clock[-1] - clock[0])
            said.setdefault(f"brought from {own_rate:.4g} Hz (jitter {jitter:.2f} intervals, low-pass {cut_off:.3g} Hz)", []).append(name)
        elif cut_off < 0.5 * rate:
            said.setdefault(f"low-passed at {cut_off:.3g} Hz, as the slowest", []).append(name)
    return columns, [f"{', '.join(names)} {words}" for words, names in said.items()], least


def check(drive: xr.Dataset, *, file=None) -> xr.Dataset:
    """The drive, if it is one; else InputError naming the variable, the time and the value.

    ``e`` may be wholly absent (all NaN); nothing else may hold NaN.
    """
    label = drive.attrs.get("name", "drive")
    for name in DRIVE:
        if name not in drive:
            raise InputError(f"no variable {name!r} (expected {', '.join(DRIVE)})", file=file, place=label)
        if drive[name].dims != ("time",):
            raise InputError(f"{name} has dims {drive[name].dims} (expected time)", file=file, place=label)
        unit = drive[name].attrs.get("units", VARIABLES[name].unit)
        if unit != VARIABLES[name].unit:
            raise InputError(f"{name} is in {unit!r} (expected {VARIABLES[name].unit})", file=file, place=label)
    if drive.attrs.get("role", "fit") not in ROLES:
        raise InputError(f"role {drive.attrs['role']!r} (expected {' or '.join(ROLES)})", file=file, place=label)
    time = drive["time"].values
    sampling.check_clock(time, file=file, place="time")
    sampling.require_uniform(time, file=file)
    for name in DRIVE:
        values = drive[name].values
        if name == "e" and np.isnan(values).all():
            continue
        _check_values(name, time, values, file=file)
    _check_gravity(drive, file=file)
    return drive


def _check_values(name: str, time: np.ndarray, values: np.ndarray, *, file) -> None:
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        i = bad[0]
        raise InputError(
            f"sample {i + 1} ({sampling.stamp(time[i])} s) holds {values[i]} (expected a number)", file=file, place=name
        )
    lower, upper = REASONABLE[name]
    bad = np.flatnonzero((values < lower) | (values > upper))
    if bad.size:
        i = bad[0]
        raise InputError(
            f"sample {i + 1} ({sampling.stamp(time[i])} s) holds {values[i]:.6g} {VARIABLES[name].unit} "
            f"(expected {lower:g} to {upper:g}; is its unit right?)",
            file=file,
            place=name,
        )


def _check_moves(arrays: Mapping[str, tuple[np.ndarray, np.ndarray]], *, file) -> None:
    """InputError where a distance never changes, or a speed never reaches that of a vehicle which moves: a dead channel that was filled."""
    for name, other, expected in (("s", "v_x", "a distance that rises"), ("v_x", "s", f"more than {faults.STANDING:g} m/s somewhere")):
        if name not in arrays:
            continue
        values = arrays[name][1]
        if np.ptp(values) > 0.0 if name == "s" else np.max(np.abs(values)) > faults.STANDING:
            continue
        held = f"{values[0] + 0.0:.6g}" if np.ptp(values) == 0.0 else f"at most {np.max(np.abs(values)):.3g}"
        instead = f"; leave {name} out, which is then made of {other}" if other in arrays else ""
        said = f"holds {held} {VARIABLES[name].unit} throughout its {values.size} samples (expected {expected}{instead})"
        raise InputError(said, file=file, place=name)


def _check_steps(name: str, time: np.ndarray, values: np.ndarray, *, file) -> None:
    """InputError where a speed or a path changes as that of no vehicle: values that were lost (noughts) or transmitted wrongly."""
    at_once, a_second = STEPS.get(name, (np.inf, 0.0))
    known = np.flatnonzero(np.concatenate([[True], np.diff(values) != 0.0]))  # others are held, or rounded
    since = np.diff(time[known])
    usual = np.median(since) if since.size else 0.0  # what was held for longer was lost, and goes on where the vehicle has come to meanwhile
    allowed = np.minimum(np.maximum(time[known[1:]] - time[known[1:] - 1], np.minimum(since, usual)), distance.LONGEST_HOLD)
    bad = np.flatnonzero(np.abs(np.diff(values[known])) > at_once + a_second * allowed)
    if bad.size:
        before, i = known[bad[0] : bad[0] + 2]
        unit = VARIABLES[name].unit
        raise InputError(
            f"sample {i + 1} ({sampling.stamp(time[i])} s) holds {values[i]:.4g} {unit}, {since[bad[0]]:.3g} s after it became {values[before]:.4g} "
            f"(expected a change of at most {at_once:g} {unit} and {a_second:g} a second; were values lost, or transmitted wrongly? "
            f"Cut the record there, or leave {name} out{' where s is recorded' if name == 'v_x' else ''})",
            file=file,
            place=name,
        )


def check_alive(name: str, values: np.ndarray, *, file=None, place: str | None = None) -> None:
    """InputError where a measured signal (SI units) is constant, or all but constant: a dead channel that was filled.

    Errors are weighed by the size of their signal, so that one without any would outweigh all others.
    """
    found = np.asarray(values, dtype=float)
    found = found[np.isfinite(found)]
    found = found[np.unique(np.round(found / FINEST), return_index=True)[1]]
    if 0 < found.size < FEWEST:
        held = " and ".join(f"{value + 0.0:.6g}" for value in found)
        raise InputError(
            f"{name} holds {held} {VARIABLES[name].unit} throughout its {len(values)} samples "
            f"(expected at least {FEWEST} different values; was the sensor dead, or the column filled?)",
            file=file,
            place=place or name,
        )


def check_turning(name: str, values: np.ndarray, *, file=None, place: str | None = None) -> None:
    """InputError where a measured signal (SI units) is an angular rate and larger than that of any road vehicle, as one in another unit is."""
    found = np.asarray(values, dtype=float)
    rms = float(np.sqrt(np.mean(np.square(found[np.isfinite(found)])))) if np.isfinite(found).any() else 0.0
    if rms > FASTEST.get(name, np.inf):
        most = f"{FASTEST[name]:g} {VARIABLES[name].unit}"
        raise InputError(
            f"{name} has a root mean square of {rms:.3g} {VARIABLES[name].unit} (expected at most {most}; is its unit right?)", file=file, place=place or name
        )


def _check_gravity(drive: xr.Dataset, *, file) -> None:
    """A mean a_z near 0 or near g tells whether gravity is in the record, and whether z points up."""
    expected = STANDARD_GRAVITY * int(drive.attrs.get("gravity", 0))
    mean = float(drive["a_z"].mean())
    if abs(mean - expected) > 0.4 * STANDARD_GRAVITY:
        raise InputError(
            f"mean {mean:.3g} m/s2 where about {expected:.3g} is expected with gravity: {bool(expected)} "
            "(is gravity in the record, does z point up, is the unit right?)",
            file=file,
            place="a_z",
        )


def upward(roll, pitch) -> np.ndarray:
    """Unit vector that points up, along the body's axes (shape (3, ...)), from roll and pitch in rad.

    Third row of the rotation from body to earth axes in the sequence yaw, pitch, roll (ISO 8855).
    """
    roll, pitch = np.asarray(roll), np.asarray(pitch)
    return np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)])


def specific_force(acceleration, roll, pitch) -> np.ndarray:
    """What an accelerometer reads in m/s2, shape (3, time), from acceleration in body axes and attitude."""
    return np.asarray(acceleration) + STANDARD_GRAVITY * upward(roll, pitch)


def felt(drive: xr.Dataset) -> np.ndarray:
    """What the accelerometers of a drive read in m/s2, (3, time), from its accelerations and attitude."""
    return specific_force([drive[name].values for name in SIGNALS[:3]], drive["roll"].values, drive["pitch"].values)


def acceleration(specific_force, roll, pitch) -> np.ndarray:
    """Acceleration in body axes in m/s2, shape (3, time), from what an accelerometer reads and attitude."""
    return np.asarray(specific_force) - STANDARD_GRAVITY * upward(roll, pitch)


def late(drive: xr.Dataset, names, by) -> xr.Dataset:
    """A drive whose variables of these ``names`` are recorded later ``by`` so many s, a number or (time,); at the ends they are held."""
    from scipy.interpolate import CubicSpline  # here: it takes half a second, and the library of effects is read at every start

    time = drive["time"].values
    past = np.clip(time - by, time[0], time[-1])
    return drive.assign({name: drive[name].copy(data=CubicSpline(time, drive[name].values)(past)) for name in names})


def transfer(drive: xr.Dataset, to: tuple[float, float, float]) -> xr.Dataset:
    """The drive as an accelerometer elsewhere on the rigid body would have recorded it.

    ``to`` is in m from the centre of gravity, in body axes: a + alpha x r + omega x (omega x r)
    with r from the present sensor to the new one. The angular acceleration is the
    difference of fourth order of the measured rates, so noise of the rates enters
    the result with r times the sampling rate; compare at the sensor where that matters.
    """
    place = np.array([drive.attrs[f"sensor_{axis}"] for axis in "xyz"])
    arm = np.asarray(to, dtype=float) - place
    rates = np.stack([drive[name].values for name in ("roll_rate", "pitch_rate", "yaw_rate")])
    interval = float(drive["time"][1] - drive["time"][0])
    angular = _derivative(rates, interval)
    moved = _cross(angular, arm) + _cross(rates, _cross(rates, arm))
    result = drive.copy()
    for name, change in zip(("a_x", "a_y", "a_z"), moved):
        result[name] = drive[name].copy(data=drive[name].values + change)
    result.attrs.update(sensor_x=float(to[0]), sensor_y=float(to[1]), sensor_z=float(to[2]))
    return result


def _cross(vectors: np.ndarray, other: np.ndarray) -> np.ndarray:
    other = other if other.ndim == 2 else other[:, None]
    return np.cross(vectors, np.broadcast_to(other, vectors.shape), axis=0)


def _derivative(values: np.ndarray, interval: float) -> np.ndarray:
    derivative = np.gradient(values, interval, axis=-1)
    if values.shape[-1] >= 5:
        derivative[..., 2:-2] = (
            8 * (values[..., 3:-1] - values[..., 1:-3]) - (values[..., 4:] - values[..., :-4])
        ) / (12 * interval)
    return derivative


def completed(drives: xr.Dataset | Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Stacked drives taken apart, or a list of them, each with all attributes of ``from_arrays``: one that does not tell them, as a simulated one,
    is called by its number, is fitted, holds no gravity, and was recorded at its own rate by an instrument in the centre of gravity."""
    return [_completed(drive, number) for number, drive in enumerate(unstack(drives) if isinstance(drives, xr.Dataset) else drives, start=1)]


def _completed(drive: xr.Dataset, number: int) -> xr.Dataset:
    if TOLD <= drive.attrs.keys():
        return drive
    usual = {
        "name": f"drive_{number}", "role": "fit", "gravity": 0, "sensor_x": 0.0, "sensor_y": 0.0, "sensor_z": 0.0, "lateral_position": np.nan,
        "road_friction": 1.0, "place_measured": 1, "cut_off": 0.5 * sampling.rate_of(drive["time"].values), "start_time": 0.0, "way_before": 0.0,
        "treatment": "none", "faults": "",
    }  # fmt: skip
    return drive.assign_attrs({**usual, **drive.attrs})


def require_one_rate(drives: Sequence[xr.Dataset]) -> None:
    """Raise InputError unless drives are sampled at one rate, as what lays them side by side takes for granted."""
    rates = [sampling.rate_of(drive["time"].values) for drive in drives]
    names = [drive.attrs.get("name", "drive") for drive in drives]
    for name, rate in zip(names, rates):
        if abs(rate / rates[0] - 1.0) > SAME_RATE:
            raise InputError(f"is sampled at {rate:.6g} Hz, drive {names[0]} at {rates[0]:.6g} Hz (expected one rate for all)", place=f"drive {name}")


def stack(drives: list[xr.Dataset]) -> xr.Dataset:
    """Drives of one rate on one dataset of dims drive, time, padded with NaN at the end.

    Their numeric and text attributes become variables over ``drive``.
    """
    require_one_rate(drives)
    length = max(drive.sizes["time"] for drive in drives)
    longest = max(drives, key=lambda drive: drive.sizes["time"])
    rows = {}
    for name in longest.data_vars:
        rows[name] = np.full((len(drives), length), np.nan)
        for i, drive in enumerate(drives):
            rows[name][i, : drive.sizes["time"]] = drive[name].values
    data = {name: (("drive", "time"), values) for name, values in rows.items()}
    for name in drives[0].attrs:
        data[name] = ("drive", np.array([drive.attrs[name] for drive in drives]))
    for name in data.keys() & PARAMETERS.keys():
        data[name] = (*data[name], {"units": PARAMETERS[name].unit, "long_name": PARAMETERS[name].meaning})
    names = data.pop("name")[1].astype(str)
    stacked = xr.Dataset(data, {"time": longest["time"].values, "drive": names})
    return describe(stacked)


def unstack(measured: xr.Dataset) -> list[xr.Dataset]:
    """The drives of a stacked dataset, each without its padding and with its attributes back."""
    drives = []
    for i in range(measured.sizes["drive"]):
        row = measured.isel(drive=i)
        series = row[[name for name in row.data_vars if row[name].dims == ("time",)]]
        drive = series.isel(time=np.isfinite(series["a_z"].values)).drop_vars("drive")
        drive.attrs = {name: row[name].item() for name in row.data_vars if row[name].ndim == 0}
        drive.attrs["name"] = str(row["drive"].item())
        drives.append(drive)
    return drives
