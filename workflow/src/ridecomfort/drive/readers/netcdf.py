"""Drives in NetCDF files of the drive schema: what other simulators and earlier studies hand over."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InputError
from ...vocabulary import DRIVE
from .. import units
from . import missing

if TYPE_CHECKING:
    import xarray as xr

SUFFIXES = (".nc", ".nc4")


def read(path, columns: Mapping[str, Mapping] | None) -> tuple[dict, dict]:
    """Quantities of a drive in SI units, and the attributes that the file holds.

    The file has one dimension, time. ``columns`` may map quantities (and ``time``) to variables of other names, with the unit of
    those that have no ``units`` of their own and, for axes that point the other way, ``factor: -1``. Dates ("seconds since
    ...", CF) count from the first sample. ``e`` that is all NaN counts as not measured. A file without the attribute
    ``gravity`` holds accelerations, as simulators give them.
    Raises InputError naming the variable.
    """
    from ... import store

    dataset = store.read(path)
    named = dict(columns or {})
    clock = named.get("time", {}).get("column", "time")
    if clock not in dataset.variables:
        raise InputError(f"has no variable {clock!r} for time", file=path)
    _check_taken(named, dataset.variables, path)
    time = _clock(dataset[clock], named.get("time", {}), path)
    quantities = {}
    for quantity in DRIVE:
        entry = named.get(quantity, {})
        variable = entry.get("column", quantity)
        if variable not in dataset:
            if quantity in named:
                raise InputError(f"has no variable {variable!r} for {quantity}", file=path)
            continue
        series = dataset[variable]
        if series.dims != dataset[clock].dims or series.ndim != 1:
            raise InputError(f"{variable} has dims {series.dims} (expected time alone)", file=path)
        if quantity == "e" and series.isnull().all():
            continue
        if series.dtype.kind not in "fiu":
            raise InputError(f"holds {series.values.ravel()[:1]} for {quantity} (expected numbers)", file=path, place=str(series.name))
        quantities[quantity] = time, entry.get("factor", 1.0) * _scale(quantity, series, entry, path) * series.values
    gravity = str(dataset.attrs.get("gravity", 0)).strip().lower()  # NetCDF has no booleans
    attributes = {"gravity": gravity not in ("0", "0.0", "false", "no", "")}
    for name in ("name", "role", "lateral_position"):
        if name in dataset.attrs:
            attributes[name] = dataset.attrs[name]
    place = {name: dataset.attrs.get(name) for name in ("sensor_x", "sensor_y", "sensor_z")}
    lacking = [name for name, value in place.items() if value is None]
    if len(lacking) < len(place):
        if lacking:
            raise InputError(f"has no attribute {lacking[0]!r} (expected all of {', '.join(place)}, or none)", file=path)
        attributes["sensor"] = tuple(_number(name, value, path) for name, value in place.items())
    if "lateral_position" in attributes:
        attributes["lateral_position"] = _number("lateral_position", attributes["lateral_position"], path)
    return quantities, attributes


def _number(name: str, value, path) -> float:
    """The number that an attribute of a file holds."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"holds {value!r} (expected a number)", file=path, place=f"attribute {name}") from None


def check(path, columns: Mapping[str, Mapping] | None) -> None:
    """Raise InputError where the file has no variables for what ``columns`` asks for, or for what a drive needs."""
    import netCDF4

    try:
        with netCDF4.Dataset(path) as file:
            variables = set(file.variables)
    except (OSError, RuntimeError):
        return  # reading it says why
    named = _variables(columns or {})
    for quantity in columns or {}:
        if named.get(quantity, quantity) not in variables:
            raise InputError(f"has no variable {named.get(quantity, quantity)!r} for {quantity}", file=path)
    _check_taken(columns or {}, variables, path)
    lacks = missing([quantity for quantity, variable in named.items() if variable in variables])
    if lacks:
        raise InputError(f"{lacks}; `columns` says what variables of other names hold", file=path, place="variables")


def _variables(columns: Mapping[str, Mapping]) -> dict[str, str]:
    """The variable that holds a quantity, of its own name where ``columns`` does not say another."""
    return {name: columns.get(name, {}).get("column", name) for name in ("time", *DRIVE)}


def _check_taken(columns: Mapping[str, Mapping], found: Collection[str], path) -> None:
    """Raise InputError where a variable of the file would be read for two quantities."""
    taken: dict[str, str] = {}
    for quantity, variable in _variables(columns).items():
        if variable in found and (other := taken.setdefault(variable, quantity)) != quantity:
            raise InputError(f"variable {variable!r} stands for both {other} and {quantity} (expected one; `columns` says which)", file=path, place="columns")


def _clock(series: xr.DataArray, entry: Mapping, path) -> np.ndarray:
    """Time in s; reading has turned dates, and durations that are spelled out ("seconds"), into those of numpy already."""
    values = series.values
    if values.dtype.kind in "Mm":
        since = values - values[:1] if values.dtype.kind == "M" else values
        return np.where(np.isnat(since), np.nan, since / np.timedelta64(1, "s"))
    if values.dtype.kind not in "fiu":
        raise InputError(
            f"holds {values.ravel()[:1]} for time (expected numbers, or dates of the standard calendar)", file=path, place=str(series.name)
        )
    return _scale("time", series, entry, path) * values


def _scale(quantity: str, series: xr.DataArray, entry: Mapping, path) -> float:
    """What the values of a variable are multiplied with to be in SI units: by its own ``units``, else by the unit of its ``entry``."""
    stated, given = series.attrs.get("units"), entry.get("unit")
    scales = [units.factor(quantity, unit, file=path, place=str(series.name)) for unit in (stated, given) if unit is not None]
    if len(set(scales)) > 1:
        raise InputError(
            f"unit {given!r} for {quantity}, but its variable has units {stated!r} (expected the unit of the variable)",
            file=path, place=str(series.name),
        )  # fmt: skip
    return scales[0] if scales else 1.0
