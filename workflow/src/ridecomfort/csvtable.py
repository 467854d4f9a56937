"""Comma-separated files with one row of column names."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

from .errors import InputError

if TYPE_CHECKING:
    import pandas as pd


def read(path, rows: int | None = None) -> pd.DataFrame:
    """The table of a file, of its first ``rows`` alone where that is given.

    Raises InputError where there is no file, it is no such table, or is separated by something else, and one that names the first line
    with another number of fields than the header has names.
    """
    import pandas as pd

    try:
        names(path)
        table = pd.read_csv(path, skipinitialspace=True, nrows=rows)
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError("no such file", file=path) from None
    except (OSError, ValueError, csv.Error) as problem:  # text that is none is a ValueError, too
        saved = "; is it saved as UTF-8?" if isinstance(problem, UnicodeDecodeError) else ""
        raise InputError(f"not a readable CSV file ({str(problem).splitlines()[0]}{saved})", file=path) from None
    if _is_longer(path):
        raise _uneven(path)
    return table


def names(path) -> list[str]:
    """What the first line of a file names. Raises UnicodeDecodeError where that is no text, and InputError where all names stand in one column
    because something else than a comma lies between them."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        found = next(csv.reader(file, skipinitialspace=True), [])
    for separator in (";", "\t") if len(found) == 1 else ():
        if separator in found[0]:
            raise InputError(f"one column only: separated by {separator!r}? (expected ',', and a point in decimal numbers)", file=path, place="line 1")
    return found


def line_of(path, row: int) -> int:
    """The line of a file that a row of its table (from 0) stands in; blank ones are no rows."""
    with open(path, encoding="utf-8-sig") as file:
        written = [number for number, line in enumerate(file, start=1) if line.strip()]
    return written[row + 1]


def _is_longer(path) -> bool:
    """Whether the first row has more fields than the header has names: pandas makes its first an index then, perhaps one that counts the
    rows, and every name stands for its neighbour."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        counts = [len(row) for row, _ in zip(filter(any, csv.reader(file, skipinitialspace=True)), range(2))]
    return counts[-1] > counts[0]


def _uneven(path) -> InputError:
    """What to say of the first line with another number of fields than the header has names."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        rows = csv.reader(file, skipinitialspace=True)
        counts = [(rows.line_num, len(row)) for row in rows if any(row)]
    (_, named), *others = counts
    line, fields = next(other for other in others if other[1] != named)
    commas = ": are there commas in decimal numbers?" if fields > named + 1 else ""
    return InputError(f"{fields} fields, expected one for each of the {named} names of columns{commas}", file=path, place=f"line {line}")
