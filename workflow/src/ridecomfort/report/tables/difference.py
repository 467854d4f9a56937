"""How drives were aligned, where the error sits, and how much of it could be explained."""

from __future__ import annotations

import numpy as np

from ...discrepancy import findings as located
from ...discrepancy import judged, ladder
from ...vocabulary import SIGNALS
from .. import catalogue, notation
from ..study import Compared, Difference
from ..table import Column, Source, Table
from ..units import printed

JUDGED = f"From {judged.LOWEST:g} Hz on, this model"
"""Heading of what is told of the frequencies that a model answers for."""

MOUNTING = ("mounting_roll", "mounting_pitch", "mounting_yaw", "acceleration_gain")
"""What alignment seeks in drives only whose accelerations hold gravity."""

DOUBTS = ("distance_doubt", "alignment_doubt")
"""Attributes of aligned drives with what speaks against their distances, and why they are not aligned for the model."""


def alignment(study: Difference) -> Table:
    """What stood between each record and its road."""
    shown = (
        ("clock_offset", "clock_offset_ms", ("Clock offset [ms]", "found"), ".1f", 1e3),
        ("clock_offset_error", "clock_offset_error_ms", ("Clock offset [ms]", "std. error"), ".2f", 1e3),
        ("speed_scale", "speed_scale", ("Speed scale", "[-]"), ".4f", 1.0),
        ("lateral_correction", "lateral_correction_m", ("Path [m]", "to the left"), ".3f", 1.0),
        ("lateral_wander", "lateral_wander_m", ("Path [m]", "wander, rms"), ".3f", 1.0),
        ("distance_wander", "distance_wander_m", ("Distance [m]", "wander, rms"), ".3f", 1.0),
        ("mounting_roll", "mounting_roll_deg", ("Mounting [deg]", "roll"), ".2f", 180 / np.pi),
        ("mounting_pitch", "mounting_pitch_deg", ("Mounting [deg]", "pitch"), ".2f", 180 / np.pi),
        ("mounting_yaw", "mounting_yaw_deg", ("Mounting [deg]", "yaw"), ".2f", 180 / np.pi),
        ("acceleration_gain", "acceleration_gain", ("Gain [-]", "acceleration"), ".4f", 1.0),
        ("yaw_rate_gain", "yaw_rate_gain", ("Gain [-]", "yaw rate"), ".3f", 1.0),
    )
    columns = [Column("site", ("", "Site")), Column("drive", ("", "Drive")), Column("role", ("", "Role"))]
    columns += [Column(key, heading, form) for _, key, heading, form, _ in shown]
    rows, sources, breaks = [], [], []
    for site in study.sites:
        breaks.append(len(rows))
        for name in site.measured["drive"].values:
            own = site.measured.sel(drive=name)
            unknown = MOUNTING if "gravity" in own and not own["gravity"] else ()
            values = [factor * float(own[key]) if key in own and key not in unknown else None for key, _, _, _, factor in shown]
            rows.append((site.label, notation.literal(name), str(own["role"].item()), *values))
        names = ", ".join(key for key, *_ in shown)
        sources.append(Source(f"all, {site.label}", site.files.get("measured", ""), names, "as in the file, in the unit printed"))
    notes = (
        "Clock offset: how much later accelerations and rates stand in the record than distance and speed; its error is "
        "that by noise, what the model lacks may shift it by milliseconds. Speed scale: true "
        "over recorded speed. Mounting: rotation of the instrument against the body. Gains: against gravity, and against the bends of "
        "the road (below 0.2 Hz; none where it hardly bends). Clock, speed scale, path, mounting and the gain against gravity are put right before "
        "anything is compared, the gain against bends is not (mounting and the gain against "
        "gravity only where the record holds gravity): what spoils a comparison is an offset known to milliseconds only, or a gain beside 1. "
        "Role check: nothing is fitted to the drive; nor is it to any of a site whose vehicle is calibrated on another.",
        *(f"{site.label}, {words}." for site in study.sites for words in _of_records(site)),
        *(f"{site.label}: {site.measured.attrs[doubt]}." for site in study.sites for doubt in DOUBTS if site.measured.attrs.get(doubt)),
    )
    return _table(study, "alignment", columns, rows, sources, notes, breaks[1:])


def _of_records(site: Compared) -> list[str]:
    """What was done to the records of a site's drives, and what speaks against them, one a drive; not of those without either."""
    texts = [site.measured[key].values if key in site.measured else np.full(site.measured.sizes["drive"], "") for key in ("treatment", "faults")]
    said = {name: [str(text) for text in both if text not in ("", "none")] for name, *both in zip(site.measured["drive"].values, *texts)}
    return [f"{notation.literal(str(name))}: {'; '.join(parts)}" for name, parts in said.items() if parts]


def findings(study: Difference) -> Table:
    """The largest errors of every site in words and numbers."""
    columns = (
        Column("site", ("", "Site")),
        Column("number", ("", "No."), "d"),
        Column("signal", ("", "Signal")),
        Column("band_Hz", ("", "Band [Hz]")),
        Column("where", ("", "Where")),
        Column("when", ("", "Relatively most at")),
        Column("power_pct", ("Error above the floor", "[% of the signal's power]"), ".1f"),
        Column("explainable_pct", ("Error above the floor", "[% of the explainable]"), ".0f"),
    )
    notes = [
        f"Found is what reaches {100 * located.NAMED:g} % of the signal's power in a band, at most five a site and two of a signal; where nothing "
        "does, the largest. Relatively most: in percent of the signal's power under the same condition."
    ]
    rows, sources, breaks = [], [], []
    for site in study.sites:
        breaks.append(len(rows))
        errors = located.findings(site.comparison)
        for number, each in enumerate(errors, start=1):
            shares = 100 * each.power_share, 100 * each.explainable_share
            band = f"{each.lower:g}–{each.upper:g}"
            rows.append((site.label, number, notation.signal(each.signal), band, each.where, each.when or "any time", *shares))
        if not errors:
            rows.append((site.label, None, "none", "", "", "", None, None))
        elif located.are_small(errors):
            notes.append(f"{site.label}: nothing reaches {100 * located.NAMED:g} %; told is the largest of what is left.")
        rule = "largest shares over bands, attribute words has them as sentences"
        sources.append(Source(site.label, site.files.get("comparison", ""), "power_share, explainable_share, condition_error", rule))
        notes += [f"{site.label}: {words}" for words in (*located.doubts(site.comparison), *located.gathered(site.comparison))]
        notes.append(f"{site.label}: state {site.comparison.attrs['located_state']}; {floor_note(site)}")
    return _table(study, "findings", columns, rows, sources, notes, breaks[1:])


def explainable(study: Difference) -> Table:
    """RMSE, NRMSE, floor and explainable error of every site, fitted and held-out drives apart."""
    columns = (
        Column("site", ("", "Site")),
        Column("drives", ("", "Drives")),
        Column("signal", ("", "Signal")),
        Column("unit", ("", "Unit")),
        *(Column(f"{key}_{state}", (title, word), ".4f") for key, title in (("rmse", "RMSE, all frequencies"), ("nrmse", "NRMSE, all frequencies [-]"))
          for state, word in (("uncalibrated", "uncalibrated"), ("model", "this model"))),
        Column("floor_rmse", (JUDGED, "RMSE of the floor"), ".4f"),
        Column("explainable_rmse", (JUDGED, "RMSE above the floor"), ".4f"),
        Column("explainable_pct", (JUDGED, "above the floor, of the squared error [%]"), ".0f"),
        Column("left_pct", (JUDGED, "above the floor, of uncalibrated [%]"), ".0f"),
    )  # fmt: skip
    rows, sources, breaks, notes = [], [], [], []
    for site in study.sites:
        for group, drives in _groups(study, site):
            breaks.append(len(rows))
            part = site.comparison.isel(drive=drives)
            for signal in SIGNALS:
                one, (factor, unit) = part.sel(signal=signal), printed(signal)
                mean = lambda name, state, one=one: float(np.sqrt((one[name].isel(state=state) ** 2).mean("drive")))  # noqa: E731
                floor = float(np.sqrt((one["floor_rmse"] ** 2).mean("drive")))
                left, first = mean("explainable_rmse", -1) ** 2, mean("explainable_rmse", 0) ** 2
                errors = [factor * mean("rmse", 0), factor * mean("rmse", -1), mean("nrmse", 0), mean("nrmse", -1)]
                share = 100 * left / (left + floor**2) if left + floor**2 > 0 else None
                rows.append(
                    (site.label, group, notation.signal(signal), unit, *errors, factor * floor, factor * np.sqrt(left), share,
                     100 * left / first if first > 0 else None)
                )  # fmt: skip
        names = "rmse, nrmse, floor_rmse, explainable_rmse"
        sources.append(Source(site.label, site.files.get("comparison", ""), names, "root of the mean square over the drives"))
        notes.append(f"{site.label}: {floor_note(site)}")
    notes.append(
        "NRMSE: RMSE over the range of the measured signal. The floor is what no model of this road and car could explain, "
        "as far as this model shows it: what it lacks differs between repeats, too, so a better one shows a lower floor, and the error "
        f"ladder has the lowest of its models. RMSE and NRMSE are of all frequencies, floor and error above it from {judged.IN_WORDS}: "
        "slower errors are drifts of instruments and what the driver makes of the path."
    )
    return _table(study, "explainable", columns, rows, sources, notes, breaks[1:])


def floor_note(site: Compared) -> str:
    """How the floor of a site is known, as a sentence, which drives nearly repeat others, what of it is no noise, and what is taken for the driver's
    foot."""
    near, driver = (site.comparison.attrs.get(name, "") for name in ("near_repeats", "driver"))
    said = [f"the floor is {_known(str(site.comparison.attrs['floor']))}", notation.literal(near), *located.of_floor(site.comparison), driver]
    return "; ".join(filter(None, said)) + "."


def _known(attribute: str) -> str:
    return "known from drives that repeat one another" if attribute == "from repeats" else attribute


def _groups(study: Difference, site: Compared):
    """The groups of a site's drives that are not empty, with the numbers of the drives."""
    fitted = site.comparison["role"].values == "fit"
    if not np.isfinite(study.ladder["rmse"].sel(site=site.name, group=ladder.FITTED)).any():
        fitted = np.zeros_like(fitted)
    groups = {ladder.FITTED: fitted, ladder.HELD_OUT: ~fitted}
    return [(name, np.flatnonzero(drives)) for name, drives in groups.items() if drives.any()]


def _table(study: Difference, name, columns, rows, sources, notes, breaks) -> Table:
    notes = [*notes, *filter(None, [study.standin_note()])]
    caption = catalogue.DIFFERENCE_TABLES[name]
    return Table(name, f"{caption} Model: {study.model}.", tuple(columns), tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks))
