"""Drives in comma-separated files with one row of column names."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from textwrap import shorten
from typing import TYPE_CHECKING

import numpy as np

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
    _check_separator(_header(path), path)
    table = _table(path)
    if columns is None:
        columns = _named(table.columns)
    _check_names(list(map(str, table.columns)), columns, path)
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
    found = _header(path)
    if found is None:
        return  # reading it says why
    _check_separator(found, path)
    if columns is None and missing(found):
        raise InputError(f"{missing(found)}; `columns` says what columns of other names hold", file=path, place="line 1")
    _check_names(found, _named(found) if columns is None else columns, path)


def _header(path) -> list[str] | None:
    """What the first line of a file names, None where that is no text."""
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            return next(csv.reader(file, skipinitialspace=True), [])
    except UnicodeDecodeError:
        return None


def _check_separator(found: Sequence[str] | None, path) -> None:
    """Raise InputError where all names stand in one column because something else than a comma lies between them."""
    for separator in (";", "\t") if found and len(found) == 1 else ():
        if separator in found[0]:
            raise InputError(f"one column only: separated by {separator!r}? (expected ',')", file=path, place="line 1")


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
        if entry["column"] not in found:
            names = shorten(", ".join(found), LONGEST, placeholder=" ...")
            raise InputError(f"no column {entry['column']!r} for {quantity} (found {names})", file=path)


def _table(path) -> pd.DataFrame:
    import pandas as pd

    try:
        table = pd.read_csv(path, skipinitialspace=True)
    except (ValueError, UnicodeDecodeError) as problem:
        raise InputError(f"not a readable CSV file ({str(problem).splitlines()[0]})", file=path) from None
    # Of rows that are longer than the header pandas makes the first column an index, and every name stands for its neighbour.
    if not isinstance(table.index, pd.RangeIndex):
        raise _uneven(path)
    return table


def _uneven(path) -> InputError:
    """What to say of the first line with another number of fields than the header has names."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        rows = csv.reader(file, skipinitialspace=True)
        counts = [(rows.line_num, len(row)) for row in rows if any(row)]
    (_, names), *others = counts
    line, fields = next(other for other in others if other[1] != names)
    return InputError(f"{fields} fields, expected one for each of the {names} names of columns", file=path, place=f"line {line}")


def _numbers(series: pd.Series, path, column: str) -> np.ndarray:
    import pandas as pd

    numbers = pd.to_numeric(series, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        i = bad[0]
        value = "nothing, or nan" if pd.isna(series.iloc[i]) else repr(str(series.iloc[i]))
        raise InputError(
            f"line {line_of(path, i)}, column {column!r} holds {value} (expected a number)", file=path
        )
    return numbers


def _check_clock(time: np.ndarray, path, column: str) -> None:
    """Raise InputError that names the line where time (s) does not advance."""
    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        i = back[0]
        raise InputError(
            f"line {line_of(path, i + 1)}, column {column!r}: the clock does not advance, {time[i + 1]:.6g} s after {time[i]:.6g} s "
            "(expected strictly increasing time)",
            file=path,
        )


def line_of(path, row: int) -> int:
    """The line of a file that a row of its table (from 0) stands in; blank ones are no rows."""
    with open(path, encoding="utf-8-sig") as file:
        written = [number for number, line in enumerate(file, start=1) if line.strip()]
    return written[row + 1]
