"""From measured drives to a verdict: the library first, and where that does not explain them, a force of any form."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import xarray as xr

from .. import pool
from . import opening, turns
from .amended import is_all_but_nil, with_allowances, with_bounds, with_held, with_parameters
from .balance import DOUBTFUL, total_shares
from .beyond import BeyondBounds, at_bounds, ends_at_bounds
from .car import Car
from .discovery import Discovery, discovered
from .explain import REPEATS
from .missing_force import missing_force
from .off_file import OffFile, off_file
from .naming import ranked
from .ranking import with_forms
from .reconsider import beside_a_force, heard, humming, is_doubtful, left, named_all_the_same, reconsidered, surely_fits_better
from .righted import Outcome, Ranked, beside_the_vehicle, searched_again, unless_a_form_alone
from .rung import begin
from .verdict import Verdict

NEARLY_ALL = 0.98
"""Share of the explainable error removed above which no form is looked for in place of an error of the measurement, nor, as the mean of fitted
drives and of those held out, a wrong file of the vehicle."""


def diagnose(
    measured: Mapping[str, tuple], vehicle, *, signatures: bool = False, effects_folder=None, seed: int = 0, name: str = "discovered",
    workers: int | None = None, say: Callable[[str], None] = lambda words: None, **settings,
) -> tuple[xr.Dataset, Verdict, Discovery | None]:  # fmt: skip
    """The evidence, the verdict, and where that is "outside", or a form explains as much as what is named, the search for a form, else None.
    Wherever such a search was made its evidence stands beside that of the library (``ranking.forms``). ``signatures``: with the curves of what is
    missing (``missing_force``).

    Where parameters of the vehicle beyond their bounds may explain more, a second search begins with them: it decides if it leaves nothing out,
    unless a form found within the bounds leaves less than the effects that it names, and if it leaves something out but explains more than the
    first; else the first decides, and the parameters are told beside it (``righted``). Arguments as for ``rank``, but ``most``; ``name``: of the
    effect that is proposed.
    """
    experiment = opening.opened(measured, vehicle, effects_folder=effects_folder, workers=workers, **settings)
    each = pool.mapped(pool.workers() if workers is None else workers)
    common = {"seed": seed, "each": each, "say": say}
    rung = begin(experiment, opening.start_values(experiment), each)
    first = Ranked(*ranked(experiment, rung, **common), rung)
    outcome_of = lambda search: _outcome(search, experiment, name, {**common, "effects_folder": effects_folder})
    found, second, is_tried = None, None, _may_lie_beyond(first)
    if is_tried:
        found, second = searched_again(experiment, first.selection, common)
    if second is not None and second.leaves_nothing_out:
        outcome, found = unless_a_form_alone(first, found, second, outcome_of)
    elif is_tried:
        outcome, found = beside_the_vehicle(first, outcome_of(first), found, second, outcome_of)
    else:
        outcome = outcome_of(first)
    verdict, proposal = outcome.verdict, outcome.proposed
    if proposal is not None and verdict.verdict == "outside":
        is_beside = found is not None and not (found.is_first or found.is_instead)
        if is_beside and proposal.share > verdict.whole().share + found.share:
            found = None
        verdict = beside_a_force(verdict, proposal)
    beside_file = _beside_the_file(verdict, outcome, found)
    verdict = with_bounds(with_parameters(verdict, found and found.of(vehicle)), at_bounds(outcome.stands_on, experiment.free))
    verdict = with_held(verdict, beside_file)
    table = outcome.table
    if signatures:
        say("drawing the missing force")
        force = proposal if verdict.verdict == "outside" else None
        curves = missing_force(experiment, outcome.rung, outcome.selection, verdict, force, effects_folder=effects_folder, each=each)
        table = table.merge(curves)
    return table, with_allowances(verdict, {candidate.name for candidate in experiment.candidates}), proposal


def _beside_the_file(verdict: Verdict, outcome: Outcome, found: BeyondBounds | None) -> OffFile | None:
    """Parameters that calibration holds beside the drives, where what was found explains most or leaves next to nothing, or nothing is missing:
    else what is missing may drive them there. Beside those ``found`` beyond their bounds, only where these came first: else no model has all of it."""
    is_in_model = found is None or found.is_first
    if verdict.verdict in ("named", "cluster", "nothing"):
        is_explained = verdict.verdict == "nothing" or left(verdict) <= 1.0 - DOUBTFUL or is_all_but_nil(verdict.remainder)
        told = found.names() if found else ()
        return off_file(outcome.selection, told, bool(verdict.effects)) if is_in_model and is_explained else None
    if found is not None:
        return None
    explains = outcome.proposed is not None and left(outcome.proposed) <= 1.0 - DOUBTFUL
    return outcome.proposed.off_file if explains else None


def _may_lie_beyond(first: Ranked) -> bool:
    """Whether parameters of the vehicle beyond their bounds may explain what a search leaves, or the gain or clock that it fits by itself."""
    is_suspect, is_explained = first.table.attrs["suspected"] in ("data", "road"), left(first.verdict) < 1.0 - NEARLY_ALL
    return not (is_suspect or first.verdict.verdict == "nothing" or is_explained) and ends_at_bounds(first.selection)


def _outcome(search: Ranked, experiment: Car, name: str, common: Mapping) -> Outcome:
    """A search in the light of what comes back with the way or the time, and of a force of any form where what was found leaves one open."""
    table = search.table
    verdict = heard(search.verdict, table.attrs["turns"], table.attrs["suspected"] == "road")
    is_road_open = table.attrs["floor"] == REPEATS and bool(table.attrs["road"]) and not table.attrs["turns"]
    is_error_alone = verdict.verdict == "suspect" and not table.attrs["suspected"] and verdict.whole().share < NEARLY_ALL
    is_road_alone = verdict.verdict == "suspect" and table.attrs["suspected"] == "road"
    if not (is_doubtful(verdict) or verdict.verdict in ("outside", "nothing") or is_road_alone or is_error_alone):
        return Outcome(table, verdict, None, search.selection, search.rung)
    library = experiment.candidates if verdict.verdict in ("named", "cluster", "outside") else ()
    line = turns.left_by(search.selection) if table.attrs["turns"] else None
    proposal = discovered(search.rung, name=name, known=library, probed=search.selection.probed, line=line, **common)
    table = with_forms(table, proposal.evidence)
    fits_better = surely_fits_better(proposal, search.selection)
    verdict = reconsidered(verdict, proposal, is_road_open, is_error_alone, fits_better, total_shares(search.selection)[0])
    if line is not None:
        verdict = humming(search.verdict, verdict, line.unit, proposal)
    if not (table.attrs["turns"] or table.attrs["road"]):
        verdict = named_all_the_same(verdict, proposal)
    is_told = verdict.verdict == "outside" or verdict.is_like_force
    return Outcome(table, verdict, proposal if is_told else None, search.selection, search.rung)
