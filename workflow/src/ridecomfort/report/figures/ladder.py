"""The error ladder: the error falls from model to model, down to the floor."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.transforms import offset_copy

from ...discrepancy import ladder as rungs
from ...vocabulary import SIGNALS
from .. import catalogue, notation, style
from ..study import Difference
from ..tables.ladder import METHODS, rung_title

TITLES = {rungs.FITTED: "fitted drives", rungs.HELD_OUT: "drives held out"}
LOOKS = {
    "thresholds": {"color": "#6A3D9A", "marker": "p", "markersize": 4},
    "iso2631": {"color": style.MEASURED, "marker": "h", "markersize": 4, "markerfacecolor": "white"},
}
DASHES = {"thresholds": (0, (4, 10)), "iso2631": (7, (4, 10))}
"""Lines of the repeats by method, dashes of one amid the gaps of the other where they coincide: a dashed line of two colours."""

LINEAR, TICKS = 10.0, (0, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""% up to which the axis of the error is linear, and logarithmic beyond, so that the last falls are seen beside the first; its ticks."""

HIGHEST, ROOM = 1000.0, 1.15
"""% at which the axis ends at the latest, whatever an uncalibrated model leaves, and times the largest error at which it does else: room for
its marker."""

APART = 5.0
"""Points between the markers at the top of the axis of signals that lie above it on the same rung."""

LEGIBLE = (withStroke(linewidth=2.0, foreground="white"),)
"""What keeps words readable over lines and markers."""

NUMBERS = 3.5
"""Points above a panel at which the numbers of its rungs stand, clear of lines and of markers at its top."""

LONGEST = 16
"""Letters in a line under a rung."""

NONE_LEFT = "the model that is 100 %\nleaves nothing above the floor\n(rms: error_ladder.md)"
"""What a panel says that has no line."""

CROWDED, SMALL = 0.45, 5.0
"""Inches a rung below which its name stands upright in one line, and points of the print of such names and numbers."""


def error_ladder(study: Difference) -> Figure:
    """Explainable error left on every rung, fitted and held out, a column a site; below, sections graded unlike measured."""
    found = study.ladder
    sites = [str(site) for site in found["site"].values]
    groups = [str(group) for group in found["group"].values if np.isfinite(found["rmse"].sel(group=group)).any()]
    rows = len(groups) + 1
    is_crowded = style.DOUBLE < CROWDED * len(sites) * found.sizes["rung"]
    drawn = style.figure(style.DOUBLE, 1.1 + 2.0 * rows + (0.4 if is_crowded else 0.0))
    panels = drawn.subplots(rows, len(sites), sharex=True, sharey="row", squeeze=False)
    places, blank = np.arange(found.sizes["rung"]), []
    for column, site in enumerate(sites):
        for axes, group in zip(panels[:, column], groups):
            chosen = found.sel(site=site, group=group)
            if np.isfinite(chosen["rmse"]).any():
                axes.set_title(f"{catalogue.label(site)}, {TITLES[group]}", pad=13)
                _left(axes, chosen, places, SMALL if is_crowded else 6.0)
            else:
                axes.set_axis_off()
                blank.append(axes)
        _sections(panels[-1, column], found.sel(site=site), groups, places)
        panels[-1, column].set_title(f"{catalogue.label(site)}, all drives")
        titles = [rung_title(str(name)) for name in found["rung"].values]
        if is_crowded:
            panels[-1, column].set_xticks(places, titles, rotation=90, fontsize=SMALL)
        else:
            panels[-1, column].set_xticks(places, map(_wrapped, titles), rotation=30, ha="right", rotation_mode="anchor")
        panels[-1, column].set_xlim(-0.3, places[-1] + 0.3)
    for row in panels[:-1]:
        first = next(axes for axes in row if axes.axison)
        first.set_ylabel("explainable error left [%]")
        first.tick_params(labelleft=True)
        left = 100 * np.nan_to_num(found["left"].values)  # of what had nothing above the floor nothing is left
        highest, lowest = min(ROOM * max(left.max(), 100.0), HIGHEST), min(0.0, left.min())
        first.set_yscale("symlog", linthresh=LINEAR)
        first.set_yticks([tick for tick in TICKS if tick <= highest], [f"{tick}" for tick in TICKS if tick <= highest])
        first.set_ylim(max(lowest, -HIGHEST) - 0.05 * LINEAR, highest)
    panels[-1, 0].set_ylabel("sections unlike measured [%]")
    panels[-1, 0].set_ylim(bottom=0.0)
    key = lambda look, label: Line2D([], [], color=look[0], marker=look[1], markersize=3.5, label=label)  # noqa: E731
    lines = [key(look, notation.signal(signal)) for signal, look in style.SIGNAL_LINES.items()]
    lines.append(Line2D([], [], color="black", linewidth=2.2, label="all signals (numbers above)"))
    lines.append(Line2D([], [], color=style.FLOOR, linestyle="--", label="floor"))
    lines += [Line2D([], [], **look, label=f"{METHODS[name]}, model") for name, look in LOOKS.items()]
    if np.isfinite(found["repeats_agreeing"]).any():
        begun = lambda name: {**_repeats(name), "linestyle": (0, DASHES[name][1])}  # noqa: E731
        lines += [Line2D([], [], **begun(name), label=f"{title}, repeats") for name, title in METHODS.items()]
    if blank:
        blank[0].legend(handles=lines, loc="center left", ncols=2).set_in_layout(False)
    else:
        drawn.legend(handles=lines, loc="outside upper center", ncols=5)
    return drawn


def _left(axes, chosen: xr.Dataset, places: np.ndarray, size: float) -> None:
    """Lines of what each signal, and all of them, leave on every rung, in percent of the reference."""
    for signal in SIGNALS:
        colour, marker = style.SIGNAL_LINES[signal]
        values = 100 * chosen["left"].sel(signal=signal).values
        axes.plot(*_known(places, values), color=colour, marker=marker, markersize=3.5)
    overall = _known(places, 100 * chosen["left_overall"].values)
    axes.plot(*overall, color="black", linewidth=2.2, zorder=1)
    if not np.isfinite(chosen["left"]).any():
        axes.text(0.5, 0.5, NONE_LEFT, transform=axes.transAxes, ha="center", va="center", path_effects=LEGIBLE)
    at = offset_copy(axes.get_xaxis_transform(), axes.figure, y=NUMBERS, units="points")
    for place, value in zip(*overall):
        number = f"{value:.0f}" if value >= LINEAR else f"{value:.1f}"
        axes.text(place, 1.0, number, transform=at, ha="center", va="bottom", fontsize=size, fontweight="bold")
    _above(axes, chosen, places)
    most = 100 * np.nan_to_num(chosen["left"].values).max(axis=chosen["left"].dims.index("rung"))
    beyond = [f"{notation.signal(str(chosen['signal'].values[k]))} {most[k]:,.0f} %" for k in np.argsort(-most) if most[k] > HIGHEST]
    if beyond:
        axes.text(
            0.99, 0.97, "\n".join(["above the axis (at its top), up to:", *beyond]), transform=axes.transAxes, ha="right", va="top", fontsize="x-small",
            path_effects=LEGIBLE,
        )  # fmt: skip
    axes.axhline(0.0, color=style.FLOOR, linestyle="--")
    axes.yaxis.grid(True)


def _above(axes, chosen: xr.Dataset, places: np.ndarray) -> None:
    """The marker of each signal that lies above the axis on a rung, side by side at its top."""
    for place, left in zip(places, 100 * chosen["left"].transpose("rung", "signal").values):
        signals = [str(name) for name in chosen["signal"].values[left > HIGHEST]]
        for number, signal in enumerate(signals):
            aside = APART * (number - 0.5 * (len(signals) - 1))
            at = offset_copy(axes.get_xaxis_transform(), axes.figure, x=aside, units="points")
            colour, marker = style.SIGNAL_LINES[signal]
            axes.plot(place, 1.0, color=colour, marker=marker, markersize=3.5, clip_on=False, transform=at)


def _sections(axes, chosen: xr.Dataset, groups, places: np.ndarray) -> None:
    """Lines of the share of sections that replays grade otherwise than measured; dashed, repeats among themselves."""
    part = chosen.sel(group=groups)
    for method, look in LOOKS.items():
        own = part.sel({"method": method})
        compared = own["compared"].sum("group").values
        unlike = 100 * (compared - own["agreeing"].sum("group").values) / np.where(compared > 0, compared, np.nan)
        axes.plot(*_known(places, unlike), **look)
        repeats = own["repeats_agreeing"].values
        known = np.isfinite(repeats)
        if known.any():
            sections = np.nan_to_num(own["compared"].max("rung").values)[known]
            axes.axhline(100 * (1 - np.average(repeats[known], weights=sections)), **_repeats(method))
    axes.yaxis.grid(True)


def _repeats(method: str) -> dict:
    """How the line is drawn of sections that repeats grade unlike one another."""
    return {"color": LOOKS[method]["color"], "linestyle": DASHES[method], "linewidth": 0.8}


def _known(places: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    known = np.isfinite(values)
    return places[known], values[known]


def _wrapped(title: str) -> str:
    """A title over as few lines as hold it."""
    lines = [""]
    for word in title.split(" "):
        if lines[-1] and len(lines[-1]) + len(word) >= LONGEST:
            lines.append(word)
        else:
            lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)
