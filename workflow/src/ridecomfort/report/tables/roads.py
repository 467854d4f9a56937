"""What the roads are like: roughness, what was repaired, and what smoothing would cost."""

from __future__ import annotations

import xarray as xr

from .. import catalogue
from ..study import Site, Study
from ..table import Column, Source, Table

CM3_PER_M3 = 1e6
MM_PER_M = 1e3


def roughness(study: Study) -> Table:
    """Class, unevenness, waviness and IRI of the wheel tracks of each road as the study uses it."""
    columns = (
        Column("site", ("Site",)),
        Column("track_m", ("Track [m]",), ".2f"),
        Column("class", ("Class",)),
        Column("unevenness_cm3", ("$G_d(n_0)$ [cm³]",), ".1f"),
        Column("waviness", ("Waviness $w$ [-]",), ".2f"),
        Column("iri_m_per_km", ("IRI [m/km]",), ".2f"),
    )
    rows, sources, breaks = [], [], []
    for site in study.sites:
        found = used(site)
        breaks.append(len(rows))
        for track in found["track"].values:
            one = found.sel(track=track)
            rows.append(
                (
                    site.label,
                    float(track),
                    str(one["class"].values) or None,
                    CM3_PER_M3 * float(one["unevenness"]),
                    float(one["waviness"]),
                    float(one["iri_track"]),
                )
            )
        sources.append(_source(site, "class, unevenness, waviness, iri_track", "of the stage that the study uses"))
    notes = (
        "Tracks are metres to the left of the reference line. Straight line through the smoothed spectrum from 0.011 "
        "to 2.83 cycles/m, unevenness at 0.1 cycles/m (ISO 8608, annex B and C); IRI of the whole length.",
    )
    return _table(study, "roughness", columns, rows, sources, notes, breaks[1:])


def repair(study: Study) -> Table:
    """What was done to each road: cells changed, the largest change, and the spectrum before and after."""
    columns = (
        Column("site", ("", "Site")),
        Column("cells", ("Cells", "all"), "d"),
        Column("outliers_repaired", ("Cells", "outliers repaired"), "d"),
        Column("outliers_kept", ("Cells", "outliers kept"), "d"),
        Column("holes_filled", ("Cells", "holes filled"), "d"),
        Column("changed_pct", ("Cells", "changed [%]"), ".3f"),
        Column("largest_change_mm", ("Largest change", "[mm]"), ".1f"),
        Column("largest_change_u_m", ("Largest change", "$u$ [m]"), ".1f"),
        Column("largest_change_v_m", ("Largest change", "$v$ [m]"), ".1f"),
        Column("unevenness_before_cm3", ("$G_d(n_0)$ [cm³]", "before"), ".2f"),
        Column("unevenness_after_cm3", ("$G_d(n_0)$ [cm³]", "after"), ".2f"),
        Column("waviness_before", ("Waviness $w$ [-]", "before"), ".3f"),
        Column("waviness_after", ("Waviness $w$ [-]", "after"), ".3f"),
        Column("dips", ("Found and kept", "dips"), "d"),
        Column("bumps", ("Found and kept", "bumps"), "d"),
        Column("joints", ("Found and kept", "joints"), "d"),
        Column("deepest_mm", ("Found and kept", "deepest [mm]"), ".0f"),
    )
    rows, sources = [], []
    for site in study.sites:
        found, said = site.inspection, site.inspection.attrs
        kind, height = found["kind"].values, found["height"].values
        dips = height[kind == "dip"]
        level, waviness = found["unevenness"].mean("track"), found["waviness"].mean("track")
        rows.append(
            (
                site.label,
                *(int(said[name]) for name in ("cells", "cells_repaired", "cells_kept", "cells_filled")),
                100.0 * float(said["share_changed"]),
                MM_PER_M * float(said["largest_change"]),
                *(float(said[name]) if name in said else None for name in ("largest_change_u", "largest_change_v")),
                *(CM3_PER_M3 * float(level.sel(stage=stage)) for stage in ("measured", "repaired")),
                *(float(waviness.sel(stage=stage)) for stage in ("measured", "repaired")),
                dips.size,
                int((kind == "bump").sum()),
                int((kind == "joint").sum()),
                MM_PER_M * float(-dips.min()) if dips.size else None,
            )
        )
        sources += [
            _source(site, "attributes cells_*, share_changed, largest_change*", "as in the file"),
            _source(site, "unevenness, waviness", "mean of the wheel tracks as measured and repaired"),
            _source(site, "kind, height", "numbers by kind; least height of a dip"),
        ]
    notes = (
        "Where: every changed cell stands in road.nc (treated), every place in inspection.nc (dimension defect) and on "
        "the map of the site. A dip of one or two cells looks like an outlier in a grid and is repaired where the site "
        "asks for it; only from a scan, where ten points or more see it, is it told from one and kept.",
        "Dips and bumps: 5 mm and six robust standard deviations from the median of 5 m of their track. "
        "Joints: 1 mm, and three times what nine in ten cross sections do, from the median of 1.2 m, over half the width.",
    )
    return _table(study, "repair", columns, rows, sources, notes)


def smoothing(study: Study) -> Table:
    """Cut-offs that cross-validation finds, and what smoothing with them takes from roughness, IRI and a_z."""
    columns = (
        Column("site", ("", "Site")),
        Column("road", ("", "Road")),
        Column("cutoff_along_m", ("Cut-off [m]", "along"), ".2f"),
        Column("cutoff_across_m", ("Cut-off [m]", "across"), ".2f"),
        Column("lambda_along_m4", (r"$\lambda$ [m⁴]", "along"), ".1e"),
        Column("lambda_across_m4", (r"$\lambda$ [m⁴]", "across"), ".1e"),
        Column("held_out_error_mm", ("", "Held-out error [mm]"), ".2f"),
        Column("unevenness_cm3", ("", "$G_d(n_0)$ [cm³]"), ".2f"),
        Column("waviness", ("", "$w$ [-]"), ".2f"),
        Column("iri_m_per_km", ("", "IRI [m/km]"), ".3f"),
        Column("a_z_rms", ("$a_z$ [m/s²]", "rms"), ".4f"),
        Column("a_z_peak", ("$a_z$ [m/s²]", "largest"), ".2f"),
    )
    rows, sources, breaks = [], [], []
    for site in study.sites:
        found = site.inspection
        breaks.append(len(rows))
        for stage in ("repaired", "smoothed"):
            one = found.sel(stage=stage)
            cut = found.sel(direction=["along", "across"])
            given = stage == "smoothed"
            rows.append(
                (
                    site.label,
                    stage + (", used" if found.attrs["used"] == stage else ""),
                    *(float(value) if given else None for value in cut["cutoff"].values),
                    *(float(value) if given else None for value in cut["penalty"].values),
                    MM_PER_M * float(found["held_out_error"].sel(direction="along").min()) if given else None,
                    CM3_PER_M3 * float(one["unevenness"].mean()),
                    float(one["waviness"].mean()),
                    float(one["iri_track"].mean()),
                    float(one["a_z_rms"]),
                    float(one["a_z_peak"]),
                )
            )
        sources += [
            _source(site, "cutoff, penalty, held_out_error", "as in the file; least error along the road"),
            _source(site, "unevenness, waviness, iri_track", "mean of the wheel tracks"),
            _source(site, "a_z_rms, a_z_peak", "one drive of the nominal vehicle at the site's speed profile"),
        ]
    notes = (
        "The study smooths a road where its site file says road: options: smoothing: cross-validation.",
        "Cut-off: wavelength that smoothing halves; two spacings of the grid are the shortest tried, and where the "
        "error is least there, the heights hold no noise that a spline would take out.",
    )
    return _table(study, "smoothing", columns, rows, sources, notes, breaks[1:])


def used(site: Site) -> xr.Dataset:
    """The inspection of a site's road at the stage that the study uses."""
    return site.inspection.sel(stage=site.inspection.attrs["used"])


def _source(site: Site, variable: str, rule: str) -> Source:
    return Source(site.label, site.files.get("inspection", ""), variable, rule)


def _table(study: Study, name: str, columns, rows, sources, notes=(), breaks=()) -> Table:
    notes = [*notes, *([study.standin_note()] if study.standin_note() else [])]
    caption = catalogue.ROAD_TABLES[name]
    return Table(name, caption, tuple(columns), tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks))
