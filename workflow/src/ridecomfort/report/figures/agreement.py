"""Agreement of the methods, influences on the runs, and the number of runs."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator, StrMethodFormatter

from ...comfort import enough
from ...comfort.agreement import SUBSTANTIAL
from .. import style
from ..notation import symbol, words
from ..study import Study
from ..tables.agreement import measure_title, pair_title, place_title, places, why_no_width

SPREAD = 0.62
"""Height that the marks of one row share; rows are 1 apart."""

RUNS, WIDTHS = (10, 30, 100, 300, 1000, 3000, 10_000), (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
"""Ticks of the axes, which are logarithmic."""

SCHEMES = {"latin_hypercube": ("Latin hypercube", 0), "monte_carlo": ("plain Monte Carlo", 1)}


def agreement(study: Study) -> Figure:
    """Weighted kappa, rank correlation and lag of every pair of methods, per site and pooled."""
    found = study.assessment
    sites, pairs = places(study), found["pair"].values.tolist()
    drawn = style.figure(style.DOUBLE, 1.1 + 0.55 * len(sites))
    panels = drawn.subplots(1, 3, sharey=True)
    quantities = (("kappa", "weighted kappa [-]"), ("spearman", "rank correlation [-]"), ("lag", "lag of the first [m]"))
    for axes, (name, label) in zip(panels, quantities):
        for offset, pair, (colour, marker) in zip(_offsets(len(pairs)), pairs, style.LINES):
            values = found[name].sel(pair=pair, site=sites).transpose("site", "bound").values
            _intervals(axes, np.arange(len(sites)) + offset, values, colour, [marker] * len(sites))
        axes.axvline(0, color=style.FAINT, linewidth=0.6, zorder=0)
        axes.set_xlabel(label)
        axes.margins(x=0.08)
        _rows(axes, [place_title(site) for site in sites])
    panels[0].axvspan(SUBSTANTIAL, 1, color=style.GRID, alpha=0.6, linewidth=0, zorder=0)
    panels[0].set_title("shaded: substantial")
    for axes in panels[:2]:
        low = min(-0.05, axes.get_xlim()[0])
        axes.set_xlim(low, 1)
    handles = [
        Line2D([], [], color=colour, marker=marker, markersize=3.5, label=pair_title(pair))
        for pair, (colour, marker) in zip(pairs, style.LINES)
    ]
    drawn.legend(handles=handles, loc="outside upper center", ncols=len(pairs))
    return drawn


def influence(study: Study) -> Figure:
    """First-order share of each factor in every measure of a run's comfort, with the direction of its influence."""
    found = study.assessment
    factors, sites = found["factor"].values.tolist(), found["place"].values.tolist()
    measures = found["measure"].values.tolist()
    drawn = style.figure(style.DOUBLE, 1.0 + (0.3 + 0.11 * len(sites)) * len(measures))
    panels = drawn.subplots(1, len(factors), sharex=True, sharey=True, squeeze=False)[0]
    for axes, factor in zip(panels, factors):
        for offset, place, (colour, _) in zip(_offsets(len(sites)), sites, _repeated(len(sites))):
            rank, share = (
                found[name].sel(factor=factor, place=place).transpose("measure", "bound").values
                for name in ("rank_correlation", "first_order")
            )
            markers = [_direction(*row) for row in rank]
            _intervals(axes, np.arange(len(measures)) + offset, np.clip(100.0 * share, 0.0, 100.0), colour, markers)
        axes.axvline(0, color=style.FAINT, linewidth=0.6, zorder=0)
        axes.set_title(f"{words(factor)} {symbol(factor)}")
        axes.set_xlabel("share of the variance [%]")
        _rows(axes, [measure_title(measure) for measure in measures])
    if not np.isfinite(found["first_order"].values).any():
        panels[0].annotate("too few runs", (0.5, 0.5), xycoords="axes fraction", ha="center")
        panels[0].set_xlim(0, 100)
    handles = [
        Line2D([], [], color=colour, label=place_title(place)) for place, (colour, _) in zip(sites, _repeated(len(sites)))
    ]
    directions = {"^": "more, worse", "v": "more, better", "o": "no direction"}
    handles += [
        Line2D([], [], color="#555555", marker=marker, linestyle="", markersize=3.5, label=word)
        for marker, word in directions.items()
    ]
    columns = style.legend_columns(handles, style.DOUBLE)
    drawn.set_figheight(drawn.get_figheight() + 0.15 * (-(-len(handles) // columns) - 1))
    drawn.legend(handles=handles, loc="outside upper center", ncols=columns)
    return drawn


def number_of_runs(study: Study) -> Figure:
    """Width of the interval of a probability against the number of runs, by sampling scheme, on each site."""
    found = study.assessment
    drawn, panels = style.panels(len(study.sites), 2.1, 2.6, margin=0.8)
    for axes, site in zip(panels, study.sites):
        chosen = found.sel(place=site.name)
        chosen = chosen.isel(size=np.flatnonzero(chosen["designs"].values))
        sizes, runs = chosen["size"].values, site.samples.sizes["run"]
        style.panel_title(axes, site.label, margin=0.8)
        axes.set_xlabel("number of runs [-]")
        axes.set_xscale("log")
        axes.set_yscale("log")
        if not sizes.size:
            axes.annotate(why_no_width(runs).replace(", ", ",\n"), (0.5, 0.5), xycoords="axes fraction", ha="center", fontsize=6)
            continue
        for scheme, (_, look) in SCHEMES.items():
            colour, marker = style.LINES[look]
            width = chosen["width"].sel(scheme=scheme).values
            axes.plot(sizes, width, marker, color=colour, markersize=4)
            along = np.geomspace(sizes[0], runs, 20)
            axes.plot(along, enough.by_root(sizes, width) / np.sqrt(along), color=colour, linewidth=0.8)
        axes.plot(sizes, chosen["wilson"].values, color=style.FAINT, dashes=(3, 2))
        axes.set_xticks([tick for tick in RUNS if sizes[0] <= tick <= runs])
        axes.axvline(runs, color=style.MEASURED, linewidth=0.6, dashes=(1, 1.5))
    if not any(axes.lines for axes in panels):
        panels[0].set(xlim=(10, 1000), ylim=(0.01, 1))  # of all, which share their axes
    for axes in panels:
        if axes.get_subplotspec().is_first_col():
            axes.set_ylabel("width of the 95 % interval [-]")
    panels[0].set_yticks([tick for tick in WIDTHS if panels[0].get_ylim()[0] <= tick <= panels[0].get_ylim()[1]])
    for axes in panels:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(StrMethodFormatter("{x:g}"))
            axis.set_minor_locator(NullLocator())
        axes.yaxis.grid(True, linewidth=0.3)
    handles = [
        Line2D([], [], color=style.LINES[look][0], marker=style.LINES[look][1], markersize=4, label=title)
        for title, look in SCHEMES.values()
    ]
    handles.append(Line2D([], [], color=style.FAINT, dashes=(3, 2), label="Wilson"))
    handles.append(Line2D([], [], color=style.MEASURED, linewidth=0.6, dashes=(1, 1.5), label="runs of this study"))
    drawn.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 2 * len(panels)))
    return drawn


def _intervals(axes: Axes, heights, values, colour: str, markers) -> None:
    """Estimates with intervals: ``values`` (row, bound), as dots on bars."""
    for height, (value, lower, upper), marker in zip(heights, values, markers):
        if np.isfinite(value):
            axes.plot([lower, upper], [height, height], color=colour, linewidth=1.1)
            axes.plot(value, height, marker, color=colour, markersize=3.5)


def _rows(axes: Axes, names) -> None:
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(names) - 0.5, -0.5)
    for line in np.arange(0.5, len(names) - 1):
        axes.axhline(line, color=style.GRID, linewidth=0.5)


def _offsets(count: int) -> np.ndarray:
    return np.linspace(-SPREAD / 2, SPREAD / 2, count) if count > 1 else np.zeros(1)


def _repeated(count: int) -> list[tuple[str, str]]:
    """Colour and marker for as many sites as there are."""
    return [style.LINES[index % len(style.LINES)] for index in range(count)]


def _direction(value: float, lower: float, upper: float) -> str:
    return "^" if lower > 0 else "v" if upper < 0 else "o"
