"""Every data figure of the paper and of the study, and drawn diagrams of how it works."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from matplotlib.figure import Figure

from .. import style
from ..study import Site, Study
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

SHOWN: Mapping[str, Callable[[Study], Iterable[str]]] = {
    "framework": lambda study: (),
    "leastsquare": lambda study: (),
    "validation_iso": lambda study: _simulated(weighting.sampled(study)),
    "testsection_figs": lambda study: [site.name for site in study.sites],
    "smoothing": lambda study: [site.name for site in study.sites],
    "optichain": lambda study: study.calibrations,
    "convergence": lambda study: study.calibrations,
    "opti_plots": lambda study: _simulated(calibration.shown(study)),
}
"""Names of the sites whose data a figure shows, of each figure of the whole study that does not show all of them and of all calibrations."""


def _simulated(site: Site) -> tuple[str | None, ...]:
    """Names of the sites whose data are in the simulated drives of a site."""
    return site.name, site.calibrated_on


def draw(study: Study, name: str) -> Figure:
    """One figure by its name in ``catalogue.figures``, in the study's style."""
    with style.styled():
        if name in BUILDERS:
            return style.marked(BUILDERS[name](study), standin_mark(study, name))
        kind, _, site = name.partition("_")
        return style.marked(OF_SITE[kind](study, site), standin_mark(study, name))


def standin_mark(study: Study, name: str) -> str | None:
    """The words for the stand-in sites whose data a figure in ``catalogue.figures`` shows; None where it shows none."""
    if name in BUILDERS:
        return study.standin_mark(SHOWN[name](study) if name in SHOWN else None)
    return study.standin_mark([name.partition("_")[2]])
