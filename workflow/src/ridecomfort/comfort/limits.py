"""Limits of acceleration and jerk: what passengers accept; light enough for the configuration to check them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import InputError

STYLES = ("PT", "ND", "AG")
"""Public transport, normal and aggressive driving, mildest first."""

BAE = "Bae, Moon and Seo (2019), as in tab:thresholds_manual"
DATA = "sec:thresholding, from car-following data of Makridis et al."


@dataclass(frozen=True)
class Band:
    """What a passenger accepts of one quantity: from ``lower`` to ``upper``, and who says so."""

    lower: float
    upper: float
    source: str = ""

    def __post_init__(self) -> None:
        if not self.lower < 0 < self.upper:
            raise InputError(f"[{self.lower}, {self.upper}], expected a value below 0 and one above it")


ACCELERATION = {
    "a_x": {"PT": Band(-0.90, 0.90, BAE), "ND": Band(-2.00, 1.47, BAE), "AG": Band(-5.08, 3.07, BAE)},
    "a_y": {"PT": Band(-0.90, 0.90, BAE), "ND": Band(-4.00, 4.00, BAE), "AG": Band(-5.60, 5.60, BAE)},
    "a_z": {"PT": Band(-0.10, 0.10, DATA), "ND": Band(-0.10, 0.10, DATA), "AG": Band(-0.30, 0.30, DATA)},
}
"""m/s2, by axis and style (tab:thresholds_manual)."""

JERK = {
    "standing_low": Band(-0.50, 0.50, "Eriksson and Friman, standing in public transport; sec:back_motivation"),
    "standing_high": Band(-0.90, 0.90, "Eriksson and Friman, standing in public transport; sec:back_motivation"),
    "seated": Band(-2.90, 2.90, "Elbanhawi, Simic and Jazar (2015), seated; sec:back_motivation"),
}
"""m/s3; the lower and the upper figure for standing, and the upper bound for seated passengers."""


def bands(configured: Mapping[str, Mapping] | None = None) -> dict[str, dict[str, Band]]:
    """Bands from plain settings ``{axis: {style: [lower, upper]}}``, the paper's where none are given.

    A setting may say where it comes from, ``[lower, upper, source]``; one that repeats the paper's keeps its source.
    """
    if configured is None:
        return ACCELERATION
    answer = {}
    for axis in sorted(configured):
        styles = sorted(configured[axis], key=lambda style: (STYLES.index(style) if style in STYLES else 9, style))
        published = ACCELERATION.get(axis, {})
        answer[axis] = {style: band(configured[axis][style], published.get(style), f"thresholds: {axis}: {style}") for style in styles}
    return answer


def jerk_bands(configured: Mapping | None = None) -> dict[str, Band]:
    """Bands from plain settings ``{style: [lower, upper]}`` or ``[lower, upper, source]``, the paper's without any."""
    if configured is None:
        return dict(JERK)
    return {style: band(values, JERK.get(style), f"jerk: {style}") for style, values in configured.items()}


def band(configured, published: Band | None = None, place: str = "threshold") -> Band:
    """A band from ``[lower, upper]`` or ``[lower, upper, source]``; with the figures of a published one, that one.

    Raises InputError, which names the ``place``, where they do not lie on either side of 0.
    """
    if isinstance(configured, Band):
        return configured
    lower, upper, *source = configured
    if not source and published is not None and (lower, upper) == (published.lower, published.upper):
        return published
    try:
        return Band(lower, upper, *(source or ["as configured"]))
    except InputError as problem:
        raise InputError(str(problem), place=place) from None
