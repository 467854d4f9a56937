"""What the sites look like: plan, height, slope and curvature of their reference lines."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .. import style
from ..study import Study
from ..tables.inputs import GON_PER_RAD, length, mean_curvature, mean_slope


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
