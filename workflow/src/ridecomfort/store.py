"""NetCDF in and out: encoding, CF attributes, provenance, atomic writes."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import xarray as xr

from . import __version__
from .errors import InputError
from .vocabulary import describe

CONVENTIONS = "CF-1.11"
COMPRESSION = {"zlib": True, "complevel": 1, "shuffle": True}


def configuration_hash(configuration: Mapping) -> str:
    """Twelve hexadecimal digits that change when any value of the configuration does."""
    text = json.dumps(configuration, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def write(
    dataset: xr.Dataset,
    path,
    *,
    title: str,
    configuration: Mapping | None = None,
    seed: int | None = None,
    keep_bits: int | None = None,
    compress: bool = True,
) -> None:
    """Write a dataset as NetCDF-4 with CF attributes and provenance; all of it or nothing.

    ``keep_bits`` rounds float32 data variables to that many bits of the mantissa
    (10 bits: relative error below 5e-4), which is what makes them compress.
    The file holds no time stamp, so that equal data give equal bytes.
    """
    dataset = describe(dataset.copy())
    dataset.attrs.update(
        Conventions=CONVENTIONS, title=title, source=f"ridecomfort {__version__}"
    )
    if configuration is not None:
        dataset.attrs["configuration_hash"] = configuration_hash(configuration)
        dataset.attrs["configuration"] = json.dumps(configuration, sort_keys=True, default=str)
    if seed is not None:
        dataset.attrs["seed"] = seed
    encoding = {}
    for name, variable in dataset.variables.items():
        if variable.dtype.kind not in "fiub" or variable.ndim == 0:
            continue
        encoding[name] = dict(COMPRESSION) if compress else {}
        if variable.dtype.kind == "f":
            encoding[name]["_FillValue"] = variable.dtype.type(np.nan) if name not in dataset.coords else None
        if keep_bits and variable.dtype == np.float32 and name not in dataset.coords:
            encoding[name].update(quantize_mode="BitRound", significant_digits=keep_bits)
    with replacing(path) as part:
        dataset.to_netcdf(part, engine="netcdf4", encoding=encoding)


@contextmanager
def replacing(path):
    """A path to write to that becomes ``path`` when the block ends well and vanishes when not."""
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise InputError(f"is no folder that can be written to ({problem.strerror})", file=path.parent) from None
    handle, part = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=path.suffix)
    os.close(handle)
    try:
        yield Path(part)
        os.chmod(part, 0o644)
        os.replace(part, path)
    except BaseException:
        Path(part).unlink(missing_ok=True)
        raise


def seed(path) -> int | None:
    """Seed that a file was made with, None where it tells of none. Raises InputError as ``read`` does."""
    return read(path, []).attrs.get("seed")


def read(path, variables: Iterable[str] | None = None) -> xr.Dataset:
    """A dataset loaded whole into memory, or only some of its variables.

    Raises InputError when the file is missing, truncated, not NetCDF or lacks a variable.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError("no such file", file=path)
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            if variables is not None:
                missing = [name for name in variables if name not in dataset.variables]
                if missing:
                    raise InputError(f"has no variable {missing[0]!r}", file=path)
                dataset = dataset[list(variables)]
            return dataset.load()
    except InputError:
        raise
    except (OSError, RuntimeError, ValueError) as problem:
        raise InputError(f"not a readable NetCDF file ({problem}); if the study made it: delete it and run again", file=path) from None
