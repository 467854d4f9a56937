"""Parameters of the vehicle beyond their bounds: whether the drives speak for values farther off, and what those explain."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import norm

from .. import calibrate
from ..calibrated import with_values
from ..descent import descend
from ..errors import InputError
from ..identifiability import AT_BOUND, CONFIDENCE, UNIDENTIFIED
from ..vehicle.parameters import PARAMETERS
from . import refit
from .car import Car
from .confirm import EQUAL
from .experiment import Size
from .off_file import beside_given
from .propose import HELD_OUT_Z
from .refit import Fit
from .rung import Rung, climb
from .selection import Selection, State, shares

WIDER = {"m": 1.0, "1": 1.0, "kg m2": 2.0}
"""Factor by unit that the upper bound is multiplied by and the lower one divided by: lengths are known to a tape measure, shares by drawings,
friction by what rubber does (one of 0.2 on a dry road is a tyre that is soft to the side), inertias by mass and size..."""

ANY = 3.0
"""...and all else, stiffnesses, dampings and masses, by nothing but its effect."""

LOWER = {"tyre_radial_damping": 100.0}
"""Factor that the lower bound of a single parameter is divided by: published dampings of tyres, 0 to 2000 N s/m, all lie below the bounds of
the paper."""

LEAST_SHARE = 0.05
"""Share of the explainable error that must go for them to be worth a word."""

LEAST_POWER = 0.05
"""White power of what a parameter does beyond its bound, against the most that any does there, from which on it is told, too, though its
interval reaches back into them: what goes with all of them is not the work of those alone that are sure."""

LEFT, CLOSER = 0.75, 0.5
"""Shares of what effects leave of the explainable error that parameters alone, and parameters with fewer effects, may leave at most to take
their place: beside an effect that does nearly all, what a wrong damper does is little, and another effect stands in for that."""


@dataclass(frozen=True)
class Beyond:
    """A parameter of the vehicle: the value that the vehicle was ``given`` with, the ``bounds`` it was kept in, and the ``value`` it has within
    ``wider`` ones, with its 90 % ``interval``."""

    parameter: str
    unit: str
    given: float
    bounds: tuple[float, float]
    wider: tuple[float, float]
    value: float
    interval: tuple[float, float]


@dataclass(frozen=True)
class AtBound:
    """A parameter of the vehicle that ended at a bound: its ``value`` in ``unit``, the ``bound``, whether that is the ``upper`` or the
    ``lower`` ``end``, and whether it is one WIDER than the parameter's own, which were given."""

    parameter: str
    unit: str
    value: float
    bound: float
    end: str
    is_wider: bool = False

    def words(self) -> str:
        """Such as "spring_stiffness_rear at 15000 N/m, its lower bound"."""
        bound = f"{_rounded(self.bound) if self.is_wider else self.bound:g} {self.unit}".removesuffix(" 1")
        last = {"lower": "the least", "upper": "the most"}[self.end]
        if self.is_last:
            return f"{self.parameter} at {bound}, {last} that there can be"
        which = f"{last} that was tried beyond its bounds" if self.is_wider else f"its {self.end} bound"
        return f"{self.parameter} at {bound}, {which}"

    @property
    def is_last(self) -> bool:
        """Whether no vehicle lies beyond."""
        return self.bound == getattr(PARAMETERS[self.parameter], self.end)


@dataclass(frozen=True)
class BeyondBounds:
    """``parameters`` that lie beyond their bounds, and the ``share`` of the explainable error that goes on fitted and on held-out drives
    (nan where not known) when they may: beside effects that were found without; where ``is_first``, before any effect; where ``is_instead``,
    alone, as another explanation, which is no better than that of the verdict, or ``is_as_good``. ``less_sure``: parameters whose values lie
    beyond their bounds, too, and do much there, but whose intervals reach back into them. ``effects``: names of the fewer effects that remove
    as much as those of the verdict where parameters may lie beyond their bounds; shares are of both then."""

    parameters: tuple[Beyond, ...]
    share: float
    held_out_share: float
    is_first: bool = False
    is_instead: bool = False
    less_sure: tuple[Beyond, ...] = ()
    effects: tuple[str, ...] = ()
    is_as_good: bool = False

    def words(self, is_more: bool) -> str:
        """What they are and what goes with them; ``is_more``: beside effects that were found."""
        names = _told(self.parameters)
        if self.less_sure:
            names += f", less surely {_told(self.less_sure)}, of which one may stand in for another"
        checked = f", {100 * self.held_out_share:.0f} % on drives held out" if np.isfinite(self.held_out_share) else ""
        gone = f"{100 * self.share:.0f} % of the explainable error{checked}"
        if self.is_instead:
            how, alone = "as good" if self.is_as_good else "which is no better", f"{', '.join(self.effects)} alone, with " if self.effects else ""
            return f"another explanation, {how}, {gone}: {alone}parameters of the vehicle beyond their bounds, {names}"
        share = f"{gone}{',' if checked else ''} goes with parameters of the vehicle beyond their bounds: {names}"
        if self.is_first and not _is_enough((self.share, self.held_out_share)):
            return f"beside what is missing, parameters of the vehicle lie beyond their bounds: {names}; shares are of what they leave"
        if self.is_first:
            return f"{share}; other shares are of what they leave"
        return f"another {share}" if is_more else share

    @property
    def is_another_name(self) -> bool:
        """Whether they do alone, and by no more numbers, what the effects of a verdict do."""
        return self.is_as_good and not self.effects

    def names(self) -> list[str]:
        """All parameters that are told."""
        return [one.parameter for one in (*self.parameters, *self.less_sure)]

    def of(self, vehicle) -> BeyondBounds:
        """The same with the values that this vehicle has as given: what it was calibrated to is no value of its file."""
        given = lambda those: tuple(replace(one, given=float(vehicle[one.parameter])) for one in those)
        return replace(self, parameters=given(self.parameters), less_sure=given(self.less_sure))


def other_name(parameters: Sequence[str]) -> str:
    """Parameters that are not told from effects, in words."""
    return f"{' and '.join(parameters)} beyond {'its' if len(parameters) == 1 else 'their'} bounds"


def beyond_bounds(selection: Selection, each: Callable = map) -> tuple[BeyondBounds | None, Rung] | None:
    """Parameters of the vehicle that lie beyond their bounds in a model that explains more than the last of a selection, if they surely do,
    and the rung of that model; None where none ends at a bound, or going beyond is no better, on the fitted drives or on those held out.

    What is calibrated or uncertain is calibrated anew within bounds WIDER than its own, on one drive of each condition, and then fitted
    with all drives like every model of the selection: that fit alone, whose error makes itself white, does not find its way so far. It is
    sure with HELD_OUT_Z on drives held out, of parameters whose 90 % interval lies beyond the bounds.
    """
    last = selection.states[-1]
    sizes = _wider(selection, last)
    rung = _wide(selection, last, sizes, each)
    if rung is None:
        return None
    gone = shares(selection, last, State.of(rung, "", rung.fit, rung.check), rung)
    is_sure = rung.check_frame is None or refit.advantage(rung.check_frame, rung.check, selection.check)[1] > HELD_OUT_Z
    intervals = refit.intervals(rung.fit, rung.frame, sizes) if is_sure else {}
    found = _beyond(selection.frame.experiment, rung.experiment, rung.fit, intervals, *gone) if is_sure else None
    return found, rung


def ends_at_bounds(selection: Selection) -> bool:
    """Whether a parameter of the vehicle ends at a bound in the first model of a selection or in the last: else none wants to go beyond."""
    return any(_wider(selection, state) for state in (selection.states[0], selection.states[-1]))


def at_bounds(selection: Selection, given: Sequence[Size]) -> tuple[AtBound, ...]:
    """Parameters of the vehicle that end at a bound in the last fit of a selection; without those that its fitted drives do not tell.
    ``given``: the parameters with the bounds that they have of their own."""
    values, own = selection.final.values, {size.key: (size.lower, size.upper) for size in given}
    return tuple(
        _at_bound(size, values[size.key], own[size.key])
        for size in selection.frame.experiment.free
        if size.key in PARAMETERS and not refit.is_within(size, values) and _is_told(size, selection)
    )


def _at_bound(size: Size, value: float, own: tuple[float, float]) -> AtBound:
    end, bound = min((("lower", size.lower), ("upper", size.upper)), key=lambda one: abs(value - one[1]))
    return AtBound(size.key, size.unit, float(value), float(bound), end, bound not in own)


def _is_told(size: Size, selection: Selection) -> bool:
    """Whether the fitted drives tell a parameter (``identifiability.UNIDENTIFIED``): its interval holds what its bounds say as well, as if
    it were as likely anywhere within them, and what drives held out widened it by."""
    lower, upper = selection.intervals[size.key]
    of_bounds = norm.ppf(0.5 + CONFIDENCE / 2) / np.sqrt(12.0)
    least = 1.0 / np.hypot(1.0 / UNIDENTIFIED, 1.0 / of_bounds)
    return (upper - lower) / 2 < least * selection.birge_ratio * (size.upper - size.lower)


def before_effects(selection: Selection, each: Callable = map) -> Rung | None:
    """The rung of the first model of a selection with parameters beyond the bounds that it ends at, where that alone is better: effects may
    stand in for them, beside which none is at its bound. None where none ends there, or going beyond is no better."""
    first = selection.states[0]
    return _wide(selection, first, _wider(selection, first), each) if len(selection.states) > 1 else None


def without_effects(rung: Rung, each: Callable = map) -> Rung | None:
    """The rung of a model with its vehicle's parameters alone, where a search that allows them as much begins; None where that vehicle cannot
    be driven."""
    experiment = rung.experiment
    try:
        return climb(experiment, {size.key: rung.fit.values[size.key] for size in experiment.free}, experiment.free, each)
    except (InputError, ValueError):
        return None


def searched(before: Selection, after: Selection) -> BeyondBounds | None:
    """Parameters beyond their bounds, found by the search ``after``, which allowed that. None unless they alone explain a share that is worth
    a word, at least one lies outside of its bounds, and the model is better than that of the search ``before``, which kept to them: by
    such a share, or by parameters that alone leave no more than LEFT of what all effects did. Or with fewer effects it leaves no more than
    CLOSER of what those did, whatever the parameters do alone. Parameters that alone explain no EQUAL less than all effects, by no more numbers
    than these have, or do so with fewer of the same effects, are another explanation, as good.
    """
    gained = shares(before, before.states[-1], after.states[-1], after)
    alone = shares(before, before.states[0], after.states[0], after)
    effects = shares(before, before.states[0], before.states[-1], after)
    whole = shares(before, before.states[0], after.states[-1], after)
    leaves = lambda ours, most: not any(1.0 - own > most * (1.0 - theirs) for own, theirs in zip(ours, effects))
    is_fewer = len(after.kept) < len(before.kept)
    is_better = _is_enough(alone) and (_is_enough(gained) or leaves(alone, LEFT)) or is_fewer and leaves(whole, CLOSER)
    found = lambda gone, **kind: _beyond(before.frame.experiment, after.frame.experiment, after.final, after.intervals, *gone, **kind)  # noqa: E731
    if is_better:
        return found(alone, is_first=True)
    no_less = lambda ours: not any(own <= theirs - EQUAL for own, theirs in zip(ours, effects))
    another = found(alone) if _is_enough(alone) and no_less(alone) else None
    if another is not None and len(another.names()) <= _numbers(before):
        return replace(another, is_instead=True, is_as_good=True)
    is_part = bool(after.kept) and set(after.kept) < set(before.kept)
    as_good = found(whole) if is_part and no_less(whole) else None
    return replace(as_good, is_instead=True, is_as_good=True, effects=after.kept) if as_good is not None else None


def _numbers(selection: Selection) -> int:
    """How many sizes the effects of the last model of a selection have."""
    kept = (candidate for candidate in selection.frame.experiment.candidates if candidate.name in selection.kept)
    return sum(len(candidate.sizes) for candidate in kept)


def still_beyond(before: Selection, after: Selection) -> BeyondBounds | None:
    """Parameters that lie beyond the bounds of the search ``before`` beside all that the search ``after`` found, which allowed it; None where
    there are none. How much goes with them alone is not known."""
    unknown = float("nan"), float("nan")
    return _beyond(before.frame.experiment, after.frame.experiment, after.final, after.intervals, *unknown, is_first=True)


def _wider(selection: Selection, state: State) -> list[Size]:
    """What a model of a selection fits, its vehicle's parameters with bounds WIDER than their own; empty where none of these ends at one."""
    experiment, fit = selection.frame.experiment, state.fit
    if all(refit.is_within(size, fit.values) for size in experiment.free if size.key in PARAMETERS):
        return []
    known = {size.key: size for candidate in experiment.candidates for size in (*candidate.sizes, *candidate.shaping)}
    free = [_with_wider_bounds(size) if size.key in PARAMETERS else size for size in experiment.free]
    return [*free, *(known[key] for key in fit.keys if key in known)]


def _wide(selection: Selection, state: State, sizes: Sequence[Size], each: Callable) -> Rung | None:
    """The rung of a model of a selection with these sizes; None without any, where that vehicle cannot be driven, or where too little of the
    explainable error goes with it."""
    if not sizes:
        return None
    experiment, own = selection.frame.experiment, {size.key: size for size in sizes}
    try:
        start = {**state.fit.values, **_calibrated(selection, state, sizes)}
        free = tuple(own[size.key] for size in experiment.free)
        rung = climb(replace(experiment, free=free), start, sizes, each)
    except (InputError, ValueError):  # a vehicle that cannot be driven
        return None
    return rung if _is_enough(shares(selection, state, State.of(rung, "", rung.fit, rung.check), rung)) else None


def _beyond(
    before: Car, after: Car, fit: Fit, intervals: Mapping[str, tuple[float, float]], share: float, held_out_share: float, is_first: bool = False
) -> BeyondBounds | None:
    """What lies beyond the bounds of ``before`` in a fit within those of ``after``; None unless something does with its whole interval."""
    wider = {size.key: (size.lower, size.upper) for size in after.free}
    power, sure, less_sure = {}, [], []
    for size in before.free:
        value = fit.values[size.key]
        off = abs(value - np.clip(value, size.lower, size.upper))
        if size.key not in PARAMETERS or off <= AT_BOUND * (size.upper - size.lower):
            continue
        power[size.key] = float(np.sum((off / size.probe * fit.columns[fit.keys.index(size.key)]) ** 2))
        lower, upper = intervals[size.key]
        told = Beyond(
            size.key, size.unit, float(before.vehicle[size.key]), (size.lower, size.upper), wider[size.key], value, (lower, upper)
        )
        (less_sure if lower <= size.upper and upper >= size.lower else sure).append(told)
    least = LEAST_POWER * max(power.values(), default=0.0)
    much = tuple(one for one in less_sure if power[one.parameter] >= least)
    return BeyondBounds(tuple(sure), share, held_out_share, is_first, less_sure=much) if sure else None


def _told(those: Sequence[Beyond]) -> str:
    """Their values with 90 % intervals beside those that the vehicle was given with, in words."""
    return ", ".join(beside_given(one.parameter, one.unit, one.value, one.interval, one.given) for one in those)


def _is_enough(shares: Sequence[float]) -> bool:
    """Whether all shares that are known are worth a word."""
    return min((share for share in shares if np.isfinite(share)), default=0.0) > LEAST_SHARE


def _rounded(value: float) -> float:
    return float(f"{value:.3g}")


def _with_wider_bounds(size: Size) -> Size:
    """With bounds WIDER than its own."""
    span, times = PARAMETERS[size.key], WIDER.get(size.unit, ANY)
    lower = min(size.lower, size.lower / LOWER.get(size.key, times))
    return replace(size, lower=max(lower, span.lower), upper=min(max(size.upper, size.upper * times), span.upper))


def _calibrated(selection: Selection, state: State, sizes: Sequence[Size]) -> dict[str, float]:
    """Values of ``sizes`` by least squares of what is calibrated, every signal in units of the error that ``state`` leaves of it."""
    experiment = selection.frame.experiment
    chosen = {experiment.records[index].condition: index for index in reversed(selection.frame.indices)}
    replays = [experiment.replays[index] for index in sorted(chosen.values())]
    placed = [again.drive.assign(s=("time", again.place)).assign_attrs(role="fit") for again in replays]  # as they are aligned by now
    vehicle, effects = with_values(experiment.vehicle, experiment.effects, state.fit.values)
    limits = {size.key: (size.lower, size.upper) for size in sizes}
    task = calibrate.problem(
        placed, [again.road for again in replays], vehicle,
        parameters=[key for key in limits if key in PARAMETERS], bounds=limits, effects=effects, options=replays[0].options,
        scales=np.sqrt(state.squares.mean(axis=0)),
    )  # fmt: skip
    point, everything = task.point([state.fit.values[key] for key in task.parameters]), list(range(len(limits)))
    for _ in range(2):  # to the end: between parameters that stand in for one another a rough search stops far from the best
        point = descend(task.about(point), point, everything, calibrate.EQUAL, exact=True).point
    return dict(zip(task.parameters, task.values(point).tolist()))
