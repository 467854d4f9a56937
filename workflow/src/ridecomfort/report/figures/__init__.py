"""Every data figure of the paper and of the study, and drawn diagrams of how it works."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from .. import style
from ..study import Study
from . import agreement, along, calibration, diagrams, overview, roads, roughness, surface, weighting

BUILDERS: Mapping[str, Callable[[Study], Figure]] = {
    "framework": diagrams.framework,
    "leastsquare": diagrams.leastsquare,
    "validation_iso": weighting.validation_iso,
    "testsection_figs": roads.testsection_figs,
    "smoothing": surface.smoothing,
    "optichain": diagrams.optichain,
    "convergence": calibration.convergence,
    "opti_plots": calibration.opti_plots,
    "thresholding_results_1": along.thresholding_results_1,
    "thresholding_results_2": along.thresholding_results_2,
    "ride_comfors": along.ride_comfors,
    "IRI_thresholds": along.iri_thresholds,
    "critical_shares": overview.critical_shares,
    "iri_resolution": roughness.iri_resolution,
    "agreement": agreement.agreement,
    "influence": agreement.influence,
    "number_of_runs": agreement.number_of_runs,
}

OF_SITE: Mapping[str, Callable[[Study, str], Figure]] = {
    "views": roads.views,
    "spectrum": surface.spectrum,
}
"""Figures that every site has; their names end with the site's."""


def draw(study: Study, name: str) -> Figure:
    """One figure by its name in ``catalogue.figures``, in the study's style."""
    with style.styled():
        if name in BUILDERS:
            return style.marked(BUILDERS[name](study), _mark(study, name))
        kind, _, site = name.partition("_")
        return style.marked(OF_SITE[kind](study, site), study.standin_mark(site))


def _mark(study: Study, name: str) -> str | None:
    """The words for the stand-in sites whose data a figure of the whole study shows; None where it shows none."""
    if name == "framework":
        return None
    return study.standin_mark(weighting.sampled(study).name if name == "validation_iso" else None)
