"""A verdict in the light of a force of any form, of what comes back with the way or the time, and of both together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from . import refit
from .balance import CONFIRMED, DOUBTFUL, ENOUGH, LITTLE
from .confirm import EQUAL
from .discovery import Discovery
from .places import settings as shaping
from .propose import SURE
from .reasoning import not_sure_of
from .selection import Selection
from .verdict import Named, Verdict, are_open, kind_of

BETTER = 1.2
"""Times the share that the library explains which a force of any form must explain to stand for something else."""

HALF, WORTH = 0.5, 0.025
"""Share of what the library leaves, where that is little, which a force of any form may leave at most to do so, and share of the
explainable error by which it must be better then."""

SURE_Z, MOST_LEFT = 3.0, 0.75
"""z above which one of two models fits drives better beyond chance, and share of what the other leaves of the explainable error, on fitted
and held-out drives together, that it may leave at most to be another explanation. In twenty blind trials whose names were right and
removed less than DOUBTFUL, the z of a force were at most 2.2 on fitted and 1.8 on held-out drives."""


def is_doubtful(verdict: Verdict) -> bool:
    """Whether what is named explains so little, or is so large, that it may stand in for something else."""
    most = 1.0 - WORTH / (1.0 - HALF) if verdict.may_be_shared else DOUBTFUL
    return verdict.verdict in ("named", "cluster") and (verdict.whole().share < most or _is_in_doubt(verdict))


def _is_in_doubt(verdict: Verdict) -> bool:
    """Whether what was found explains less than DOUBTFUL, of fitted drives or of these and those held out together, or is too large."""
    return min(verdict.whole().share, 1.0 - left(verdict)) < DOUBTFUL or _is_too_large(verdict)


def _is_too_large(verdict: Verdict) -> bool:
    """Whether an effect has a size beyond what is plausible."""
    return any(effect.beyond() for effect in verdict.effects)


def surely_fits_better(proposal: Discovery, selection: Selection) -> bool:
    """Whether the model with a force fits drives better than that with what the library has, beyond chance: the fitted ones and those held
    out, if any (Vuong 1989)."""
    if not proposal.place:
        return False
    force, theirs = proposal.selection, selection.states[-1].fit.residuals
    pairs = [(force.frame, force.states[-1].fit.residuals, theirs)]
    pairs += [(force.check_frame, force.check, selection.check)] if force.check_frame is not None else []
    return all(refit.advantage(frame, with_force, without)[1] > SURE_Z for frame, with_force, without in pairs)


def reconsidered(
    verdict: Verdict, proposal: Discovery, is_road_open: bool = False, is_error_alone: bool = False, fits_better: bool = False,
    too_little: float = 0.0,
) -> Verdict:  # fmt: skip
    """A verdict in the light of a force of any form.

    "Nothing" becomes "outside" where such a force is sure on fitted drives, and confirmed by those held out: what repeats do not share
    (a wheel out of round, whose turns do not keep step) counts as noise until its form is known. It must explain BETTER times
    ``too_little``, the share of effects that were too weak to be named, or it may be these. ``is_road_open``: whether the road may be
    another than that of its file, by noise of its points or by what lies between them. ``is_error_alone``: whether an error of the
    measurement was found and nothing else speaks against the data. ``fits_better``: whether the force fits drives better beyond chance than
    what was found.
    """
    said = _said_of(proposal)
    match verdict.verdict:
        case "nothing":
            is_there = is_sure(proposal) and not proposal.share <= BETTER * too_little
            return with_reason(verdict, "outside", f"{said} is there (p = {proposal.p_value:.2g})") if is_there else verdict
        case "suspect":
            return _error_or_force(verdict, proposal, said, fits_better) if is_error_alone else _noise_or_force(verdict, proposal, said)
        case "outside":
            return _road_or_force(verdict, proposal, said) if is_road_open else verdict
    if _is_better(verdict, proposal, fits_better):
        return with_reason(verdict, "outside", f"{said} explains more: {_explained(proposal)}")
    if _is_in_doubt(verdict) and is_sure(proposal) and not proposal.beside and left(proposal) < left(verdict):
        reason = f"{said} explains as much, and drives do not tell which it is: {_explained(proposal)}"
        return replace(with_reason(verdict, "cluster", reason), is_like_force=True)
    return verdict


def _said_of(proposal: Discovery) -> str:
    beside = f", with {', '.join(proposal.names_beside())} beside it," if proposal.beside else ""
    return f"a force at the {proposal.place} that the library does not hold{beside}"


def _noise_or_force(verdict: Verdict, proposal: Discovery, said: str) -> Verdict:
    """Noise of the road, which repeats share as well, gives way to a force that explains more than noise could."""
    is_there = with_reason(verdict, "outside", f"{said} is there (p = {proposal.p_value:.2g})")
    return is_there if _is_more_than_noise(proposal) else verdict


def _error_or_force(verdict: Verdict, proposal: Discovery, said: str, fits_better: bool) -> Verdict:
    """An error of the measurement gives way to a force as a named effect does, and to one that explains as much by fewer sizes."""
    if is_sure(proposal) and (_is_better(verdict, proposal, fits_better) or _leaves_less(verdict, proposal)):
        return with_reason(_of_vehicle(verdict), "outside", f"{said} explains more: {_explained(proposal)}")
    if is_sure(proposal) and _is_simpler(verdict, proposal):
        return with_reason(_of_vehicle(verdict), "outside", f"{said} explains as much by fewer sizes: {_explained(proposal)}")
    return verdict


def _road_or_force(verdict: Verdict, proposal: Discovery, said: str) -> Verdict:
    """Where the road may be another than that of its file, "outside" becomes what the library has, "suspect" if that is little, unless a
    force explains BETTER as much and is sure, or, beside so little, is more than that road could be. What makes drives held
    out worse has no name on any road; that they gain little may be the road's noise, which is theirs as well."""
    is_more = _leaves_half(verdict, proposal) if proposal.beside else proposal.share > BETTER * verdict.whole().share
    if not verdict.effects or is_sure(proposal) and is_more:
        return verdict
    if not verdict.share >= LITTLE:
        if is_more and _is_more_than_noise(proposal):
            return with_reason(verdict, "outside", f"{said} explains more: {_explained(proposal)}")
        return with_reason(verdict, "suspect", "no form of a force that was tried explains more, and what the road is otherwise may be all of it")
    if verdict.held_out_share <= 0:
        return verdict
    named = with_reason(verdict, kind_of(verdict.effects), "no form of a force that was tried explains more, and what the road is otherwise is shared by repeats, too")
    return replace(named, reasons=(*named.reasons, *not_sure_of(named.effects)))


def _is_better(verdict: Verdict, proposal: Discovery, fits_better: bool) -> bool:
    """Whether a force is sure and explains so much more than what was found that this stands in for it.

    It explains BETTER as much of the fitted drives, and no less of those held out; or what was found is in doubt, and the
    force ``fits_better`` and leaves MOST_LEFT of it at most. Where repeats surely share an error beside what was found, EQUAL more of the
    fitted drives and not much less of the others will do, or, where little is left, leaving HALF of that. With effects of the library beside
    it, a force ``fits_better`` and leaves HALF (``_leaves_half``).
    """
    verdict = verdict.whole()
    held_out = verdict.held_out_share if np.isfinite(verdict.held_out_share) else -np.inf
    if not is_sure(proposal):
        return False
    if proposal.beside:
        return fits_better and _leaves_half(verdict, proposal)
    if verdict.is_left and verdict.share < DOUBTFUL:
        return proposal.share > verdict.share + EQUAL and not BETTER * proposal.held_out_share < held_out
    is_more = proposal.share > BETTER * verdict.share and not proposal.held_out_share < held_out
    is_more = is_more or fits_better and _is_in_doubt(verdict) and left(proposal) <= MOST_LEFT * left(verdict)
    return is_more or verdict.may_be_shared and _leaves_less(verdict, proposal)


def left(found: Verdict | Discovery) -> float:
    """Share of the explainable error that is left, the mean of fitted drives and of those held out, if any."""
    found = found.whole() if isinstance(found, Verdict) else found
    known = [share for share in (found.share, found.held_out_share) if np.isfinite(share)]
    return 1.0 - float(np.mean(known)) if known else 1.0


def _explained(proposal: Discovery) -> str:
    return f"{100 * proposal.share:.0f} % (p = {proposal.p_value:.2g})"


def named_all_the_same(verdict: Verdict, proposal: Discovery) -> Verdict:
    """What the library explains at least half of is named, though repeats share an error still, where no force of any form does better: of
    many small things that a model lacks none explains the rest (but where an error of the measurement does some of that).

    An effect that removes LITTLE of the rest, on fitted drives or on those held out, may be a part of it, and is not named; nor are effects
    each of which may as well be none, nor the others where they alone remove less than half.
    """
    shares = [share for share in (verdict.share, verdict.held_out_share) if np.isfinite(share)]
    if verdict.verdict != "outside" or not verdict.effects or not min(shares, default=0.0) >= ENOUGH or verdict.is_like_error:
        return verdict
    theirs = [share for share in (proposal.share, proposal.held_out_share) if np.isfinite(share)] if is_sure(proposal) else []
    shares = [share for share in (verdict.whole().share, verdict.whole().held_out_share) if np.isfinite(share)]
    is_better = _leaves_half(verdict, proposal) if proposal.beside else any(share > own + EQUAL for share, own in zip(theirs, shares))
    if theirs and is_better:
        return verdict
    kept = tuple(effect for effect in verdict.effects if _is_much(effect, verdict)) or verdict.effects[:1]
    share, held_out = (sum(getattr(effect, key) for effect in kept) for key in ("share", "held_out_share"))
    is_most = len(kept) == len(verdict.effects) or min(own for own in (share, held_out) if np.isfinite(own)) >= ENOUGH
    if are_open(kept) or not is_most:
        return verdict
    reasons = [*verdict.reasons, *not_sure_of(kept), _no_better(theirs, shares, proposal)]
    reasons += [_not_named(effect) for effect in verdict.effects if effect not in kept]
    return replace(verdict, verdict=kind_of(kept), effects=kept, reasons=tuple(reasons), share=share, held_out_share=held_out)


def _no_better(theirs: Sequence[float], shares: Sequence[float], proposal: Discovery) -> str:
    """What is said of a force that is no reason to name nothing, of its shares beside those of what is named."""
    if any(share > own + EQUAL for share, own in zip(theirs, shares)):
        removed = " and ".join(f"{100 * share:.0f} %" for share in theirs)
        return f"{_said_of(proposal)} may be missing, too ({removed} together): beside what is named it shows better"
    return "no form of a force that was tried explains much more, alone or beside the library: what is left may be another one, or many small things"


def _not_named(effect: Named) -> str:
    """What is said of an effect that is not named after all."""
    shares = " and ".join(f"{100 * share:.0f} %" for share in (effect.share, effect.held_out_share) if np.isfinite(share))
    return f"{effect.name}, which takes {shares} of that, may be a part of what is left"


def _is_much(effect: Named, verdict: Verdict) -> bool:
    """Whether an effect removes no LITTLE against what all leave, on fitted drives and on those held out, if any."""
    pairs = (effect.share, verdict.whole().share), (effect.held_out_share, verdict.whole().held_out_share)
    return all(share >= LITTLE * (1.0 - whole) for share, whole in pairs if np.isfinite(share))


def heard(verdict: Verdict, turns: str, is_road_alone: bool) -> Verdict:
    """A verdict with what comes back with the way or the time, in words, if anything: a reason more, and enough for "outside" where nothing
    was found, where noise of the road alone was suspected, which has no period, and where what is named is DOUBTFUL."""
    if not turns:
        return verdict
    is_silent = verdict.verdict == "nothing" or verdict.verdict == "suspect" and is_road_alone
    is_doubtful = verdict.verdict in ("named", "cluster") and verdict.whole().share < DOUBTFUL
    return replace(with_reason(verdict, "outside" if is_silent or is_doubtful else verdict.verdict, turns), may_be_more=True)


def humming(before: Verdict, verdict: Verdict, unit: str, proposal: Discovery) -> Verdict:
    """A verdict that is "outside" for what comes back alone, as it was not ``before`` that was heard: "suspect" where this comes back with the
    time (``unit`` s) and no force that is alike in all drives is sure. A machine may make it as well as the mains in the instrument."""
    if not (unit == "s" and before.verdict != "outside" and verdict.verdict == "outside") or is_sure(proposal):
        return verdict
    names = ", ".join(effect.name for effect in verdict.effects if not effect.is_of_measurement)
    reasons = (f"{names} takes something, but may stand in for what hums",) if names else ()
    return replace(verdict, verdict="suspect", reasons=(*verdict.reasons, *reasons))


def _leaves_half(verdict: Verdict, proposal: Discovery) -> bool:
    """Whether what a force and effects beside it leave is HALF of what the library alone does at most, and MOST_LEFT of that on fitted drives
    and on those held out alike."""
    verdict = verdict.whole()
    pairs = (proposal.share, verdict.share), (proposal.held_out_share, verdict.held_out_share)
    known = [(1.0 - ours, 1.0 - theirs) for ours, theirs in pairs if np.isfinite(ours) and np.isfinite(theirs)]
    return left(proposal) <= HALF * left(verdict) and all(ours <= MOST_LEFT * theirs for ours, theirs in known)


def beside_a_force(verdict: Verdict, proposal: Discovery) -> Verdict:
    """The verdict "outside" with the effects that are missing beside a force which leaves MOST_LEFT at most, in place of those that the library
    would do with alone, which may stand in for it."""
    held_out = verdict.whole().held_out_share
    is_more = is_sure(proposal) and left(proposal) <= MOST_LEFT * left(verdict) and not proposal.held_out_share < held_out - EQUAL
    if verdict.verdict != "outside" or not is_more:
        return verdict
    alone = ", ".join(effect.name for effect in verdict.effects)
    reasons = (f"the library alone comes up to {alone}", *verdict.reasons) if alone else verdict.reasons
    said = _said_of(proposal)
    reasons = reasons if any(reason.startswith(said) for reason in reasons) else (*reasons, f"{said} explains more: {_explained(proposal)}")
    share, held_out = (sum((getattr(effect, key) for effect in proposal.beside), 0.0) for key in ("share", "held_out_share"))
    is_beside = bool(proposal.beside)
    return replace(verdict, effects=proposal.beside, reasons=reasons, share=share, held_out_share=held_out, is_beside_form=is_beside, of_all=None)


def _leaves_less(verdict: Verdict, proposal: Discovery) -> bool:
    """Whether a force leaves hardly half of what the library does, on fitted drives and on those held out, if any."""
    verdict = verdict.whole()
    better = proposal.share - verdict.share > WORTH and 1.0 - proposal.share < HALF * (1.0 - verdict.share)
    return better and not 1.0 - proposal.held_out_share > HALF * (1.0 - verdict.held_out_share)


def _is_simpler(verdict: Verdict, proposal: Discovery) -> bool:
    """Whether a force of fewer fitted numbers explains as much as what was found, on fitted drives and on those held out, if any."""
    numbers = sum(map(len, proposal.terms.values()))
    for term, values in proposal.settings.items():
        numbers += sum(values[own.name] != own.typical for own in shaping(proposal.place, term) if own.name in values)
    verdict, fewer = verdict.whole(), numbers < sum(len(effect.sizes) for effect in verdict.effects)
    return fewer and proposal.share > verdict.share - EQUAL and not proposal.held_out_share < verdict.held_out_share - EQUAL


def _of_vehicle(verdict: Verdict) -> Verdict:
    """A verdict without the errors of the measurement that it found, which stood in for something else."""
    effects = tuple(effect for effect in verdict.effects if not effect.is_of_measurement)
    share, held_out = (sum((getattr(effect, key) for effect in effects), 0.0) for key in ("share", "held_out_share"))
    return replace(verdict, effects=effects, share=share, held_out_share=held_out, is_like_error=True, of_all=None)


def with_reason(verdict: Verdict, kind: str, reason: str) -> Verdict:
    """A verdict of this kind with a reason more."""
    return replace(verdict, verdict=kind, reasons=(*verdict.reasons, reason))


def is_sure(proposal: Discovery) -> bool:
    """Whether a proposed form is more than chance, by its p-value, its share, and what it does on drives held out, if any.

    What is explainable holds what no model takes away, most of all where an effect is small and the road noisy: a true one may
    take 5 % of drives held out, and they be sure of it all the same.
    """
    if not (_is_no_chance(proposal) and proposal.share > LITTLE):
        return False
    is_confirmed = proposal.held_out_share > CONFIRMED or proposal.held_out_share > 0.0 and proposal.held_out_z > SURE_Z
    return is_confirmed or not np.isfinite(proposal.held_out_share)


def _is_more_than_noise(proposal: Discovery) -> bool:
    """Whether a proposed form explains more than noise of the road could. Beside that noise, which weighs more the weaker an effect is, any fall
    on drives held out will do."""
    return _is_no_chance(proposal) and proposal.share > LITTLE and not proposal.held_out_share <= 0


def _is_no_chance(proposal: Discovery) -> bool:
    """Whether fitted drives are sure of a proposed form by its p-value, or by a large gain of which drives held out confirm most.

    The p-value turns whole stretches round: of a force that is there at a few rough ones above all it says little, however much that explains.
    """
    is_confirmed = proposal.is_large and proposal.share > ENOUGH and proposal.held_out_share > ENOUGH
    return bool(proposal.place) and (proposal.p_value <= SURE or is_confirmed)
