"""Reasons of a verdict, in words: what effects remove and leave, what they cannot be told from, and what the drives can tell at all."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from . import floor
from .balance import CONFIRMED, ENOUGH, Balance, answered, total_shares
from .contest import UNDRIVEN
from .experiment import Candidate
from .found import turn_of
from .propose import LEVEL
from .selection import Round, Selection, shares
from .tries import implausible
from .verdict import Named, are_open, percent

UNSURE = "what is missing may be something else: no size of what helps is surely another than none"
"""What is said where effects explain enough, and each may as well be none."""

OF_DRIVER = "the rest is no more than a driver's foot and hands may make"
"""What is said of the rest where what was found is most of what is worth explaining, or of what is faster than a driver."""

NIL = "the error hardly rises above the floor, too little to tell shares of it"
"""What is said where a share of the explainable error is not known."""

TOO_NOISY = 1.5
"""Times the error that is left, the median of the signals, from which on noise that is told of instruments is asked about."""

NEARLY, STAYS = 0.9, 0.5
"""Share of what an effect removes, of fitted and of held-out drives, from which on another that was refitted is told beside it; and share of
its gain in the score test that the other has once that effect is there, from which on it is missing, too, and does not stand in for it."""


def removed_by(balance: Balance, selection: Selection, unnamed: Collection[str] = ()) -> list[str]:
    """How much of the explainable error the effects of the last model remove, in words: those that stand, and with the ``unnamed``, which do not."""
    named, every = [name for name in selection.kept if name not in unnamed], total_shares(selection)
    removed = (balance.share, balance.held_out) if named else every
    held_out = [f"{percent(removed[1])} on drives held out"] if np.isfinite(removed[1]) else []
    with_all = " and ".join(percent(share) for share in every if np.isfinite(share))
    nil = [NIL] if np.isnan(removed[0]) else []
    more = [f"{with_all} with {', '.join(unnamed)} as well"] if named and unnamed else []
    by = ", ".join(named or selection.kept)
    return [f"{percent(removed[0])} of the explainable error is removed on the fitted drives, by {by}", *nil, *held_out, *more]


def in_vain(found: Sequence[Named]) -> str:
    """What is said of effects that each helped beside what the one before left, and in all do not."""
    names = ", ".join(effect.name for effect in found)
    return f"{names} helped when added, but nothing of the explainable error is removed once the vehicle's parameters are fitted anew beside it"


def none_accepted(selection: Selection) -> list[str]:
    """Why no candidate was accepted, in words."""
    first = selection.rounds[0] if selection.rounds else None
    if first is None or not first.names:
        if first is not None and first.passed_over:
            return [f"{name}: {why}" for name, why in first.passed_over.items()]
        is_asked = bool(selection.frame.experiment.candidates)
        return ["no candidate changes what these drives tell" if is_asked else "no candidate was tested: no effect that was looked among has a size to fit"]
    best = float(np.min(first.p_value))
    if best > LEVEL:
        return [f"the smallest p-value over the whole library, of {len(first.names)} candidates that were tested, is {best:.2g}"]
    undriven = [(name, first.passed_over.get(name, "")) for name, p_value in zip(first.names, first.p_value) if p_value <= LEVEL]
    said = [*((trial.name, trial.objection) for trial in first.trials), *(one for one in undriven if one[1].startswith(UNDRIVEN))]
    return [f"{name}: {why}" for name, why in said if why]


def unexplained(selection: Selection, balance: Balance, is_little: bool, unnamed: Collection[str] = ()) -> str:
    """What is left beside the effects, in words; ``is_little``: whether too little was found, ``unnamed``: effects of the last model that do not
    stand."""
    if not is_little and not selection.has_repeats:
        names = ", ".join(answered(selection))
        return f"but the error answers to {names} on drives held out, too, more than noise does, and none of them explains it"
    if not is_little:
        return f"but repeats share an error that nothing in the library explains: {selection.remaining}"
    if unnamed and set(unnamed) >= set(selection.kept):
        what = "what repeats share" if selection.has_repeats else "the error"
        is_refuted = total_shares(selection)[1] < CONFIRMED and all(turn_of(selection, name).winner.met for name in unnamed)
        return "too little on drives held out to be what is missing" if is_refuted else f"but that has no name, and nothing else explains {what}"
    if balance.explained < ENOUGH:
        return "that is less than half" + (" of what repeats share" if selection.has_repeats else "")
    if balance.is_refuted or not selection.has_repeats:  # without repeats nothing is known of what all share
        return "too little on drives held out to be what is missing"
    return f"but repeats share an error that it leaves: {selection.remaining}"


def not_told_apart(effect: Named) -> str:
    """From what the data do not tell an effect, and on which drives each of those differs most from it, in words."""
    where = ", ".join(f"{name} on drives like {effect.differ_on[name]}" for name in effect.like if name in effect.differ_on)
    said = f"the data do not tell {effect.name} from {', '.join(effect.like)}"
    return f"{said}; it differs most from {where}" if where else said


def not_sure_of(effects: Sequence[Named]) -> list[str]:
    """What is said of effects that explain enough, and of which no size is surely another than none, or which the data do not tell from others."""
    return [*([UNSURE] if are_open(effects) else []), *(not_told_apart(effect) for effect in effects if effect.like)]


def nearly_as_good(selection: Selection, effect: Named) -> list[str]:
    """What would have done nearly as much in the place of an effect, of a plausible size, in words."""
    turn = turn_of(selection, effect.name)
    by_name = {candidate.name: candidate for candidate in selection.frame.experiment.candidates}
    removed = lambda trial: shares(selection, trial.before, trial.after)
    told = []
    for trial in turn.trials:
        known = [(own, most) for own, most in zip(removed(trial), removed(turn.winner)) if np.isfinite(own) and np.isfinite(most)]
        is_less_likely = trial.gain < turn.winner.gain
        is_rival = is_less_likely and trial.name not in (*selection.accepted, *effect.like) and all(own >= NEARLY * most > 0.0 for own, most in known)
        if is_rival and known and not (implausible(by_name[trial.name], trial.fit.values) or _is_missing_too(selection, turn, trial.name)):
            much, less = " and ".join(percent(own) for own, _ in known), turn.winner.gain - trial.gain
            as_much = "as much" if all(own >= most for own, most in known) else "nearly as much"
            told.append(f"{trial.name} in the place of {effect.name} removes {as_much} ({much}), but drives are less likely with it: 2 ln L is lower by {less:.0f}")
    return told


def _is_missing_too(selection: Selection, turn: Round, name: str) -> bool:
    """Whether a candidate gains in the round after this one, beside the winner, what it gained in its place."""
    after = next((later for before, later in zip(selection.rounds, selection.rounds[1:]) if before is turn), None)
    if after is None or name not in after.names:
        return False
    return bool(after.gain[after.names.index(name)] > STAYS * turn.gain[turn.names.index(name)])


def beyond_plausible(effect: Named, size: Mapping) -> str:
    """What is said of a size that was plausible when its effect was found, and is not once all is fitted together."""
    value, unit, (lower, upper) = f"{size['size']:.3g}", size["unit"], size["plausible"]
    told = f"{effect.name} ends at a {size['parameter']} of {value} {unit}".removesuffix(" 1")
    return f"{told}, beyond what is plausible ({lower:g} to {upper:g}): it may stand in for something beside it"


def size_open(effect: Named) -> str:
    """What is said of an effect that is there where what is told of each of its sizes, wider than the evidence for it, reaches to none."""
    return f"{effect.name} explains what chance would not, but the interval of its size holds none, too: how large it is these drives leave open"


def open_beside(effect: Named, surely: Sequence[Named]) -> str:
    """What is said of such an effect beside others that are ``surely`` there and remove more."""
    return f"{effect.name} is not named for that: it may make good what another shape of {', '.join(other.name for other in surely)} would do"


def with_sizes(effect: Named) -> str:
    """An effect with its sizes, by which a place of the instrument, or a gain, can be looked after."""
    sizes = ", ".join(f"{size['parameter']} {size['size']:.3g} {size['unit']}".removesuffix(" 1") for size in effect.sizes)
    return f"{effect.name} ({sizes})" if sizes else effect.name


def settings_held(selection: Selection, candidate: Candidate) -> list[str]:
    """At which settings an effect was found that are not typical, nor fitted, in words."""
    values = {size: selection.final.values.get(size.key, size.neutral) for size in candidate.shaping if size.key not in selection.intervals}
    told = [
        f"{size.key.partition('.')[2]} {value:.3g} {size.unit}".removesuffix(" 1")
        for size, value in values.items()
        if abs(value - size.neutral) > size.probe
    ]
    held = ", ".join(told)
    return [f"{candidate.name} was found with {held} held, the best of a few values that were tried"] if told else []


def of_drives(selection: Selection, is_found: bool) -> list[str]:
    """What the drives can tell, in words: what is known of the floor, and where effects were found without any drive held out that these rest on
    the fitted ones."""
    said = [_floor(selection)]
    noise = [floor.assumed(selection.frame.experiment.records[index]) for index in selection.frame.indices]
    told = np.concatenate([(known / left)[known > 0] for known, left in zip(noise, selection.states[-1].squares) if known.any()] or [[]])
    times = float(np.sqrt(np.median(told))) if told.size else 0.0
    if times > TOO_NOISY and not selection.is_floor_known:
        said.append(f"the noise that is told of the instruments is {times:.1f} times the error that is left: is its unit right?")
    if is_found and selection.check_frame is None:
        said.append("no drive is held out: this rests on the fitted drives alone")
    return said


def _floor(selection: Selection) -> str:
    """What the floor is known from, in words."""
    if selection.has_repeats:
        return "the floor is known from repeats"
    if selection.is_floor_known:
        return "no fitted drive repeats another, so that it is not known what repeats share: the floor is known from repeats that are held out"
    assumed = "assumed from the noise of the instruments" if selection.floor_squares.any() else "taken as nil"
    return f"no drive was repeated: the floor is {assumed}"
