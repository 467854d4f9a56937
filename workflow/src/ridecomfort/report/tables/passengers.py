"""What passengers bear beyond comfort: jerk, and health and sickness over a stated time."""

from __future__ import annotations

from ...comfort import exposure, quantities
from .. import catalogue
from ..notation import literal, symbol
from ..study import Study
from ..table import Column, Source, Table
from .comfort import notes_with_standin

LIMITS = {
    "crest_factor": quantities.CREST_LIMIT,
    "mtvv_ratio": quantities.MTVV_LIMIT,
    "vdv_ratio": quantities.VDV_LIMIT,
}
"""Beyond which the rms alone may underrate a vibration."""


def jerk(study: Study) -> Table:
    """Sections whose jerk leaves what standing and seated passengers accept (sec:back_motivation)."""
    first = study.sites[0].thresholds
    columns = [
        Column("axis", ("", "Jerk along")),
        Column("style", ("", "Passengers")),
        Column("lower", ("Band [m/s³]", "lower"), ".2f"),
        Column("upper", ("Band [m/s³]", "upper"), ".2f"),
    ]
    for site in study.sites:
        columns += [
            Column(f"{site.name}_C", (site.label, "$C$ [-]"), "d"),
            Column(f"{site.name}_R_c", (site.label, "$R_c$ [%]"), ".2f"),
            Column(f"{site.name}_runs", (site.label, "per run [%]"), ".2f"),
        ]
    rows = []
    for axis in first["jerk"].values.tolist():
        for style in first["jerk_style"].values.tolist():
            band = first.sel(jerk=axis, jerk_style=style)
            row = [axis[-1], style.replace("_", " "), float(band["jerk_lower"]), float(band["jerk_upper"])]
            for site in study.sites:
                found = site.thresholds.sel(jerk=axis, jerk_style=style)
                row += [
                    int(found["jerk_critical_count"]),
                    float(found["jerk_critical_share"]),
                    float(found["jerk_run_share"].mean()),
                ]
            rows.append(tuple(row))
    sources = tuple(
        Source(
            site.label,
            site.files.get("thresholds", ""),
            "jerk_lower, jerk_upper, jerk_critical_count, jerk_critical_share, jerk_run_share",
            "as in the file; per run: mean over the runs",
        )
        for site in study.sites
    )
    origins = dict.fromkeys(str(text) for text in first["jerk_source"].values.ravel())
    notes = (
        "Jerk of the driver's manoeuvres: of the acceleration behind a low-pass of 2 Hz. "
        "Bands: " + "; ".join(literal(origin) for origin in origins) + ".",
    )
    caption = catalogue.COMFORT_TABLES["jerk"]
    break_ = len(rows) // 2
    return Table("jerk", caption, tuple(columns), tuple(rows), sources, notes_with_standin(study, notes), breaks=(break_,))


def vibration(study: Study) -> Table:
    """The quantities of ISO 2631-1 of a pass over each site, by axis, and what the standard advises."""
    columns = (
        Column("site", ("Site",)),
        Column("axis", ("Axis",)),
        Column("a_w", ("$a_w$ [m/s²]",), ".3f"),
        Column("mtvv", ("MTVV [m/s²]",), ".3f"),
        Column("vdv", ("VDV [m/s^1.75]",), ".2f"),
        Column("evdv", ("eVDV [m/s^1.75]",), ".2f"),
        Column("crest_factor", ("Crest factor [-]",), ".1f"),
        Column("mtvv_ratio", ("MTVV / $a_w$ [-]",), ".2f"),
        Column("vdv_ratio", ("VDV / ($a_w$ T^1/4) [-]",), ".2f"),
        Column("beyond_rms_pct", ("Runs whose rms does not suffice [%]",), ".0f"),
    )
    rows, sources = [], []
    for site in study.sites:
        found = site.iso2631
        root = found["duration"] ** 0.25
        felt = found["weighted_rms"].where(found["weighted_rms"] >= quantities.UNFELT)
        ratios = {"crest_factor": found["crest_factor"], "mtvv_ratio": found["mtvv"] / felt, "vdv_ratio": found["vdv"] / (felt * root)}
        beyond = sum(ratios[name] > limit for name, limit in LIMITS.items()) > 0
        means = {"a_w": found["weighted_rms"], "mtvv": found["mtvv"], "vdv": found["vdv"]}
        means |= {"evdv": 1.4 * found["weighted_rms"] * root, **ratios, "beyond": 100.0 * beyond}
        for axis in found["axis"].values.tolist():
            cells = (float(values.sel(axis=axis).mean("run")) for values in means.values())
            rows.append((site.label, symbol(axis), *cells))
        variables = "weighted_rms, mtvv, vdv, crest_factor, duration"
        rule = "mean over the runs; ratios and eVDV (1.4 a_w T^1/4) of each run"
        sources.append(Source(site.label, site.files.get("iso2631", ""), variables, rule))
    notes = (
        "Without multiplying factors, over the evaluated stretch. The rms does not suffice where the crest factor passes "
        f"{quantities.CREST_LIMIT:g}, MTVV / $a_w$ {quantities.MTVV_LIMIT:g} or VDV / ($a_w$ T^1/4) "
        f"{quantities.VDV_LIMIT:g}: report MTVV or VDV too (ISO 2631-1:1997, 6.2.2 and 6.3.3). "
        f"No ratio where nothing is felt ($a_w$ below {quantities.UNFELT:g} m/s²).",
    )
    caption = catalogue.COMFORT_TABLES["vibration"]
    breaks = tuple(range(3, len(rows), 3))
    notes = notes_with_standin(study, notes)
    return Table("vibration", caption, columns, tuple(rows), tuple(sources), notes, breaks=breaks)


def exposure_table(study: Study) -> Table:
    """A(8), VDV, MSDV_z and illness rating of a trip that repeats the site, mean and largest of the runs."""
    trip = study.settings["comfort"]["exposure"]["trip"]
    columns = (
        Column("site", ("", "Site")),
        Column("run", ("", "Runs")),
        Column("duration_s", ("", "One pass [s]"), ".1f"),
        Column("worst_axis", ("Health", "worst axis by $a_w$")),
        Column("rms", ("Health", "$k a_w$ [m/s²]"), ".3f"),
        Column("a8", ("Health", "A(8) [m/s²]"), ".3f"),
        Column("rms_zone", ("Health", "zone by $a_w$")),
        Column("vdv", ("Health", "largest VDV [m/s^1.75]"), ".2f"),
        Column("vdv_zone", ("Health", "zone by VDV")),
        Column("msdv_z", ("Motion sickness", "MSDV_z [m/s^1.5]"), ".2f"),
        Column("vomiting_pct", ("Motion sickness", "may vomit [%]"), ".2f"),
        Column("illness_rating", ("Motion sickness", "illness rating, 0 to 3 [-]"), ".2f"),
    )
    zone = exposure.rms_zone(trip)
    rows, sources = [], []
    for site in study.sites:
        found = exposure.of_runs(site.iso2631, trip)
        for title, reduce in (("mean", "mean"), ("largest", "max")):
            value = {name: float(getattr(found[name], reduce)()) for name in found if name != "worst_axis"}
            rows.append(
                (
                    site.label,
                    title,
                    float(getattr(site.iso2631["duration"], reduce)()),
                    symbol(str(found["worst_axis"].values)),
                    value["rms"],
                    value["a8"],
                    zone.place(value["rms"]),
                    value["vdv"],
                    exposure.DOSE_ZONE.place(value["vdv"]),
                    value["msdv_z"],
                    value["vomiting_share"],
                    value["illness_rating"],
                )
            )
        sources.append(
            Source(
                site.label,
                site.files.get("iso2631", ""),
                "weighted_rms, vdv, msdv_z, duration",
                "of each run over a trip that repeats the site (comfort/exposure.py, of_runs); mean and largest of the runs",
            )
        )
    notes = (
        f"A site is driven in minutes; health and sickness take hours. The figures are those of {trip / 60:g} min a day "
        "spent on nothing but this site, over and over (comfort.exposure.trip); rms as over one pass, VDV with the fourth "
        "and MSDV with the square root of the number of passes.",
        f"Caution zone of $a_w$ for that time {zone.lower:.2f} to {zone.upper:.2f} m/s² (ISO 2631-1:1997, B.3.1, $k$ = 1.4 on "
        f"x and y), of VDV {exposure.DOSE_ZONE.lower:g} to {exposure.DOSE_ZONE.upper:g} m/s^1.75. Sickness: vertical motion "
        "only, 1/3 % and 1/50 of the illness rating per m/s^1.5 (ISO 2631-1:1997, D.3; Lawther and Griffin 1987); a pass of "
        "some minutes says little of motion near 0.1 Hz.",
    )
    caption = catalogue.COMFORT_TABLES["exposure"]
    breaks = tuple(range(2, len(rows), 2))
    return Table("exposure", caption, columns, tuple(rows), tuple(sources), notes_with_standin(study, notes), breaks=breaks)
