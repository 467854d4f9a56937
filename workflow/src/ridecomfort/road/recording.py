"""What a laser scanner and its inertial navigation recorded, from files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from .. import csvtable, store
from ..drive import units
from ..errors import InputError
from .survey import POSE, Profiles

BLOCK = 1000
"""Profiles that are held in memory at a time."""

MEASURED_IN = {
    "time": "s",
    **dict.fromkeys(("x", "y", "z", "height", "across"), "m"),
    **dict.fromkeys(("heading", "azimuth", "roll", "pitch"), "rad"),
}
"""SI units of what a scanner and its trajectory record; a file may have others that measure the same (`units.FACTORS`)."""

_EXPECTED = "height (profile, point), time (profile), across (point)"


@contextmanager
def profiles(path) -> Iterator[Iterator[Profiles]]:
    """The profiles of a NetCDF file while the block runs, `BLOCK` at a time.

    The file holds ``time`` (profile) in s on the clock of the trajectory,
    ``across`` (point) in m to the left of the scanner, and ``height`` (profile,
    point) in m above it, negative below, NaN where the beam did not return;
    other units stand in the attribute ``units``.
    Raises InputError for any other file.
    """
    path = Path(path)
    try:
        recorded = xr.open_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as problem:
        raise InputError(f"not a readable NetCDF file ({' '.join(str(problem).split())})", file=path) from None
    try:
        with recorded:
            for name, dims in (("height", {"profile", "point"}), ("time", {"profile"}), ("across", {"point"})):
                if name not in recorded:
                    raise InputError(f"has no variable {name!r}, expected {_EXPECTED}", file=path)
                if set(recorded[name].dims) != dims:
                    raise InputError(f"{name} has dimensions {recorded[name].dims}, expected {_EXPECTED}", file=path)
            yield _blocks(recorded, path)
    except (OSError, RuntimeError) as problem:
        raise InputError(f"not a readable NetCDF file ({problem})", file=path) from None


def _blocks(recorded: xr.Dataset, path: Path) -> Iterator[Profiles]:
    across = _variable(recorded["across"], path)
    for start in range(0, recorded.sizes["profile"], BLOCK):
        part = recorded[["time", "height"]].isel(profile=slice(start, start + BLOCK))
        height = _variable(part["height"].transpose("profile", "point"), path)
        yield Profiles(_variable(part["time"], path), across, height)


def trajectory(path) -> xr.Dataset:
    """The trajectory of a scanner, `survey.POSE` over ``time``, from a NetCDF or CSV file.

    A CSV file has a row of column names: ``time``, ``x``, ``y``, ``z``,
    ``heading``, ``roll`` and ``pitch``, each in SI units or with the unit behind it
    (``roll [deg]``). A NetCDF file has variables of these names over ``time``, each in SI units or
    in those of its attribute ``units``. Heading is counterclockwise from x (east); ``azimuth``,
    clockwise from north, may stand for it in a CSV file. Roll is positive with the left side up,
    pitch with the nose down. Raises InputError naming line and column, or the variable.
    """
    path = Path(path)
    if path.suffix.lower() != ".csv":
        recorded = store.read(path, POSE)
        if "time" not in recorded.coords or any(recorded[name].dims != ("time",) for name in POSE):
            raise InputError("expected every variable over a dimension time that has values", file=path)
        values = {name: _variable(recorded[name], path) for name in ("time", *POSE)}
        return xr.Dataset({name: ("time", values[name]) for name in POSE}, coords={"time": values["time"]})
    table = csvtable.read(path)
    values = {}
    for column in table:
        parts = re.fullmatch(r"(\w+)\s*(?:\[(.*)\])?", column.strip())
        if parts and parts[1] in ("time", "azimuth", *POSE):
            values[parts[1]] = _column(parts[1], table[column], parts[2], path)
    if "azimuth" in values:
        values.setdefault("heading", np.pi / 2 - np.unwrap(values["azimuth"]))
    for name in ("time", *POSE):
        if name not in values:
            raise InputError(f"has no column {name!r} (found {', '.join(map(str, table.columns))})", file=path)
    return xr.Dataset({name: ("time", values[name]) for name in POSE}, coords={"time": values["time"]})


def _variable(variable: xr.DataArray, path: Path) -> np.ndarray:
    """The values of a variable of a NetCDF file in SI units. Durations ("seconds") have been turned into those of numpy by reading."""
    name, values = str(variable.name), variable.values
    if values.dtype.kind == "m":
        return np.where(np.isnat(values), np.nan, values / np.timedelta64(1, "s"))
    if values.dtype.kind not in "fiu":
        held = "dates" if values.dtype.kind == "M" else "something else"
        raise InputError(f"holds {held}, expected numbers in {MEASURED_IN[name]}", file=path, place=f"variable {name!r}")
    return values.astype(float) * _factor(name, variable.attrs.get("units"), path, f"variable {name!r}")


def _factor(name: str, unit: str | None, path: Path, place: str) -> float:
    """What values in a unit are multiplied with to be in SI units, as they are without one. Raises InputError for a unit that does not fit."""
    accepted = units.FACTORS[MEASURED_IN[name]]
    if unit is not None and units.spelled(unit) not in accepted:
        raise InputError(f"unit {unit!r}, expected one of {', '.join(accepted)}", file=path, place=place)
    return 1.0 if unit is None else accepted[units.spelled(unit)]


def _column(name: str, series: pd.Series, unit: str | None, path: Path) -> np.ndarray:
    column = str(series.name)
    factor = _factor(name, unit, path, f"column {column!r}")
    numbers = pd.to_numeric(series, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        value = "nothing" if pd.isna(series.iloc[bad[0]]) else repr(series.iloc[bad[0]])
        raise InputError(f"{value}, expected a number", file=path, place=f"line {csvtable.line_of(path, bad[0])}, column {column!r}")
    return numbers * factor
