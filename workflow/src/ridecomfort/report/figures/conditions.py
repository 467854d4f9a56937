"""The error by speed, curvature, lateral acceleration, suspension and tyre velocity; and transfer functions."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ...discrepancy.response import INPUT
from ...vocabulary import SIGNALS
from .. import notation, style
from ..study import Difference
from ..units import printed

AXES = {
    "speed": ("speed [km/h]", 3.6),
    "curvature": ("curvature of the path [1/km]", 1000.0),
    "lateral_acceleration": ("lateral acceleration [m/s²]", 1.0),
    "suspension_velocity": ("suspension velocity, rms [m/s]", 1.0),
    "tyre_velocity": ("tyre velocity, rms [m/s]", 1.0),
}
"""Axis label of each condition, and the factor from its SI unit."""

SMALLEST = 0.1
"""Percent below which an error is not drawn."""

TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200)

INPUTS = {"road_heave": "up and down", "road_tilt": "left against right"}


def conditions(study: Difference, site: str) -> Figure:
    """Error above the floor over the power under the same condition, a panel for each condition, a line for each signal."""
    found = next(each for each in study.sites if each.name == site).comparison
    names = [name for name in AXES if name in found["condition"].values]
    drawn = style.figure(style.DOUBLE, 5.0)
    panels = drawn.subplots(2, 3, sharey=True).ravel()
    shown = []
    for axes, name in zip(panels, names):
        label, factor = AXES[name]
        one = found.sel(condition=name)
        middle = factor * one["condition_level"].values
        for signal in SIGNALS:
            own = one.sel(signal=signal)
            above = (own["condition_error"] - own["band_floor"]).sum("band").values
            share = np.maximum(100 * above / np.maximum(own["condition_measured"].sum("band").values, 1e-30), SMALLEST)
            shown += share.tolist()
            colour, marker = style.SIGNAL_LINES[signal]
            axes.plot(middle, share, color=colour, marker=marker, markersize=3.5, label=notation.signal(signal))
        axes.set_yscale("log")
        axes.set_xlabel(label)
        axes.set_yticks(TICKS, [f"{tick:g}" for tick in TICKS])
        axes.minorticks_off()
        axes.yaxis.grid(True)
    panels[0].set_ylim(0.8 * min(shown), 1.25 * max(shown))
    for axes in panels[len(names) :]:
        axes.set_axis_off()
    for axes in (panels[0], panels[3]):
        axes.set_ylabel("error above floor [% of power]")
    handles, labels = panels[0].get_legend_handles_labels()
    panels[-1].legend(handles, labels, loc="center", ncols=2, title="signal")
    return drawn


def responses(study: Difference, site: str) -> Figure:
    """Columns: gain from the road, measured and simulated; gain of measured over simulated; coherences. A row for each signal."""
    found = next(each for each in study.sites if each.name == site).comparison
    drawn = style.figure(style.DOUBLE, 8.6)
    panels = drawn.subplots(len(SIGNALS), 3, sharex=True)
    frequency = found["frequency"].values
    kept = (frequency >= 0.4) & (frequency <= 40.0)
    frequency = frequency[kept]
    for (road, gain, coherent), signal in zip(panels, SIGNALS):
        one, (factor, unit) = found.sel(signal=signal), printed(signal)
        if "road_gain" in found:
            for source, colour in (("measured", style.MEASURED), ("simulated", style.CALIBRATED)):
                road.plot(frequency, factor * one["road_gain"].sel(source=source).values[kept], color=colour, label=source)
                values = one["road_coherence"].sel(source=source).values[kept]
                coherent.plot(frequency, values, color=colour, linewidth=0.7, linestyle=(0, (2, 1)), label=f"{source} and road")
            road.set_yscale("log")
        road.set_ylabel(f"{notation.signal(signal)}\n[{unit} per m/s]")
        road.set_title(f"road {INPUTS[INPUT[signal]]} → {notation.signal(signal)}")
        gain.axhline(1.0, color=style.FAINT, linewidth=0.7)
        gain.plot(frequency, one["model_gain"].values[kept], color=style.ERROR)
        gain.set_ylim(0.0, 2.0)
        gain.set_ylabel("gain [-]")
        gain.set_title("measured over simulated")
        coherent.plot(frequency, one["model_coherence"].values[kept], color=style.ERROR, label="measured and simulated")
        coherent.set_ylim(0.0, 1.03)
        coherent.set_ylabel("coherence [-]")
        for axes in (road, gain, coherent):
            axes.set_xscale("log")
            axes.set_xlim(frequency[0], frequency[-1])
    for axes in panels[-1]:
        axes.set_xticks([0.5, 1, 2, 5, 10, 20, 40], ["0.5", "1", "2", "5", "10", "20", "40"])
        axes.minorticks_off()
        axes.set_xlabel("frequency [Hz]")
    handles, labels = panels[0][2].get_legend_handles_labels()
    own = panels[0][0].get_legend_handles_labels()
    labels = [*own[1], *(f"coherence of {label}" for label in labels)]
    drawn.legend([*own[0], *handles], labels, loc="outside upper right", ncols=3)
    drawn.align_ylabels(panels)
    return drawn
