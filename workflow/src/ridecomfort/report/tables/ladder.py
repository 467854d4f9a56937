"""The error ladder, and what it does to the comfort result."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ...discrepancy import critical, judged
from ...discrepancy import ladder as rungs
from ...discrepancy.explain import STRETCH
from ...vocabulary import SIGNALS
from .. import catalogue, notation
from ..study import Difference, foot_notes
from ..table import Column, Source, Table
from ..units import printed

METHODS = {key: notation.METHODS[key] for key in critical.METHODS}
FLOOR = "lowest floor"

NOT_CALIBRATED = (
    "Nothing is calibrated{where}: effects have the sizes that they are configured with, and one that does not help may only have the wrong size"
)
"""What is said of a ladder, or of the sites in it, whose models have no calibrated vehicle."""


def rung_title(name: str) -> str:
    """A rung in print: names of effects in words."""
    return notation.words(name) if name.startswith("+") else name


def error_ladder(study: Difference) -> Table:
    """Error and share of the explainable error left, by site, group of drives, rung and signal; the floor last."""
    columns = [Column("site", ("", "Site")), Column("drives", ("", "Drives")), Column("model", ("", "Model"))]
    for signal in SIGNALS:
        title = f"{notation.signal(signal)} [{printed(signal)[1]}]"
        unit = printed(signal)[1].replace("/", "_per_").replace("²", "2")
        columns.append(Column(f"{signal}_rmse_{unit}", (title, "RMSE"), ".4f"))
        columns.append(Column(f"{signal}_left_pct", (title, "left [%]"), ".0f"))
    of_all_signals = len(columns)
    columns.append(Column("all_left_pct", ("All signals", "left [%]"), ".1f"))
    columns.append(Column("all_fall_pct", ("All signals", "fall [% points]"), ".1f"))
    columns.append(Column("all_falling_pct", ("All signals", "stretches falling [%]"), ".0f"))
    columns.append(Column("all_helps", ("All signals", "helps")))
    rows, breaks, bold = [], [], set()
    for site, group, chosen in _groups(study.ladder):
        breaks.append(len(rows))
        higher = np.nan
        for rung in chosen["rung"].values:
            one = chosen.sel(rung=rung)
            if not np.isfinite(one["rmse"]).any():
                continue
            cells = []
            for signal in SIGNALS:
                own = one.sel(signal=signal)
                cells += [printed(signal)[0] * float(own["rmse"]), 100 * float(own["left"])]
            bold.add((len(rows), of_all_signals))
            left = 100 * float(one["left_overall"])
            of_all = left, higher - left, 100 * float(one["falling"]), rungs.helps((higher - left) / 100, float(one["fall_p_value"]))
            rows.append((catalogue.label(site), group, rung_title(str(rung)), *cells, *of_all))
            higher = left
        floor = [[printed(signal)[0] * float(chosen["floor_rmse"].sel(signal=signal)), 0] for signal in SIGNALS]
        rows.append((catalogue.label(site), group, FLOOR, *np.ravel(floor).tolist(), 0, None, None, ""))
    file = study.ladder_file
    sources = (
        Source("RMSE", file, "rmse, floor_rmse", "root of the mean square over the drives"),
        Source("left", file, "left, left_overall", f"mean square above the floor over that of {_reference(study)}"),
        Source("fall", file, "left_overall", "of the row above less this"),
        Source("stretches falling", file, "falling", "in percent"),
        Source("helps", file, "left_overall, fall_p_value", f"p up to {rungs.LEVEL:g}, fall from {100 * rungs.WORTHWHILE:g} % on"),
    )
    known = zip(study.ladder["site"].values, study.ladder["floor_known"].values)
    floors = [f"{catalogue.label(str(site))}: floor {how}" for site, how in known]
    titled = study.ladder.assign_coords(
        rung=[rung_title(str(rung)) for rung in study.ladder["rung"].values],
        signal=[notation.signal(str(name)) for name in study.ladder["signal"].values],
    )
    notes = (
        f"RMSE: of the error from {judged.IN_WORDS}; slower errors are drifts of instruments and what the driver makes of the path. "
        f"Left: error above the floor, as a share of what {_reference(study)} leaves; – where a signal had nothing above the floor. "
        f"{_how_calibrated(study)} All signals: each weighs as "
        f"much as there was to explain of its own error. Fall: from the row above, and in how many of the stretches of {STRETCH:g} m that "
        f"these drives have. A model helps where chance makes it fall so in at most one of {1 / rungs.LEVEL:.0f} cases (Wilcoxon's signed ranks of "
        f"the stretches), little where it falls by less than {100 * rungs.WORTHWHILE:g} %. What helps drives held out on no site is to be taken out "
        f"again, if it does not help after the others either: the order of effects in config/study.yaml is that of the rows. "
        f"Drives of less than {rungs.FEWEST} stretches do not tell. Every comparison has a floor of its own; all "
        "models are measured against the lowest floor, the least of the models shown. With fewer models it may lie higher, so that the same model "
        "leaves less above it, a signal perhaps nothing, which does not count among all then. The diagnosis tells other shares: it takes all sites together, aligns their drives more often and fits what is uncertain of the vehicle.",
        *_of_reference(study),
        "; ".join(floors) + ".",
        *(f"{catalogue.label(site)}: {words}." for site, words in _remarks(titled)),
    )
    return _table(study, "error_ladder", columns, rows, sources, notes, breaks[1:], frozenset(bold))


def error_ladder_sections(study: Difference) -> Table:
    """Critical sections of the replays on every rung beside those of the measured drives, by method."""
    columns = [Column("site", ("", "Site")), Column("drives", ("", "Drives")), Column("model", ("", "Model"))]
    for key, title in METHODS.items():
        columns += [
            Column(f"{key}_simulated", (title, "simulated"), ".0f"),
            Column(f"{key}_measured", (title, "measured"), ".0f"),
            Column(f"{key}_agreeing_pct", (title, "alike [%]"), ".1f"),
            Column(f"{key}_changed", (title, "changed"), ".0f"),
            Column(f"{key}_changed_in_all", (title, "in all"), ".0f"),
        ]
    columns.append(Column("sections", ("", "Sections"), ".0f"))
    rows, breaks = [], []
    for site, group, chosen in _groups(study.ladder):
        breaks.append(len(rows))
        for rung in chosen["rung"].values:
            one = chosen.sel(rung=rung)
            if not np.isfinite(one["compared"]).any():
                continue
            cells = []
            for method in METHODS:
                own = one.sel({"method": method})
                alike = 100 * float(own["agreeing"]) / max(float(own["compared"]), 1.0)
                cells += [float(own["critical_simulated"]), float(own["critical_measured"]), alike, float(own["changed"]), float(own["changed_in_all"])]
            compared = float(one["compared"].isel({"method": 0}))
            rows.append((catalogue.label(site), group, rung_title(str(rung)), *cells, compared))
        repeats = [[None, None, 100 * float(chosen["repeats_agreeing"].sel({"method": method})), None, None] for method in METHODS]
        if np.isfinite(chosen["repeats_agreeing"]).any():
            rows.append((catalogue.label(site), group, "repeats among themselves", *sum(repeats, []), None))
    sources = (
        Source("simulated, measured", study.ladder_file, "critical_simulated, critical_measured", "sum over the drives"),
        Source("alike, changed", study.ladder_file, "agreeing, compared, changed, changed_in_all, repeats_agreeing", "share of the sections in percent"),
    )
    notes = (
        "Sections of the measured drives and of the model on the same path at the same speed, at the place of the sensor. Critical: "
        "by thresholds, some acceleration leaves the band of at least the mildest driving style in the whole section; by ISO 2631, "
        "the total value lies above the lower edge of the second band in the whole section. Alike: same style or band as measured. "
        f"Changed: other style or band than on the rung before; in all: than with {_reference(study)}. Repeats differ among themselves in speed and path, which a replay follows: "
        "a good model may agree better with a drive than its repeats do.",
        *foot_notes(study.sites),
    )
    return _table(study, "error_ladder_sections", columns, rows, sources, notes, breaks[1:])


def _reference(study: Difference) -> str:
    """The model whose error is the 100 %; a site on which nothing is calibrated has another than those beside it."""
    if study.ladder.attrs["reference"] == rungs.UNCALIBRATED:
        return "the uncalibrated base model"
    others = ", ".join(_uncalibrated(study))
    return "the calibrated base model" + (f" (on {others} the uncalibrated one)" if others else "")


def _uncalibrated(study: Difference) -> list[str]:
    """Sites in print on which nothing is calibrated."""
    has_none = ~np.isfinite(study.ladder["rmse"].sel(rung=rungs.CALIBRATED)).any(["group", "signal"])
    return [catalogue.label(site) for site in study.ladder["site"].values[has_none].tolist()]


def _how_calibrated(study: Difference) -> str:
    """What is fitted to which drives before models are compared, in sentences."""
    uncalibrated = _uncalibrated(study)
    if len(uncalibrated) == study.ladder.sizes["site"]:
        return f"{NOT_CALIBRATED.format(where='')}. All drives are aligned for each model."
    but = f" ({NOT_CALIBRATED.format(where=' on ' + ', '.join(uncalibrated))})" if uncalibrated else ""
    return (
        f"Every model is calibrated anew on the fitted drives{but}, and all drives are aligned for it (for uncalibrated as for calibrated); "
        "nothing else is ever fitted to the others."
    )


def _of_reference(study: Difference) -> list[str]:
    """What the 100 % of a calibrated base model are made of."""
    if study.ladder.attrs["reference"] != rungs.CALIBRATED:
        return []
    names = dict.fromkeys(name for each in study.calibrations.values() for name in each["parameter"].values.tolist() if "." not in name)
    return [
        f"100 % are what the base model leaves with {', '.join(names)} calibrated. With others calibrated they are other 100 %: "
        "compare such ladders by their RMSE."
    ]


def _remarks(titled: xr.Dataset) -> list[tuple[str, str]]:
    """Site and words for what the numbers of a ladder do not say of themselves."""
    return [*rungs.risen(titled), *rungs.worsened(titled), *rungs.disagreeing(titled)]


def _groups(found: xr.Dataset):
    """Site, group and part of the ladder wherever there are such drives."""
    for site in found["site"].values:
        for group in found["group"].values:
            chosen = found.sel(site=site, group=group)
            if np.isfinite(chosen["rmse"]).any():
                yield str(site), str(group), chosen


def _table(study: Difference, name, columns, rows, sources, notes, breaks, bold=frozenset()) -> Table:
    notes = (*notes, *filter(None, [study.standin_note()]))
    caption = catalogue.DIFFERENCE_TABLES[name]
    return Table(name, caption, tuple(columns), tuple(rows), sources, notes, bold=bold, breaks=tuple(breaks))
