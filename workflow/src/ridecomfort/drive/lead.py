"""Whether drives tell the distance of another point of the vehicle than its centre of gravity: their clocks are one length over the speed then."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy.stats import chi2

APART = 1.1
"""Ratio of the largest to the smallest speed from which on one length and one clock differ."""

LEAST, CLOSE = 0.3, 0.2
"""m of a length that is worth a word, and within which it is that of the front axle."""

PRECISION = 0.001
"""s that clocks may differ from one another by, beside their standard errors: what alignment leaves of the path and the vehicle."""

CHANCE, SELDOM = 0.05, 0.001
"""Probabilities below which clocks are not one length over the speed, and below which they are not the same clock."""


def length(clock_offset: Sequence[float], error: Sequence[float], speed: Sequence[float]) -> float | None:
    """m by which the point whose distance was recorded runs ahead of the centre of gravity; None where clocks do not say so.

    ``clock_offset`` with standard ``error`` (s) and mean ``speed`` (m/s) of every drive, (drive,): they must agree on one length, and not on
    one clock (a chi-squared test of either), at speeds APART.
    """
    clock, speed = np.asarray(clock_offset, float), np.asarray(speed, float)
    weight = 1.0 / (np.square(np.nan_to_num(error)) + PRECISION**2)
    if len(clock) < 2 or speed.max() < APART * speed.min():
        return None
    found = float(np.sum(weight * clock / speed) / np.sum(weight / speed**2))
    one = float(np.sum(weight * clock) / np.sum(weight))
    misses = [float(np.sum(weight * (clock - expected) ** 2)) for expected in (found / speed, one)]
    of_length, of_clock = chi2.sf(misses, len(clock) - 1)
    return found if abs(found) >= LEAST and of_length > CHANCE and of_clock < SELDOM else None


def of_drives(drives: Sequence[xr.Dataset]) -> float | None:
    """``length`` of aligned drives; None where no place was recorded, which alone has a clock."""
    told = [drive for drive in drives if drive.attrs["place_measured"]]
    if len(told) < 2:
        return None
    clocks, errors = ([drive.attrs[name] for drive in told] for name in ("clock_offset", "clock_offset_error"))
    return length(clocks, errors, [float(drive["v_x"].mean()) for drive in told])


def words(metres: float, front_axle: float) -> str:
    """What such a length of the drives of a site means; ``front_axle``: m by which that axle lies ahead of the centre of gravity."""
    where = f"{abs(metres):.2f} m {'ahead of' if metres > 0 else 'behind'} the centre of gravity"
    said = f"clock offsets times speed are one length: s looks like the distance of a point {where}"
    if abs(metres - front_axle) < CLOSE:
        return f"{said}, where the front axle is (distance_of: front_axle)"
    return f"{said}; shift s by as much, where that is so"
