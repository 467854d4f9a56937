"""Units that a drive may be recorded in, and their SI factors."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from ..errors import InputError
from ..vocabulary import STANDARD_GRAVITY, VARIABLES

FACTORS = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "m": {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3},
    "m/s": {"m/s": 1.0, "km/h": 1 / 3.6},
    "m/s2": {"m/s2": 1.0, "mm/s2": 1e-3, "g": STANDARD_GRAVITY},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180, "mrad/s": 1e-3},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
}
"""SI unit -> {unit accepted for it: factor}."""


def factor(quantity: str, unit: str, *, file=None, place: str | None = None) -> float:
    """What a value of ``quantity`` in ``unit`` is multiplied with to be in the study's unit.

    Raises InputError for a unit that does not measure the quantity.
    """
    accepted = FACTORS[VARIABLES[quantity].unit]
    if spelled(unit) not in accepted:
        raise InputError(
            f"unit {unit!r} does not fit {quantity} (expected one of {', '.join(accepted)})", file=file, place=place
        )
    return accepted[spelled(unit)]


SIGNS = {"²": "2", "⁻": "-", "¹": "1", "^": "", "**": "", "°": "deg", "µ": "u", "μ": "u", " per ": "/", "/s/s": "/s2"}
"""What others write and ``FACTORS`` writes otherwise."""

_PREFIXES = {"": "", "kilo": "k", "centi": "c", "milli": "m", "micro": "u", "nano": "n"}

WORDS = {
    **{f"{prefix}{name}": f"{short}m" for prefix, short in _PREFIXES.items() for name in ("metre", "meter")},
    **{f"{prefix}second": f"{short}s" for prefix, short in _PREFIXES.items()},
    **{"sec": "s", "hour": "h", "degree": "deg", "radian": "rad", "kmh": "km/h", "kph": "km/h"},
}
"""Names of units, in the singular, and how ``FACTORS`` writes them."""

_WORD = re.compile("|".join(rf"\b{word}s?\b" for word in WORDS))
_POWER = re.compile(r"(\w+)[ .*·]+(\w+?)-(\d)")


def spelled(unit: str) -> str:
    """A unit as ``FACTORS`` writes it: "m/s2" of "m s-2" (UDUNITS), "m/s²" or "metres per second^2"; what is not known as it is."""
    text = _WORD.sub(lambda word: WORDS.get(word[0], WORDS.get(word[0].removesuffix("s"))), str(unit).strip())
    for written, meant in SIGNS.items():
        text = text.replace(written, meant)
    return _POWER.sub(lambda part: f"{part[1]}/{part[2]}{part[3].removeprefix('1')}", text)


_BRACKETS = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)")


def of_header(column: str) -> str | None:
    """The unit that a header states in brackets, as ``FACTORS`` spells it: "m/s2" of "acc_x [m/s²]".

    None where it states none, or none that is known here.
    """
    known = {unit for accepted in FACTORS.values() for unit in accepted}
    for match in _BRACKETS.finditer(str(column)):
        unit = spelled(match[1] or match[2] or "")
        if unit in known:
            return unit
    return None


def in_brackets(column: str) -> str | None:
    """What a header states in brackets: its unit as by ``of_header``, else what stands in the last of them as it is, for ``factor`` to refuse.

    None where it has no brackets, or none that hold anything.
    """
    held = [(match[1] or match[2] or "").strip() for match in _BRACKETS.finditer(str(column))]
    return of_header(column) or next((text for text in reversed(held) if text), None)


def of_column(quantity: str, entry: Mapping, *, file=None, place: str | None = None) -> float:
    """``factor`` of a column by the ``unit`` of its entry, 1 without one; the sign of its axis is left to the caller.

    Raises InputError for a unit that does not measure the quantity, and for one that the header
    of the column (``column`` of the entry) contradicts.
    """
    if "unit" not in entry:
        return 1.0
    unit, stated = entry["unit"], of_header(entry["column"])
    scale = factor(quantity, unit, file=file, place=place)
    same = stated is None or FACTORS[VARIABLES[quantity].unit].get(stated) == scale
    if not same:
        raise InputError(
            f"unit {unit!r} for {quantity}, but its column is headed {entry['column']!r} (expected the unit of the header)",
            file=file,
            place=place,
        )
    return scale
