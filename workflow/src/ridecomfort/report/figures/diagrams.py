"""Drawn diagrams of the study's own workflow and of its calibration."""

from __future__ import annotations

from textwrap import fill

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from .. import catalogue, style
from ..notation import SYMBOLS, symbol, unit
from ..study import Study
from ..tables.calibration import initial_cost

BOX = {"input": "#EFE6DC", "work": "#DDEBF5", "result": "#E3F1E8", "check": "#FBEFD3"}


def framework(study: Study) -> Figure:
    """fig:framework: from road surface and settings to the tables."""
    drawn, axes = _canvas(style.DOUBLE, 2.75, 16.4, 6.2)
    _box(axes, 1.6, 5.2, 2.9, 1.5, "(1) Settings", "study, sites, vehicle,\ndistributions", "input")
    _box(axes, 1.6, 3.1, 2.9, 1.5, "Measured drives", "aligned in time\nand with the road", "input")
    _box(axes, 1.6, 1.0, 2.9, 1.5, "Road", "OpenCRG surface,\nreference line", "input")
    _box(axes, 5.5, 5.2, 2.9, 1.5, "(2) Samples", "Latin hypercube: speed,\nposition, friction", "work")
    _box(axes, 5.5, 3.1, 2.9, 1.5, "Calibration", "least squares: blocks\nOP$_1$ to OP$_5$, joint", "work")
    simulation = "vehicle of 14 degrees\nof freedom and driver\non the road surface"
    _box(axes, 9.2, 3.1, 2.7, 1.9, "(3) Simulation", simulation, "work")
    _box(axes, 12.6, 5.2, 2.5, 1.5, "(4) Space", "drives over time to\nequal steps of $s$", "work")
    methods = "thresholds\nISO 2631: $a_v$\nIRI by speed driven,\nin short sections"
    _box(axes, 12.6, 1.6, 2.9, 2.5, "Comfort", methods, "work")
    _box(axes, 15.4, 3.7, 1.7, 1.5, "(5) Report", "tables,\nfigures", "result")
    for path in (
        [(3.05, 5.2), (4.05, 5.2)],
        [(3.05, 3.1), (4.05, 3.1)],
        [(6.95, 3.1), (7.85, 3.1)],
        [(6.95, 5.2), (8.6, 5.2), (8.6, 4.05)],
        [(9.8, 4.05), (9.8, 5.2), (11.35, 5.2)],
        [(12.6, 4.45), (12.6, 2.85)],
        [(14.05, 1.6), (15.4, 1.6), (15.4, 2.95)],
        [(3.05, 1.0), (11.15, 1.0)],
        [(5.5, 1.0), (5.5, 2.35)],
        [(9.2, 1.0), (9.2, 2.15)],
    ):
        _arrow(axes, path)
    return drawn


def leastsquare(study: Study) -> Figure:
    """fig:leastsquare: what one block of the calibration does."""
    drawn, axes = _canvas(style.DOUBLE, 2.05, 16.0, 4.6)
    _box(axes, 1.5, 3.6, 2.6, 1.5, "Start", "parameters $p_0$,\nscenario $S$", "input")
    _box(axes, 5.3, 3.6, 2.8, 1.5, "Simulate", "$f(x, p_i)$ at the\nmeasured speed", "work")
    _box(axes, 9.1, 3.6, 2.8, 1.5, "Residuals", "$r = f(x, p_i) - y(x)$,\neach signal normalised", "work")
    _box(axes, 12.6, 3.6, 2.4, 1.5, "Below tolerance?", "change of cost\nor of $p$", "check")
    _box(axes, 15.1, 3.6, 1.4, 1.5, "Result", "$p_{end}$", "result")
    _box(axes, 9.1, 1.2, 2.8, 1.3, "Measured drive", "$y(x)$", "input")
    _box(axes, 5.3, 1.2, 2.8, 1.3, "New guess", "$p_{i+1}$ within bounds", "work")
    for path in (
        [(2.8, 3.6), (3.9, 3.6)],
        [(6.7, 3.6), (7.7, 3.6)],
        [(10.5, 3.6), (11.4, 3.6)],
        [(13.8, 3.6), (14.4, 3.6)],
        [(9.1, 1.85), (9.1, 2.85)],
        [(12.6, 2.85), (12.6, 0.2), (5.3, 0.2), (5.3, 0.55)],
        [(5.3, 1.85), (5.3, 2.85)],
    ):
        _arrow(axes, path)
    axes.text(14.1, 3.75, "yes", ha="center", fontsize=6)
    axes.text(12.75, 2.5, "no", fontsize=6)
    return drawn


def optichain(study: Study) -> Figure:
    """fig:optichain: the chain of blocks with our values and costs, a chain for each calibration."""
    chains = {name: _blocks(dataset) for name, dataset in study.calibrations.items()}
    lines = [
        (name, blocks[first : first + PER_LINE], first)
        for name, blocks in chains.items()
        for first in range(0, len(blocks), PER_LINE)
    ]
    drawn, axes = _canvas(style.DOUBLE, 1.45 * len(lines), 18.0, 3.6 * len(lines))
    step, height = 18.0 / PER_LINE, 2.5
    width = step - 0.45
    for row, (name, blocks, first) in enumerate(lines):
        top = 3.6 * (len(lines) - row)
        middle = top - 2.05
        words = "continued" if first else f"calibrated on {catalogue.label(name)}"
        axes.text(0.22, top - 0.5, words, fontsize=8)
        for k, (title, text, kind) in enumerate(blocks):
            place = (k + 0.5) * step
            _box(axes, place, middle, width, height, title, text, kind)
            if k:
                _arrow(axes, [(place - step + width / 2, middle), (place - width / 2, middle)])
    return drawn


PER_LINE = 7
"""Boxes of a chain on one line; a longer chain goes on below."""


def _blocks(calibration: xr.Dataset) -> list[tuple[str, str, str]]:
    """Title, text and kind of each box of a chain; the result is the block whose values the study goes on with."""
    parameters = calibration["parameter"].values.tolist()
    steps = calibration["step"].values.tolist()
    applied = steps[-1] if calibration.attrs["applied"] == "joint" else f"OP_{len(parameters)}"
    boxes = [("$I_0$", f"initial values\ncost {_cost(initial_cost(calibration))}", "input")]
    for k, name in enumerate(steps):
        step = calibration.sel(step=name)
        cost = f"cost {_cost(float(step['cost']))}\n{int(step['iterations'])} iterations"
        if name.startswith("OP_"):
            key = parameters[k]
            block = calibration.sel(parameter=key)
            words = unit(str(block["unit"].item())).removeprefix("-")
            after = f"{_number(float(step['step_value'].sel(parameter=key)))} {words}".rstrip()
            text = f"{_number(float(block['initial']))} →\n{after}\n{cost}"
            title = f"OP$_{{{name[3:]}}}$"
            if key in SYMBOLS:
                title += f": {symbol(key)}"
            else:
                text = f"{fill(symbol(key), 14)}\n{text}"
        else:
            title, text = name.capitalize(), f"all {len(parameters)} parameters\nat once\n{cost}"
        boxes.append((title, text, "result" if name == applied else "work"))
    return boxes


def _cost(value: float) -> str:
    return f"{1000 * value:.5g}·10$^{{-3}}$"


def _number(value: float) -> str:
    return f"{value:,.0f}".replace(",", "\u2009") if abs(value) >= 100 else f"{value:.3g}"


def _canvas(width: float, height: float, right: float, top: float) -> tuple[Figure, Axes]:
    drawn = style.figure(width, height, layout="none")
    axes = drawn.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0, right)
    axes.set_ylim(0, top)
    axes.axis("off")
    return drawn, axes


def _box(axes: Axes, x: float, y: float, width: float, height: float, title: str, text: str, kind: str) -> None:
    """A box around (x, y) with a title in bold and lines of text."""
    axes.add_patch(
        FancyBboxPatch(
            (x - width / 2, y - height / 2),
            width,
            height,
            boxstyle="round,pad=0,rounding_size=0.12",
            facecolor=BOX[kind],
            edgecolor="#555555",
            linewidth=0.7,
        )
    )
    axes.text(x, y + height / 2 - 0.12, title, ha="center", va="top", fontsize=7.5, fontweight="bold")
    axes.text(x, y - 0.25, text, ha="center", va="center", fontsize=6.3, linespacing=1.25)


def _arrow(axes: Axes, path) -> None:
    """An arrow along straight pieces."""
    for one, other in zip(path[:-2], path[1:-1]):
        axes.plot(*zip(one, other), color="#555555", linewidth=0.9, solid_capstyle="round")
    head = {"arrowstyle": "-|>", "mutation_scale": 7, "shrinkA": 0, "shrinkB": 0}
    axes.add_patch(FancyArrowPatch(path[-2], path[-1], color="#555555", linewidth=0.9, **head))
