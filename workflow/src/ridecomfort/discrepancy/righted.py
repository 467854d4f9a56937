"""A search that begins with parameters of the vehicle put right, beyond their bounds, beside one that keeps to these."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .beyond import BeyondBounds, before_effects, beyond_bounds, searched, still_beyond, without_effects
from .car import Car
from .confirm import EQUAL
from .discovery import Discovery
from .naming import ranked
from .reconsider import MOST_LEFT, beside_a_force, is_sure, surely_fits_better, with_reason
from .rung import Rung
from .selection import Selection, shares
from .verdict import Verdict

MUCH = 0.5
"""Share of what another explanation removes from which on parameters alone are told beside it."""

TRIED = "parameters of the vehicle beyond their bounds were tried, too: they are no better explanation"
"""What is said where a second search, or wider bounds, explained no more."""

WITHIN = "the vehicle's parameters were free beyond their bounds, and lie within them beside the form: shares are of what they leave"
"""What is said where no parameter lies beyond its bounds any longer beside the form."""

Shares = tuple[float, float]
"""Of the explainable error, on fitted drives and on those held out (nan without)."""


@dataclass(frozen=True)
class Ranked:
    """What a search for missing effects came to from a ``rung``; ``parameters`` of the vehicle that its last model has beyond their bounds, if
    it was free to go there."""

    table: xr.Dataset
    verdict: Verdict
    selection: Selection
    rung: Rung
    parameters: BeyondBounds | None = None

    @property
    def leaves_nothing_out(self) -> bool:
        """Whether it explains the drives better than a search within bounds, or sees that the data are wrong."""
        if self.parameters is not None and self.parameters.is_instead:
            return False
        return self.verdict.verdict in ("named", "cluster", "nothing") or self.table.attrs["suspected"] in ("data", "fit")


@dataclass(frozen=True)
class Outcome:
    """Evidence and verdict of a search in the light of a force of any form, which is ``proposed`` where the verdict is "outside" or
    ``is_like_force``; the ``selection`` is that of the library."""

    table: xr.Dataset
    verdict: Verdict
    proposed: Discovery | None
    selection: Selection
    rung: Rung
    """Of the model that the search began with."""

    @property
    def sure(self) -> Discovery | None:
        """What is proposed in place of what the library has, if it is more than chance."""
        is_instead = self.proposed is not None and self.verdict.verdict == "outside"
        return self.proposed if is_instead and is_sure(self.proposed) else None

    @property
    def stands_on(self) -> Selection:
        """The search whose last model the verdict stands on: that of a sure form, or that of the library."""
        return self.selection if self.sure is None else self.sure.selection


def searched_again(experiment: Car, before: Selection, common: Mapping) -> tuple[BeyondBounds | None, Ranked | None]:
    """Parameters of the vehicle beyond their bounds, if they explain more beside the effects of the search ``before``; and a search that
    begins with such parameters put right, if its model is the better one.

    ``experiment``: as its drives came. ``common``: arguments of ``rank.ranked``.
    """
    common["say"]("trying parameters of the vehicle beyond their bounds")
    found, wide = beyond_bounds(before, common["each"]) or (None, None)
    rung = without_effects(wide, common["each"]) if wide else before_effects(before, common["each"])
    if rung is None:
        return found, None
    common["say"]("searching again with those parameters put right")
    came = replace(experiment, free=rung.experiment.free)
    table, verdict, after = ranked(came, rung, **common)
    parameters = searched(before, after)
    return found, Ranked(table, verdict, after, rung, parameters) if parameters is not None else None


def unless_a_form_alone(
    first: Ranked, found: BeyondBounds | None, second: Ranked, outcome_of: Callable[[Ranked], Outcome]
) -> tuple[Outcome, BeyondBounds | None]:
    """The outcome of the ``second`` search, which leaves nothing out, and the parameters to tell with it; where it names effects beside these, that
    of the ``first``, with the parameters ``found`` beside it, if a form within the bounds surely fits better and leaves MOST_LEFT, at most: with a
    knee, dampers twice as firm are nearly dry friction."""
    outcome = outcome_of(second)
    if outcome.verdict.verdict not in ("named", "cluster"):
        return outcome, second.parameters
    plain = outcome_of(first)
    if plain.sure is None or not surely_fits_better(plain.sure, second.selection):
        return outcome, second.parameters
    ends = plain.sure.selection, second.selection
    ours, theirs = (shares(first.selection, first.selection.states[0], end.states[-1], *ends) for end in ends)
    return _kept(plain, found, second, ours) if _leaves_less(ours, theirs) else (outcome, second.parameters)


def beside_the_vehicle(
    first: Ranked, outcome: Outcome, found: BeyondBounds | None, second: Ranked | None, outcome_of: Callable[[Ranked], Outcome]
) -> tuple[Outcome, BeyondBounds | None]:
    """The better of two explanations, and the parameters of the vehicle to tell with it.

    ``first`` keeps to the bounds, with its ``outcome`` and the parameters ``found`` beside its effects; ``second`` does not, and leaves
    something out. It is asked for its outcome where that of the first is "outside": only there is something left to explain.
    """
    if second is not None and second.parameters.is_instead:
        found = found or second.parameters
    elif second is not None and outcome.verdict.verdict == "outside":
        other = outcome_of(second)
        theirs, plain = _removed(first, first, outcome.sure), _removed(first, second, None)
        if found is not None:
            beside = np.add(_removed(first, first, None), (found.share, found.held_out_share))
            theirs = max(theirs, tuple(beside), key=_mean)
        if (other.verdict.verdict != "suspect" or second.table.attrs["suspected"] == "road") and is_better(_removed(first, second, other.sure), plain, theirs):
            return _put_right(first, second, other)
        return _kept(outcome, found, second, theirs)
    return _kept(outcome, found)


def _kept(
    outcome: Outcome, found: BeyondBounds | None, second: Ranked | None = None, removes: Shares | None = None
) -> tuple[Outcome, BeyondBounds | None]:
    """The outcome of the first search, with the parameters ``found`` beside it, or those that a ``second`` search began with, if they alone do much of
    what it ``removes``, or the word that such were tried."""
    if found is None and second is not None and is_much((second.parameters.share, second.parameters.held_out_share), removes):
        found = replace(second.parameters, is_first=False, is_instead=True)
    if found is None:
        outcome = replace(outcome, verdict=with_reason(outcome.verdict, outcome.verdict.verdict, TRIED))
    return outcome, found


def is_better(ours: Shares, without_a_form: Shares, theirs: Shares) -> bool:
    """Whether what removes ``ours``, and without a form that much of it, is a better explanation than what removes ``theirs``: it leaves
    MOST_LEFT, at most, of what that leaves, on fitted drives and on those held out, or needs no form for as much."""
    return _leaves_less(ours, theirs) or _all_known(lambda own, other: own > other - EQUAL, without_a_form, theirs)


def _leaves_less(ours: Shares, theirs: Shares) -> bool:
    """Whether what removes ``ours`` leaves MOST_LEFT, at most, of what that leaves which removes ``theirs``, on fitted and on held-out drives."""
    return _all_known(lambda own, other: 1.0 - own <= MOST_LEFT * (1.0 - other), ours, theirs)


def is_much(alone: Shares, theirs: Shares) -> bool:
    """Whether what removes ``alone`` removes MUCH of what another explanation does, on fitted drives and on those held out."""
    return _all_known(lambda own, other: own >= MUCH * other, alone, theirs)


def _all_known(holds: Callable[[float, float], bool], ours: Shares, theirs: Shares) -> bool:
    """Whether something holds of all pairs of shares that are known, and one is."""
    known = [pair for pair in zip(ours, theirs) if np.isfinite(pair).all()]
    return bool(known) and all(holds(*pair) for pair in known)


def _removed(first: Ranked, search: Ranked, sure: Discovery | None) -> Shares:
    """What the last model of a search removes of what was explainable at the beginning of the ``first``, or that with a ``sure`` form, if more."""
    ends = [search.selection, *([sure.selection] if sure else [])]
    return max((shares(first.selection, first.selection.states[0], end.states[-1], end) for end in ends), key=_mean)


def _mean(found: Shares) -> float:
    known = [share for share in found if np.isfinite(share)]
    return float(np.mean(known)) if known else -np.inf


def _put_right(first: Ranked, second: Ranked, outcome: Outcome) -> tuple[Outcome, BeyondBounds | None]:
    """The outcome of the second search with its parameters; beside a sure form those that lie beyond the bounds still, for which what has that
    form may have stood in. Where nothing but the road is suspect beside them, they are what is missing, and that of the road is a reason."""
    if outcome.verdict.verdict == "suspect":
        outcome = replace(outcome, verdict=replace(outcome.verdict, verdict="outside"))
    if outcome.sure is None or beside_a_force(outcome.verdict, outcome.sure) is outcome.verdict:
        return outcome, second.parameters
    found = still_beyond(first.selection, outcome.sure.selection)
    if found is None:
        outcome = replace(outcome, verdict=with_reason(outcome.verdict, outcome.verdict.verdict, WITHIN))
    return outcome, found
