"""How far the methods agree, what moves a run's comfort, and how many runs are enough."""

from __future__ import annotations

import numpy as np

from ...comfort import agreement as measures
from ...comfort import enough, influence, methods
from .. import catalogue
from ..notation import METHODS, symbol
from ..study import Study
from ..table import Column, Source, Table
from .comfort import notes_with_standin

PAIRED = {**METHODS, "a_z": "thresholding of $a_z$"}
GRADES = {"iso2631": methods.ISO_GRADES, "iri": methods.IRI_GRADES}
POOLED = "pooled"
DIFFERENCE = "ISO 2631 closer to the IRI than thresholding by"
MEASURES = {"a_v": "mean $a_v$", "iri": "IRI class F or worse"}
WIDTHS = (0.1, 0.05)
"""Widths of an interval for which the numbers of runs are told."""


def pair_title(pair: str) -> str:
    """A pair of methods of ``methods.agree`` in print."""
    return " – ".join(PAIRED[method] for method in pair.split(" - "))


def measure_title(measure: str) -> str:
    """A measure of ``influence.measures`` in print."""
    return MEASURES.get(measure, f"{symbol(measure)} outside PT")


def place_title(name: str) -> str:
    """A site, or all of them together, in print."""
    return "all sites" if name == POOLED else catalogue.label(name)


def places(study: Study) -> list[str]:
    """The sites that agreement is told of: each, and all together where there are several."""
    names = study.assessment["site"].values.tolist()
    return names if len(study.sites) > 1 else [name for name in names if name != POOLED]


def agreement_table(study: Study) -> Table:
    """Weighted kappa, equal grades, rank correlation and lag of each pair of methods, per site and pooled."""
    found = study.assessment
    columns = [Column("pair", ("", "Methods")), Column("site", ("", "Site"))]
    for key, title, form in (
        ("kappa", "Weighted kappa [-]", ".2f"),
        ("same", "Same grade [%]", ".1f"),
        ("spearman", "Rank correlation [-]", ".2f"),
        ("lag", "Lag [m]", ".0f"),
    ):
        columns += [Column(f"{key}_{bound}", (title, bound), form) for bound in ("estimate", "lower", "upper")]
    columns.append(Column("verdict", ("", "Substantially similar")))
    rows, breaks = [], []
    for pair in found["pair"].values.tolist():
        for site in places(study):
            chosen = found.sel(pair=pair, site=site)
            kappa = measures.Estimate(*chosen["kappa"].values.tolist())
            cells = [
                *chosen["kappa"].values.tolist(),
                *(100.0 * chosen["same"].values).tolist(),
                *chosen["spearman"].values.tolist(),
                *chosen["lag"].values.tolist(),
            ]
            rows.append((pair_title(pair), place_title(site), *cells, measures.verdict(kappa)))
        breaks.append(len(rows))
    for site in places(study):
        closer = found["kappa_difference"].sel(site=site).values.tolist()
        rows.append((DIFFERENCE, place_title(site), *closer, *(None,) * 9, ""))
    sources = (
        Source("all", study.assessment_file, "kappa, same, spearman, lag", "as in the file; same in percent"),
        Source(DIFFERENCE, study.assessment_file, "kappa_difference", "as in the file"),
        Source("verdict", "this table", "kappa", f"interval above, below or about {measures.SUBSTANTIAL:g}"),
    )
    notes = (
        f"ISO 2631 and IRI substantially similar: {found.attrs['verdict']}; {_printed(found.attrs['reason'])}.",
        "Kappa with quadratic weights on a scale of five grades: the classes of the IRI; NU, LU, FU, U and VU with EU "
        f"(label {found.attrs['rule']}); none, PT, ND and AG passed by thresholding. A section's grade is that of the mean "
        "over it. The lag is by how much the first method follows the second along the road; it was sought within 50 m, and "
        "an interval that reaches so far tells none.",
        f"95 % intervals by block bootstrap: blocks of {found.attrs['block']:g} m within each site, "
        f"{found.attrs['repetitions']} resamples, so that they respect the correlation along the road; none where a road is shorter "
        f"than {measures.FEWEST} blocks, for the lag without 50 m at either end. No kappa where a method knows one grade only.",
    )
    return _table(study, "agreement", columns, rows, sources, notes, breaks)


def confusion_table(study: Study) -> Table:
    """Confusion matrices of every pair of methods, per site and pooled."""
    found = study.assessment
    columns = [
        Column("pair", ("", "Methods")),
        Column("first", ("", "Grade by the first")),
    ]
    sites, grades = places(study), found.sizes["second_grade"]
    for site in sites:
        heading = f"{place_title(site)}, grade by the second"
        columns += [Column(f"{site}_{grade}", (heading, str(grade)), "d") for grade in range(grades)]
    rows, breaks = [], []
    for pair in found["pair"].values.tolist():
        first, _ = pair.split(" - ")
        for grade, name in enumerate(GRADES.get(first, methods.THRESHOLD_GRADES)):
            cells = found["confusion"].sel(pair=pair, site=sites).values[:, grade].ravel().tolist()
            rows.append((pair_title(pair), f"{grade}: {name}", *cells))
        breaks.append(len(rows))
    sources = (Source("all", study.assessment_file, "confusion", "as in the file; rows that a method lacks left out"),)
    named = ", ".join(f"{grade} {name}" for grade, name in enumerate(methods.IRI_GRADES))
    iso = ", ".join(f"{grade} {name}" for grade, name in enumerate(methods.ISO_GRADES))
    notes = (f"Grades of the IRI: {named}; of ISO 2631: {iso}.",)
    return _table(study, "confusion", columns, rows, sources, notes, breaks[:-1])


def influence_table(study: Study) -> Table:
    """Share of the variance and rank correlation of each measure of comfort with each factor, and a verdict."""
    found = study.assessment
    factors = found["factor"].values.tolist()
    columns = [Column("site", ("", "Site")), Column("measure", ("", "Comfort of a run"))]
    for factor in factors:
        title = symbol(factor)
        columns += [
            Column(f"{factor}_share", (title, "share [%]"), ".1f"),
            Column(f"{factor}_lower", (title, "lower"), ".1f"),
            Column(f"{factor}_upper", (title, "upper"), ".1f"),
            Column(f"{factor}_rank", (title, "rank corr. [-]"), ".2f"),
            Column(f"{factor}_verdict", (title, "verdict")),
        ]
    columns.append(Column("unexplained", ("", "None alone [%]"), ".1f"))
    rows, breaks = [], []
    for place in found["place"].values.tolist():
        for measure in found["measure"].values.tolist():
            chosen = found.sel(place=place, measure=measure)
            row, explained = [place_title(place), measure_title(measure)], 0.0
            for factor in factors:
                share = 100.0 * chosen["first_order"].sel(factor=factor).values
                verdict = influence.verdict(share[1] / 100.0, share[2] / 100.0)
                share = np.clip(share, 0.0, 100.0)
                rank = float(chosen["rank_correlation"].sel(factor=factor, bound="estimate"))
                row += [*share.tolist(), rank, verdict]
                explained += share[0]
            rows.append((*row, float(np.clip(100.0 - explained, 0.0, 100.0))))
        breaks.append(len(rows))
    sources = (
        Source("share", study.assessment_file, "first_order", "as in the file, in percent, within 0 to 100"),
        Source("rank corr.", study.assessment_file, "rank_correlation", "as in the file"),
        Source("verdict", "this table", "lower, upper", "ridecomfort/comfort/influence.py, verdict"),
    )
    notes = (
        "Share of the variance between runs that the factor explains alone (first-order Sobol' index, of an additive "
        "model of all factors), 95 % interval by jackknife. It matters where the interval lies from "
        f"{100 * influence.MATTERS:g} % on, it does not where the interval lies below. Fewer than {influence.LEAST_RUNS} runs, or a measure that is the same in all runs: no figure. "
        "Estimates scatter a little beyond 0 and 100 % and are printed as these.",
        "Measures of a run: mean of $a_v$ over the site; share of the sections outside the PT band; share of the "
        "sections of class F or worse by the IRI at the speed of the run.",
    )
    return _table(study, "influence", columns, rows, sources, notes, breaks[:-1])


def number_of_runs_table(study: Study) -> Table:
    """Width of the interval by number of runs: Latin hypercube, plain Monte Carlo, Wilson."""
    found = study.assessment
    columns = (
        Column("site", ("", "Site")),
        Column("size", ("", "Runs [-]"), "d"),
        Column("designs", ("", "Designs of that size [-]"), "d"),
        Column("latin_hypercube", ("Width of the 95 % interval [-]", "Latin hypercube"), ".4f"),
        Column("monte_carlo", ("Width of the 95 % interval [-]", "Monte Carlo"), ".4f"),
        Column("wilson", ("Width of the 95 % interval [-]", "Wilson"), ".4f"),
    )
    rows, breaks, notes = [], [], []
    for site in study.sites:
        chosen = found.sel(place=site.name)
        known = np.flatnonzero(chosen["designs"].values)
        if not known.size:
            rows.append((site.label, None, None, None, None, None))
            breaks.append(len(rows))
            notes.append(f"{site.label}: no figures, {why_no_width(site.samples.sizes['run'])}.")
            continue
        chosen = chosen.isel(size=known)
        for size in chosen["size"].values.tolist():
            at = chosen.sel(size=size)
            widths = (float(at["width"].sel(scheme=scheme)) for scheme in enough.SCHEMES)
            rows.append((site.label, size, int(at["designs"]), *widths, float(at["wilson"])))
        one = {scheme: enough.by_root(chosen["size"], chosen["width"].sel(scheme=scheme)) for scheme in enough.SCHEMES}
        runs = site.samples.sizes["run"]
        rows.append((site.label, runs, None, *(width / np.sqrt(runs) for width in one.values()), None))
        breaks.append(len(rows))
        needed = ", ".join(
            f"{width:g}: " + " and ".join(f"{np.ceil((one[scheme] / width) ** 2):.0f}" for scheme in enough.SCHEMES)
            for width in WIDTHS
        )
        notes.append(
            f"{site.label}: runs for a width of {needed} (Latin hypercube and Monte Carlo); "
            f"{int(chosen['open_sections'])} open outcomes."
        )
    sources = (
        Source("all", study.assessment_file, "width, wilson, designs", "as in the file"),
        Source("all runs", "this table", "width", "fitted to the rows above, proportional to one over the root of the runs"),
    )
    notes = (
        "Nothing is simulated again: the study's Latin hypercube is sliced, each block of consecutive runs of these sizes "
        "is a Latin hypercube itself (Qian 2012); as many runs drawn from it at random are a plain Monte Carlo sample. The "
        "scatter of the estimates over the designs gives the width, root mean square over the open outcomes: pairs of a "
        "section and a lower edge of a comfort band that its mean $a_v$ reaches in some runs and not in all.",
        *notes,
        f"No figure where no outcome is open, the runs hold fewer than {enough.LEAST_DESIGNS} designs of at least "
        f"{enough.LEAST_SIZE} runs, or they were drawn as plain Monte Carlo.",
    )
    return _table(study, "number_of_runs", columns, rows, sources, notes, breaks[:-1])


def why_no_width(runs: int) -> str:
    """Why the width of an interval cannot be told from smaller designs."""
    least = enough.LEAST_DESIGNS * enough.LEAST_SIZE
    if runs < least:
        return f"{runs} runs are too few, at least {least} are needed"
    return "no outcome is open, or the runs are no sliced Latin hypercube"


def _printed(reason: str) -> str:
    """Names of sites in the reason of the verdict as they are printed."""
    head, found, tail = reason.partition("By site: ")
    parts = (part.rsplit(" ", 1) for part in tail.split(", "))
    return head + found + ", ".join(f"{catalogue.label(site)} {value}" for site, value in parts)


def _table(study: Study, name: str, columns, rows, sources, notes, breaks) -> Table:
    caption, notes = catalogue.COMFORT_TABLES[name], notes_with_standin(study, notes)
    return Table(name, caption, tuple(columns), tuple(rows), tuple(sources), notes, breaks=tuple(breaks))
