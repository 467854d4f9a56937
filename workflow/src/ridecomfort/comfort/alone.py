"""Each method on a single recording or profile of a user's own, without a study around it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
import xarray as xr

from .. import csvtable
from ..drive import sampling, units
from ..drive.readers import csv
from ..errors import InputError
from ..vocabulary import STANDARD_GRAVITY, VARIABLES, describe
from . import bands, exposure, iri, iso2631, jerk, limits, quantities, seat, total
from .quartercar import MOVING_AVERAGE

AXES = ("a_x", "a_y", "a_z")

NEAR_GRAVITY = 1.0
"""m/s2; a mean of a_z this close to gravity is gravity."""

HEIGHTS = ("left", "right", "elevation")

LARGEST_MEAN, LARGEST_RMS = 20.0, 30.0
"""m/s2; an acceleration whose mean, or rms about it, lies beyond is in another unit: no passenger bears it."""

SLOWEST_WEIGHTED, FASTEST_WEIGHTED = 0.5, 80.0
"""Hz; the vibration that comfort and health are told of (ISO 2631-1:1997, 6.4.1)."""

LEAST_RATE = 20.0
"""Hz; slower recordings do not hold all of 4 to 8 Hz, where Wk weighs most."""

SHORTEST = 4.0
"""s; two periods of the slowest vibration. A duration shall be typical and statistically sufficient (ISO 2631-1:1997, 5.5)."""

LARGEST_IRI = 100.0
"""m/km; unpaved roads, eroded and slow, reach 20 (Sayers, Gillespie and Paterson 1986, WBTP 46, figure 2)."""

COARSEST = 1.0
"""m between the samples of a profile; of one at 1 m a fifth and more of the IRI is missing, of one at 5 m most."""

TIME_CONSTANT = 1.0
"""s, of the running rms; it knows too little of the past before (ISO 2631-1:1997, 6.3.1)."""

_HEADER = re.compile(r"\s*(\w+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
"""A name, and a unit in brackets behind it or none."""


@dataclass(frozen=True)
class Result:
    """What a method says: a table (for printing and CSV), sentences, and the signals to be drawn."""

    method: str
    title: str
    table: pd.DataFrame
    remarks: list[str]
    signals: xr.Dataset
    unit: str = ""
    edges: Mapping = field(default_factory=dict)

    def text(self) -> str:
        """Title, table and remarks for a terminal."""
        places = {name: "{:.2f}".format for name in self.table if name.endswith(" [m]")}
        table = self.table.to_string(index=False, float_format=lambda number: f"{number:.4g}", formatters=places, na_rep="–")
        return "\n".join([self.title, "", table, *(["", *self.remarks] if self.remarks else [])])


def recording(file, settings: Mapping | None = None) -> xr.Dataset:
    """The accelerations of a CSV file in m/s2 over uniform ``time``; attribute ``rate`` in Hz.

    ``settings``: ``columns`` (quantity to {"column": name}) and ``unit``, that of the accelerations.
    Without columns the file has ``time`` and any of AXES. Units are those in brackets behind the
    names (which ``unit`` must not contradict), else s and m/s2. Time stamps that jitter are
    brought to a uniform clock; a file that skips samples is refused, and so is an acceleration
    that is out of reason in its unit. Attribute ``unused``: a sentence about columns that were not read, or "".
    """
    settings = settings or {}
    present = list(csvtable.read(file, rows=0).columns)
    columns = {**_headed(present, ("time", *AXES)), **settings.get("columns", {})}
    if "time" not in columns:
        raise InputError(f"no column time (found {', '.join(present)}); name it with --column time=COLUMN", file=file)
    for name in ("time", *AXES):
        if name in columns:
            asked = settings.get("unit") if name in AXES else None
            unit = asked or columns[name].get("unit") or units.in_brackets(columns[name]["column"])
            columns[name] = {**columns[name], "unit": unit or VARIABLES[name].unit}
            units.of_column(name, columns[name], file=file, place="--unit" if asked else f"column {columns[name]['column']!r}")
    found, _ = csv.read(file, columns)
    if not found:
        raise InputError(f"no column {', '.join(AXES)} (found {', '.join(present)})", file=file)
    clock = next(iter(found.values()))[0]
    sampling.check_clock(clock, file=file)
    start, interval, _ = sampling.require_uniform(clock, file=file)
    rate = 1.0 / interval
    if rate < sampling.SLOWEST_RATE:
        column = columns["time"]["column"]
        raise InputError(
            f"{rate:.3g} samples per second (expected {sampling.SLOWEST_RATE:g} or more; is the time in s? Name its unit in brackets behind "
            "the name of the column, as in time [ms])",
            file=file,
            place=f"column {column!r}",
        )
    # A clock written with few digits: 99.9998 Hz is 100 Hz.
    rate = round(rate) if abs(rate / round(rate) - 1.0) < 1e-4 else rate
    # On the rounded clock the record holds as many samples as its duration does, which over a long ride are not those it came with.
    count = int(np.floor((len(clock) - 1) * interval * rate + sampling.LARGEST_SHIFT)) + 1
    time = start + np.arange(count) / rate
    signals = {
        name: ("time", sampling.resample_inertial(clock, values, time, rate, file=file)[0])
        for name, (_, values) in found.items()
    }
    for name, (_, values) in signals.items():
        _check_reason(name, values, file)
    attributes = {"rate": float(rate), "file": str(file), "unused": _unused(present, columns)}
    answer = xr.Dataset(signals, {"time": time - time[0]}, attributes)
    return describe(answer)


def _headed(present, names) -> dict[str, dict[str, str]]:
    """The columns that are headed by one of the names, with the unit in brackets behind it: ``a_z [m/s2]``."""
    answer = {}
    for column in present:
        match = _HEADER.fullmatch(str(column))
        if match and match[1] in names:
            unit = {"unit": units.of_header(column) or match[2]} if match[2] else {}
            answer[match[1]] = {"column": column, **unit}
    return answer


def _unused(present, columns) -> str:
    """A sentence about the columns that are not read, with a hint where the name of one looks like an axis."""
    read = {entry["column"] for entry in columns.values()}
    named = []
    for column in (column for column in present if column not in read):
        match = re.match(r"a(?:cc\w*)?[_ ]?([xyz])\b", str(column), re.IGNORECASE)
        axis = f"a_{match[1].lower()}" if match else None
        named.append(f"{column} (if it is {axis}: --column {axis}={column!r})" if axis and axis not in columns else str(column))
    return f"columns not read: {', '.join(named)}" if named else ""


def _check_reason(name: str, values: np.ndarray, file) -> None:
    mean, rms = float(np.mean(values)), float(np.std(values))
    if abs(mean) > LARGEST_MEAN or rms > LARGEST_RMS:
        raise InputError(
            f"mean {mean:.3g} m/s2 and rms {rms:.3g} m/s2 about it (expected within {LARGEST_MEAN:g} and {LARGEST_RMS:g}; "
            "is the unit right? Name it in brackets behind the name of the column, or with --unit)",
            file=file,
            place=name,
        )


def ride(recording: xr.Dataset, exposure_time: float | None = None, chair: seat.Seat | None = None) -> Result:
    """Comfort, health and motion sickness of a recording on the seat after ISO 2631-1.

    A recording of the floor goes through a ``chair`` first: its a_z only.

    Offsets, gravity among them, do not matter: no weighting passes them. Health and
    sickness are stated for ``exposure_time`` s of nothing but this recording, or
    for the recording alone. Raises InputError below LEAST_RATE or SHORTEST, and for a ``chair`` without a_z.
    """
    rate = recording.attrs["rate"]
    _check_band(recording)
    rows, remarks, rms, squares = [], [], {}, 0.0
    duration = recording.sizes["time"] / rate
    trip, dose = duration if exposure_time is None else exposure_time, 0.0
    names = [name for name in AXES if name in recording]
    running = xr.Dataset(coords={"time": recording["time"]})
    if chair is not None and "a_z" not in names:
        raise InputError(f"a seat changes a_z alone, which is not among {', '.join(names)}", place="--seat")
    if chair is not None:
        recording = recording.assign(a_z=seat.on_seat(recording["a_z"], rate, chair))
        remarks.append(f"a_z through a seat of {chair.natural_frequency:g} Hz, damping ratio {chair.damping_ratio:g}")
    for name in names:
        axis = name[-1]
        weighting, factor = total.COMFORT["seat", axis]
        found = iso2631.metrics(iso2631.weight(recording[name], rate, weighting, before="mirror"), rate)
        rms[axis] = float(found["rms"])
        squares = squares + factor**2 * found["running_rms"] ** 2
        running[f"a_w{axis}"] = found["running_rms"]
        k_health = total.HEALTH["seat", axis][1]
        repeated = exposure.repeated(float(found["vdv"]), float(found["msdv"]), duration, trip)
        dose = max(dose, k_health * repeated.vdv)
        rows.append(
            {
                "axis": name,
                "weighting": weighting,
                "a_w [m/s2]": rms[axis],
                "MTVV [m/s2]": float(found["mtvv"]),
                "VDV [m/s1.75]": float(found["vdv"]),
                "eVDV [m/s1.75]": float(found["evdv"]),
                "crest factor": float(found["crest_factor"]),
                "A(8) [m/s2]": float(exposure.a8(k_health * rms[axis], trip)),
            }
        )
        remarks += [f"{name}: {sentence}" for sentence in quantities.advice(found)]
    running["a_v"] = np.sqrt(squares)
    if duration > 2 * TIME_CONSTANT:
        running = running.where(running["time"] >= TIME_CONSTANT)
    value = float(total.total_value(rms))
    rows.append({"axis": "a_v", "a_w [m/s2]": value, "MTVV [m/s2]": float(running["a_v"].max())})
    verdicts = [f"a_v over the whole recording: {' and '.join(bands.names(value))}"]
    known = running["a_v"].values[np.isfinite(running["a_v"].values)]
    shares = bands.membership(known).mean(axis=1)
    verdicts.append(
        f"running a_v ({TIME_CONSTANT:g} s), share of time: "
        + ", ".join(f"{name} {100 * share:.1f} %" for name, share in zip(bands.BANDS, shares) if share > 0)
        + "; bands overlap"
    )
    worst = max(total.HEALTH["seat", axis][1] * value for axis, value in rms.items())
    zone = exposure.rms_zone(trip)
    verdicts.append(
        f"health, {trip / 60:.1f} min a day of nothing else: {worst:.2f} m/s2 on the worst axis, "
        f"{zone.place(worst)} (caution zone {zone.lower:.2f} to {zone.upper:.2f} m/s2); "
        f"VDV {dose:.1f} m/s1.75, {exposure.DOSE_ZONE.place(dose)} "
        f"({exposure.DOSE_ZONE.lower:g} to {exposure.DOSE_ZONE.upper:g} m/s1.75)"
    )
    if "a_z" in names:
        verdicts.append(_sickness(recording["a_z"], rate, duration, trip))
    if rate < 2 * FASTEST_WEIGHTED:
        verdicts.append(
            f"the weightings span {SLOWEST_WEIGHTED:g} to {FASTEST_WEIGHTED:g} Hz: "
            f"at {rate:g} Hz vibration above {rate / 2:g} Hz is not heard"
        )
    if len(names) < len(AXES):
        verdicts.append(f"only {', '.join(names)}: a_v lacks the other axes")
    verdicts += [recording.attrs["unused"]] if recording.attrs.get("unused") else []
    title = f"ISO 2631-1 comfort on the seat, {duration:.1f} s at {rate:g} Hz"
    return Result("iso2631", title, pd.DataFrame(rows), verdicts + remarks, describe(running), "m/s2", bands.BANDS)


def _check_band(recording: xr.Dataset) -> None:
    """Raise InputError where a recording cannot hold the vibration that ISO 2631-1 weighs."""
    rate, file = recording.attrs["rate"], recording.attrs.get("file")
    if round(rate) < LEAST_RATE:
        raise InputError(
            f"{rate:.3g} samples per second hold nothing above {rate / 2:.3g} Hz (expected {LEAST_RATE:g} or more: the weightings "
            f"span {SLOWEST_WEIGHTED:g} to {FASTEST_WEIGHTED:g} Hz)",
            file=file,
            place="time",
        )
    duration = recording.sizes["time"] / rate
    if duration < SHORTEST:
        raise InputError(
            f"lasts {duration:.3g} s (expected {SHORTEST:g} s or more: "
            f"two periods of {SLOWEST_WEIGHTED:g} Hz, the slowest vibration told of)",
            file=file,
            place="time",
        )


def _sickness(a_z: xr.DataArray, rate: float, duration: float, trip: float) -> str:
    found = iso2631.metrics(iso2631.weight(a_z, rate, "Wf", before="mirror"), rate)
    dose = exposure.repeated(float(found["vdv"]), float(found["msdv"]), duration, trip).msdv
    caveat = " (a recording below 10 min says little of 0.1 to 0.5 Hz)" if duration < 600 else ""
    return (
        f"motion sickness after {trip / 60:.1f} min of nothing else: MSDV_z {dose:.2f} m/s1.5, "
        f"{exposure.vomiting_share(dose):.1f} % may vomit, "
        f"illness rating {exposure.illness_rating(dose):.2f} of 3{caveat}"
    )


def styles(recording: xr.Dataset) -> Result:
    """Share of time outside the acceleration and jerk bands of a recording."""
    rate = recording.attrs["rate"]
    remarks = ["accelerations as recorded; gravity and the offset of the sensor are thought to be out of them"]
    rows, signals = [], xr.Dataset(coords={"time": recording["time"]})
    for name in (name for name in AXES if name in recording):
        signal = recording[name].values
        if name == "a_z" and abs(abs(signal.mean()) - STANDARD_GRAVITY) < NEAR_GRAVITY:
            remarks = [f"a_z holds gravity: its mean of {signal.mean():.2f} m/s2 was taken off"]
            signal = signal - signal.mean()
        signals[name] = ("time", signal)
        rows += [
            _outside(name, style, signal, band, "m/s2", rate) for style, band in limits.ACCELERATION[name].items()
        ]
        if name != "a_z":
            rows += [
                _outside(f"jerk of {name}", style, jerk.of_drive(signal, rate), band, "m/s3", rate)
                for style, band in limits.JERK.items()
            ]
    remarks += [recording.attrs["unused"]] if recording.attrs.get("unused") else []
    title = f"Driving styles, {recording.sizes['time'] / rate:.1f} s at {rate:g} Hz"
    return Result("thresholds", title, pd.DataFrame(rows), remarks, describe(signals), "m/s2", limits.ACCELERATION)


def _outside(quantity: str, style: str, signal: np.ndarray, band: limits.Band, unit: str, rate: float) -> dict:
    outside = np.concatenate([[False], (signal < band.lower) | (signal > band.upper), [False]])
    edges = np.flatnonzero(np.diff(outside.astype(np.int8)))
    longest = np.max(edges[1::2] - edges[::2], initial=0)
    return {
        "quantity": quantity,
        "style": style,
        "lower": band.lower,
        "upper": band.upper,
        "unit": unit,
        "time outside [%]": 100.0 * outside.sum() / len(signal),
        "longest [s]": longest / rate,
        "source": band.source,
    }


def roughness(
    file, segment: float, *, smoothed: bool = False, local: float | None = None, columns: Mapping[str, Mapping] | None = None
) -> Result:
    """IRI per segment of a profile in a CSV file: columns ``s`` and any of HEIGHTS; of two tracks MRI and HRI.

    Columns are in m, or in the unit that stands in brackets behind the name: ``elevation [mm]``; ``columns`` gives other names
    (quantity to {"column": name}). ``local``: m/km; the stretches whose continuous IRI lies above are named (``iri.local_roughness``).
    Raises InputError for a profile with gaps, coarser than COARSEST or out of order, a ``local`` that is no roughness, and a ``segment`` shorter than what
    the profile resolves: its samples, or the moving average.
    """
    if local is not None and not (np.isfinite(local) and local > 0.0):
        raise InputError(f"{local!r}, expected an IRI above 0 m/km", place="--local")
    table = csvtable.read(file)
    columns = {**_headed(table.columns, ("s", *HEIGHTS)), **(columns or {})}
    names = [name for name in HEIGHTS if name in columns]
    if "s" not in columns or not names:
        found = ", ".join(map(str, table.columns))
        raise InputError(f"expected columns s and any of {', '.join(HEIGHTS)} (found {found})", file=file)
    profiles = {name: _metres(table, "s" if name == "s" else "elevation", columns[name], file) for name in ("s", *names)}
    s = profiles.pop("s")
    _check_ascending(s, columns["s"]["column"], file)
    spacing = float(np.diff(s).max(initial=0.0))
    if spacing > COARSEST * (1 + 1e-6):
        column = columns["s"]["column"]
        problem = f"samples up to {spacing:.4g} m apart, expected {COARSEST:g} m or less: they hold no IRI"
        raise InputError(problem, file=file, place=f"column {column!r}")
    resolved = max(MOVING_AVERAGE, spacing)
    if segment < resolved:
        raise InputError(f"{segment:g} m, expected {resolved:.4g} m or more, what the profile resolves", file=file, place="--segment")
    settings = {"moving_average": None} if smoothed else {}
    try:
        start, stop = iri.segments(s[0], s[-1], segment)
        found = {f"IRI {name}": iri.iri(profile, s, segment, **settings) for name, profile in profiles.items()}
        if {"left", "right"} <= set(names):
            found["MRI"] = iri.mean_of_tracks(profiles["left"], profiles["right"], s, segment, **settings)
            found["HRI"] = iri.half_car(profiles["left"], profiles["right"], s, segment, **settings)
        spots = {
            name: iri.local_roughness(profile, s, local, **settings) for name, profile in profiles.items() if local is not None
        }
    except InputError as problem:
        raise InputError(str(problem), file=file) from None
    for name, each in found.items():
        if np.max(each) > LARGEST_IRI:
            raise InputError(
                f"{name} of {np.max(each):.4g} m/km, expected less than {LARGEST_IRI:g} m/km: are s and heights in m? "
                "(a unit may stand behind the name, as in elevation [mm])",
                file=file,
            )
    rows = pd.DataFrame({"from [m]": start, "to [m]": stop, **{f"{name} [m/km]": each for name, each in found.items()}})
    signals = xr.Dataset({name: ("segment", each) for name, each in found.items()}, {"s": s})
    remarks = ["profile taken as averaged over 250 mm already" if smoothed else "moving average of 250 mm applied"]
    rest = s[-1] - stop[-1]
    left_out = f"the last {rest:.1f} m, less than half a segment, are in no row (--segment)" if rest > 0.05 else ""
    remarks += [remark for remark in (left_out, iri.coarse(spacing), _unused(table.columns, columns)) if remark]
    for name, stretches in spots.items():
        remarks.append(f"{name}: {len(stretches)} stretch{'' if len(stretches) == 1 else 'es'} with more than {local:g} m/km over 7.62 m (25 ft)")
        remarks += [
            f"  {each['start']:.1f} to {each['stop']:.1f} m, {each['peak']:.2f} m/km at {each['place']:.1f} m"
            for each in stretches
        ]
    return Result("iri", f"IRI at 80 km/h, segments of {segment:g} m", rows, remarks, describe(signals), "m/km")


def _metres(table: pd.DataFrame, quantity: str, entry: Mapping, file) -> np.ndarray:
    """A column of a profile, that of ``quantity``, in m. Raises InputError where there is none, or where it holds something else."""
    column = entry["column"]
    if column not in table:
        raise InputError(f"no column {column!r} (found {', '.join(map(str, table.columns))})", file=file)
    if table[column].dtype.kind not in "fiu":
        raise InputError(f"column {column!r} holds something else than numbers", file=file)
    scale = units.of_column(quantity, {"unit": units.in_brackets(column) or "m", **entry}, file=file, place=f"column {column!r}")
    return scale * table[column].to_numpy(float)


def _check_ascending(s: np.ndarray, column, file) -> None:
    """Raise InputError that names the line where positions (m) do not ascend."""
    back = np.flatnonzero(~(np.diff(s) > 0.0))
    if not back.size:
        return
    i = back[0] + int(np.isfinite(s[back[0]]))
    found = f"{s[i]:.10g} m after {s[i - 1]:.10g} m" if i and np.isfinite(s[i]) else "no number"
    raise InputError(f"{found} (expected positions that ascend)", file=file, place=f"line {csvtable.line_of(file, i)}, column {column!r}")
