"""From a selection of effects to the verdict that its evidence carries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from . import bursts, reasoning
from .balance import LITTLE, SHARED_Z, Balance, balanced, total_shares
from .cluster import SAME_PORT
from .experiment import Candidate
from .found import found_effects, told_apart, turn_of
from .propose import SURE
from .selection import Selection
from .shared import OF_DRIVER
from .verdict import Named, Verdict, are_open, kind_of, percent

MOST = 0.8
"""Share of what repeats share that an error of the measurement must take to be all that is wrong."""

BORNE_OUT = 0.5
"""Share of the evidence for an effect that repeats must bear out among themselves: 0.4 and 0.6 of links against diving and squatting where nothing was missing
but foot and speed were noisy (z of 1.6 and 2.6), 1.0 of effects that were there, at a kappa of 0.1 (z of 8 and 10)."""

ANOTHER_SHAPE = 0.05
"""Share of what an effect removes below which a later one at the same port may be no more than another shape of it."""


def standing(selection: Selection, candidates: Sequence[Candidate]) -> list[Named]:
    """The accepted effects that are no chance and not one another in another shape."""
    by_name = {candidate.name: candidate for candidate in candidates}
    return told_apart(_kept(selection, found_effects(selection, by_name), by_name)[0])


def judge(
    selection: Selection, candidates: Sequence[Candidate], suspicions: Sequence[str] = (), notes: Sequence[str] = (),
    is_material: bool = True, was_material: bool = True, material_left: float = 1.0,
) -> Verdict:  # fmt: skip
    """The verdict that a selection carries; ``suspicions`` are signs of wrong data that were found beside it, ``notes`` words
    on the road that may be otherwise than it was driven; ``is_material``: whether what repeats share is worth explaining,
    ``was_material``: whether it was before anything was found, ``material_left``: share that is left of it."""
    by_name = {candidate.name: candidate for candidate in candidates}
    found = found_effects(selection, by_name)
    effects, reasons, unnamed = _kept(selection, found, by_name)
    of_those_but = lambda names: balanced(selection, notes, is_material, material_left, names)
    balance = of_those_but(unnamed)
    of_all = total_shares(selection)
    is_vain = bool(found) and of_all[0] <= 0
    if is_vain:
        effects, reasons, balance = [], [reasoning.in_vain(found)], replace(balance, share=0.0, held_out=0.0)
    reasons += notes
    told = _of_measurement(selection, balance, effects, by_name, bool(found) and balance.is_little and not is_vain)
    effects, is_little, stood_in = told_apart(told.effects), told.is_little, [effect.name for effect in effects if effect not in told.effects]
    if stood_in:
        unnamed = [*unnamed, *stood_in]
        balance = of_those_but(unnamed)
        is_little = is_little or balance.is_little
    reasons += told.reasons
    decoys = any(turn.decoy_ranks for turn in selection.rounds)
    if decoys:
        reasons.append("a decoy that explains nothing ranks first: the errors are not what the test takes them for")
    if told.is_wrong or decoys or suspicions:
        said = (*reasons, *suspicions)
        left = balance.is_left, balance.is_shared
        return Verdict("suspect", tuple(effects), said, balance.share, balance.held_out, *left, of_all=of_all if unnamed else None)
    if is_little and not (was_material or balance.is_left):
        if effects:
            names = ", ".join(effect.name for effect in effects)
            held_out = f", {percent(balance.held_out)} on drives held out" if np.isfinite(balance.held_out) else ""
            removes = "removes" if len(effects) == 1 else "remove"
            reasons.append(f"{names} would help, but {removes} too little to be what is missing: {percent(balance.share)} of the explainable error{held_out}")
        effects, is_little, balance = [], False, replace(balance, share=0.0, held_out=0.0)
    elif not is_vain:
        reasons += reasoning.removed_by(balance, selection, unnamed) if found else reasoning.none_accepted(selection)
        if found and balance.is_all_that_matters:
            reasons.append(f"that is {percent(balance.worth_gone)} of what repeats share and is worth explaining: {reasoning.OF_DRIVER}")
        if found and balance.is_most_of_fast:
            reasons.append(f"that is {percent(balance.faster_gone)} of what repeats share above {OF_DRIVER:g} Hz: {reasoning.OF_DRIVER}")
    if is_little or balance.is_left and not effects:
        kind = "outside"
        reasons.append(reasoning.unexplained(selection, balance, is_little, unnamed))
    elif effects:
        kind = kind_of(effects)
        reasons += reasoning.not_sure_of(effects)
        reasons += [said for effect in effects for said in reasoning.nearly_as_good(selection, effect)]
    else:
        kind = "nothing"
    if kind != "outside" and balance.is_shared and not balance.is_left:
        reasons.append(f"repeats share an error yet, but nowhere more than a driver's foot and hands may make, or than matters; most surely {selection.remaining.band}")
    if effects and selection.birge_ratio > 1.0:
        reasons.append(f"drives held out ask for other sizes by {selection.birge_ratio:.1f} times what noise allows: intervals are that much wider")
    said = (*reasons, *reasoning.of_drives(selection, bool(effects)), *bursts.words(selection.floor_time_share))
    left = balance.is_left, balance.is_shared or not selection.has_repeats
    moments = tuple(bursts.of_moments(selection.floor_time_share))
    return Verdict(
        kind, tuple(effects), said, balance.share, balance.held_out, *left, is_like_error=told.is_like_error, of_moments=moments,
        of_all=of_all if unnamed else None,
    )  # fmt: skip


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
    are_errors = [all(map(is_error, (effect.name, *effect.like))) for effect in told_apart(effects)]
    if not any(are_errors):
        return _Told(effects, is_little)
    wrong, vehicle = ([effect for effect, is_one in zip(effects, are_errors) if is_one is asked] for asked in (True, False))
    names, removed = ", ".join(effect.name for effect in wrong), sum(effect.share for effect in wrong)
    is_refuted = balance.is_refuted or balance.held_out <= 0
    leaves_much = selection.remaining.z > SHARED_Z and selection.shared_gone < MOST
    is_little = is_little or is_refuted or leaves_much
    is_lesser = sum(effect.share for effect in vehicle) > removed and not are_open(vehicle)
    if not (is_little or is_lesser):
        return _Told(effects, is_little, (f"{names} is an error of the measurement, not of the vehicle",), is_wrong=True)
    # Beside what explains most, one that removes little may be a part of what is left, as any effect may.
    is_like_error = removed >= LITTLE * (1.0 - balance.share)
    told = ", ".join(map(reasoning.with_sizes, wrong))
    return _Told(vehicle, is_little, (f"{told} would help, an error of the measurement that may stand in for something else",), is_like_error=is_like_error)


def _kept(selection: Selection, found: Sequence[Named], by_name) -> tuple[list[Named], list[str], list[str]]:
    """The effects that stand, in words what is to be said of them and of the others, and the names of those of the last model with which nothing is
    explained: not of another shape of what stands, nor of what did what drivers do within moments, which no effect need explain."""
    shared = not selection.has_repeats or selection.shared_z > SHARED_Z
    kept, reasons, unnamed = [], [], []
    for effect in found:
        same = _shaped_by(selection, effect, found, by_name)
        moments, turn = _of_moments(selection, effect.name), turn_of(selection, effect.name)
        is_met, borne = turn.winner.met, turn.borne
        if effect.name in selection.needless:
            reasons.append(f"{effect.name} helped when it was found, but what was found with it does as well without it")
        elif not any(size.key in selection.sure for size in by_name[effect.name].sizes):
            unnamed.append(effect.name)
            reasons.append(f"{effect.name} helps, but its size may as well be none")
        elif same:
            reasons.append(f"{effect.name} adds {percent(effect.share)}, which may be another shape of {same}")
        elif moments:
            reasons.append(f"{effect.name} helps in {moments}, less than what drives differ by there within moments: it may stand in for what a driver did")
        elif borne.share < BORNE_OUT:
            unnamed.append(effect.name)
            reasons.append(
                f"{effect.name} helps every drive by what it does in that drive, and hardly by what it does in its repeats: it answers to noise of what"
                " the model is driven with"
            )
        elif not shared and borne.z < SHARED_Z:
            unnamed.append(effect.name)
            reasons.append(f"{effect.name} may be chance or noise of what the model is driven with: repeats share no error for certain, nor do they surely bear it out")
        elif not shared and effect.p_value > SURE:
            unnamed.append(effect.name)
            reasons.append(f"{effect.name} may be chance: repeats share no error for certain")
        elif not is_met and effect.p_value > SURE:
            unnamed.append(effect.name)
            reasons.append(f"{effect.name} may be chance: no drive held out meets it")
        else:
            kept.append(effect)
            reasons += reasoning.settings_held(selection, by_name[effect.name])
            reasons += [reasoning.beyond_plausible(effect, size) for size in effect.beyond()]
            reasons += [reasoning.size_open(effect)] if effect.is_open else []
            if not is_met:
                reasons.append(f"no drive held out meets {effect.name}: it rests on the fitted drives alone")
    surely = [effect for effect in kept if not (effect.is_open or effect.is_of_measurement)]
    least = sum(effect.share for effect in surely)
    blurred = [effect for effect in kept if effect.is_open and effect.share < least]
    reasons += [reasoning.open_beside(effect, surely) for effect in blurred]
    unnamed += [effect.name for effect in blurred]
    return [effect for effect in kept if effect not in blurred], reasons, unnamed


def _of_moments(selection: Selection, name: str) -> str:
    """The signals in which an effect does most of what it does, where it does less than their floors hold and these are made by moments, in
    words; empty where it does not."""
    of_moments = bursts.of_moments(selection.floor_time_share)
    if not of_moments:
        return ""
    winner = turn_of(selection, name).winner
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
