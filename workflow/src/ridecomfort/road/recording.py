"""What a laser scanner and its inertial navigation recorded, from files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from .. import store
from ..errors import InputError
from .survey import POSE, Profiles

BLOCK = 1000
"""Profiles that are held in memory at a time."""

UNITS = {"s": 1.0, "m": 1.0, "rad": 1.0, "deg": np.pi / 180}
"""Units of the columns of a trajectory, and what they are in SI units."""

_EXPECTED = "height (profile, point), time (profile), across (point)"


@contextmanager
def profiles(path) -> Iterator[Iterator[Profiles]]:
    """The profiles of a NetCDF file while the block runs, `BLOCK` at a time.

    The file holds ``time`` (profile) in s on the clock of the trajectory,
    ``across`` (point) in m to the left of the scanner, and ``height`` (profile,
    point) in m above it, negative below, NaN where the beam did not return.
    Raises InputError for any other file.
    """
    path = Path(path)
    try:
        with xr.open_dataset(path, engine="netcdf4") as recorded:
            for name, dims in (("height", {"profile", "point"}), ("time", {"profile"}), ("across", {"point"})):
                if name not in recorded:
                    raise InputError(f"has no variable {name!r}, expected {_EXPECTED}", file=path)
                if set(recorded[name].dims) != dims:
                    raise InputError(f"{name} has dimensions {recorded[name].dims}, expected {_EXPECTED}", file=path)
            yield _blocks(recorded)
    except (OSError, RuntimeError) as problem:
        raise InputError(f"not a readable NetCDF file ({problem})", file=path) from None


def _blocks(recorded: xr.Dataset) -> Iterator[Profiles]:
    across = recorded["across"].values.astype(float)
    for start in range(0, recorded.sizes["profile"], BLOCK):
        part = recorded[["time", "height"]].isel(profile=slice(start, start + BLOCK))
        height = part["height"].transpose("profile", "point").values.astype(float)
        yield Profiles(part["time"].values.astype(float), across, height)


def trajectory(path) -> xr.Dataset:
    """The trajectory of a scanner, `survey.POSE` over ``time``, from a NetCDF or CSV file.

    A CSV file has a row of column names: ``time``, ``x``, ``y``, ``z``,
    ``heading``, ``roll`` and ``pitch``, each in SI units or with the unit behind it
    (``roll [deg]``). Heading is counterclockwise from x (east); ``azimuth``,
    clockwise from north, may stand for it. Roll is positive with the left side up,
    pitch with the nose down. Raises InputError naming line and column.
    """
    path = Path(path)
    if path.suffix.lower() != ".csv":
        recorded = store.read(path, POSE)
        if "time" not in recorded.coords or any(recorded[name].dims != ("time",) for name in POSE):
            raise InputError("expected every variable over a dimension time that has values", file=path)
        return recorded
    if not path.is_file():
        raise InputError("no such file", file=path)
    try:
        table = pd.read_csv(path, skipinitialspace=True)
    except (ValueError, UnicodeDecodeError) as problem:
        raise InputError(f"not a readable CSV file ({str(problem).splitlines()[0]})", file=path) from None
    values = {}
    for column in table:
        parts = re.fullmatch(r"(\w+)\s*(?:\[(.*)\])?", column.strip())
        if parts and parts[1] in ("time", "azimuth", *POSE):
            values[parts[1]] = _column(table[column], column, parts[2], path)
    if "azimuth" in values:
        values.setdefault("heading", np.pi / 2 - np.unwrap(values["azimuth"]))
    for name in ("time", *POSE):
        if name not in values:
            raise InputError(f"has no column {name!r} (found {', '.join(map(str, table.columns))})", file=path)
    return xr.Dataset({name: ("time", values[name]) for name in POSE}, coords={"time": values["time"]})


def _column(series: pd.Series, column: str, unit: str | None, path: Path) -> np.ndarray:
    if unit is not None and unit not in UNITS:
        raise InputError(f"unit {unit!r}, expected one of {', '.join(UNITS)}", file=path, place=f"column {column!r}")
    numbers = pd.to_numeric(series, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        value = "nothing" if pd.isna(series.iloc[bad[0]]) else repr(series.iloc[bad[0]])
        raise InputError(f"{value}, expected a number", file=path, place=f"line {bad[0] + 2}, column {column!r}")
    return numbers * UNITS[unit or "m"]
