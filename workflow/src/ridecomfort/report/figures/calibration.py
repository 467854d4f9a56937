"""How the calibration went, and signals measured and simulated."""

from __future__ import annotations

import re
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from ...vocabulary import SIGNALS
from .. import catalogue, published, style
from ..notation import SYMBOLS, literal, symbol
from ..study import Site, Study, foot_notes
from ..tables.calibration import initial_cost
from ..units import printed

PAPERS_SITE = "ts3"
"""The site that the paper shows in fig:opti_plots."""

LOOKS = {
    "reference": ("simulated, not calibrated", style.REFERENCE),
    "with_effects": ("simulated with the model's effects, not calibrated", style.EFFECTS),
    "calibrated": ("simulated, calibrated", style.CALIBRATED),
}
"""Label and colour of each state of the vehicle."""

DETAIL = 3.0
"""Seconds of the drive that the right-hand panels show: those with the strongest vertical acceleration."""

LONGEST = 110
"""Letters in a line above the panels."""


def convergence(study: Study) -> Figure:
    """Cost after every block and parameters within their bounds, a row for each calibration."""
    rows = len(study.calibrations)
    names = [each["parameter"].values.tolist() for each in study.calibrations.values()]
    columns = 5 if all(key in SYMBOLS for own in names for key in own) else 2
    legend = 0.15 * -(-max(map(len, names)) // columns)
    drawn = style.figure(style.DOUBLE, 0.2 + (2.35 + legend) * rows)
    panels = drawn.subplots(rows, 2, squeeze=False)
    for (left, right), (name, dataset) in zip(panels, study.calibrations.items()):
        blocks = dataset["step"].values.tolist()
        places = np.arange(len(blocks) + 1)
        cost = 1000 * np.concatenate([[initial_cost(dataset)], dataset["cost"].values])
        left.plot(places, cost, "o-", color=style.CALIBRATED, markersize=3.5)
        for place, count in zip(places[1:], dataset["iterations"].values):
            style.note(left, f"{int(count)} it.", (place, cost[place]))
        names = ["start", *(re.sub(r"OP_(\d+)", r"OP$_{\1}$", block) for block in blocks)]
        left.set_xticks(places, names)
        left.set_ylabel("cost, half the sum of NRMSE² [10$^{-3}$]")
        left.margins(y=0.15)
        left.set_title(f"calibrated on {catalogue.label(name)}")
        lower, upper = dataset["lower"].values, dataset["upper"].values
        values = np.vstack([dataset["initial"].values, dataset["step_value"].values])
        for parameter, key in enumerate(dataset["parameter"].values.tolist()):
            turn, look = divmod(parameter, len(style.LINES))
            colour, marker = style.LINES[look][0], style.LINES[(look + turn) % len(style.LINES)][1]  # no two alike though colours come again
            scale = lambda value, k=parameter: (value - lower[k]) / (upper[k] - lower[k])  # noqa: E731
            along = scale(values[:, parameter])
            right.plot(places, along, marker=marker, color=colour, markersize=3.5, label=symbol(key))
            interval = [scale(float(dataset[edge][parameter])) for edge in ("interval_lower", "interval_upper")]
            place = places[-1] + 0.35 + 0.16 * parameter
            right.plot([place, place], interval, color=colour, linewidth=2.2, solid_capstyle="butt")
        right.axhspan(0, 1, color="#F4F4F4", zorder=0)
        right.set_ylim(-0.08, 1.08)
        right.set_xticks(places, names)
        right.set_ylabel("place between the bounds [-]")
        right.set_title("bars at the right: 90 % intervals")
        right.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=columns, columnspacing=1.2)
    return drawn


def opti_plots(study: Study) -> Figure:
    """fig:opti_plots: the first fitted drive of the site that is ``shown``."""
    site = shown(study)
    drive = _drive(site)
    comparison = site.comparison.isel(drive=drive)
    time = comparison["time"].values
    present = np.isfinite(comparison["measured"].sel(signal="a_z").values)
    time, comparison = time[present] - time[present][0], comparison.isel(time=present)
    middle = _roughest(time, comparison["measured"].sel(signal="a_z").values)
    drawn = style.figure(style.DOUBLE, 8.2)
    panels = drawn.subplots(len(SIGNALS), 2, sharex="col", width_ratios=(1.7, 1.0))
    theirs = published.figures()["nrmse"].get(f"{site.name}_ref_rmse", {})
    for letter, (whole, detail), signal in zip("abcdef", panels, SIGNALS):
        factor, words = printed(signal)
        chosen = comparison.sel(signal=signal)
        for axes, width in ((whole, 0.4), (detail, 0.8)):
            measured = factor * chosen["measured"].values
            axes.plot(time, measured, color=style.MEASURED, linewidth=width, label="measured", zorder=3)
            for state in chosen["state"].values.tolist():
                label, colour = LOOKS[state]
                values = factor * chosen["simulated"].sel(state=state).values
                axes.plot(time, values, color=colour, linewidth=1.2, label=label)
        whole.set_ylabel(f"{symbol(signal)} [{words}]")
        errors = [f"{factor * float(chosen['rmse'].sel(state=state)):.4f}" for state in chosen["state"].values]
        title = f"({letter}) RMSE {' → '.join(errors)} {words}"
        if signal in theirs:
            title += f" (paper, not calibrated: {theirs[signal]:.4f})"
        whole.set_title(title)
        whole.margins(x=0)
        detail.set_xlim(middle - DETAIL / 2, middle + DETAIL / 2)
    panels[0][1].set_title(f"the {DETAIL:g} s with the strongest $a_z$")
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    drawn.align_ylabels(panels[:, 0])
    handles, labels = panels[0][0].get_legend_handles_labels()
    title = "\n".join([f"{site.label}, drive {_name(site, drive)}", *(fill(note, LONGEST) for note in foot_notes([site]))])
    drawn.legend(handles, labels, loc="outside upper right", ncols=3, title=title, title_fontsize=7)
    return drawn


def shown(study: Study) -> Site:
    """The site of fig:opti_plots: the paper's, else the last site with drives."""
    return next((each for each in study.compared if each.name == PAPERS_SITE), study.compared[-1])


def _roughest(time: np.ndarray, values: np.ndarray) -> float:
    """Middle in s of the stretch of DETAIL seconds with the largest mean square."""
    count = int(DETAIL / (time[1] - time[0]))
    energy = np.concatenate([[0.0], np.cumsum((values - values.mean()) ** 2)])
    first = int(np.argmax(energy[count:] - energy[:-count]))
    return float(time[first] + DETAIL / 2)


def _drive(site: Site) -> int:
    roles = site.comparison["role"].values.tolist() if "role" in site.comparison else []
    return roles.index("fit") if "fit" in roles else 0


def _name(site: Site, drive: int) -> str:
    return literal(site.comparison["drive"].values[drive])
