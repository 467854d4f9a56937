"""From measured drives to a verdict: the library first, and where that does not explain them, a force of any form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import xarray as xr

from .. import pool
from . import opening
from .beyond import BeyondBounds, before_effects, beyond_bounds, ends_at_bounds, searched, without_effects
from .car import Car
from .discover import Discovery, discovered
from .explain import REPEATS
from .judge import with_parameters
from .rank import ranked
from .ranking import with_forms
from .reconsider import beside_a_force, heard, is_doubtful, left, named_all_the_same, reconsidered, surely_fits_better, with_reason
from .rung import Rung, begin
from .selection import Selection
from .verdict import Verdict

NEARLY_ALL = 0.98
"""Share of the explainable error removed above which no form is looked for in place of an error of the measurement, nor, as the mean of fitted
drives and of those held out, a wrong file of the vehicle."""


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
    table, verdict, selection = ranked(experiment, rung, signatures=signatures, **common)
    found = None
    is_explained = left(verdict) < 1.0 - NEARLY_ALL
    if not table.attrs["suspected"] and verdict.verdict != "nothing" and not is_explained and ends_at_bounds(selection):
        found, again = _with_vehicle_right(experiment, selection, signatures, common)
        if again is not None:
            table, verdict, selection, rung = again
        elif found is None:
            verdict = with_reason(verdict, verdict.verdict, "parameters of the vehicle beyond their bounds were tried, too: they explain no more")
    verdict = heard(verdict, table.attrs["turns"], table.attrs["suspected"] == "road")
    is_road_open = table.attrs["floor"] == REPEATS and bool(table.attrs["road"]) and not table.attrs["turns"]
    is_error_alone = verdict.verdict == "suspect" and not table.attrs["suspected"] and verdict.share < NEARLY_ALL
    is_road_alone = verdict.verdict == "suspect" and table.attrs["suspected"] == "road"
    proposal = None
    if is_doubtful(verdict) or verdict.verdict in ("outside", "nothing") or is_road_alone or is_error_alone:
        beside = experiment.candidates if verdict.verdict in ("named", "cluster", "outside") else ()
        proposal = discovered(rung, name=name, known=beside, probed=selection.probed, **common)
        table = with_forms(table, proposal.evidence)
        verdict = reconsidered(verdict, proposal, is_road_open, is_error_alone, surely_fits_better(proposal, selection))
        if not (table.attrs["turns"] or table.attrs["road"]):
            verdict = named_all_the_same(verdict, proposal)
        proposal = proposal if verdict.verdict == "outside" else None
    if proposal is not None:
        if found is not None and not found.is_first and proposal.share > verdict.share + found.share:
            found = None
        verdict = beside_a_force(verdict, proposal)
    return table, with_parameters(verdict, found and found.of(vehicle)), proposal


def _with_vehicle_right(
    experiment: Car, selection: Selection, signatures: bool, common: Mapping
) -> tuple[BeyondBounds | None, tuple[xr.Dataset, Verdict, Selection, Rung] | None]:
    """Parameters of the vehicle beyond their bounds, if they explain more, and what a search finds that begins with them put right, with
    the rung it begins at, if that is the better one and leaves nothing out, or sees that the data are wrong. ``experiment``: as its drives
    came."""
    common["say"]("trying parameters of the vehicle beyond their bounds")
    found, wide = beyond_bounds(selection, common["each"]) or (None, None)
    rung = without_effects(wide, common["each"]) if wide else before_effects(selection, common["each"])
    if rung is None:
        return found, None
    common["say"]("searching again with those parameters put right")
    came = replace(experiment, free=rung.experiment.free)
    table, verdict, again = ranked(came, rung, signatures=signatures, **common)
    first = searched(selection, again)
    is_explained = verdict.verdict in ("named", "cluster", "nothing") or table.attrs["suspected"] == "data"
    return (first, (table, verdict, again, rung)) if is_explained and first is not None else (found, None)
