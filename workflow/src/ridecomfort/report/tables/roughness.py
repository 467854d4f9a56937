"""What a survey of the IRI hides: classes, wheel tracks and peaks in its resolution and in full."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .. import catalogue
from ..classes import QUALITIES
from ..study import Study
from ..table import Column, Source, Table
from .comfort import notes_with_standin


def iri_resolution(study: Study) -> Table:
    """Sections by class: by the survey and by the continuous IRI over a section."""
    columns = [Column("class", ("", "Class"))]
    for site in study.sites:
        columns += [
            Column(f"{site.name}_survey", (site.label, f"survey, {resolution(study):g} m [-]"), "d"),
            Column(f"{site.name}_full", (site.label, "full [-]"), "d"),
        ]
    rows = []
    for name in QUALITIES:
        counts = (
            int(site.iri[count].sel(quality=name))
            for site in study.sites
            for count in ("critical_count", "critical_count_full")
        )
        rows.append((name, *counts))
    rows.append(("in no class", *(rest for site in study.sites for rest in _in_none(site.iri))))
    sources = [
        Source(
            site.label,
            site.files.get("iri", ""),
            "critical_count, critical_count_full",
            "as in the file; in no class: sections − the sum of the classes",
        )
        for site in study.sites
    ]
    notes = (
        f"full: continuous IRI over {length(study):g} m around each place. A section is of a class where the IRI lies "
        "in it over the whole section, at the mean speed of the runs; where the class changes within it, it is of none.",
    )
    return _table(study, "iri_resolution", columns, rows, sources, notes)


def iri_tracks(study: Study) -> Table:
    """The IRI of the tracks, MRI, HRI, the largest values, and how much of the road is worse than its survey says."""
    columns = [
        Column("site", ("", "Site")),
        Column("right", ("Mean of the survey [m/km]", "right track"), ".2f"),
        Column("left", ("Mean of the survey [m/km]", "left track"), ".2f"),
        Column("mri", ("Mean of the survey [m/km]", "MRI"), ".2f"),
        Column("hri", ("Mean of the survey [m/km]", "HRI"), ".2f"),
        Column("largest_survey", ("Largest [m/km]", "survey"), ".2f"),
        Column("largest_full", ("Largest [m/km]", "full"), ".2f"),
        Column("largest_at_m", ("Largest [m/km]", "full, at $s$ [m]"), ".0f"),
        Column("worse_pct", ("Worse than in the survey [%]", "by a class"), ".1f"),
        Column("much_worse_pct", ("Worse than in the survey [%]", "by two or more"), ".1f"),
    ]
    rows, sources = [], []
    for site in study.sites:
        found, file = site.iri, site.files.get("iri", "")
        tracks = found["iri_track"].mean("s").values
        full = found["iri_full"].values
        worse = hidden(found)
        rows.append(
            (
                site.label,
                float(tracks[0]),
                float(tracks[-1]),
                float(found["iri"].mean()),
                float(found["hri"].mean()),
                float(found["iri"].max()),
                float(full.max()),
                float(found["s"][int(full.argmax())]),
                100.0 * float((worse == 1).mean()),
                100.0 * float((worse > 1).mean()),
            )
        )
        sources += [
            Source(f"{site.label}, tracks, MRI, HRI", file, "iri_track, iri, hri", "mean along s; the outermost tracks"),
            Source(f"{site.label}, largest", file, "iri, iri_full", "largest along s, and where"),
            Source(
                f"{site.label}, worse",
                file,
                "iri, iri_full, threshold",
                "share of the places along s whose class by iri_full is worse than that by iri, at the mean speed",
            ),
        ]
    notes = (
        f"Wheel tracks {_tracks(study)} m to the left of the reference line. MRI: mean of the IRI of the tracks; "
        "HRI: IRI of their mean profile.",
        f"survey: segments of {resolution(study):g} m, linear between their middles; full: continuous over "
        f"{length(study):g} m.",
    )
    return _table(study, "iri_tracks", columns, rows, sources, notes)


def hidden(found: xr.Dataset) -> np.ndarray:
    """By how many classes the continuous IRI is worse than the survey at each place s; negative where it is better."""
    return classes(found, "iri_full") - classes(found, "iri")


def classes(found: xr.Dataset, variable: str) -> np.ndarray:
    """Index into QUALITIES of an IRI at each place s, at the mean speed of the runs."""
    return (found[variable].values >= found["threshold"].transpose("quality", "s").values[:-1]).sum(axis=0)


def resolution(study: Study) -> float:
    """Length of the segments of the survey in m."""
    return study.settings["comfort"]["iri"]["segment"]


def length(study: Study) -> float:
    """Length of the sections in m."""
    return study.sites[0].iri.attrs["critical_length"]


def _in_none(found: xr.Dataset) -> tuple[int, int]:
    counts = ("critical_count", "critical_count_full")
    return tuple(found.sizes["window"] - int(found[count].sum()) for count in counts)


def _tracks(study: Study) -> str:
    return " and ".join(f"{offset:g}".replace("-", "−") for offset in study.sites[0].iri["track"].values)


def _table(study: Study, name: str, columns, rows, sources, notes) -> Table:
    caption = catalogue.COMFORT_TABLES[name]
    return Table(name, caption, tuple(columns), tuple(rows), tuple(sources), notes_with_standin(study, notes))
