"""Units that a drive may be recorded in, and their SI factors."""

from __future__ import annotations

import math

from ..errors import InputError
from ..vocabulary import STANDARD_GRAVITY, VARIABLES

FACTORS = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "m": {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3},
    "m/s": {"m/s": 1.0, "km/h": 1 / 3.6},
    "m/s2": {"m/s2": 1.0, "m/s^2": 1.0, "mm/s2": 1e-3, "g": STANDARD_GRAVITY},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180, "mrad/s": 1e-3},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
}
"""SI unit -> {unit accepted for it: factor}."""


def factor(quantity: str, unit: str, *, file=None, place: str | None = None) -> float:
    """What a value of ``quantity`` in ``unit`` is multiplied with to be in the study's unit.

    Raises InputError for a unit that does not measure the quantity.
    """
    accepted = FACTORS[VARIABLES[quantity].unit]
    if unit not in accepted:
        raise InputError(
            f"unit {unit!r} does not fit {quantity} (expected one of {', '.join(accepted)})", file=file, place=place
        )
    return accepted[unit]
