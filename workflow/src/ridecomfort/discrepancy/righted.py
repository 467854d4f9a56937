"""A second search, which begins with parameters of the vehicle put right that lie beyond their bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .beyond import BeyondBounds, before_effects, beyond_bounds, searched, without_effects
from .car import Car
from .confirm import EQUAL
from .discover import Discovery
from .rank import ranked
from .reconsider import MOST_LEFT, left
from .rung import Rung
from .selection import Selection
from .verdict import Verdict


@dataclass(frozen=True)
class Search:
    """What a search for missing effects came to from a ``rung``; ``parameters`` of the vehicle, if it began with these put right."""

    table: xr.Dataset
    verdict: Verdict
    selection: Selection
    rung: Rung
    parameters: BeyondBounds | None = None

    @property
    def leaves_nothing_out(self) -> bool:
        """Whether it explains the drives, or sees that the data are wrong."""
        return self.verdict.verdict in ("named", "cluster", "nothing") or self.table.attrs["suspected"] == "data"

    def removed(self, verdict: Verdict, proposal: Discovery | None = None) -> tuple[float, float]:
        """Shares of the explainable error that go with its parameters and, beside them, the better of what a verdict found and a proposed
        form, on fitted drives and on those held out (nan without)."""
        best = min((one for one in (verdict, proposal) if one is not None and np.isfinite(one.share)), key=left)
        if self.parameters is None:
            return best.share, best.held_out_share
        pairs = (self.parameters.share, best.share), (self.parameters.held_out_share, best.held_out_share)
        return tuple(first + (1.0 - first) * then for first, then in pairs)


def searched_again(experiment: Car, before: Selection, signatures: bool, common: Mapping) -> tuple[BeyondBounds | None, Search | None]:
    """Parameters of the vehicle beyond their bounds, if they explain more beside the effects of the search ``before``; and a search that
    begins with such parameters put right, if its model is the better one.

    ``experiment``: as its drives came. ``signatures`` and ``common``: arguments of ``rank.ranked``.
    """
    common["say"]("trying parameters of the vehicle beyond their bounds")
    found, wide = beyond_bounds(before, common["each"]) or (None, None)
    rung = without_effects(wide, common["each"]) if wide else before_effects(before, common["each"])
    if rung is None:
        return found, None
    common["say"]("searching again with those parameters put right")
    came = replace(experiment, free=rung.experiment.free)
    table, verdict, after = ranked(came, rung, signatures=signatures, **common)
    parameters = searched(before, after)
    if parameters is None:
        return found, None
    return found, Search(table, verdict, after, rung, parameters)


def is_better(ours: tuple[float, float], of_these: tuple[float, float], theirs: tuple[float, float]) -> bool:
    """Whether what removes ``ours``, ``of_these`` by no force of a form, is a better explanation than what removes ``theirs`` (shares of the
    explainable error on fitted drives and on those held out): it leaves MOST_LEFT, at most, of what that leaves, or needs no form for as much."""
    known = [(own, plain, other) for own, plain, other in zip(ours, of_these, theirs) if np.isfinite(own) and np.isfinite(other)]
    leaves_less = all(1.0 - own <= MOST_LEFT * (1.0 - other) for own, _, other in known)
    return leaves_less or all(plain > other - EQUAL for _, plain, other in known)
