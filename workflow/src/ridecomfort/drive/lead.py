"""Whether the distances of drives are those of another point than the centre of gravity: their clocks are one length over the speed then."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy.stats import chi2

APART = 1.1
"""Ratio of the largest to the smallest speed from which on one length and one clock differ."""

LEAST, CLOSE, ON_A_VEHICLE = 0.3, 0.2, 3.0
"""m of a length that is worth a word, within which it is that of the front axle, and up to which a point lies on a vehicle."""

PRECISION = 0.001
"""s that clocks may differ from one another by, beside their standard errors: what alignment leaves of the path and the vehicle."""

CHANCE, SELDOM = 0.05, 0.001
"""Probabilities below which clocks are not one length over the speed, and below which they are not the same clock."""


def length(clock_offset: Sequence[float], error: Sequence[float], speed: Sequence[float]) -> float | None:
    """m by which the point whose distance was recorded runs ahead of the centre of gravity; None where clocks do not say so.

    ``clock_offset`` with standard ``error`` (s) and mean ``speed`` (m/s, harmonic over time: the length over the mean delay) of every drive, (drive,). They must agree on
    one length of LEAST, and not on one clock (a chi-squared test of either), at speeds APART; drives whose error is not known do not
    count. A clock that lags by itself as well, the same on all drives, hides a length.
    """
    known = np.isfinite(error)
    clock, error, speed = (np.asarray(values, float)[known] for values in (clock_offset, error, speed))
    if len(clock) < 2 or speed.max() < APART * speed.min():
        return None
    weight = 1.0 / (error**2 + PRECISION**2)
    found = float(np.sum(weight * clock / speed) / np.sum(weight / speed**2))
    one = float(np.sum(weight * clock) / np.sum(weight))
    misses = [float(np.sum(weight * (clock - expected) ** 2)) for expected in (found / speed, one)]
    of_length, of_clock = chi2.sf(misses, len(clock) - 1)
    return found if abs(found) >= LEAST and of_length > CHANCE and of_clock < SELDOM else None


def of_drives(drives: Sequence[xr.Dataset]) -> float | None:
    """``length`` of aligned drives; those whose place was not recorded have no clock."""
    told = [drive for drive in drives if drive.attrs["place_measured"]]
    clocks, errors = ([drive.attrs[name] for drive in told] for name in ("clock_offset", "clock_offset_error"))
    return length(clocks, errors, [float(1.0 / (1.0 / drive["v_x"]).mean()) for drive in told])


def words(metres: float, front_axle: float, is_of_front_axle: bool = False) -> str:
    """What such a length of the drives of a site means; ``front_axle``: m by which that axle lies ahead of the centre of gravity,
    ``is_of_front_axle``: whether distances were taken for those of that axle."""
    said = "clock offsets times speed are one length"
    if abs(metres) > ON_A_VEHICLE:
        where = f"{abs(metres):.2f} m {'before' if metres > 0 else 'behind'} the road's"
        return f"{said}: s looks as if it began {where} ({-metres:+.2f} m to it put that right)"
    point = metres + front_axle if is_of_front_axle else metres
    if is_of_front_axle and abs(point) < CLOSE:
        return f"{said}: s looks like the distance of the centre of gravity, not of the front axle (leave out distance_of)"
    where = f"{abs(point):.2f} m {'ahead of' if point > 0 else 'behind'} the centre of gravity"
    if abs(point - front_axle) < CLOSE:
        return f"{said}: s looks like the distance of a point {where}, where the front axle is (distance_of: front_axle)"
    return f"{said}: s looks like the distance of a point {where}, or begins elsewhere than the road's; if so, {-metres:+.2f} m to s put it right"
