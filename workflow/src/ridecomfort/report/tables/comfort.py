"""Critical sections by the three methods, and how often single runs meet them."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ...comfort import bands
from .. import catalogue, published
from ..classes import CRITICAL_BANDS, CRITICAL_QUALITIES, STYLES
from ..notation import METHODS, symbol
from ..study import Study
from ..table import Column, PapersNote, Source, Table

OURS = "this study"
PAPER = "paper"
MISPRINT = "†"
PERCEPTION = bands.PERCEPTION[0], bands.PERCEPTION[-1]
"""Threshold of vibration perception in m/s2, lower and upper value (sec:iso_comfort)."""

COUNTS = (("C", "$C$ [-]", "d"), ("R_c", "$R_c$ [%]", ".2f"), ("N", "$N$ [-]", "d"), ("R_n", "$R_n$ [%]", ".2f"))


def thresholding_table(study: Study) -> Table:
    """tab:thresholding_table: sections whose mean acceleration leaves the band in the whole window."""
    rows = [
        (rf"$\pm a_{{{axis[-1]},{style}}}$", (axis, style))
        for axis in ("a_x", "a_y", "a_z")
        for style in STYLES
    ]
    return _detections(
        study,
        "thresholding_table",
        "thresholds",
        "Threshold",
        rows,
        lambda dataset, key: dataset.sel(axis=key[0], style=key[1]),
        breaks=(6, 12),
        notes=(
            "Along $x$ the simulated driver brakes and accelerates as the site file asks for (speed: acceleration, "
            "deceleration), so that counts of $a_x$ tell how the site was set, not what the road is like.",
            PapersNote("The paper prints no PT row for $a_z$, where its PT and ND thresholds are equal."),
        ),
    )


def rid_comf_res(study: Study) -> Table:
    """tab:rid_comf_res: sections that lie in an ISO 2631 band over the whole window."""
    return _detections(
        study,
        "rid_comf_res",
        "iso2631",
        "Band",
        [(band, (band,)) for band in CRITICAL_BANDS],
        lambda dataset, key: dataset.sel(band=key[0]),
        notes=("Bands overlap on purpose (ISO 2631-1, Annex C): a section may count in two of them.",),
    )


def rid_comf_res2(study: Study) -> Table:
    """tab:rid_comf_res2: sections that lie in an IRI class over the whole window."""
    return _detections(
        study,
        "rid_comf_res2",
        "iri",
        "Class",
        [(quality, (quality,)) for quality in CRITICAL_QUALITIES],
        lambda dataset, key: dataset.sel(quality=key[0]),
    )


def exceedance(study: Study) -> Table:
    """Sections critical in the mean over the runs beside the single runs: mean count, sections likely, possible."""
    columns = [Column("method", ("", "Method")), Column("class", ("", "Class"))]
    for site in study.sites:
        columns += [
            Column(f"{site.name}_mean", (site.label, "mean run [-]"), "d"),
            Column(f"{site.name}_runs", (site.label, "per run [-]"), ".2f"),
            Column(f"{site.name}_likely", (site.label, "$p$ > 0.5 [-]"), "d"),
            Column(f"{site.name}_possible", (site.label, "$p$ > 0 [-]"), "d"),
        ]
    classes = (
        [
            ("thresholds", "Thresholding", f"{axis}, {style}", {"axis": axis, "style": style})
            for axis in ("a_x", "a_y", "a_z")
            for style in STYLES
        ]
        + [("iso2631", "ISO 2631", band, {"band": band}) for band in CRITICAL_BANDS]
        + [("iri", "IRI", quality, {"quality": quality}) for quality in CRITICAL_QUALITIES]
    )
    rows = []
    for dataset, method, name, place in classes:
        axis, comma, style = name.partition(", ")
        row = [method, symbol(axis) + comma + style if comma else name]
        for site in study.sites:
            chosen = getattr(site, dataset).sel(place)
            probability = chosen["exceedance_probability"].values
            row += [
                int(chosen["critical_count"]),
                float(np.nansum(probability)),
                int((probability > 0.5).sum()),
                int((probability > 0).sum()),
            ]
        rows.append(tuple(row))
    sources = []
    for site in study.sites:
        for dataset in ("thresholds", "iso2631", "iri"):
            file = site.files.get(dataset, "")
            of = f"{site.label}, {METHODS[dataset]}"
            sources.append(Source(f"{of}, mean run", file, "critical_count", "as in the file"))
            sources.append(
                Source(
                    f"{of}, per run, p > 0.5, p > 0",
                    file,
                    "exceedance_probability",
                    "sum over the sections; number of sections above 0.5; above 0",
                )
            )
    notes = (
        "mean run: sections that are critical for the mean of all runs. per run: mean number of critical "
        "sections of a single run. $p$: share of the runs in which a section is critical.",
    )
    return Table(
        "exceedance",
        catalogue.COMFORT_TABLES["exceedance"],
        tuple(columns),
        tuple(rows),
        tuple(sources),
        _notes(study, notes),
        breaks=(9, 14),
    )


def perception(study: Study) -> Table:
    """The vibration total value along the sites against the threshold of perception."""
    columns = (
        Column("site", ("Site",)),
        Column("lowest", ("Lowest $a_v$ [m/s²]",), ".4f"),
        Column("mean", ("Mean $a_v$ [m/s²]",), ".4f"),
        Column("largest", ("Largest $a_v$ [m/s²]",), ".4f"),
        Column("above_lower_pct", (f"Above {PERCEPTION[0]} m/s² [%]",), ".2f"),
        Column("above_upper_pct", (f"Above {PERCEPTION[1]} m/s² [%]",), ".2f"),
    )
    rows, sources = [], []
    for site in study.sites:
        values = site.iso2631["a_v"].values
        values = values[np.isfinite(values)]
        above = [100.0 * float((values > threshold).mean()) for threshold in PERCEPTION]
        rows.append((site.label, float(values.min()), float(values.mean()), float(values.max()), *above))
        rule = "mean over the runs; lowest, mean and largest along s, share of the places along s"
        sources.append(Source(site.label, site.files.get("iso2631", ""), "a_v", rule))
    caption = catalogue.COMFORT_TABLES["perception"]
    notes = (
        "The threshold of ISO 2631-1 is a peak of vibration in one axis; $a_v$, held against it as in the paper, is a running rms of all "
        "three, of which a peak is 1.4 times as large and more.",
    )
    return Table("perception", caption, columns, tuple(rows), tuple(sources), _notes(study, notes))


def windows(dataset: xr.Dataset) -> int:
    """Number of evaluated sections of a comfort dataset."""
    return dataset.sizes["window"]


def _detections(study: Study, name, dataset, heading, rows, choose, breaks=(), notes=()) -> Table:
    columns = [Column("class", ("", heading)), Column("source", ("", "Source"))]
    for site in study.sites:
        columns += [Column(f"{site.name}_{key}", (site.label, title), form) for key, title, form in COUNTS]
    cells, marks, bold = [], {}, set()
    for text, key in rows:
        for source in (OURS, PAPER):
            line: list = [text, source]
            for site in study.sites:
                if source == OURS:
                    values = counts(choose(getattr(site, dataset), key))
                else:
                    values = published.detection(name, key, site.name) or (None,) * 4
                    if published.misprinted(name, key, site.name):
                        marks |= {(len(cells), len(line) + offset): MISPRINT for offset in (2, 3)}
                line += values
            bold |= {(len(cells), column) for column in _largest(line)}
            cells.append(tuple(line))
    sources = [
        Source(
            f"{OURS}, {site.label}",
            site.files.get(dataset, ""),
            "critical_count, critical_share",
            "$C$ and $R_c$ as in the file; $N$ = sections − $C$, $R_n$ = 100 − $R_c$",
        )
        for site in study.sites
    ]
    sources.append(Source.paper("detections, misprints", f"tab:{name}"))
    notes = list(notes)
    if bold:
        notes.append("Bold: the site with the largest share $R_c$ of the row.")
    if marks:
        notes.append(
            f"{MISPRINT} as printed; $N$ = sections − $C$ and $R_n$ = 100 − $R_c$ are meant and used here."
        )
    return Table(
        name,
        catalogue.COMFORT_TABLES[name],
        tuple(columns),
        tuple(cells),
        tuple(sources),
        _notes(study, notes, windows_of=dataset),
        marks,
        frozenset(bold),
        breaks,
    )


def counts(chosen: xr.Dataset) -> tuple[int, float, int, float]:
    """C, R_c in percent, N and R_n in percent of one class of a comfort dataset."""
    critical, share = int(chosen["critical_count"]), float(chosen["critical_share"])
    return critical, share, windows(chosen) - critical, 100.0 - share


def _largest(line) -> set[int]:
    """Columns of C and R_c of the sites with the largest share R_c; none where nothing is critical."""
    shares = {column: line[column + 1] for column in range(2, len(line), 4) if line[column + 1]}
    if not shares or len(line) < 2 + 2 * len(COUNTS):
        return set()
    most = max(shares.values())
    return {column + offset for column, share in shares.items() if share == most for offset in (0, 1)}


def notes_with_standin(study: Study, notes) -> tuple[str, ...]:
    """The notes of a table, and behind them that data are stand-ins where they are."""
    return _notes(study, notes)


def _notes(study: Study, notes, windows_of: str | None = None) -> tuple[str, ...]:
    notes = list(notes)
    if windows_of:
        numbers = ", ".join(f"{site.label} {windows(getattr(site, windows_of))}" for site in study.sites)
        paper = ", ".join(
            f"{site.label} {published.windows(site.name)}" for site in study.sites if published.windows(site.name)
        )
        notes.insert(0, f"Sections of this study: {numbers}" + (f"; of the paper: {paper}." if paper else "."))
    if study.standin_note():
        notes.append(study.standin_note())
    return tuple(notes)
