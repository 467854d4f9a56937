"""Where the error sits, in words, largest first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr

from . import bursts
from .judged import LOWEST_OF_DRIVER, doubt

NAMED = 0.01
"""Share of the signal's power below which a finding is not worth a sentence, unless there is no other."""

LEAST_NAMED = 0.001
"""Share of the signal's power below which nothing is."""

OF_A_SIGNAL = 2
"""Findings of one signal at most: bands of one error beside each other would crowd out all that is wrong elsewhere."""

HALF = 0.5
"""Share of an error that the stretch of road named for it holds."""

EVERYWHERE, PATCHY = 0.35, 0.25
"""Share of the road from which on one stretch that holds HALF of an error says nothing, and up to which many that do are told to be few."""

PREVAILING, HELD, LEAST = 2.0, 0.1, 0.1
"""How many times as large as below an edge an error is beside the signal above it (or the other way round) for that to be named; the least
part of the error that one side holds, and of the signal that the other does; and the least that the error counts for there, beside its mean."""

CLEARLY = 1.2
"""How many times the ratio that suspension velocities have those of tyres must have to be named: the two go together on a rough road."""

GATHERED, OFTEN = 0.15, 5.0
"""Share of the error above the floor, the median of the signals, from which on one stretch of road that holds it is told, and how many times its
share of the road that must be."""

STRAIGHT = 3000.0
"""m of radius above which a road is called straight."""


def _tighter(curvature: float) -> str:
    radius = 1 / max(curvature, 1e-6)
    return "bends" if radius > STRAIGHT else f"radii below {radius:.0f} m"


def _straighter(curvature: float) -> str:
    radius = 1 / max(curvature, 1e-6)
    return "straight stretches" if radius > STRAIGHT else f"radii above {radius:.0f} m"


def _of_size(what: str, unit: str) -> tuple[Callable[[float], str], Callable[[float], str]]:
    """Both sides of an edge of a size that begins at nil: two digits, for an edge that is printed as nil says nothing, or what cannot be."""
    digits = partial(np.format_float_positional, precision=2, fractional=False, trim="-")
    return lambda edge: f"{what} above {digits(edge)} {unit}", lambda edge: f"{what} below {digits(edge)} {unit}"


CONDITIONS: dict[str, tuple[Callable[[float], str], Callable[[float], str]]] = {
    "speed": (lambda v: f"speeds above {3.6 * v:.0f} km/h", lambda v: f"speeds below {3.6 * v:.0f} km/h"),
    "curvature": (_tighter, _straighter),
    "lateral_acceleration": _of_size("lateral accelerations", "m/s²"),
    "longitudinal_acceleration": _of_size("braking or driving", "m/s²"),
    "suspension_velocity": _of_size("suspension velocities", "m/s"),
    "tyre_velocity": _of_size("tyre velocities", "m/s"),
}
"""How the upper and the lower classes of a condition are said."""


@dataclass(frozen=True)
class Finding:
    """An error above the floor: its signal, band in Hz, the stretch in m that holds half of it (None: no short one does), and the ``least``
    share of the road, in stretches wherever they are, that does.

    ``when`` is the condition under which it is largest beside the signal, in words (empty: none); ``power_share`` is over the
    signal's measured power, ``explainable_share`` over its error in all bands that lie above the floor.
    """

    signal: str
    lower: float
    upper: float
    stretch: tuple[float, float] | None
    least: float
    when: str
    power_share: float
    explainable_share: float

    @property
    def where(self) -> str:
        """The stretch in words."""
        if self.stretch is None:
            return "all along the road" if self.least > PATCHY else f"at many places, half of it on {100 * self.least:.0f} % of the road"
        return "half of it between {:.2f} and {:.2f} km".format(*(place / 1000 for place in self.stretch))

    def words(self) -> str:
        """Such as "a_z, 8-14 Hz, half of it between 1.20 and 1.50 km, relatively most at speeds above 70 km/h: 12 % of its power"."""
        when = f", relatively most at {self.when}" if self.when else ""
        return (
            f"{self.signal}, {self.lower:g}-{self.upper:g} Hz, {self.where}{when}: {100 * self.power_share:.1f} % of the "
            f"signal's power, {100 * self.explainable_share:.0f} % of its explainable error"
        )


def findings(located: xr.Dataset, count: int = 5) -> list[Finding]:
    """The largest errors above the floor of what ``locate.locate`` returned, by their share of power: at most ``count`` that reach NAMED,
    OF_A_SIGNAL each; the largest alone, from LEAST_NAMED on, where none does."""
    share = located["power_share"].values
    whole = share.sum(axis=1)
    explainable = located["explainable_share"].values.sum(axis=1)
    found = []
    largest = np.nan_to_num(whole, nan=-np.inf)  # nothing is said of a signal that has no power
    for signal, band in sorted(np.ndindex(whole.shape), key=lambda key: -largest[key]):
        if largest[signal, band] < (NAMED if found else LEAST_NAMED) or len(found) == count:
            break
        name = str(located["signal"].values[signal])
        if sum(finding.signal == name for finding in found) == OF_A_SIGNAL:
            continue
        lower, upper = (float(located[f"band_{end}"][band]) for end in ("lower", "upper"))
        along = np.maximum(share[signal, :, band], 0.0)
        lower = max(lower, LOWEST_OF_DRIVER.get(name, lower))
        parts = float(whole[signal, band]), float(explainable[signal, band])
        found.append(Finding(name, lower, upper, _stretch(located, along), _least(along), _when(located, signal, band), *parts))
    return found


def are_small(found: Sequence[Finding]) -> bool:
    """Whether findings hold no more than the largest of errors that are none worth a sentence."""
    return all(finding.power_share < NAMED for finding in found)


def gathered(located: xr.Dataset) -> list[str]:
    """The stretch in which most signals have much of their error, in words, if there is one. A single hole or crest does not come first in
    any band, and yet may be what the model does otherwise than the car."""
    above = np.maximum(located["power_share"].values, 0.0).sum(axis=2)
    whole = above.sum(axis=1)
    counts = whole >= LEAST_NAMED
    if 2 * counts.sum() < len(whole):
        return []
    share = np.median(above[counts] / whole[counts, None], axis=0)
    place = int(share.argmax())
    if share[place] < max(GATHERED, OFTEN / len(share)):
        return []
    start, end = (float(located[f"stretch_{edge}"][place]) / 1000 for edge in ("start", "end"))
    return [
        f"{100 * share[place]:.0f} % of the error above the floor, the median of the signals, lies between {start:.2f} and {end:.2f} km, "
        f"{100 / len(share):.0f} % of the road"
    ]


def doubts(located: xr.Dataset) -> list[str]:
    """Signals whose column, sign or unit is in doubt, in words: what else is found of them means nothing then."""
    found = zip(*(located[name].values.tolist() for name in ("signal", "goes_with", "against", "correlation", "ratio")))
    return [said for of_it in found if (said := doubt(*of_it))]


def of_floor(compared: xr.Dataset) -> list[str]:
    """What is to be said of a floor that is no noise, in words (``bursts.words``)."""
    return bursts.words(dict(zip(compared["signal"].values.tolist(), compared["floor_time_share"].values.tolist())))


def words(located: xr.Dataset, count: int = 5) -> list[str]:
    """Doubts and, behind them, findings as sentences, and the place where errors gather."""
    return [*doubts(located), *(finding.words() for finding in findings(located, count)), *gathered(located), *of_floor(located)]


def _stretch(located: xr.Dataset, share: np.ndarray) -> tuple[float, float] | None:
    """Start and end in m of the shortest run of stretches that holds half of an error; None where it is even."""
    for length in range(1, int(EVERYWHERE * len(share)) + 1):
        sums = np.convolve(share, np.ones(length), "valid")
        if sums.max() >= HALF * share.sum():
            first = int(sums.argmax())
            return float(located["stretch_start"][first]), float(located["stretch_end"][first + length - 1])
    return None


def _least(share: np.ndarray) -> float:
    """The least part of the stretches that holds HALF of an error."""
    held = np.cumsum(np.sort(share)[::-1])
    return (int(np.searchsorted(held, HALF * held[-1])) + 1) / len(share)


def _when(located: xr.Dataset, signal: int, band: int) -> str:
    """The condition above or below one of whose edges an error above the floor is largest beside the signal, in words, empty if none is.

    Beside the signal: rough stretches make any error larger, and only what grows otherwise than the signal says something of its cause.
    """
    time = located["condition_share"].values
    error = time * (located["condition_error"].values[:, :, signal, band] - float(located["band_floor"][signal, band]))
    measured = time * located["condition_measured"].values[:, :, signal, band]
    parts = (np.cumsum(each, axis=1) / each.sum(axis=1, keepdims=True) for each in (error, measured))
    below, signal_below = (each[:, :-1] for each in parts)
    sides = [(1.0 - below, 1.0 - signal_below), (below, signal_below)]
    ratios = np.stack([_times(*own, *other) for own, other in (sides, sides[::-1])])
    suspension, tyre = (np.flatnonzero(located["condition"].values == f"{of}_velocity") for of in ("suspension", "tyre"))
    if suspension.size and ratios[:, tyre].max(initial=0.0) < CLEARLY * ratios[:, suspension].max():
        ratios[:, tyre] = 0.0
    side, condition, edge = np.unravel_index(int(ratios.argmax()), ratios.shape)
    if ratios[side, condition, edge] < PREVAILING:
        return ""
    return CONDITIONS[str(located["condition"].values[condition])][side](float(located["condition_edge"][condition, edge + 1]))


def _times(error: np.ndarray, signal: np.ndarray, other_error: np.ndarray, other_signal: np.ndarray) -> np.ndarray:
    """How many times as large as on the other side of an edge an error is beside the signal; nil where one side holds too little."""
    counts = (error >= HELD) & (other_signal >= HELD)
    least = LEAST * other_signal  # an error below the floor is none, and by how much says nothing
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(counts, (error / signal) / (np.maximum(other_error, least) / other_signal), 0.0)
