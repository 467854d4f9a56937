"""Readers of measured drives, found by the suffix of the file.

A reader is a module of this folder with the suffixes it reads (``SUFFIXES``) and
``read(path, columns) -> (quantities, attributes)``: quantities map a name of
``vocabulary.DRIVE`` to (time, values) in SI units, attributes are what the file
itself says about gravity, sensor, ... It may have ``check(path, columns)``, which raises what can be
seen without reading the values. Another format is one more file here.

Every call of Snakemake asks for the suffixes: what only reading needs is imported there.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import InputError
from ...vocabulary import SIGNALS

if TYPE_CHECKING:
    import xarray as xr


def suffixes() -> dict[str, str]:
    """Suffix of a file -> module that reads it."""
    found = {}
    for module in pkgutil.iter_modules(__path__):
        for suffix in importlib.import_module(f"{__name__}.{module.name}").SUFFIXES:
            found[suffix] = f"{__name__}.{module.name}"
    return found


def reader_of(path):
    """The module that reads a file of this name; InputError where there is none."""
    readers, suffix = suffixes(), Path(path).suffix.lower()
    if suffix not in readers:
        raise InputError(f"no reader for {Path(path).suffix!r} (expected {', '.join(sorted(readers))})", file=path)
    return importlib.import_module(readers[suffix])


def missing(found: Collection[str]) -> str:
    """What a drive lacks whose quantities these are, with what is expected; "" for nothing."""
    lacks = [name for name in ("time", *SIGNALS) if name not in found]
    if not lacks and not {"v_x", "s"} & {*found}:
        lacks = ["v_x or s"]
    return f"no {', '.join(lacks)} (expected time, {', '.join(SIGNALS)}, and v_x or s)" if lacks else ""


def check(path, columns: Mapping[str, Mapping] | None = None) -> None:
    """Raise InputError where a file cannot hold what ``columns`` asks for and a drive needs, as far as that is seen at a glance."""
    look = getattr(reader_of(path), "check", None)
    if look:
        look(path, columns)


def read(path, columns: Mapping[str, Mapping] | None = None, *, measured: bool = True, **attributes) -> xr.Dataset:
    """A drive from a file, by the reader of its suffix; see ``record.from_arrays``.

    ``columns`` maps quantities to ``{"column": ..., "unit": ..., "factor": 1}``.
    Attributes given here (name, role, gravity, sensor, ...) win over what the file says, but one that says that it is kept for checking is refused
    where it would be fitted. A signal that is constant is
    refused where it was ``measured``, for a simulated vehicle need not roll or yaw on an even, straight road; so is an angular rate that no
    road vehicle has.
    """
    from .. import record

    path = Path(path)
    if not path.exists():
        raise InputError("no such file", file=path)
    quantities, own = reader_of(path).read(path, columns)
    if own.get("role") == "check" and attributes.get("role") == "fit":
        raise InputError("holds 'check' where the drive is to be fitted (expected role: check in the site file, or no such attribute)", file=path, place="attribute role")
    for signal in SIGNALS if measured else ():
        if signal in quantities:
            column = (columns or {}).get(signal, {}).get("column", signal)
            record.check_alive(signal, quantities[signal][1], file=path, place=f"column {column!r}")
            record.check_turning(signal, quantities[signal][1], file=path, place=f"column {column!r}")
    return record.from_arrays(quantities, **{"name": path.stem, **own, **attributes}, file=path)
