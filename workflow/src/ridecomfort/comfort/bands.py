"""Comfort bands of ISO 2631-1 for the total value, with the overlaps that the standard means."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import InputError

INFINITE = float("inf")

BANDS = {
    "NU": (0.0, 0.315),
    "LU": (0.315, 0.63),
    "FU": (0.50, 1.00),
    "U": (0.80, 1.60),
    "VU": (1.25, 2.50),
    "EU": (2.00, INFINITE),
}
"""m/s2, mildest first: not, a little, fairly, uncomfortable, very, extremely uncomfortable
(ISO 2631-1:1997 C.2.3; tab:acc_thresholds, with the band U that it leaves out)."""

PERCEPTION = (0.01, 0.015, 0.02)
"""m/s2 peak of W_k-weighted vibration: a quarter of alert people perceive the first, half the
second, three quarters the third (ISO 2631-1:1997 C.3, interquartile range about the median)."""

RULES = ("severe", "mild", "middle")
"""How a value in two bands gets one label: the worse band, the better one, or the one on its side
of the middle of their overlap."""


def edges(configured: Mapping | None = None) -> dict[str, tuple[float, float]]:
    """Bands from plain settings {name: [lower, upper or None]}, mildest first; the standard's where none are given.

    Raises InputError where bands do not follow upon each other, from 0 to no end.
    """
    if configured is None:
        return dict(BANDS)
    order = [name for name in BANDS if name in configured] + [name for name in configured if name not in BANDS]
    answer = {
        name: (float(configured[name][0]), INFINITE if configured[name][1] is None else float(configured[name][1]))
        for name in order
    }
    lower, upper = np.array(list(answer.values())).T
    if not (np.all(np.diff(lower) > 0) and np.all(np.diff(upper) > 0) and np.all(lower < upper)):
        raise InputError("bands must follow upon each other, mildest first", place="iso2631.bands")
    if np.any(lower[1:] > upper[:-1]):
        gap = int(np.argmax(lower[1:] > upper[:-1]))
        raise InputError(f"nothing between {order[gap]} and {order[gap + 1]}", place="iso2631.bands")
    if lower[0] > 0.0 or np.isfinite(upper[-1]):
        raise InputError(
            f"{order[0]} begins at {lower[0]:g} and {order[-1]} ends at {upper[-1]:g}, expected 0 and null: every value lies in a band",
            place="iso2631.bands",
        )
    return answer


def membership(total_value, limits: Mapping | None = None) -> np.ndarray:
    """Which bands hold each value: bool (band, ...); one or, in an overlap, two of them."""
    values = np.asarray(total_value)
    return np.array([(values >= lower) & (values < upper) for lower, upper in edges(limits).values()])


def label(total_value, rule: str = "severe", limits: Mapping | None = None) -> np.ndarray:
    """The index of the one band of each value by one of ``RULES``, for maps; -1 where it is not finite."""
    return np.where(np.isfinite(total_value), np.searchsorted(boundaries(rule, limits), total_value, side="right"), -1)


def boundaries(rule: str = "severe", limits: Mapping | None = None) -> np.ndarray:
    """The values in m/s2 at which the single label changes, between one band and the next."""
    lower, upper = np.array(list(edges(limits).values())).T
    if rule == "severe":
        return lower[1:]
    if rule == "mild":
        return upper[:-1]
    if rule == "middle":
        return 0.5 * (lower[1:] + upper[:-1])
    raise InputError(f"{rule!r} is unknown; expected one of {', '.join(RULES)}", place="rule")


def names(total_value: float, limits: Mapping | None = None) -> list[str]:
    """Names of every band that a value lies in."""
    return [name for name, (lower, upper) in edges(limits).items() if lower <= total_value < upper]
