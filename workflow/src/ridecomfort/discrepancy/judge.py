"""From a selection of effects to the verdict that its evidence carries."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from . import bursts, floor
from .allowance import Allowance
from .balance import CONFIRMED, ENOUGH, LITTLE, SHARED_Z, Balance, answered, balanced
from .beyond import AtBound, BeyondBounds
from .cluster import SAME_PORT
from .experiment import Candidate, Size
from .off_file import OffFile
from .propose import LEVEL, SURE
from .selection import Round, Selection, shares
from .shared import SLOW
from .tries import LEAST_MOVED
from .verdict import Named, Verdict, are_open, kind_of, percent

MOST = 0.8
"""Share of what repeats share that an error of the measurement must take to be all that is wrong."""

TOLD, LEAST_TOLD = 3, 0.001
"""Signals of which it is told what is left, and share of their power below which it is not."""

UNSURE = "what is missing may be something else: no size of what helps is surely another than none"
"""What is said where effects explain enough, and each may as well be none."""

MAY_DRIVE = "something that is missing may drive it there"
"""What is said of parameters of the vehicle that end at their bounds..."""

BEYOND = "; if the car may lie beyond, have it calibrated in wider bounds (calibration: parameters, bounds)"
"""...where there can be more or less of them."""

OF_DRIVER = "the rest is no more than a driver's foot and hands may make"
"""What is said of the rest where what was found is most of what is worth explaining, or of what is faster than a driver."""

TOO_NOISY = 1.5
"""Times the error that is left, the median of the signals, from which on noise that is told of instruments is asked about."""

NEARLY, STAYS = 0.9, 0.5
"""Share of what an effect removes, of fitted and of held-out drives, from which on another that was refitted is told beside it; and share of
its gain in the score test that the other has once that effect is there, from which on it is missing, too, and does not stand in for it."""

ANOTHER_SHAPE = 0.05
"""Share of what an effect removes below which a later one at the same port may be no more than another shape of it."""


def standing(selection: Selection, candidates: Sequence[Candidate]) -> list[Named]:
    """The accepted effects that are no chance and not one another in another shape."""
    by_name = {candidate.name: candidate for candidate in candidates}
    return _kept(selection, _found(selection, by_name), by_name)[0]


def judge(
    selection: Selection, candidates: Sequence[Candidate], suspicions: Sequence[str] = (), notes: Sequence[str] = (),
    is_material: bool = True, was_material: bool = True, material_left: float = 1.0,
) -> Verdict:  # fmt: skip
    """The verdict that a selection carries; ``suspicions`` are signs of wrong data that were found beside it, ``notes`` words
    on the road that may be otherwise than it was driven; ``is_material``: whether what repeats share is worth explaining,
    ``was_material``: whether it was before anything was found, ``material_left``: share that is left of it."""
    by_name = {candidate.name: candidate for candidate in candidates}
    found = _found(selection, by_name)
    effects, reasons = _kept(selection, found, by_name)
    balance = balanced(selection, notes, is_material, material_left)
    is_vain = bool(found) and balance.share <= 0
    if is_vain:
        effects, reasons, balance = [], [_vain(found)], replace(balance, share=0.0, held_out=0.0)
    reasons += notes
    told = _of_measurement(selection, balance, effects, by_name, bool(found) and balance.is_little and not is_vain)
    effects, is_little = told.effects, told.is_little
    reasons += told.reasons
    decoys = any(turn.decoy_ranks for turn in selection.rounds)
    if decoys:
        reasons.append("a decoy that explains nothing ranks first: the errors are not what the test takes them for")
    if told.is_wrong or decoys or suspicions:
        said = (*reasons, *suspicions)
        return Verdict("suspect", tuple(effects), said, balance.share, balance.held_out, balance.is_left, balance.is_shared)
    if is_little and not (was_material or balance.is_left):
        if effects:
            names = ", ".join(effect.name for effect in effects)
            held_out = f", {percent(balance.held_out)} on drives held out" if np.isfinite(balance.held_out) else ""
            removes = "removes" if len(effects) == 1 else "remove"
            reasons.append(f"{names} would help, but {removes} too little to be what is missing: {percent(balance.share)} of the explainable error{held_out}")
        effects, is_little, balance = [], False, replace(balance, share=0.0, held_out=0.0)
    elif not is_vain:
        reasons += _removed(balance, found) if found else _unfound(selection)
        if found and balance.is_all_that_matters:
            reasons.append(f"that is {percent(1.0 - material_left)} of what repeats share and is worth explaining: {OF_DRIVER}")
        if found and balance.is_most_of_fast:
            reasons.append(f"that is {percent(selection.faster_gone)} of what repeats share above {SLOW:g} Hz: {OF_DRIVER}")
    if is_little or balance.is_left and not effects:
        kind = "outside"
        reasons.append(_unexplained(selection, balance, is_little))
    elif effects:
        kind = kind_of(effects)
        reasons += [UNSURE] if are_open(effects) else []
        reasons += [_alike(effect) for effect in effects if effect.like]
        reasons += [said for effect in effects for said in _nearly(selection, effect)]
    else:
        kind = "nothing"
    if kind != "outside" and balance.is_shared and not balance.is_left:
        reasons.append(f"repeats share an error yet, but nowhere more than a driver's foot and hands may make, or than matters; most surely {selection.remaining.band}")
    if effects and selection.birge_ratio > 1.0:
        reasons.append(f"drives held out ask for other sizes by {selection.birge_ratio:.1f} times what noise allows: intervals are that much wider")
    said = (*reasons, *_of_drives(selection, bool(effects)), *bursts.words(selection.floor_time_share))
    left = balance.is_left, balance.is_shared or not selection.has_repeats
    moments = tuple(bursts.of_moments(selection.floor_time_share))
    return Verdict(kind, tuple(effects), said, balance.share, balance.held_out, *left, is_like_error=told.is_like_error, of_moments=moments)


@dataclass(frozen=True)
class _Told:
    """The ``effects`` that are left of a verdict once errors of the measurement are told from effects of the vehicle, ``reasons`` for that, whether
    the measurement ``is_wrong``, whether what is left ``is_like_error``, as one that was left out as a stand-in, and whether it ``is_little``."""

    effects: list[Named]
    is_little: bool
    reasons: tuple[str, ...] = ()
    is_wrong: bool = False
    is_like_error: bool = False


def _of_measurement(selection: Selection, balance: Balance, effects: list[Named], by_name: Mapping[str, Candidate], is_little: bool) -> _Told:
    """Which of the ``effects`` the verdict keeps: an error of the measurement that leaves much, that drives held out refute, or beside which effects
    of the vehicle remove more, is what something else, not in the library, looks like."""
    is_error = lambda name: by_name[name].instrument
    wrong = [effect for effect in effects if all(is_error(name) for name in (effect.name, *effect.like))]
    if not wrong:
        return _Told(effects, is_little)
    vehicle = [effect for effect in effects if effect not in wrong]
    names, removed = ", ".join(effect.name for effect in wrong), sum(effect.share for effect in wrong)
    is_refuted = balance.is_refuted or balance.held_out <= 0
    leaves_much = selection.remaining.z > SHARED_Z and selection.shared_gone < MOST
    is_little = is_little or is_refuted or leaves_much
    is_lesser = sum(effect.share for effect in vehicle) > removed and not are_open(vehicle)
    if not (is_little or is_lesser):
        return _Told(effects, is_little, (f"{names} is an error of the measurement, not of the vehicle",), is_wrong=True)
    # Beside what explains most, one that removes little may be a part of what is left, as any effect may.
    is_like_error = removed >= LITTLE * (1.0 - balance.share)
    return _Told(vehicle, is_little, (f"{names} would help, an error of the measurement that may stand in for something else",), is_like_error=is_like_error)


def with_remainder(
    verdict: Verdict, remainder: Mapping[str, float], at_first: Mapping[str, float], accepted: Sequence[str] = ()
) -> Verdict:
    """A verdict that says what share of the power of each signal is left by the effects that were ``accepted``, and was ``at_first``, before
    anything was found."""
    largest = sorted(remainder, key=lambda name: -remainder[name])[:TOLD]
    told = [f"{100 * remainder[name]:.1f} % of the power of {name}" for name in largest if remainder[name] >= LEAST_TOLD]
    left = " and ".join([", ".join(told[:-1]), told[-1]]) if len(told) > 1 else "".join(told)
    names = ", ".join(accepted)
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
        return replace(verdict, verdict="outside", effects=(), reasons=reasons, share=0.0, held_out_share=0.0, beyond_bounds=found)
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


def _removed(balance: Balance, found: Sequence[Named]) -> list[str]:
    """How much of the explainable error the effects that were found remove, in words."""
    names = ", ".join(effect.name for effect in found)
    held_out = [f"{percent(balance.held_out)} on drives held out"] if np.isfinite(balance.held_out) else []
    return [f"{percent(balance.share)} of the explainable error is removed on the fitted drives, by {names}", *held_out]


def _vain(found: Sequence[Named]) -> str:
    """What is said of effects that each helped beside what the one before left, and in all do not."""
    names = ", ".join(effect.name for effect in found)
    return f"{names} helped when added, but nothing of the explainable error is removed once the vehicle's parameters are fitted anew beside it"


def _unfound(selection: Selection) -> list[str]:
    """Why no candidate was accepted, in words."""
    first = selection.rounds[0] if selection.rounds else None
    if first is None or not first.names:
        is_asked = bool(selection.frame.experiment.candidates)
        return ["no candidate changes what these drives tell" if is_asked else "no candidate was tested: the library that was looked among is empty"]
    best = float(np.min(first.p_value))
    if best > LEVEL:
        return [f"the smallest p-value over the whole library, of {len(first.names)} candidates that were tested, is {best:.2g}"]
    return [f"{trial.name}: {trial.objection}" for trial in first.trials if trial.objection]


def _unexplained(selection: Selection, balance: Balance, is_little: bool) -> str:
    """What is left beside the effects, in words; ``is_little``: whether too little was found."""
    if not is_little and not selection.has_repeats:
        names = ", ".join(answered(selection))
        return f"but the error answers to {names} on drives held out, too, more than noise does, and none of them explains it"
    if not is_little:
        return f"but repeats share an error that nothing in the library explains: {selection.remaining}"
    if balance.explained < ENOUGH:
        return "that is less than half" + (" of what repeats share" if selection.has_repeats else "")
    if balance.is_refuted or not selection.has_repeats:  # without repeats nothing is known of what all share
        return "too little on drives held out to be what is missing"
    return f"but repeats share an error that it leaves: {selection.remaining}"


def _alike(effect: Named) -> str:
    where = ", ".join(f"{name} on drives like {effect.differ_on[name]}" for name in effect.like)
    return f"the data do not tell {effect.name} from {', '.join(effect.like)}; it differs most from {where}"


def _nearly(selection: Selection, effect: Named) -> list[str]:
    """What would have done nearly as much in the place of an effect, in words."""
    turn = _turn(selection, effect.name)
    removed = lambda trial: shares(selection, trial.before, trial.after)
    told = []
    for trial in turn.trials:
        known = [(own, most) for own, most in zip(removed(trial), removed(turn.winner)) if np.isfinite(own) and np.isfinite(most)]
        is_less_likely = trial.gain < turn.winner.gain
        is_rival = is_less_likely and trial.name not in (*selection.accepted, *effect.like) and all(own >= NEARLY * most > 0.0 for own, most in known)
        if is_rival and known and not _is_missing_too(selection, turn, trial.name):
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


def _of_drives(selection: Selection, is_found: bool) -> list[str]:
    """What the drives can tell, in words: what is known of the floor, and where effects were found without any drive held out that these rest on
    the fitted ones."""
    said = [_floor(selection)]
    noise = [floor.assumed(selection.frame.experiment.records[index]) for index in selection.frame.indices]
    times = float(np.sqrt(np.median([known / left for known, left in zip(noise, selection.states[-1].squares)])))
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


def _kept(selection: Selection, found: Sequence[Named], by_name) -> tuple[list[Named], list[str]]:
    """The effects that stand, and in words what is to be said of them and of the others."""
    unmet = {turn.winner.name for turn in selection.rounds if turn.winner is not None and not turn.winner.met}
    shared = not selection.has_repeats or selection.shared_z > SHARED_Z
    kept, reasons = [], []
    for effect in found:
        same = _shaped_by(selection, effect, found, by_name)
        moments = _of_moments(selection, effect.name)
        if effect.name in selection.needless:
            reasons.append(f"{effect.name} helped when it was found, but what was found with it does as well without it")
        elif not any(size.key in selection.sure for size in by_name[effect.name].sizes):
            reasons.append(f"{effect.name} helps, but its size may as well be none")
        elif same:
            reasons.append(f"{effect.name} adds {percent(effect.share)}, which may be another shape of {same}")
        elif moments:
            reasons.append(f"{effect.name} helps in {moments}, less than what drives differ by there within moments: it may stand in for what a driver did")
        elif not shared and effect.p_value > SURE:
            reasons.append(f"{effect.name} may be chance: repeats share no error for certain")
        elif effect.name in unmet and effect.p_value > SURE:
            reasons.append(f"{effect.name} may be chance: no drive held out meets it")
        else:
            kept.append(effect)
            reasons += _set(selection, by_name[effect.name])
            reasons += [_beyond(effect, size) for size in effect.beyond()]
            reasons += [_open(effect)] if effect.is_open else []
            if effect.name in unmet:
                reasons.append(f"no drive held out meets {effect.name}: it rests on the fitted drives alone")
    return kept, reasons


def _beyond(effect: Named, size: Mapping) -> str:
    """What is said of a size that was plausible when its effect was found, and is not once all is fitted together."""
    value, unit, (lower, upper) = f"{size['size']:.3g}", size["unit"], size["plausible"]
    told = f"{effect.name} ends at a {size['parameter']} of {value} {unit}".removesuffix(" 1")
    return f"{told}, beyond what is plausible ({lower:g} to {upper:g}): it may stand in for something beside it"


def _open(effect: Named) -> str:
    """What is said of an effect that is there where what is told of each of its sizes, wider than the evidence for it, reaches to none."""
    return f"{effect.name} explains what chance would not, but the interval of its size holds none, too: how large it is these drives leave open"


def _is_open(selection: Selection, candidate: Candidate) -> bool:
    intervals = [(size.neutral, selection.told(size.key)) for size in candidate.sizes if size.key in selection.intervals]
    return bool(intervals) and all(lower <= neutral <= upper for neutral, (lower, upper) in intervals)


def _set(selection: Selection, candidate: Candidate) -> list[str]:
    """At which settings an effect was found that are not typical, nor fitted, in words."""
    values = {size: selection.final.values.get(size.key, size.neutral) for size in candidate.shaping if size.key not in selection.intervals}
    told = [
        f"{size.key.partition('.')[2]} {value:.3g} {size.unit}".removesuffix(" 1")
        for size, value in values.items()
        if abs(value - size.neutral) > size.probe
    ]
    held = ", ".join(told)
    return [f"{candidate.name} was found with {held} held, the best of a few values that were tried"] if told else []


def _turn(selection: Selection, name: str) -> Round:
    """The round that accepted an effect."""
    return next(turn for turn in selection.rounds if turn.winner is not None and turn.winner.name == name)


def _of_moments(selection: Selection, name: str) -> str:
    """The signals in which an effect does most of what it does, where it does less than their floors hold and these are made by moments, in
    words; empty where it does not."""
    of_moments = bursts.of_moments(selection.floor_time_share)
    if not of_moments:
        return ""
    winner = _turn(selection, name).winner
    before, after, first, least = (
        squares.mean(axis=0) for squares in (winner.before.squares, winner.after.squares, selection.states[0].squares, selection.floor_squares)
    )
    channels = selection.frame.experiment.channels
    removed = np.maximum(before - after, 0.0) / first
    doubtful = np.array([channel in of_moments for channel in channels]) & (before - after < least)
    told = [channel for channel, is_so, own in zip(channels, doubtful, removed) if is_so and own > 0]
    return ", ".join(told) if removed[doubtful].sum() > 0.5 * removed.sum() else ""


def _shaped_by(selection: Selection, effect: Named, found: Sequence[Named], by_name) -> str:
    """The name of an effect found before at the same port that it is like and beside which it is small; empty where there is none."""
    port = by_name[effect.name].port
    turns = {turn.winner.name: turn for turn in selection.rounds if turn.winner is not None}
    for other in found[: found.index(effect)] if port else ():
        is_small = other.name not in selection.needless and by_name[other.name].port == port and effect.share < ANOTHER_SHAPE * other.share
        if is_small and turns[other.name].correlation.get(effect.name, 0.0) > SAME_PORT:
            return other.name
    return ""


def _found(selection: Selection, by_name: Mapping[str, Candidate]) -> list[Named]:
    """Those of the accepted that are among the candidates ``by_name``."""
    return [_named(selection, number, by_name) for number, name in enumerate(selection.accepted) if name in by_name]


def _named(selection: Selection, number: int, by_name: Mapping[str, Candidate]) -> Named:
    turn = selection.rounds[number]
    winner = turn.winner
    place = turn.names.index(winner.name)
    sizes = []
    for size in (*by_name[winner.name].sizes, *by_name[winner.name].shaping):
        if size.key in selection.intervals:
            sizes.append(_size(size, selection))
    held = [
        _held(size, selection.final.values.get(size.key, size.neutral))
        for size in by_name[winner.name].shaping
        if size.key not in selection.intervals
    ]
    before, after = selection.states[number : number + 2]
    like = tuple(name for name in turn.cluster if name in by_name)
    return Named(
        winner.name, tuple(sizes), by_name[winner.name].sentence, float(turn.p_value[place]),
        *shares(selection, before, after), float(turn.absorbed[place]), like, turn.differ_on, by_name[winner.name].instrument, tuple(held),
        _is_open(selection, by_name[winner.name]),
    )  # fmt: skip


def _size(size: Size, selection: Selection) -> dict:
    value, interval = selection.final.values[size.key], selection.intervals[size.key]
    allowed = selection.allowed.get(size.key, Allowance())
    return {
        "parameter": size.key.partition(".")[2] or size.key,
        "size": float(value),
        "unit": size.unit,
        "interval": [float(end) for end in selection.told(size.key)],
        "interval_of_noise": [float(end) for end in interval],
        "allows_for": allowed.name if allowed.is_notable(interval) else "",
        "plausible": [float(size.lower), float(size.upper)],
        "is_plausible": size.holds(value),
        "is_shaping": size.shaping,
    }


def _held(size: Size, value: float) -> dict:
    is_typical = abs(value - size.neutral) < LEAST_MOVED * size.probe
    return {
        "parameter": size.key.partition(".")[2],
        "size": float(size.neutral if is_typical else value),
        "unit": size.unit,
        "is_typical": bool(is_typical),
    }
