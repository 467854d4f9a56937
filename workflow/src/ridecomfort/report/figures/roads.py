"""What the sites look like: plan, height, slope, curvature and cross slope of the roads, and a height map."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ...road import crossslope, defects
from .. import style
from ..study import Study
from ..tables.inputs import GON_PER_RAD, length, mean_curvature, mean_slope, slope


def testsection_figs(study: Study) -> Figure:
    """fig:testsection_figs: a row for each site."""
    rows = len(study.sites)
    drawn = style.figure(style.DOUBLE, 0.3 + 1.75 * rows)
    grid = drawn.add_gridspec(rows, 3, width_ratios=(1.0, 1.35, 1.35))
    for row, site in enumerate(study.sites):
        road = site.road
        u = road["u"].values
        plan, height, curve = (drawn.add_subplot(grid[row, column]) for column in range(3))

        x, y = road["x"].values, road["y"].values
        x, y = x - x[0], y - y[0]
        plan.plot(x, y, color=style.ROAD, linewidth=1.4)
        plan.plot(x[:1], y[:1], "o", color=style.ROAD, markersize=4)
        plan.set_aspect("equal", adjustable="datalim")
        plan.set_xlabel("east [m]")
        plan.set_ylabel("north [m]")
        plan.set_title(f"{site.label}: {length(road) / 1000:.2f} km, dot: start")

        line = road["elevation"].sel(v=0.0, method="nearest").values
        height.plot(u, line - line[np.isfinite(line)][0], color=style.ROAD)
        height.set_ylabel("height above start [m]")
        height.set_title(f"mean slope {100 * mean_slope(road):.2f} %")

        curve.plot(u, 1000 * GON_PER_RAD * road["curvature"].values, color=style.ROAD)
        curve.axhline(0, color=style.GRID, linewidth=0.6, zorder=0)
        curve.set_ylabel("curvature [gon/km]")
        curve.set_title(f"mean {1000 * GON_PER_RAD * mean_curvature(road):.1f} gon/km")
        for axes in (height, curve):
            axes.margins(x=0)
            axes.set_xlabel("distance $u$ [m]")
    return drawn


STRIP = 1000.0
"""m of road that a strip of the height map shows."""

MARKS = {
    "dip": ("v", style.LINES[0][0]),
    "bump": ("^", style.LINES[5][0]),
    "joint": ("|", style.LINES[2][0]),
    "outlier kept": ("x", style.LINES[3][0]),
    "outlier repaired": ("x", "#000000"),
    "hole filled": ("s", "#000000"),
}
"""Marker and colour of what was found on a road."""

COLUMN = 1.0
"""m along the road that a column of the height map stands for: its cell furthest from the rest is shown."""

SCALES_MM = (15.0, 30.0, 60.0, 120.0)
"""mm at either end of the colours of a height map, which takes the first that SHOWN of its cells stay within."""

SHOWN = 99.0
"""Percent of the cells of a height map that its colours tell apart at least, but on the roughest roads."""


def views(study: Study, name: str) -> Figure:
    """Plan, height, slope, curvature and cross slope of a site's road, and its height map with what was found."""
    site = study.site(name)
    road = site.road
    u = road["u"].values
    strips = _strips(u)
    tall = np.ptp(road["y"].values) / max(np.ptp(road["x"].values), 1.0)
    heights = np.clip(0.8 * style.DOUBLE * tall, 1.5, 3.5), 4.0, 0.4 + 0.62 * len(strips)
    drawn = style.figure(style.DOUBLE, sum(heights))
    top, middle, bottom = drawn.subfigures(3, 1, height_ratios=heights)
    _plan(top.subplots(), site)
    line = road["elevation"].sel(v=0.0, method="nearest").values
    rows = (
        ("height [m]", line),
        ("slope [%]", 100 * slope(road)),
        ("curvature\n[gon/km]", 1000 * GON_PER_RAD * road["curvature"].values),
        ("cross slope\n[%]", 100 * crossslope.cross_slope(road)),
    )
    for row, (axes, (label, values)) in enumerate(zip(middle.subplots(len(rows), 1, sharex=True), rows)):
        axes.plot(u, values, color=style.ROAD)
        if row:
            axes.axhline(0, color=style.GRID, linewidth=0.6, zorder=0)
        axes.set_ylabel(label)
        axes.margins(x=0)
    axes.set_xlabel("distance $u$ [m]")
    middle.align_ylabels()
    _map(bottom, site, strips)
    return drawn


def _plan(axes, site) -> None:
    """The reference line from above, marked every 1000 m, 500 m or 100 m by its length."""
    road = site.road
    u, x, y = (road[key].values for key in ("u", "x", "y"))
    x, y = x - x[0], y - y[0]
    axes.plot(x, y, color=style.ROAD, linewidth=1.4)
    every = 1000.0 if u[-1] - u[0] > 2000 else 500.0 if u[-1] - u[0] > 800 else 100.0
    for at in np.arange(0.0, u[-1] - u[0], every):
        i = np.searchsorted(u, u[0] + at)
        axes.plot(x[i], y[i], "o", color=style.ROAD, markersize=3 if i else 5)
        # Beside the line, to its left: the name of a place must not lie on the road that it names.
        towards = road["heading"].values[i] + 0.5 * np.pi
        axes.annotate(
            f"{u[0] + at:.0f} m", (x[i], y[i]), xytext=(12 * np.cos(towards), 8 * np.sin(towards)),
            textcoords="offset points", fontsize=6, ha="center", va="center",
        )  # fmt: skip
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("east [m]")
    axes.set_ylabel("north [m]")
    axes.set_title(f"{site.label}, dot: start")


def _strips(u) -> list[tuple[float, float]]:
    """Beginning and end in m of each strip of the height map."""
    count = max(1, round((u[-1] - u[0]) / STRIP))
    ends = np.linspace(u[0], u[-1], count + 1)
    return list(zip(ends[:-1], ends[1:]))


def _map(figure, site, strips) -> None:
    """Heights above the median of 5 m of each track, strip by strip, and what was found."""
    road, found = site.road, site.inspection
    u, v = road["u"].values, road["v"].values
    away = 1e3 * defects.deviation(road)
    needed = np.nanpercentile(np.abs(away), SHOWN)
    scale = next((limit for limit in SCALES_MM if needed <= limit), SCALES_MM[-1])
    panels = figure.subplots(len(strips), 1, squeeze=False)[:, 0]
    for axes, (first, last) in zip(panels, strips):
        inside = slice(*np.searchsorted(u, [first, last]))
        image = axes.imshow(
            _thinned(away[inside], max(1, round(COLUMN / (u[1] - u[0])))).T,
            extent=(first, last, v[0], v[-1]), origin="lower", aspect="auto", interpolation="nearest",
            cmap="PuOr_r", vmin=-scale, vmax=scale,
        )  # fmt: skip
        here = found.isel(defect=(found["u_middle"].values >= first) & (found["u_middle"].values <= last))
        for kind, (marker, colour) in MARKS.items():
            which = here["kind"].values == kind
            face = colour if marker in "x|" else "none"
            axes.scatter(
                here["u_middle"].values[which], here["v_middle"].values[which], s=16, marker=marker, c=face,
                edgecolors=None if marker in "x|" else colour, linewidths=0.8, label=kind,
            )  # fmt: skip
        axes.set(xlim=(first, last), ylim=(v[0], v[-1]))
        axes.set_ylabel("$v$ [m]")
    panels[-1].set_xlabel("distance $u$ [m]")
    figure.colorbar(image, ax=list(panels), label="deviation [mm]", extend="both", pad=0.01, aspect=15 * len(panels))
    counts = {kind: int((found["kind"].values == kind).sum()) for kind in MARKS}
    handles, _ = panels[0].get_legend_handles_labels()
    named = [(handle, f"{kind} ({counts[kind]})") for handle, kind in zip(handles, MARKS) if counts[kind]]
    if named:
        panels[0].legend(*zip(*named), loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(named), borderpad=0.1)


def _thinned(heights, count: int):
    """Of every ``count`` cross sections the height furthest from zero, NaN where there is none."""
    whole = heights[: len(heights) // count * count]
    if not len(whole):
        return heights
    blocks = np.nan_to_num(whole).reshape(-1, count, heights.shape[1])
    furthest = np.abs(blocks).argmax(axis=1)
    values = np.take_along_axis(blocks, furthest[:, None], axis=1)[:, 0]
    return np.where(np.isfinite(whole).reshape(blocks.shape).any(axis=1), values, np.nan)
