"""Errors before and after calibration, and the calibrated parameters."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ... import identifiability
from ...discrepancy import judged
from ...vocabulary import SIGNALS
from .. import catalogue, published
from ..notation import symbol, unit, words
from ..study import Difference, Site, Study, foot_notes
from ..table import Column, PapersNote, Source, Table
from .comfort import OURS, PAPER

CHANGE = r"$\pm$ [%]"

OF_EFFECTS = (
    "The initial size of an effect is the one that its file calls typical. Sizes of effects may differ from those of the missing "
    "effects, beyond the intervals of either: here all parameters of an effect are fitted, what only shapes it as well, and the rest of the vehicle is held; there what shapes it is held unless the drives ask for "
    "more, and what is uncertain of the vehicle is fitted. To hold a parameter here give its value in config/study.yaml, effects: [{name: {parameter: value}}]."
)
"""What is said of effects beside their calibrated sizes."""

STATES = (("reference", "ref", "Ref"), ("calibrated", "opt", "Opt"))
"""State of the vehicle, its key among the published figures, and how both are called in print."""

WITH_EFFECTS = "with effects"
NOT_CALIBRATED = f"{WITH_EFFECTS}: the model's effects at the sizes that they are configured with, not calibrated; Ref is without them."
"""What is said of the state ``with_effects``, which an uncalibrated model with effects has."""

_BOUNDS = {
    "spring_stiffness_front": "spring_stiffness_front_N_per_m",
    "spring_stiffness_rear": "spring_stiffness_rear_N_per_m",
    "tyre_friction": "tyre_friction",
    "tyre_radial_stiffness": "tyre_radial_stiffness_N_per_m",
    "tyre_radial_damping": "tyre_radial_damping_Ns_per_m",
}


def nrmse(site: Site, state: str, role: str = "fit") -> list[float]:
    """NRMSE of each of ``SIGNALS``, mean over the drives of a role: ``fit``, at the usual speed, or ``check``."""
    chosen = site.comparison["nrmse"].isel(drive=_drives(site, role)).sel(state=state).mean("drive")
    return [float(chosen.sel(signal=signal)) for signal in SIGNALS]


def initial_cost(calibration: xr.Dataset) -> float:
    """Cost of the start in the units of ``cost``: half the sum of NRMSE^2 over the signals, mean over the drives."""
    return 0.5 * float((calibration["initial_nrmse"] ** 2).sum("signal").mean("drive"))


def baseline_res(study: Study) -> Table:
    """tab:baseline_res: NRMSE of the model before calibration."""
    rows = []
    for site in study.compared:
        rows.append((site.label, OURS, *nrmse(site, "reference", _main_role(site))))
        if _has_effects(site):
            rows.append((f"{site.label}, {WITH_EFFECTS}", OURS, *nrmse(site, "with_effects", _main_role(site))))
        paper = published.figures()["nrmse"].get(site.name)
        if paper:
            rows.append((site.label, PAPER, *(paper["ref"][signal] for signal in SIGNALS)))
    return Table(
        "baseline_res",
        catalogue.COMPARISON_TABLES["baseline_res"],
        _columns("Site"),
        tuple(rows),
        (*_sources(study.compared), Source.paper("nrmse", "tab:baseline_res")),
        _notes(study, [*([NOT_CALIBRATED] if any(map(_has_effects, study.compared)) else []), *foot_notes(study.compared)]),
    )


def opti_res(study: Study, site: Site) -> Table:
    """tab:opti_res_<site>: NRMSE before and after calibration and the change in percent."""
    rows = _changes(site, _main_role(site), "")
    sources = _sources((site,))
    breaks, notes = [], [NOT_CALIBRATED] if _has_effects(site) else []
    is_fitted = site.calibrated_on == site.name
    if not is_fitted:
        notes.append(f"Nothing is fitted to any drive of {site.label}.")
    if _main_role(site) == "fit" and _drives(site, "check"):
        breaks.append(len(rows))
        rows += _changes(site, "check", ", check")
        notes.append("check: drives that nothing is fitted to." if is_fitted else "check: drives of role check; the other rows are those of role fit.")
        file = site.files.get("comparison", "")
        sources.append(Source(f"{OURS}, check", file, "nrmse", "mean over the drives of role check, never fitted"))
    rule = "100 (Ref − Opt) / Ref, from unrounded values"
    sources.append(Source(f"{CHANGE}, {OURS}", "this table", "Ref, Opt", rule))
    paper = published.figures()["nrmse"].get(site.name)
    if paper:
        breaks.append(len(rows))
        for _, key, title in STATES:
            rows.append((title, PAPER, *(paper[key][signal] for signal in SIGNALS)))
        rows.append((CHANGE, PAPER, *(paper["improvement_pct"][signal] for signal in SIGNALS)))
        sources.append(Source.paper(f"nrmse.{site.name}", f"tab:opti_res_{site.name}"))
    where = f"Calibrated on {catalogue.label(site.calibrated_on)}." if site.calibrated_on else "Not calibrated."
    return Table(
        f"opti_res_{site.name}",
        f"{catalogue.opti_res_caption(site.name)} {where}",
        _columns("State"),
        tuple(rows),
        tuple(sources),
        _notes(study, [*notes, *foot_notes([site])]),
        breaks=tuple(breaks),
    )


def constraints(study: Study) -> Table:
    """tab:constraints, with what the calibration made of the parameters."""
    columns = (
        Column("calibrated_on", ("", "Calibrated on")),
        Column("parameter", ("", "Parameter")),
        Column("unit", ("", "Unit")),
        Column("paper_lower", ("Bounds, paper", "lower"), ".7g", of_paper=True),
        Column("paper_upper", ("Bounds, paper", "upper"), ".7g", of_paper=True),
        Column("lower", ("Bounds, this study", "lower"), ".7g"),
        Column("upper", ("Bounds, this study", "upper"), ".7g"),
        Column("initial", ("Value, this study", "initial"), ".4g"),
        Column("value_sequence", ("Value, this study", "after OP blocks"), ".4g"),
        Column("value", ("Value, this study", "calibrated"), ".4g"),
        Column("interval_lower", ("90 % interval", "lower"), ".4g"),
        Column("interval_upper", ("90 % interval", "upper"), ".4g"),
        Column("verdict", ("", "In words")),
    )
    rows, sources, breaks = [], [], []
    bounds = published.figures()["calibration_bounds"]
    for name, calibration in study.calibrations.items():
        if rows:
            breaks.append(len(rows))
        for parameter in calibration["parameter"].values.tolist():
            chosen = calibration.sel(parameter=parameter)
            in_words = words(parameter).capitalize()
            sign = symbol(parameter) if parameter in _BOUNDS else ""
            rows.append(
                (
                    catalogue.label(name),
                    f"{in_words} {sign}".strip(),
                    unit(str(chosen["unit"].item())),
                    *(bounds[_BOUNDS[parameter]] if parameter in _BOUNDS else (None, None)),
                    *(float(chosen[key]) for key in ("lower", "upper", "initial", "value_sequence", "value")),
                    *(float(chosen[key]) for key in ("interval_lower", "interval_upper")),
                    str(chosen["verdict"].item()),
                )
            )
        file = study.calibration_files.get(name, "")
        variables = "lower, upper, initial, value_sequence, value, interval_lower, interval_upper, verdict"
        sources.append(Source(f"{OURS}, 90 % interval, in words", file, variables, "as in the file"))
    sources.append(Source.paper("calibration_bounds", "tab:constraints"))
    notes = [
        PapersNote(
            "The paper writes the rear spring stiffness both $K_{sr}$ and $K_{rf}$. Its damping bounds lie above "
            "what is published for passenger car tyres (0 to 2000 N s/m); they are kept for the paper's calibration."
        ),
        PapersNote("The paper does not publish its calibrated values."),
    ]
    for name, calibration in study.calibrations.items():
        applied = {"joint": "the joint search", "sequence": "the sequence of blocks"}[calibration.attrs["applied"]]
        remarks = calibration.attrs["remarks"]
        notes.append(
            f"{catalogue.label(name)}: calibrated values are those of {applied}; stopped by "
            f"{calibration.attrs['stopping_rule']}. Remarks: {remarks}."
        )
    return Table(
        "constraints",
        catalogue.CALIBRATION_TABLES["constraints"],
        columns,
        tuple(rows),
        tuple(sources),
        _notes(study, notes, normalisation=False),
        breaks=tuple(breaks),
    )


def calibrated(found: Difference) -> Table:
    """The parameters of a model that was compared, those of its effects included, as calibration left them."""
    columns = (
        Column("calibrated_on", ("", "Calibrated on")),
        Column("parameter", ("", "Parameter")),
        Column("unit", ("", "Unit")),
        Column("initial", ("Value", "initial"), ".4g"),
        Column("value", ("Value", "calibrated"), ".4g"),
        Column("interval_lower", ("90 % interval", "lower"), ".4g"),
        Column("interval_upper", ("90 % interval", "upper"), ".4g"),
        Column("lower", ("Bounds", "lower"), ".7g"),
        Column("upper", ("Bounds", "upper"), ".7g"),
        Column("verdict", ("", "In words")),
    )
    rows, sources, breaks, notes = [], [], [], []
    for name, calibration in found.calibrations.items():
        breaks.append(len(rows))
        for parameter in calibration["parameter"].values.tolist():
            chosen = calibration.sel(parameter=parameter)
            shown = [float(chosen[column.key]) for column in columns[3:9]]
            in_words = words(parameter.replace(".", ": "))
            rows.append((catalogue.label(name), in_words, unit(str(chosen["unit"].item())), *shown, _in_words(parameter, chosen)))
        variables = "initial, value, interval_lower, interval_upper, lower, upper, verdict"
        sources.append(Source(catalogue.label(name), found.calibration_files.get(name, ""), variables, "as in the file"))
        notes.append(f"{catalogue.label(name)}: {calibration.attrs['remarks']}.")
        notes += [f"{catalogue.label(name)}: {heard}." for heard in filter(None, [calibration.attrs.get("driver")])]
    if not rows:
        rows.append(("none", "", "", *(None,) * 6, ""))
    notes.append(
        "At a bound the data ask for what lies beyond it, or the model lacks something that the parameter stands in for. Not identified: "
        "the drives do not tell it, and another value would do. Intervals hold where the model lacks nothing and what is not calibrated is as in "
        f"the vehicle's file. A verdict counts errors from {judged.IN_WORDS} and fits more that is uncertain: where it tells a value of one of these "
        "parameters that differs by more than the intervals, prefer that."
    )
    if any("." in name for calibration in found.calibrations.values() for name in calibration["parameter"].values.tolist()):
        notes.append(OF_EFFECTS)
    notes += filter(None, [found.standin_note()])
    caption = f"{catalogue.DIFFERENCE_TABLES['calibrated']} Model: {found.model}."
    return Table("calibrated", caption, columns, tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks[1:]))


def _in_words(parameter: str, chosen: xr.Dataset) -> str:
    """What is known of a parameter, of effects whether there may be none, and the one it is hardly told from."""
    said, (lower, upper) = str(chosen["verdict"].item()), (float(chosen[f"interval_{end}"]) for end in ("lower", "upper"))
    is_cut = lower <= float(chosen["lower"]) or upper >= float(chosen["upper"])
    if "." in parameter and lower <= 0.0 <= upper:
        said = f"{said}, may be nil"
    elif is_cut and said == "identified":
        said = f"{said}, its interval ends at a bound"
    others = chosen["correlation"].drop_sel(other=parameter)
    strongest = others[int(np.abs(others).fillna(0.0).argmax("other"))] if others.size else None
    if strongest is not None and abs(strongest) > identifiability.COLLINEAR:
        said += f", hardly told from {words(strongest['other'].item().replace('.', ': '))} ({float(strongest):+.2f})"
    return said


def _drives(site: Site, role: str) -> list[int]:
    return [drive for drive, its in enumerate(site.comparison["role"].values.tolist()) if its == role]


def _main_role(site: Site) -> str:
    """The role that stands for the site: ``fit``, or ``check`` where nothing is fitted."""
    return "fit" if _drives(site, "fit") else "check"


def _changes(site: Site, role: str, suffix: str) -> list[tuple]:
    """Rows Ref, Opt and change of the drives of a role; Ref alone, or with that of the model's effects, where nothing is calibrated."""
    errors = {
        title: nrmse(site, state, role) for state, _, title in STATES if state in site.comparison["state"].values
    }
    rows = [(title + suffix, OURS, *values) for title, values in errors.items()]
    if len(errors) == len(STATES):
        change = [100.0 * (before - after) / before for before, after in zip(*errors.values())]
        rows.append((CHANGE + suffix, OURS, *change))
    if _has_effects(site):
        rows.append((WITH_EFFECTS.capitalize() + suffix, OURS, *nrmse(site, "with_effects", role)))
    return rows


def _has_effects(site: Site) -> bool:
    """Whether the site was compared with effects that nothing calibrated."""
    return "with_effects" in site.comparison["state"].values


def _columns(heading: str) -> tuple[Column, ...]:
    errors = (Column(f"nrmse_{signal}", (f"NRMSE {symbol(signal)}",), ".4f") for signal in SIGNALS)
    return Column(heading.lower(), (heading,)), Column("source", ("Source",)), *errors


def _sources(sites) -> list[Source]:
    return [
        Source(
            f"{OURS}, {site.label}",
            site.files.get("comparison", ""),
            "nrmse",
            f"mean over the drives of role {_main_role(site)}{'' if site.calibrated_on == site.name else ', not fitted'}",
        )
        for site in sites
    ]


def _notes(study: Study, notes=(), normalisation: bool = True) -> tuple[str, ...]:
    notes = list(notes)
    if normalisation:
        notes.append("NRMSE: RMSE over the range (largest − smallest value) of the measured signal.")
        notes.append(PapersNote("The paper does not state how it normalises."))
    if study.standin_note():
        notes.append(study.standin_note())
    return tuple(notes)
