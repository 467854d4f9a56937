"""Every table of the paper and of the study, ours beside the published figures."""

from __future__ import annotations

from dataclasses import replace

from ..study import Study
from ..table import PUBLISHED, PapersNote, Table
from . import agreement, calibration, comfort, inputs, passengers, roads, roughness, weighting
from .comfort import PAPER


def make(study: Study) -> dict[str, Table]:
    """All tables of a study by name, in the order of ``catalogue.tables`` but for the claims.

    Where none of the sites is the paper's, no table has a column, row or note that is there for what it published.
    """
    made = {
        "sites": inputs.sites(study),
        "quantities": inputs.quantities(study),
        "lhs_input": inputs.lhs_input(study),
        "thresholds_manual": inputs.thresholds_manual(study),
        "acc_thresholds": inputs.acc_thresholds(study),
        "IRI_thresholds": inputs.iri_thresholds(study),
        "weighting": weighting.weighting(study),
        "roughness": roads.roughness(study),
        "repair": roads.repair(study),
        "smoothing": roads.smoothing(study),
    }
    if study.compared:
        made["baseline_res"] = calibration.baseline_res(study)
    if study.calibrations:
        made["constraints"] = calibration.constraints(study)
    for site in study.compared:
        made[f"opti_res_{site.name}"] = calibration.opti_res(study, site)
    made["thresholding_table"] = comfort.thresholding_table(study)
    made["rid_comf_res"] = comfort.rid_comf_res(study)
    made["rid_comf_res2"] = comfort.rid_comf_res2(study)
    made["perception"] = comfort.perception(study)
    made["exceedance"] = comfort.exceedance(study)
    made["jerk"] = passengers.jerk(study)
    made["vibration"] = passengers.vibration(study)
    made["exposure"] = passengers.exposure_table(study)
    made["iri_resolution"] = roughness.iri_resolution(study)
    made["iri_tracks"] = roughness.iri_tracks(study)
    made["agreement"] = agreement.agreement_table(study)
    made["confusion"] = agreement.confusion_table(study)
    made["influence"] = agreement.influence_table(study)
    made["number_of_runs"] = agreement.number_of_runs_table(study)
    return made if study.of_the_paper else {name: _ours(table) for name, table in made.items()}


def _ours(table: Table) -> Table:
    """The table without what stands in it for the paper's figures."""
    of_whom = next((number for number, column in enumerate(table.columns) if column.key == "source"), None)
    rows = [row for row, cells in enumerate(table.rows) if of_whom is None or cells[of_whom] != PAPER]
    columns = [number for number, column in enumerate(table.columns) if not column.of_paper and number != of_whom]
    place = {(row, column): (i, j) for i, row in enumerate(rows) for j, column in enumerate(columns)}
    breaks = {sum(row < above for row in rows) for above in table.breaks}
    return replace(
        table,
        columns=tuple(table.columns[column] for column in columns),
        rows=tuple(tuple(table.rows[row][column] for column in columns) for row in rows),
        sources=tuple(source for source in table.sources if source.file != PUBLISHED),
        notes=tuple(note for note in table.notes if not isinstance(note, PapersNote)),
        marks={place[cell]: mark for cell, mark in table.marks.items() if cell in place},
        bold=frozenset(place[cell] for cell in table.bold if cell in place),
        breaks=tuple(sorted(breaks - {0, len(rows)})),
    )

