"""What is missing, a force mostly, against what it could depend on: to be checked by eye."""

from __future__ import annotations

from textwrap import fill

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.stats import norm

from ...identifiability import CONFIDENCE
from .. import style
from ..notation import words
from ..study import Diagnosis

HALF_WIDTH = float(norm.ppf(0.5 + CONFIDENCE / 2))
"""Standard errors of half a 90 % interval."""

POORLY_KNOWN = 8.0
"""Times the usual standard error beyond which an estimate is not drawn: where the car was hardly ever."""

SHOWN = {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "1": (100.0, "%"), "N": (1.0, "N"), "m/s": (1.0, "m/s")}
"""Factor to, and unit in which a unit is shown."""

LEAST_REACH = {"N": 30.0, "rad": 5e-4, "1": 0.03}
"""By unit, what the scale of a panel reaches at least: what is smaller is none to look for a cause in, and looks flat."""

EXPLAINS, SURELY, PALE = 0.01, 5.0, 0.4
"""Share of the error below which curves are pale, unless they reach beyond LEAST_REACH by so many standard errors, and how pale: mostly they
show traces of what is missing elsewhere, or chance."""

ROW, LONGEST, IN_LEGEND = 1.9, 20, 48
"""Inches of a row of panels, letters in a line beside it and of one in the legend."""

READ = "Levels do not show, nor do lines in what one strut or tyre sees: calibration could take them up."
"""How the figure is read."""

NONE_EXPLAINS = f"No curve explains {100 * EXPLAINS:.0f} % of the error, noise included, or is surely large: all are pale."
"""What it says where none does."""

AXLE_LINES = {"front": ("#0072B2", "o"), "rear": ("#009E73", "s")}


def signature(found: Diagnosis) -> Figure:
    """Estimates of what is missing with their 90 % intervals, a row each thing that it may depend on, a column each axle, one scale for all
    panels of what acts at the same place, and what was found would show together."""
    ranking = found.ranking
    if "missing" not in ranking:
        drawn = style.figure(style.DOUBLE, ROW)
        axes = drawn.subplots()
        axes.set_axis_off()
        axes.text(0.5, 0.5, "The missing force was not estimated.", ha="center")
        return drawn
    places, axles = ranking["seen"].values, ranking["axle"].values
    drawn = style.figure(style.DOUBLE, ROW * len(places))
    panels = drawn.subplots(len(places), len(axles), squeeze=False, sharex="row", sharey="row")
    rows = {str(place): ranking.sel(seen=place) for place in places}
    reaches = {kind: max(_reach(one) for one in rows.values() if _kind(one) == kind) for kind in map(_kind, rows.values())}
    explains = {place: bool(one["seen_share"] >= EXPLAINS) or _is_surely_large(one) for place, one in rows.items()}
    for panel, (place, one) in zip(panels, rows.items()):
        factor, unit = SHOWN[str(one["seen_unit"].item())]
        times, missing_unit = SHOWN[str(one["missing_unit"].item())]
        reach, share = reaches[_kind(one)], 100 * float(one["seen_share"])
        strength = 1.0 if explains[place] else PALE
        for axes, axle in zip(panel, axles):
            own = one.sel(axle=axle)
            missing, error = times * own["missing"].values, times * HALF_WIDTH * own["missing_error"].values
            known = _known(one).sel(axle=axle).values
            at = factor * own["seen_at"].values
            colour, marker = AXLE_LINES[str(axle)]
            axes.axhline(0.0, color=style.FLOOR, linewidth=0.7)
            axes.fill_between(at[known], (missing - error)[known], (missing + error)[known], color=colour, alpha=0.2 * strength, linewidth=0)
            axes.plot(at[known], missing[known], color=colour, marker=marker, markersize=3.5, alpha=strength)
            axes.plot(at[known], times * own["named_missing"].values[known], color=style.ERROR, linestyle="--", alpha=strength)
            axes.set_ylim(-times * reach, times * reach)
            axes.set_title(f"{axle} {place}" + (f"; both: {share:.0f} % of the error" if axes is panel[-1] else ""))
            axes.set_xlabel(f"{one['seen_axis'].item()} [{unit}]")
        panel[0].set_ylabel(fill(f"{one['missing_what'].item()} [{missing_unit}]", LONGEST))
    proposal = (found.verdict.get("proposal") or {}) if found.verdict["verdict"] == "outside" else {}
    names = proposal.get("beside") or () if proposal.get("form") else [effect["name"] for effect in found.verdict["effects"]]
    together = " and ".join([*map(words, names), *(["the proposed form"] if proposal.get("form") else [])])
    handles = [
        Line2D([], [], color=colour, marker=marker, markersize=3.5, label=f"estimated, {axle}")
        for axle, (colour, marker) in AXLE_LINES.items()
    ]
    handles.append(Patch(color=style.FAINT, alpha=0.5, label="90 % interval"))
    if ranking["named_missing"].notnull().any():
        handles.append(Line2D([], [], color=style.ERROR, linestyle="--", label=fill(f"what would show: {together}", IN_LEGEND)))
    drawn.legend(handles=handles, loc="outside upper center", ncols=3, title=READ if any(explains.values()) else f"{READ}\n{NONE_EXPLAINS}", title_fontsize=7)
    return drawn


def _kind(one) -> tuple[str, str]:
    """What something acts on, the strut or the tyre say, and as what: panels of the same have one scale."""
    return str(one["seen"].item()).split()[0], str(one["missing_what"].item())


def _reach(one) -> float:
    """What a row of panels shows: the estimates that are drawn, with their intervals, and what the named effects would show."""
    known = _known(one).values
    estimated = np.abs(one["missing"]) + HALF_WIDTH * one["missing_error"]
    shown = np.abs(one["named_missing"].fillna(0.0))
    reach = np.maximum(estimated, shown).values[known]
    return max(1.1 * float(reach.max(initial=0.0)), LEAST_REACH[str(one["missing_unit"].item())])


def _is_surely_large(one) -> bool:
    """Whether an estimate reaches beyond what is small and is surely another than none there."""
    size = np.abs(one["missing"])
    is_large = (size > LEAST_REACH[str(one["missing_unit"].item())]) & (size > SURELY * one["missing_error"])
    return bool((is_large & _known(one)).any())


def _known(one):
    """Whether (axle, knot) an estimate is about as well known as most of them of its row."""
    error = one["missing_error"].where(np.isfinite(one["missing"]))
    return error <= max(POORLY_KNOWN * float(error.median()), 1e-9)
