"""Every table of the paper and of the study, ours beside the published figures."""

from __future__ import annotations

from ..study import Study
from ..table import Table
from . import agreement, calibration, comfort, inputs, passengers, roads, roughness, weighting


def make(study: Study) -> dict[str, Table]:
    """All tables of a study by name, in the order of ``catalogue.tables`` but for the claims."""
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
    return made

