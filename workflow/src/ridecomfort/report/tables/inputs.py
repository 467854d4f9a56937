"""What goes into the study: sites, signals, sampling and the thresholds of the three methods."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ...vocabulary import SIGNALS, VARIABLES
from .. import catalogue, published
from ..classes import QUALITIES, STYLES
from ..notation import literal, symbol, unit
from ..study import Site, Study
from ..table import Column, PapersNote, Source, Table
from .comfort import OURS, PAPER, windows

GON_PER_RAD = 200.0 / np.pi
ERRATUM = "†"

SLOPE_BASE = 20.0
"""m over which heights tell a slope: a hill is longer, and what shakes a car is shorter."""

FAMILIES = {"normal": "Gaussian", "uniform": "uniform"}


def sites(study: Study) -> Table:
    """The roads: length, slope, curvature, speed limit, sections and IRI classes."""
    columns = [
        Column("site", ("", "Site")),
        Column("source", ("", "Source")),
        Column("road", ("", "Road")),
        Column("length_km", ("", "Length [km]"), ".2f"),
        Column("mean_slope_pct", ("", "Mean slope [%]"), ".2f"),
        Column("curvature_gon_per_km", ("", "Curvature [gon/km]"), ".2f"),
        Column("speed_limit_km_h", ("", "Limit [km/h]"), ".0f"),
        Column("windows", ("", "Sections [-]"), "d"),
    ]
    columns += [Column(f"iri_{name}_pct", ("Share of IRI class [%]", name), ".2f") for name in QUALITIES]
    rows, sources = [], []
    for site in study.sites:
        shares = site.iri["critical_share"]
        rows.append(
            (
                site.label,
                OURS,
                literal(site.title.removeprefix(f"{site.label}, ")) if site.title not in ("", site.label) else None,
                length(site.road) / 1000.0,
                100.0 * mean_slope(site.road),
                mean_curvature(site.road) * 1000.0 * GON_PER_RAD,
                site.speed_limit_km_h,
                windows(site.iri),
                *(float(shares.sel(quality=name)) for name in QUALITIES),
            )
        )
        paper = published.figures()["sites"].get(site.name)
        if paper:
            found = published.figures()["detections"]["iri"]
            rows.append(
                (
                    site.label,
                    PAPER,
                    paper["road"],
                    paper["length_km"],
                    paper["mean_slope_pct"],
                    paper["curvature_gon_per_km"],
                    paper["speed_limit_kmh"],
                    paper["windows_5m"],
                    None,
                    *(found[name][site.name][1] for name in QUALITIES[1:]),
                )
            )
        road, iri = site.files.get("road", ""), site.files.get("iri", "")
        sources += [
            Source(f"{site.label}, length", road, "u", "last − first"),
            Source(f"{site.label}, mean slope", road, *_slope_source(site.road)),
            Source(f"{site.label}, curvature", road, "curvature", "mean of the absolute value along u; 200/π gon/rad"),
            Source(f"{site.label}, limit", "configuration", f"sites.{site.name}.speed", "as configured"),
            Source(f"{site.label}, sections, IRI classes", iri, "window, critical_share", "number; as in the file"),
        ]
    sources.append(Source.paper("sites, detections.iri", "sec:test_sec_meas, tab:rid_comf_res2"))
    notes = (
        "Stand-in roads are matched to the published length, slope, curvature, limit and shares of G, F, M and P; "
        "what the other comfort methods find is an outcome.",
    )
    return _table(study, "sites", columns, rows, sources, notes if study.standin else ())


def quantities(study: Study) -> Table:
    """tab:quantities: the signals that are measured, simulated and compared."""
    paper = published.figures()["signals"]
    columns = (
        Column("symbol", ("Symbol",)),
        Column("description", ("Quantity",)),
        Column("paper_unit", ("Unit, paper",), of_paper=True),
        Column("name", ("Name in the files",)),
        Column("unit", ("Unit in the files",)),
    )
    rows = [("T", "time vector of the drive", "s", "time", "s")]
    for name in ("v_x", *SIGNALS):
        known = VARIABLES[name]
        rows.append((symbol(name), known.long_name, unit(paper[name].replace("^", "")), name, unit(known.unit)))
    sources = (
        Source.paper("signals", "tab:quantities"),
        Source("name, unit and quantity", "ridecomfort/vocabulary.py", "VARIABLES", "as in every file of the study"),
    )
    return Table("quantities", catalogue.INPUT_TABLES["quantities"], columns, tuple(rows), sources)


def lhs_input(study: Study) -> Table:
    """tab:lhs_input: the distributions that the runs are drawn from and what was drawn."""
    columns = (
        Column("site", ("", "Site")),
        Column("runs", ("", "Runs [-]"), "d"),
        Column("variable", ("", "Variable")),
        Column("distribution", ("", "Distribution")),
        Column("paper_first", ("Paper", "$\\mu$ or a"), ".4g", of_paper=True),
        Column("paper_second", ("Paper", "$\\sigma$ or b"), ".4g", of_paper=True),
        Column("configured_first", ("Configured", "$\\mu$ or a"), ".4g"),
        Column("configured_second", ("Configured", "$\\sigma$ or b"), ".4g"),
        Column("mean", ("Sampled, " + OURS, "mean"), ".4f"),
        Column("std", ("Sampled, " + OURS, "std"), ".4f"),
        Column("min", ("Sampled, " + OURS, "least"), ".4f"),
        Column("max", ("Sampled, " + OURS, "largest"), ".4f"),
    )
    rows, sources, breaks = [], [], []
    for site in study.sites:
        if rows:
            breaks.append(len(rows))
        for name in ("speed_deviation", "lateral_position", "road_friction"):
            values = site.samples[name].values.astype(float)
            family, *configured = distribution(site.sampling.get(name))
            paper_family, *paper = distribution(published.figures()["sampling"][name].get(site.name))
            rows.append(
                (
                    site.label,
                    values.size,
                    f"{symbol(name)} [{unit(VARIABLES[name].unit)}]",
                    _families(family, paper_family),
                    *paper,
                    *configured,
                    float(values.mean()),
                    float(values.std()),
                    float(values.min()),
                    float(values.max()),
                )
            )
        sources += [
            Source(
                f"{site.label}, sampled",
                site.files.get("samples", ""),
                "speed_deviation, lateral_position, road_friction",
                "mean, standard deviation, least and largest over the runs",
            ),
            Source(
                f"{site.label}, configured", "configuration", f"sites.{site.name}.sampling", "as configured"
            ),
        ]
    sources.append(Source.paper("sampling", "tab:lhs_input"))
    notes = [
        "Gaussian: mean $\\mu$ and standard deviation $\\sigma$; uniform: from a to b.",
        PapersNote("The paper does not state the unit of the speed deviation; m/s is assumed."),
    ]
    lengths = [
        f"{site.label} {known['length_km_lhs_table']:.1f} km (text: {known['length_km']:.2f} km), "
        f"curvature {known['curvature_class']}"
        for site in study.sites
        if (known := published.figures()["sites"].get(site.name))
    ]
    if lengths:
        notes.append(PapersNote("The paper's table prints " + "; ".join(lengths) + "."))
    return _table(study, "lhs_input", columns, rows, sources, notes, breaks)


def thresholds_manual(study: Study) -> Table:
    """tab:thresholds_manual: the bands of the three driving styles by axis."""
    paper = published.figures()["acceleration_thresholds"]
    dataset, file = _first(study, "thresholds")
    columns = [Column("style", ("", "Style")), Column("source", ("", "Source"))]
    for axis in ("a_x", "a_y", "a_z"):
        columns.append(Column(f"{axis}_lower", (symbol(axis), "lower"), ".2f"))
        columns.append(Column(f"{axis}_upper", (symbol(axis), "upper"), ".2f"))
    rows = []
    for style in STYLES:
        chosen = dataset.sel(style=style)
        ours = [float(chosen[edge].sel(axis=axis)) for axis in ("a_x", "a_y", "a_z") for edge in ("lower", "upper")]
        rows.append((style, OURS, *ours))
        rows.append((style, PAPER, *(value for axis in ("a_x", "a_y", "a_z") for value in paper[axis][style])))
    sources = (
        Source(OURS, file, "lower, upper, source", "as in the file, the same for all sites"),
        Source.paper("acceleration_thresholds", "tab:thresholds_manual"),
    )
    origins: dict[str, list[str]] = {}
    for axis in ("a_x", "a_y", "a_z"):
        for style in STYLES:
            origin = literal(dataset["source"].sel(axis=axis, style=style).item())
            origins.setdefault(origin, []).append(f"{symbol(axis)} {style}")
    notes = (
        "Bands of this study from: " + "; ".join(f"{origin} ({', '.join(where)})" for origin, where in origins.items()) + ".",
        PapersNote(
            "The paper's text prints −5.80 m/s² for the AG deceleration along x; −5.08 m/s² of its table and of its "
            "source is used."
        ),
    )
    caption = catalogue.INPUT_TABLES["thresholds_manual"]
    return Table("thresholds_manual", caption, tuple(columns), tuple(rows), sources, notes)


def acc_thresholds(study: Study) -> Table:
    """tab:acc_thresholds: the bands of the vibration total value."""
    names = {"NU": "not", "LU": "little", "FU": "fairly", "U": "", "VU": "very", "EU": "extremely"}
    paper = published.figures()["iso2631_bands"]
    dataset, file = _first(study, "iso2631")
    columns = (
        Column("band", ("", "Band")),
        Column("lower", (OURS.capitalize(), "lower"), ".3f"),
        Column("upper", (OURS.capitalize(), "upper"), ".3f"),
        Column("paper_lower", ("Paper", "lower"), ".3f", of_paper=True),
        Column("paper_upper", ("Paper", "upper"), ".3f", of_paper=True),
    )
    rows, marks = [], {}
    for band in dataset["band"].values.tolist():
        chosen = dataset.sel(band=band)
        printed = [None if np.isinf(edge) else float(edge) for edge in paper[band]]
        ours = [float(chosen[edge]) for edge in ("band_lower", "band_upper")]
        if band == "U":
            marks = {(len(rows), 3): ERRATUM, (len(rows), 4): ERRATUM}
        words = f"{names[band]} uncomfortable".strip().capitalize()
        rows.append((f"{words} ({band})", *(None if np.isinf(edge) else edge for edge in ours), *printed))
    sources = (
        Source(OURS, file, "band_lower, band_upper", "as in the file, the same for all sites"),
        Source.paper("iso2631_bands", "tab:acc_thresholds"),
    )
    notes = (
        PapersNote(f"{ERRATUM} left out in the paper's table, though tab:rid_comf_res reports it; ISO 2631-1, Annex C."),
        "Bands overlap on purpose.",
    )
    caption = catalogue.INPUT_TABLES["acc_thresholds"]
    return Table("acc_thresholds", caption, columns, tuple(rows), sources, notes, marks)


def iri_thresholds(study: Study) -> Table:
    """tab:IRI_thresholds: upper edges of the IRI classes at the configured speeds."""
    ours = study.settings["comfort"]["iri"]
    paper = published.figures()["iri_thresholds"]
    speeds = ours["speed_km_h"]
    columns = [Column("class", ("", "Class")), Column("source", ("", "Source"))]
    columns += [
        Column(f"at_{speed:g}_km_h", ("Speed [km/h]", f"{speed:g}"), ".2f") for speed in speeds
    ]
    rows = []
    for name in QUALITIES[:-1]:
        printed = dict(zip(paper["kmh"], paper[name]))
        rows.append((name, OURS, *(float(edge) for edge in ours["thresholds"][name])))
        rows.append((name, PAPER, *(printed.get(speed) for speed in speeds)))
    sources = (
        Source(OURS, "configuration", "comfort.iri.thresholds", "as configured"),
        Source.paper("iri_thresholds", "tab:IRI_thresholds"),
    )
    return Table(
        "IRI_thresholds",
        catalogue.INPUT_TABLES["IRI_thresholds"],
        tuple(columns),
        tuple(rows),
        sources,
        ("Poor (P) lies above mediocre (M).",),
    )


def length(road: xr.Dataset) -> float:
    """Length of the reference line in m."""
    return float(road["u"][-1] - road["u"][0])


def mean_slope(road: xr.Dataset) -> float:
    """Mean absolute `slope` (1)."""
    return float(np.nanmean(np.abs(slope(road))))


def slope(road: xr.Dataset) -> np.ndarray:
    """Slope (u) of the reference line (1); of a road whose line is level that of its heights at the v nearest 0, over `SLOPE_BASE`."""
    if not _is_level(road):
        return road["slope"].values
    u, heights = road["u"].values, road["elevation"].sel(v=0.0, method="nearest").values
    known = np.isfinite(heights)
    before, after = (np.clip(u + aside, u[0], u[-1]) for aside in (-0.5 * SLOPE_BASE, 0.5 * SLOPE_BASE))
    begun, ended = (np.interp(place, u[known], heights[known]) for place in (before, after))
    return (ended - begun) / (after - before)


def _is_level(road: xr.Dataset) -> bool:
    """Whether the climb of a road, if it has any, is in its heights alone: files may hold it there or as slope of their line."""
    return "slope" not in road or not np.nan_to_num(road["slope"].values).any()


def _slope_source(road: xr.Dataset) -> tuple[str, str]:
    if _is_level(road):
        return "elevation", f"mean of the absolute value along u of the slope over {SLOPE_BASE:g} m at the v nearest 0: slope is nil"
    return "slope", "mean of the absolute value along u"


def mean_curvature(road: xr.Dataset) -> float:
    """Mean absolute curvature of the reference line in rad/m, the change of heading per length."""
    return float(np.nanmean(np.abs(road["curvature"].values)))


def distribution(setting) -> tuple:
    """Family and two parameters of a configured distribution such as ``{"normal": [0, 0.2]}``."""
    if not setting:
        return None, None, None
    family, parameters = next(iter(setting.items()))
    return family, *(float(value) for value in parameters)


def _families(ours: str | None, papers: str | None) -> str:
    """The family of a distribution in words, and the paper's where that is another."""
    ours, papers = (FAMILIES.get(family, family) for family in (ours or papers, papers or ours))
    return ours if ours == papers else f"{ours}; paper: {papers}"


def _first(study: Study, dataset: str) -> tuple[xr.Dataset, str]:
    site: Site = study.sites[0]
    return getattr(site, dataset), site.files.get(dataset, "")


def _table(study, name, columns, rows, sources, notes=(), breaks=()) -> Table:
    notes = [*notes, *([study.standin_note()] if study.standin_note() else [])]
    caption = catalogue.INPUT_TABLES[name]
    return Table(
        name, caption, tuple(columns), tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks)
    )
