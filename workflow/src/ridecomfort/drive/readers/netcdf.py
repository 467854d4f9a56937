"""Drives in NetCDF files of the drive schema: what other simulators and earlier studies hand over."""

from __future__ import annotations

from collections.abc import Mapping

from ... import store
from ...errors import InputError
from ...vocabulary import DRIVE
from .. import units

SUFFIXES = (".nc", ".nc4")


def read(path, columns: Mapping[str, Mapping] | None) -> tuple[dict, dict]:
    """Quantities of a drive in SI units by the ``units`` of each variable, and the attributes that the file holds.

    The file has one dimension, ``time`` (s); ``columns`` may map quantities to
    variables of other names. ``e`` that is all NaN counts as not measured. A file
    without the attribute ``gravity`` holds accelerations, as simulators give them.
    """
    dataset = store.read(path)
    named = {quantity: entry["column"] for quantity, entry in (columns or {}).items() if quantity != "time"}
    clock = (columns or {}).get("time", {}).get("column", "time")
    if clock not in dataset.variables:
        raise InputError(f"has no variable {clock!r} for time", file=path)
    quantities = {}
    for quantity in DRIVE:
        variable = named.get(quantity, quantity)
        if variable not in dataset:
            if quantity in named:
                raise InputError(f"has no variable {variable!r} for {quantity}", file=path)
            continue
        series = dataset[variable]
        if series.dims != dataset[clock].dims or series.ndim != 1:
            raise InputError(f"{variable} has dims {series.dims} (expected time alone)", file=path)
        if quantity == "e" and series.isnull().all():
            continue
        scale = 1.0
        if "units" in series.attrs:
            scale = units.factor(quantity, series.attrs["units"], file=path, place=variable)
        quantities[quantity] = dataset[clock].values, scale * series.values
    attributes = {"gravity": bool(dataset.attrs.get("gravity", 0))}
    for name in ("name", "role", "lateral_position"):
        if name in dataset.attrs:
            attributes[name] = dataset.attrs[name]
    if "sensor_x" in dataset.attrs:
        attributes["sensor"] = tuple(float(dataset.attrs[f"sensor_{axis}"]) for axis in "xyz")
    return quantities, attributes
