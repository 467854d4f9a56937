"""From measured drives to a verdict: the library first, and where that does not explain them, a force of any form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import xarray as xr

from .. import pool
from . import opening
from .beyond import beside, ends_at_bounds
from .car import Car
from .discover import Discovery, discovered
from .explain import REPEATS
from .judge import with_parameters
from .rank import ranked
from .ranking import with_forms
from .reconsider import beside_a_force, heard, is_doubtful, is_sure, left, named_all_the_same, reconsidered, surely_fits_better, with_reason
from .righted import Search, is_better, searched_again
from .rung import begin
from .verdict import Verdict

NEARLY_ALL = 0.98
"""Share of the explainable error removed above which no form is looked for in place of an error of the measurement, nor, as the mean of fitted
drives and of those held out, a wrong file of the vehicle."""

TRIED = "parameters of the vehicle beyond their bounds were tried, too: they explain no more"
"""What is said where that is so."""


def diagnose(
    measured: Mapping[str, tuple], vehicle, *, signatures: bool = False, effects_folder=None, seed: int = 0, name: str = "discovered",
    workers: int | None = None, say: Callable[[str], None] = lambda words: None, **settings,
) -> tuple[xr.Dataset, Verdict, Discovery | None]:  # fmt: skip
    """The evidence, the verdict, and where that is "outside" the search for a form, else None. Wherever such a search was made its evidence
    stands beside that of the library (``ranking.forms``).

    Where parameters of the vehicle beyond their bounds explain more, all of that is what a second search says, which allows them
    (``beyond``). Arguments as for ``rank``, but ``most``; ``name``: of the effect that is proposed.
    """
    experiment = opening.opened(measured, vehicle, effects_folder=effects_folder, workers=workers, **settings)
    common = {"effects_folder": effects_folder, "seed": seed, "say": say}
    common["each"] = pool.mapped(pool.workers() if workers is None else workers)
    rung = begin(experiment, opening.start_values(experiment), common["each"])
    search = Search(*ranked(experiment, rung, signatures=signatures, **common), rung)
    found, again = None, None
    is_explained = left(search.verdict) < 1.0 - NEARLY_ALL
    if not search.table.attrs["suspected"] and search.verdict.verdict != "nothing" and not is_explained and ends_at_bounds(search.selection):
        found, again = searched_again(experiment, search.selection, signatures, common)
        if again is not None and again.leaves_nothing_out:
            search, found, again = again, again.parameters, None
        elif found is None and again is None:
            search = replace(search, verdict=with_reason(search.verdict, search.verdict.verdict, TRIED))
    table, verdict, proposal = _beside_a_force(search, experiment, name, common)
    if again is not None and verdict.verdict == "outside":
        say("looking at both: the vehicle as it is, and put right")
        other = _beside_a_force(again, experiment, name, common)
        theirs = search.removed(verdict, proposal)
        if is_better(again.removed(*other[1:]), again.removed(other[1]), theirs):
            (table, verdict, proposal), found = other, again.parameters
            if proposal is not None and is_sure(proposal):
                found = beside(found, search.selection, proposal.selection)
        elif again.parameters.is_much_of(theirs):
            found = replace(again.parameters, is_instead=True)
    if proposal is not None:
        if found is not None and not found.is_first and proposal.share > verdict.share + found.share:
            found = None
        verdict = beside_a_force(verdict, proposal)
    return table, with_parameters(verdict, found and found.of(vehicle)), proposal


def _beside_a_force(search: Search, experiment: Car, name: str, common: Mapping) -> tuple[xr.Dataset, Verdict, Discovery | None]:
    """Evidence and verdict of a search in the light of what comes back with the way or the time, and of a force of any form where what was
    found leaves one open; with that force where the verdict is "outside"."""
    table = search.table
    verdict = heard(search.verdict, table.attrs["turns"], table.attrs["suspected"] == "road")
    is_road_open = table.attrs["floor"] == REPEATS and bool(table.attrs["road"]) and not table.attrs["turns"]
    is_error_alone = verdict.verdict == "suspect" and not table.attrs["suspected"] and verdict.share < NEARLY_ALL
    is_road_alone = verdict.verdict == "suspect" and table.attrs["suspected"] == "road"
    if not (is_doubtful(verdict) or verdict.verdict in ("outside", "nothing") or is_road_alone or is_error_alone):
        return table, verdict, None
    library = experiment.candidates if verdict.verdict in ("named", "cluster", "outside") else ()
    proposal = discovered(search.rung, name=name, known=library, probed=search.selection.probed, **common)
    table = with_forms(table, proposal.evidence)
    verdict = reconsidered(verdict, proposal, is_road_open, is_error_alone, surely_fits_better(proposal, search.selection))
    if not (table.attrs["turns"] or table.attrs["road"]):
        verdict = named_all_the_same(verdict, proposal)
    return table, verdict, proposal if verdict.verdict == "outside" else None
