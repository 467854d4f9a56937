"""Drives in comma-separated files with one row of column names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import shorten
from typing import TYPE_CHECKING

import numpy as np

from ... import csvtable
from ...errors import InputError
from ...vocabulary import DRIVE
from .. import units
from . import missing

if TYPE_CHECKING:
    import pandas as pd

SUFFIXES = (".csv",)

LONGEST = 300
"""Letters of a line of names that are shown where one is missing; what is no table may have thousands."""


def read(path, columns: Mapping[str, Mapping] | None) -> tuple[dict, dict]:
    """Quantities of a drive in SI units, each with the time of its row, and no attributes.

    ``columns`` maps quantities (and ``time``) to column, unit and, for axes that
    point the other way, ``factor: -1``. Without it the columns are named as in the
    vocabulary and hold SI units. Raises InputError naming line and column.
    """
    table, found = csvtable.read(path), csvtable.names(path)
    if columns is None:
        columns = _named(found)
    _check_names(found, columns, path)
    values = {}
    for quantity, entry in columns.items():
        column = entry["column"]
        scale = units.of_column(quantity, entry, file=path, place=f"column {column!r}")
        if quantity == "time":
            _check_clock(scale * _numbers(table[column], path, column), path, column)
        values[quantity] = entry.get("factor", 1.0) * scale * _numbers(table[column], path, column)
    time = values.pop("time")
    return {quantity: (time, series) for quantity, series in values.items()}, {}


def check(path, columns: Mapping[str, Mapping] | None) -> None:
    """Raise InputError where the first line of the file does not name what ``columns`` asks for, or a drive needs without them."""
    try:
        found = csvtable.names(path)
    except UnicodeDecodeError:
        return  # reading it says why
    if columns is None and missing(found):
        raise InputError(f"{missing(found)}; `columns` says what columns of other names hold", file=path, place="line 1")
    _check_names(found, _named(found) if columns is None else columns, path)


def _named(found: Sequence[str]) -> dict[str, dict[str, str]]:
    """The columns of a file that are named as in the vocabulary."""
    return {name: {"column": name} for name in ("time", *DRIVE) if name in found}


def _check_names(found: Sequence[str], columns: Mapping[str, Mapping], path) -> None:
    if "time" not in columns:
        raise InputError("no column stands for time", file=path, place="columns")
    for quantity, entry in columns.items():
        if quantity not in ("time", *DRIVE):
            expected = ", ".join(("time", *DRIVE))
            raise InputError(f"unknown quantity {quantity!r} (expected {expected})", file=path, place="columns")
        if found.count(entry["column"]) > 1:
            raise InputError(f"{found.count(entry['column'])} columns are called {entry['column']!r} (expected one, for {quantity})", file=path, place="line 1")
        if entry["column"] not in found:
            names = shorten(", ".join(found), LONGEST, placeholder=" ...")
            raise InputError(f"no column {entry['column']!r} for {quantity} (found {names})", file=path)


def _numbers(series: pd.Series, path, column: str) -> np.ndarray:
    import pandas as pd

    numbers = pd.to_numeric(series, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        i = bad[0]
        value = "nothing, or nan" if pd.isna(series.iloc[i]) else repr(str(series.iloc[i]))
        raise InputError(
            f"line {csvtable.line_of(path, i)}, column {column!r} holds {value} (expected a number)", file=path
        )
    return numbers


def _check_clock(time: np.ndarray, path, column: str) -> None:
    """Raise InputError that names the line where time (s) does not advance."""
    from ..sampling import stamp

    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        i = back[0]
        raise InputError(
            f"line {csvtable.line_of(path, i + 1)}, column {column!r}: the clock does not advance, {stamp(time[i + 1])} s after {stamp(time[i])} s "
            "(expected strictly increasing time)",
            file=path,
        )
