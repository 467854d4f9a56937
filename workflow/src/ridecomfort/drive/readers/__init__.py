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
from collections.abc import Mapping
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


def check(path, columns: Mapping[str, Mapping] | None = None) -> None:
    """Raise InputError where a file cannot hold what ``columns`` asks for, as far as that is seen at a glance."""
    reader = suffixes().get(Path(path).suffix.lower())
    look = getattr(importlib.import_module(reader), "check", None) if reader else None
    if look:
        look(path, columns)


def read(path, columns: Mapping[str, Mapping] | None = None, *, measured: bool = True, **attributes) -> xr.Dataset:
    """A drive from a file, by the reader of its suffix; see ``record.from_arrays``.

    ``columns`` maps quantities to ``{"column": ..., "unit": ..., "factor": 1}``.
    Attributes given here (name, role, gravity, sensor, ...) win over what the file says. A signal that is constant is
    refused where it was ``measured``; a simulated vehicle need not roll or yaw on an even, straight road.
    """
    from .. import record

    path = Path(path)
    if not path.exists():
        raise InputError("no such file", file=path)
    readers = suffixes()
    if path.suffix.lower() not in readers:
        raise InputError(f"no reader for {path.suffix!r} (expected {', '.join(sorted(readers))})", file=path)
    reader = importlib.import_module(readers[path.suffix.lower()])
    quantities, own = reader.read(path, columns)
    for signal in SIGNALS if measured else ():
        if signal in quantities:
            column = (columns or {}).get(signal, {}).get("column", signal)
            record.check_alive(signal, quantities[signal][1], file=path, place=f"column {column!r}")
    return record.from_arrays(quantities, **{"name": path.stem, **own, **attributes}, file=path)
