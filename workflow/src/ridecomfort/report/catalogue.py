"""Names and captions of every table and figure, for a given set of sites.

Names are the paper's labels where it has one (``tab:rid_comf_res`` becomes
``rid_comf_res``). The module is light: the workflow reads it to know what will be made.

``sites`` maps the name of each site to what the configuration says of it. Looked at here are
``has_drives`` (measured drives exist, and with them a comparison) and ``calibrated_on`` (the site
whose calibration the site is simulated with; ``none``, None or absent: the nominal vehicle).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

OF_THE_PAPER = ("ts1", "ts2", "ts3")
"""The sites of the paper: what it publishes is shown in studies of at least one of them."""

INPUT_TABLES = {
    "sites": "The sites and their roads.",
    "quantities": "Vehicle dynamics quantities for model validation and calibration.",
    "lhs_input": "Probabilistic input parameters: their distributions, and what was drawn from them.",
    "thresholds_manual": "Thresholds in m/s² for public transport (PT), normal (ND) and aggressive driving (AG).",
    "acc_thresholds": "Bands of the vibration total value in m/s² (ISO 2631-1, Annex C).",
    "IRI_thresholds": "Upper edges of the IRI classes in m/km as a function of speed.",
    "weighting": "Largest deviation of the digital frequency weightings from the analogue ones, in dB.",
}

ROAD_TABLES = {
    "roughness": "Roughness of the wheel tracks: ISO 8608 class, unevenness, waviness and IRI.",
    "repair": "What was found on the roads and done to them: cells changed, the largest change, the spectrum before "
    "and after.",
    "smoothing": "Smoothing splines by cross-validation: cut-offs, and what they would take from roughness, IRI and "
    "vertical acceleration.",
}

COMPARISON_TABLES = {
    "baseline_res": "NRMSE of the model before calibration, against the measured drives.",
}

CALIBRATION_TABLES = {
    "constraints": "Calibrated parameters: bounds, initial and calibrated values with 90 % intervals.",
}

COMFORT_TABLES = {
    "thresholding_table": "Critical sections by thresholds of the longitudinal, lateral and vertical acceleration.",
    "rid_comf_res": "Critical sections by the vibration total value of ISO 2631.",
    "rid_comf_res2": "Critical sections by the IRI with thresholds that depend on the speed driven.",
    "perception": "The vibration total value along the sites against the threshold of perception.",
    "exceedance": "Critical sections of the mean over the runs beside those of the single runs.",
    "jerk": "Critical sections by thresholds of the jerk of the driver's manoeuvres.",
    "vibration": "Quantities of ISO 2631-1 of one pass over the site, mean over the runs.",
    "exposure": "Health and motion sickness of a trip that is made of nothing but the site.",
    "iri_resolution": "Critical sections by the IRI of a survey and by the IRI in full resolution.",
    "iri_tracks": "The IRI of the wheel tracks, and what a survey of the site hides.",
    "agreement": "Agreement of the comfort methods, section by section, with 95 % intervals.",
    "confusion": "Number of sections by the grade that one method and the other give.",
    "influence": "What of the comfort of a run is owed to its speed, its lateral position and the road's friction.",
    "number_of_runs": "Width of the 95 % interval of a section's probability of being critical, by number of runs.",
}

CLAIMS_TABLES = {
    "claims": "The paper's claims, answered from the tables of this study.",
}

DIFFERENCE_TABLES = {
    "alignment": "Alignment of the measured drives: clock, speed scale, path and mounting as found.",
    "calibrated": "What calibration made of the model: values with 90 % intervals, and what the drives say of them.",
    "findings": "Where the error sits, largest first: errors above the floor by signal, frequency, place and condition.",
    "explainable": "Error of the model by signal: RMSE, NRMSE, the floor, what lies above it and how much of that is left.",
    "error_ladder": "The error ladder: error of each model, and the share of the explainable error that it leaves.",
    "error_ladder_sections": "What the ladder does to comfort: critical sections of the measured drives and of their replays.",
}

DIAGNOSIS_TABLES = {
    "verdict": "Which effect is missing: the verdict with its reasons.",
    "missing_effects": "Effects that were found: sizes, intervals, and what each explains.",
    "evidence": "Evidence for every effect of the library, and the refits of the best.",
    "excluded": "How large every effect of the library may be that was not found: what lies outside of the interval is excluded.",
    "forms": "Forces of any form that were looked for beside the library: the best of every place, and the refits of the best of all.",
}

SCORE_TABLES = {
    "standin_score": "The verdict against the truth of the stand-in drives: effects hidden and found.",
}

DIFFERENCE_FIGURES = {
    "error_ladder": "The error ladder: share of the explainable error that each model, calibrated anew where drives are fitted, leaves on "
    "fitted and on held-out drives, and sections that the replays grade otherwise than the measured drives; dashed, repeats against one another.",
}

DIAGNOSIS_FIGURES = {
    "evidence": "Evidence for the effects of the library: gain in the score test (fall of twice the negative log-likelihood; axis as a square "
    "root), p-value over the whole library, which asks how evenly that comes along the road, and the refits of the best: explainable error "
    "removed on fitted and on held-out drives. What a refit removes is the search's first "
    "estimate, above the floor as known in that round; the missing effects have it from the last fit of each round, the error ladder "
    "from models calibrated anew.",
    "forms": "Evidence for forces of any form, where the library does not explain the error: terms that such a force may be made of, at each "
    "place where it could act, as in the evidence for the library.",
    "signature": "The force that the calibrated model lacks, estimated without a form in mind against what it could depend on, each "
    "curve as if nothing else were missing. What calibration could take up, a straight line or a level, does not show. Dashed: what the "
    "same estimate makes of the model with all the named effects. Slip angles, the cornering stiffness over the load and toe-out over the "
    "wheel's travel are there where effects that act so are named, or come nearest. Behind the titles the share of the error that the "
    "curves of both axles explain alone, all frequencies weighing alike, noise included.",
}

ROAD_FIGURES = {
    "testsection_figs": "The sites: plan, height, slope and curvature of the reference line.",
}

SMOOTHING_FIGURES = {
    "smoothing": "Smoothing splines by cross-validation: error against held-out heights by cut-off, spectrum of the "
    "road and of the vertical acceleration of one drive, with and without.",
}

METHOD_FIGURES = {
    "framework": "The study from road surface to comfort: what flows into what.",
    "validation_iso": "Frequency weighting after ISO 2631-1 against the exact analogue filter, "
    "and the paper's bilinear transform without prewarping.",
}

CALIBRATION_FIGURES = {
    "leastsquare": "One block of the calibration: bounded nonlinear least squares.",
    "optichain": "The calibration as a chain of least-squares blocks: what each block set and what it cost.",
    "convergence": "Cost of the calibration and its parameters after each block.",
}

COMPARISON_FIGURES = {
    "opti_plots": "Measured and simulated signals before and after calibration.",
}

STRIPS = "below, the critical sections of each class, paler where only some of the runs are critical."

PT_TO_AG = "PT: public transport, ND: normal driving, AG: aggressive driving."

NU_TO_EU = "NU: not uncomfortable, LU: a little, FU: fairly, U: uncomfortable, VU: very, EU: extremely."

VG_TO_P = "VG: very good, G: good, F: fair, M: mediocre, P: poor."

COMFORT_FIGURES = {
    "thresholding_results_1": "Longitudinal and lateral acceleration along the sites, mean over the runs, with the "
    f"thresholds in the range of the signal, others are not drawn; {STRIPS} {PT_TO_AG}",
    "thresholding_results_2": "Vertical acceleration along the sites, mean over the runs, with the thresholds in the "
    f"range of the signal, others are not drawn; {STRIPS} {PT_TO_AG}",
    "ride_comfors": "Vibration total value of ISO 2631 along the sites, mean over the runs, on its bands, each shown "
    f"from its lower edge to that of the next; {STRIPS} {NU_TO_EU}",
    "IRI_thresholds": "IRI along the sites as a survey reports it and in full resolution, on the classes at the mean "
    f"speed of the runs; {STRIPS} {VG_TO_P}",
    "critical_shares": f"Share of critical sections by method and class. {PT_TO_AG} {NU_TO_EU} {VG_TO_P}",
    "iri_resolution": "Share of the road by the class of the IRI, of a survey and in full resolution.",
    "agreement": "Agreement of the methods on each site and on all: weighted kappa, rank correlation along the road, "
    "and by how much the first method lags behind the second; 95 % intervals by block bootstrap.",
    "influence": "Share of the variance between runs that speed, lateral position and friction explain alone, "
    "with 95 % intervals.",
    "number_of_runs": "Width of the 95 % interval of a section's probability of being critical against the number "
    "of runs, for Latin hypercubes and for plain Monte Carlo.",
}

OF_A_SITE = ("opti_res_", "views_", "spectrum_")
"""How the names of tables and figures begin that end with the name of a site."""

OF_A_MEASURED_SITE = ("located_", "conditions_", "responses_")
"""How those begin that end with the name of a site with measured drives."""


def with_drives(sites: Mapping[str, Mapping]) -> list[str]:
    """Names of the sites that have measured drives, in the order of the study."""
    return [name for name, site in sites.items() if site.get("has_drives")]


def calibrated_on(sites: Mapping[str, Mapping]) -> list[str]:
    """Names of the sites whose calibrations the study uses, each once."""
    named = [site.get("calibrated_on") for site in sites.values()]
    return list(dict.fromkeys(name for name in named if name and name != "none"))


def site_figures(name: str) -> dict[str, str]:
    """Name and caption of every figure of the comparison with the drives measured on one site."""
    return {
        f"located_{name}": (
            f"{label(name)}: where simulated and measured drives differ. Left: error above the floor by place and frequency, in colours "
            "that mean the same for every model and site, where it is more than chance, and in all; grey are frequencies that are the "
            "driver's, and places that no drive tells of; numbered boxes are "
            "the findings in words below, at most five, at most two of a signal: errors of 1 % of the signal's power or more in a band or, "
            "where none is as large, the largest. Right: spectra of signal, error and floor."
        ),
        f"conditions_{name}": (
            f"{label(name)}: error above the floor in percent of the signal's power under the same condition of the drive. "
            "Each point is about a fifth of the driving time, or more where classes were alike; the axis reaches from 0.1 to 100 % at least."
        ),
        f"responses_{name}": (
            f"{label(name)}: how the signals answer to the road. Left: gain from the road, of the measured drives (dark) and of the model "
            "on the same paths (blue). Middle: gain of drives over model, above 1 where the model moves too little, and phase, below 0 where the "
            "drives come later (dotted: by 10 ms), where the two are coherent. Right: coherence, of "
            "each with the road (dashed) and of drives with model (orange); below 1 it shows noise, a wrong path or clock, other inputs, "
            "or what is not linear, such as friction."
        ),
    }


def difference_figures(sites: Iterable[str]) -> dict[str, str]:
    """Name and caption of every figure of the comparison with the drives measured on these sites, and of the error ladder."""
    return {figure: caption for name in sites for figure, caption in site_figures(name).items()} | DIFFERENCE_FIGURES


def of_the_paper(sites: Iterable[str]) -> bool:
    """Whether the paper has at least one of these sites."""
    return any(name in OF_THE_PAPER for name in sites)


def tables(sites: Mapping[str, Mapping]) -> dict[str, str]:
    """Name and caption of every table of a study of these sites, in the order of the page."""
    found = INPUT_TABLES | ROAD_TABLES
    if with_drives(sites):
        found |= COMPARISON_TABLES
    if calibrated_on(sites):
        found |= CALIBRATION_TABLES
    found |= {f"opti_res_{name}": opti_res_caption(name) for name in with_drives(sites)}
    found |= COMFORT_TABLES
    return found | CLAIMS_TABLES if of_the_paper(sites) else found


def figures(sites: Mapping[str, Mapping]) -> dict[str, str]:
    """Name and caption of every figure of a study of these sites, in the order of the page."""
    found = METHOD_FIGURES | ROAD_FIGURES
    found |= {f"views_{name}": views_caption(name) for name in sites}
    found |= {f"spectrum_{name}": spectrum_caption(name) for name in sites}
    found |= SMOOTHING_FIGURES
    if calibrated_on(sites):
        found |= CALIBRATION_FIGURES
    if with_drives(sites):
        found |= COMPARISON_FIGURES
    return found | COMFORT_FIGURES


def of_another_study(name: str, sites: Mapping[str, Mapping]) -> bool:
    """Whether a table or figure of this name can only come from a study of other sites; names unknown here cannot."""
    if name in tables(sites) or name in figures(sites):
        return False
    measured = with_drives(sites)
    if name.startswith(OF_A_MEASURED_SITE):
        return name.split("_", 1)[1] not in measured
    if any(name in names for names in (DIAGNOSIS_TABLES, SCORE_TABLES, DIAGNOSIS_FIGURES)):
        return not (measured or calibrated_on(sites))  # where the vehicle is calibrated elsewhere, that site is diagnosed
    if any(name in names for names in (DIFFERENCE_TABLES, DIFFERENCE_FIGURES)):
        return not measured
    conditional = (COMPARISON_TABLES, CALIBRATION_TABLES, CLAIMS_TABLES, CALIBRATION_FIGURES, COMPARISON_FIGURES)
    return name.startswith(OF_A_SITE) or any(name in names for names in conditional)


def views_caption(site: str) -> str:
    """Caption of a site's views of its road."""
    return (
        f"{label(site)}: plan, height, slope, curvature and cross slope of the road, and the height of every cell "
        "above the median of 5 m of its track, with the dips, bumps, joints, outliers and holes that were found."
    )


def spectrum_caption(site: str) -> str:
    """Caption of a site's displacement spectra."""
    return (
        f"{label(site)}: displacement spectra of the wheel tracks on the classes of ISO 8608, with waviness, and the "
        "coherence of left and right track."
    )


def opti_res_caption(site: str) -> str:
    """Caption of a site's table of errors before and after calibration."""
    return f"NRMSE before (Ref) and after calibration (Opt), {label(site)}."


def label(site: str) -> str:
    """How a site is called in print: the paper's Ts1 for ``ts1``, any other name as it is."""
    return site.capitalize() if site in OF_THE_PAPER else site
