"""Total values: which weighting and multiplying factor each point and axis of the body takes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import InputError

COMFORT = {
    ("seat", "x"): ("Wd", 1.0),
    ("seat", "y"): ("Wd", 1.0),
    ("seat", "z"): ("Wk", 1.0),
    ("seat", "roll"): ("We", 0.63),
    ("seat", "pitch"): ("We", 0.4),
    ("seat", "yaw"): ("We", 0.2),
    ("back", "x"): ("Wc", 0.8),
    ("back", "y"): ("Wd", 0.5),
    ("back", "z"): ("Wd", 0.4),
    ("feet", "x"): ("Wk", 0.25),
    ("feet", "y"): ("Wk", 0.25),
    ("feet", "z"): ("Wk", 0.4),
    ("standing", "x"): ("Wd", 1.0),
    ("standing", "y"): ("Wd", 1.0),
    ("standing", "z"): ("Wk", 1.0),
    ("recumbent", "horizontal"): ("Wd", 1.0),
    ("recumbent", "vertical"): ("Wk", 1.0),
}
"""(point, axis) to (weighting, k); k of the rotations in m/rad, of rad/s2 (ISO 2631-1:1997 8.2.2 and 8.2.3).
Seat: the seat surface of a seated person, back: the backrest, feet: the floor."""

HEALTH = {("seat", "x"): ("Wd", 1.4), ("seat", "y"): ("Wd", 1.4), ("seat", "z"): ("Wk", 1.0)}
"""The same for health (ISO 2631-1:1997 7.2.3)."""


def total_value(rms: Mapping[str, float], point: str = "seat", factors: Mapping = COMFORT):
    """Vibration total value a_v of one point in m/s2 from weighted rms by axis (eq:combi; ISO 2631-1:1997 6.5).

    ``rms``: axis to rms in m/s2 (rotations rad/s2), numbers or arrays, each weighted as in ``factors``.
    Raises InputError for an axis that the point does not have.
    """
    total = 0.0
    for axis, value in rms.items():
        if (point, axis) not in factors:
            known = ", ".join(known for place, known in factors if place == point)
            raise InputError(f"axis {axis!r} is unknown there; expected one of {known}", place=f"point {point!r}")
        total = total + (factors[point, axis][1] * np.asarray(value)) ** 2
    return np.sqrt(total)


def overall(rms: Mapping[tuple[str, str], float], factors: Mapping = COMFORT):
    """Overall total value in m/s2 of several points, the root of the sum of their squares (ISO 2631-1:1997 8.2.3).

    ``rms``: (point, axis) to weighted rms.
    """
    points: dict[str, dict] = {}
    for (point, axis), value in rms.items():
        points.setdefault(point, {})[axis] = value
    return np.sqrt(sum(total_value(axes, point, factors) ** 2 for point, axes in points.items()))
