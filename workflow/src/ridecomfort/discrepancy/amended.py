"""A verdict with what was looked for beside it: what is left, and parameters of the vehicle at, beyond or held within their bounds."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from .balance import CONFIRMED
from .beyond import AtBound, BeyondBounds
from .off_file import OffFile
from .verdict import LEAST_TOLD, Verdict

TOLD = 3
"""Signals of which it is told what is left."""

MAY_DRIVE = "something that is missing may drive it there"
"""What is said of parameters of the vehicle that end at their bounds..."""

BEYOND = "; if the car may lie beyond, have it calibrated in wider bounds (calibration: parameters, bounds)"
"""...where there can be more or less of them."""


def is_all_but_nil(remainder: Mapping[str, float]) -> bool:
    """Whether what is left, share of the power by signal, is of no signal worth a word; not where it is unknown."""
    return max(remainder.values(), default=1.0) < LEAST_TOLD


def with_remainder(
    verdict: Verdict, remainder: Mapping[str, float], at_first: Mapping[str, float], kept: Sequence[str] = ()
) -> Verdict:
    """A verdict that says what share of the power of each signal is left by the effects that were ``kept``, those of the last model, and was
    ``at_first``, before anything was found."""
    largest = sorted(remainder, key=lambda name: -remainder[name])[:TOLD]
    told = [f"{100 * remainder[name]:.1f} % of the power of {name}" for name in largest if remainder[name] >= LEAST_TOLD]
    left = " and ".join([", ".join(told[:-1]), told[-1]]) if len(told) > 1 else "".join(told)
    names = ", ".join(kept)
    words = f"left above the floor{f' with {names}' if names else ''}: {left}" if told else f"less than {100 * LEAST_TOLD:g} % of the power of any signal is left above the floor"
    reasons = verdict.reasons if verdict.verdict == "suspect" else (*verdict.reasons, words)
    return replace(verdict, reasons=reasons, remainder=dict(remainder), at_first=dict(at_first))


def with_parameters(verdict: Verdict, found: BeyondBounds | None) -> Verdict:
    """A verdict with the parameters of the vehicle that explain more beyond their bounds, if any: a reason more. Where they came first and
    nothing else is missing, or nothing that drives held out confirm, what is missing is no effect of the library. Effects that do no more than
    they do alone are not told from them: tyres that have all lost half of their pressure are as soft as tyres of half the stiffness."""
    if found is None:
        return verdict
    reasons = (*verdict.reasons, found.words(bool(verdict.effects)))
    if found.is_first and verdict.verdict in ("named", "cluster") and verdict.held_out_share < CONFIRMED:
        names = ", ".join(effect.name for effect in verdict.effects)
        reasons = (*reasons, f"{names} may be what these leave: too little on drives held out to be what is missing")
        said = replace(verdict, verdict="outside", effects=(), reasons=reasons, share=0.0, held_out_share=0.0, of_all=None)
        return replace(said, beyond_bounds=found, may_be_more=True)
    kind = "outside" if found.is_first and verdict.verdict == "nothing" else verdict.verdict
    kind = "cluster" if found.is_another_name and kind == "named" else kind
    return replace(verdict, verdict=kind, reasons=reasons, beyond_bounds=found)


def with_bounds(verdict: Verdict, found: Sequence[AtBound]) -> Verdict:
    """A verdict with the parameters of the vehicle that end at their bounds, but those of which it says already that they lie beyond: a
    reason more, unless the data are suspect, which comes first."""
    beyond = verdict.beyond_bounds
    known = beyond.names() if beyond else []
    kept = tuple(one for one in found if one.parameter not in known)
    told = kept if verdict.verdict != "suspect" else ()
    what = MAY_DRIVE if all(one.is_last for one in told) else MAY_DRIVE + BEYOND
    reasons = (f"{'; '.join(one.words() for one in told)}: {what}",) if told else ()
    return replace(verdict, reasons=(*verdict.reasons, *reasons), at_bounds=kept)


def with_held(verdict: Verdict, found: OffFile | None) -> Verdict:
    """A verdict with the parameters of the vehicle that calibration holds beside the values that drives give them, if any: a reason more."""
    if found is None:
        return verdict
    return replace(verdict, reasons=(*verdict.reasons, found.words()), off_file=found)


def with_allowances(verdict: Verdict, names: Collection[str]) -> Verdict:
    """A verdict that says which other effects, of these ``names``, the intervals of its effects allow for, where that widens them by much."""
    told = []
    for effect in verdict.effects:
        others = dict.fromkeys(size.get("allows_for") for size in effect.sizes)
        others = [other for other in others if other in names and other not in effect.like]
        if others:
            told.append(f"intervals of {effect.name} allow for {' or '.join(others)}, which the drives leave open")
    return replace(verdict, reasons=(*verdict.reasons, *told))
