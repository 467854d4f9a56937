"""The error by speed, curvature, acceleration along and across, suspension and tyre velocity; and transfer functions."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ...discrepancy.response import INPUT
from ...vocabulary import SIGNALS
from .. import notation, style
from ..study import Compared
from ..units import printed

AXES = {
    "speed": ("speed [km/h]", 3.6),
    "curvature": ("curvature of the path [1/km]", 1000.0),
    "lateral_acceleration": ("lateral acceleration [m/s²]", 1.0),
    "longitudinal_acceleration": ("braking or driving [m/s²]", 1.0),
    "suspension_velocity": ("suspension velocity, rms [m/s]", 1.0),
    "tyre_velocity": ("tyre velocity, rms [m/s]", 1.0),
}
"""Axis label of each condition, and the factor from its SI unit."""

SMALLEST, LARGEST = 0.1, 100.0
"""Percent that the axis reaches from and at least to, so that models compare; what is less, or below the floor, is drawn at its end."""

TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)

INPUTS = {"road_heave": "heave", "road_tilt": "tilt"}

SOURCES = {"measured": ("measured drives", style.MEASURED), "simulated": ("model on the same paths", style.CALIBRATED)}
"""Label and colour of what answers to the road."""

HIGHEST = 2.0
"""Gain of drives over model up to which it is drawn: about 1 is what must be seen."""

LATE = 0.01
"""s by which drives and model are apart along the lines that are drawn beside a phase."""

TOLD, QUARTER = 0.5, 90.0
"""Coherence from which on a phase is drawn, and degrees up to which it is: beyond, the model moves against the drives."""

READ = (
    "Road heave: up and down; tilt: left against right. Gain of drives over model: above 1 the model moves too little, below 1 too\n"
    "much. Phase: below 0 the drives come later, by one time at all frequencies where it falls as the dotted line does (10 ms).\n"
    "Coherence: 1 where one follows from the other by gain and phase alone; noise, a wrong path or clock and what is not linear\n"
    "(friction) lower it; with the road, other inputs, too."
)
"""How the figure is read."""


def conditions(site: Compared, model: str) -> Figure:
    """Error above the floor in percent of the signal's power under the same condition, a panel each condition, a line each signal."""
    found = site.comparison
    names = [name for name in AXES if name in found["condition"].values]
    drawn = style.figure(style.DOUBLE, 5.8)
    panels = drawn.subplots(2, 3, sharey=True).ravel()
    highest = LARGEST
    for axes, name in zip(panels, names):
        label, factor = AXES[name]
        one = found.sel(condition=name)
        one = one.isel({"class": np.flatnonzero(one["condition_share"].values)})
        middle = factor * one["condition_level"].values
        for signal in SIGNALS:
            own = one.sel(signal=signal)
            above = (own["condition_error"] - own["band_floor"]).sum("band").values
            share = np.maximum(100 * above / np.maximum(own["condition_measured"].sum("band").values, 1e-30), SMALLEST)
            highest = max(highest, share.max())
            colour, marker = style.SIGNAL_LINES[signal]
            axes.plot(middle, share, color=colour, marker=marker, markersize=3.5, label=notation.signal(signal))
        axes.set_yscale("log")
        axes.set_xlabel(label)
        axes.locator_params(axis="x", nbins=5)
        axes.margins(x=0.08)  # labels at the ends of panels side by side would touch
        axes.set_yticks(TICKS, [f"≤ {SMALLEST:g}", *(f"{tick:g}" for tick in TICKS[1:])])
        axes.minorticks_off()
        axes.yaxis.grid(True)
    panels[0].set_ylim(0.8 * SMALLEST, 1.25 * highest)
    for axes in panels[len(names) :]:
        axes.set_axis_off()
    for axes in (panels[0], panels[3]):
        axes.set_ylabel("error above the floor\n[% of the signal's power there]")
    handles, labels = panels[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside upper center", ncols=len(labels), title=site.beside(model))
    return drawn


def responses(site: Compared, model: str) -> Figure:
    """Columns: gain from the road, of drives and model; gain and phase of drives over model; coherences. A row for each signal."""
    found = site.comparison
    drawn = style.figure(style.DOUBLE, 8.6)
    panels = drawn.subplots(len(SIGNALS), 4, sharex=True)
    frequency = found["frequency"].values
    kept = (frequency >= 0.4) & (frequency <= 40.0)
    frequency = frequency[kept]
    for (road, gain, phase, coherent), signal in zip(panels, SIGNALS):
        one, (factor, unit) = found.sel(signal=signal), printed(signal)
        if "road_gain" in found:
            for source, (label, colour) in SOURCES.items():
                values = factor * one["road_gain"].sel(source=source).values[kept]
                road.plot(frequency, values, color=colour, label=f"gain from the road, {label}")
                look = {"color": colour, "linewidth": 0.7, "linestyle": (0, (2, 1)), "label": f"coherence with the road, {label}"}
                coherent.plot(frequency, one["road_coherence"].sel(source=source).values[kept], **look)
            road.set_yscale("log")
            style.number_decades(road.yaxis, (1, 3))
        road.set_ylabel(f"{notation.signal(signal)}\n[{unit} per m/s]")
        road.set_title(f"road {INPUTS[INPUT[signal]]} → {notation.signal(signal)}")
        gain.axhline(1.0, color=style.FAINT, linewidth=0.7)
        of_model = one["model_gain"].values[kept]
        gain.plot(frequency, of_model, color=style.ERROR, label="gain, phase and coherence, drives against model")
        beyond = frequency[of_model > HIGHEST]
        if beyond.size:
            gain.plot(beyond, np.full(beyond.size, HIGHEST), "^", color=style.ERROR, markersize=3, clip_on=False)
        gain.set_ylim(0.0, HIGHEST)
        for late in (-LATE, LATE):
            phase.plot(frequency, -360.0 * late * frequency, color=style.FAINT, linewidth=0.7, linestyle=":")
        of_model = np.degrees(one["model_phase"].values[kept])
        phase.plot(frequency, np.where(one["model_coherence"].values[kept] > TOLD, of_model, np.nan), color=style.ERROR)
        phase.axhline(0.0, color=style.FAINT, linewidth=0.7)
        phase.set_ylim(-QUARTER, QUARTER)
        phase.set_yticks([-QUARTER, 0.0, QUARTER])
        phase.set_ylabel("phase [°]")
        phase.set_title("drives over model")
        gain.set_ylabel("gain [-]")
        gain.set_title("drives over model" + (f" (▲: above {HIGHEST:g})" if beyond.size else ""))
        coherent.plot(frequency, one["model_coherence"].values[kept], color=style.ERROR)
        coherent.set_ylim(0.0, 1.03)
        coherent.set_ylabel("coherence [-]")
        for axes in (road, gain, phase, coherent):
            axes.set_xscale("log")
            axes.set_xlim(frequency[0], frequency[-1])
    for axes in panels[-1]:
        axes.set_xticks([0.5, 2, 10, 40], ["0.5", "2", "10", "40"])
        axes.minorticks_off()
        axes.set_xlabel("frequency [Hz]")
    handles = [line for axes in panels[0] for line in axes.get_legend_handles_labels()[0]]
    drawn.legend(handles=handles, loc="outside upper left", ncols=2, title=f"{site.beside(model)}.\n{READ}", title_fontsize=7, alignment="left")
    drawn.align_ylabels(panels)
    return drawn
