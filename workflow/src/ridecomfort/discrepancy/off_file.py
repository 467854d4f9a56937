"""Parameters of the vehicle that calibration holds, and to which the drives give other values than the vehicle's file."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from . import evidence, floor
from . import experiment as exp
from .experiment import Size
from .refit import Fit, is_within
from .selection import Selection

LEAST_LEFT = 0.001
"""Share of the power of a signal that must be left more with the values of the file for them to be worth a word."""

LEAST_OF_FLOOR = 0.5
"""Share of the floor of a signal (mean square) that suffices, too: beside quiet instruments a thousandth of the power may be most of what an
error ladder shows."""

LEAST_OF_GONE = 0.5
"""Share of what effects removed of the error, all signals alike, that suffices as well: on an error ladder, whose models are calibrated with the
values of the file, a small effect would else not help that is there."""

LEAST_POWER = 0.05
"""White power of what one of them does alone, against the most that any does, from which on it is told."""

TOLD = 2
"""Signals of which it is told."""


@dataclass(frozen=True)
class Held:
    """A parameter of the vehicle that calibration holds: the value that it is ``given`` with, and the ``value`` that the drives give it, with
    its 90 % ``interval``."""

    parameter: str
    unit: str
    given: float
    value: float
    interval: tuple[float, float]

    def words(self) -> str:
        """As of ``beside_given``."""
        return beside_given(self.parameter, self.unit, self.value, self.interval, self.given)


@dataclass(frozen=True)
class OffFile:
    """``parameters`` that calibration holds beside the values that drives give them; ``left``: share of the power of each signal that is left
    more by it, of what is judged; ``of_floor``: the same as a multiple of its floor, where that is known; ``of_gone``: what is left more in all as a
    share of what effects removed, each signal's error at first weighing alike, nil where there are none."""

    parameters: tuple[Held, ...]
    left: Mapping[str, float] = field(default_factory=dict)
    of_floor: Mapping[str, float] = field(default_factory=dict)
    of_gone: float = 0.0

    def words(self) -> str:
        """What they are, and what holding them costs."""
        told = [f"{100 * self.left[name]:.1f} % of the power of {name}" for name in _most(self.left, LEAST_LEFT)]
        told = told or [f"{self.of_floor[name]:.2g} times the floor of {name}" for name in _most(self.of_floor, LEAST_OF_FLOOR)]
        told = told or [f"{100 * self.of_gone:.0f} % of what the effects remove"]
        less = [f"{-100 * self.left[name]:.1f} % less of that of {name}" for name in _most({name: -cost for name, cost in self.left.items()}, LEAST_LEFT)]
        left = f"another {' and '.join(told)} is left" + (f", and {' and '.join(less)}" if less else "")
        return f"the drives ask for {', '.join(one.words() for one in self.parameters)}, which calibration holds fixed: with the values of the file {left}"


def _most(costs: Mapping[str, float], least: float) -> list[str]:
    """The signals of the largest costs that are no less than ``least``."""
    return sorted((name for name in costs if costs[name] >= least), key=lambda name: -costs[name])[:TOLD]


def beside_given(parameter: str, unit: str, value: float, interval: tuple[float, float], given: float) -> str:
    """A value with its interval beside the one that the vehicle was given with, such as "roll_inertia 595 kg m2 (588 to 603) for 572"."""
    own, lower, upper, first = (f"{float(f'{number:.4g}'):g}" for number in (value, *interval, given))
    return f"{parameter} {own} {unit}".removesuffix(" 1") + f" ({lower} to {upper}) for {first}"


def off_file(selection: Selection, told: Collection[str] = (), is_named: bool = False) -> OffFile | None:
    """What calibration holds beside the drives in the last model of a selection, but what is ``told`` otherwise; None where the intervals hold the
    values of the file, or hardly more is left with these. ``is_named``: whether effects have names, so that what they remove counts.

    All else that was fitted makes good what it can of values that are held otherwise, as a calibration would.
    """
    final, frame, fit = selection.final, selection.frame, selection.states[-1].fit
    off = [size for size in frame.experiment.free if size.held and size.key not in told and _is_off(size, selection)]
    if not off:
        return None
    normal = evidence.product(fit.columns, fit.columns)
    held = _much(off, fit, normal)
    try:
        residuals = exp.simulate(frame.experiment, _at_file(held, selection, normal), frame.indices)
    except (InputError, ValueError):  # a vehicle that cannot be driven
        return None
    measured = {index: frame.experiment.measured(index) for index in frame.indices}
    with_file, with_own = (floor.squares(frame.experiment, frame.all_cleaned(those)) for those in (residuals, fit.residuals))
    more, known = (with_file - with_own).mean(axis=0), selection.floor_squares.mean(axis=0)
    share_of = lambda whole: np.divide(more, whole, out=np.zeros_like(more), where=whole > 0)
    left, of_floor = share_of(floor.squares(frame.experiment, measured).mean(axis=0)), share_of(known)
    first, last = (state.squares.mean(axis=0) for state in (selection.states[0], selection.states[-1]))
    gone = float(np.sum((first - last) / first)) if is_named else 0.0
    of_gone = float(np.sum(more / first)) / gone if gone > 0 else 0.0
    if not (np.max(left) >= LEAST_LEFT or np.max(of_floor) >= LEAST_OF_FLOOR or of_gone >= LEAST_OF_GONE):
        return None
    channels = frame.experiment.channels
    those = (Held(size.key, size.unit, size.neutral, final.values[size.key], selection.told(size.key)) for size in held)
    return OffFile(tuple(those), dict(zip(channels, left.tolist())), dict(zip(channels, of_floor.tolist())), of_gone)


def _is_off(size: Size, selection: Selection) -> bool:
    """Whether the interval of a parameter does not hold the value that it is given with. One at its bound has no value that drives give it."""
    lower, upper = selection.intervals[size.key]
    return is_within(size, selection.final.values) and not lower <= size.neutral <= upper


def _much(off: Sequence[Size], fit: Fit, normal: np.ndarray) -> list[Size]:
    """Those of the sizes that do much where they are not as the file says, and nothing else that is fitted makes good; ``normal``: products of
    the columns of the ``fit``."""
    ways, places = _ways(off, fit), {size.key: fit.keys.index(size.key) for size in off}
    others = [k for k, key in enumerate(fit.keys) if key not in ways]
    left = normal - normal[:, others] @ _steps(normal, others, normal)
    power = {key: ways[key] ** 2 * left[k, k] for key, k in places.items()}
    return [size for size in off if power[size.key] >= LEAST_POWER * max(power.values())]


def _at_file(held: Sequence[Size], selection: Selection, normal: np.ndarray) -> dict[str, float]:
    """The values of the last model of a selection with those that are ``held`` at the vehicle's file, all others as they come closest to it
    then: by its linear columns, of which ``normal`` are the products."""
    experiment, fit = selection.frame.experiment, selection.states[-1].fit
    sizes = [*experiment.free, *(size for candidate in experiment.candidates for size in (*candidate.sizes, *candidate.shaping))]
    known, ways, values = {size.key: size for size in sizes}, _ways(held, fit), dict(fit.values)
    others = [k for k, key in enumerate(fit.keys) if key in known and key not in ways]
    change = sum(way * normal[:, fit.keys.index(key)] for key, way in ways.items())
    for k, step in zip(others, _steps(normal, others, change)):
        size = known[fit.keys[k]]
        values[size.key] = float(np.clip(values[size.key] - step * size.probe, size.lower, size.upper))
    return {**values, **{size.key: size.neutral for size in held}}


def _ways(sizes: Sequence[Size], fit: Fit) -> dict[str, float]:
    """Probes from the value of a fit to that of the file, by key."""
    return {size.key: (size.neutral - fit.values[size.key]) / size.probe for size in sizes}


def _steps(normal: np.ndarray, others: Sequence[int], change: np.ndarray) -> np.ndarray:
    """Steps of those others whose sum comes closest to what has these products (key, ...) with every column."""
    return np.linalg.pinv(normal[np.ix_(others, others)], hermitian=True) @ change[others]
