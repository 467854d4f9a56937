"""Where simulated and measured drives differ: place by frequency, with the findings in words."""

from __future__ import annotations

from textwrap import fill

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ...discrepancy import findings, judged
from ...discrepancy.locate import BANDS
from ...vocabulary import SIGNALS
from .. import notation, style
from ..study import Compared
from ..tables.difference import floor_note
from ..units import printed

PALEST, DARKEST = 0.1, 30.0
"""Ends of the colours in percent of the signal's power per octave: the same for every model and site, so that maps compare."""

CHANCE = 2.0
"""Times the floor up to which the error of a cell may be chance: below it lay 99 % of the cells of a signal that was all noise."""

TICKS = (0.1, 0.3, 1, 3, 10, 30)

UNCOUNTED = "#E1E3E6"
"""Colour of what is not judged: frequencies that are the driver's, and places that no drive tells of."""

PER_OCTAVE = 6
"""Rows of the map in an octave: single lines of a short spectrum scatter so much that noise would look like error."""

LONGEST = 125
"""Letters in a line below the maps."""

SMALL = f"No error above the floor reaches {100 * findings.NAMED:g} % of its signal's power in any band; what is left: above the maps."
"""What is said where no finding is worth it."""


def located(site: Compared, model: str) -> Figure:
    """Error above the floor by place and frequency and the spectra beside it, a row for each signal; findings as numbered boxes."""
    found = site.comparison
    errors = findings.findings(found)
    lines = [f"{k}  {notation.signal(each.signal)}{each.words().removeprefix(each.signal)}" for k, each in enumerate(errors, start=1)]
    lines = [f"!  {doubt}" for doubt in findings.doubts(found)] + lines
    lines = [SMALL] * findings.are_small(errors) + lines + findings.gathered(found)
    lines = [fill(line, LONGEST, subsequent_indent="    ") for line in lines]
    words = [*lines, fill(f"{site.beside(model)}; {floor_note(site)}", LONGEST)]
    count = "\n".join(words).count("\n") + 1
    drawn = style.figure(style.DOUBLE, 8.3 + 0.16 * count)
    panels = drawn.subplots(
        len(SIGNALS) + 2, 2, width_ratios=(3.2, 1.0), height_ratios=(0.08, *[1.0] * len(SIGNALS), 0.22 * count), squeeze=False
    )
    top, panels = panels[0], panels[1:]
    place = found["s_map"].values / 1000
    colours = {"cmap": colormaps["YlOrBr"].with_extremes(bad=UNCOUNTED), "norm": LogNorm(PALEST, DARKEST)}
    for (left, right), signal in zip(panels, SIGNALS):
        own = found.sel(signal=signal)
        frequency, above = _above(own)
        image = left.pcolormesh(place, frequency, np.maximum(above, PALEST).T, **colours, shading="nearest", rasterized=True)
        whole = np.maximum(own["power_share"].sum("stretch").values, 0.0).sum()
        left.set_title(f"in all {100 * whole:.1f} % of the signal's power", loc="right", fontsize=7)
        left.set_yscale("log")
        left.set_ylim(BANDS[0][0], BANDS[-1][1])
        left.set_yticks([1, 2, 5, 10, 20, 40], ["1", "2", "5", "10", "20", "40"])
        left.minorticks_off()
        left.set_ylabel(f"{notation.signal(signal)}\nfrequency [Hz]")
        uncounted = float(judged.lowest([signal])[0])
        for axes in (left, right):
            axes.axhspan(BANDS[0][0], max(uncounted, BANDS[0][0]), color=UNCOUNTED, linewidth=0, zorder=3)
        _boxes(left, errors, signal, place)
        _spectra(right, own, signal)
        right.set_yscale("log")
        right.set_ylim(left.get_ylim())
        right.set_yticks([1, 2, 5, 10, 20, 40], [""] * 6)
        right.minorticks_off()
        left.tick_params(labelbottom=signal == SIGNALS[-1])
    panels[len(SIGNALS) - 1][0].set_xlabel("distance along the road [km]")
    bar = drawn.colorbar(image, cax=top[0], orientation="horizontal", extend="both")
    bar.set_ticks(TICKS, labels=[f"{tick:g}" for tick in TICKS])
    bar.ax.minorticks_off()
    bar.set_label("error above the floor, where the error is more than twice the floor [% of the signal's power per octave]")
    top[0].xaxis.set_ticks_position("top")
    top[0].xaxis.set_label_position("top")
    below = panels[-1][0]
    for axes in (*panels[-1], top[1]):
        axes.set_axis_off()
    text = below.text(-0.06, 0.95, "\n".join(words), fontsize=6.5, va="top", transform=below.transAxes, linespacing=1.5)
    text.set_in_layout(False)
    handles, labels = panels[0][1].get_legend_handles_labels()
    key = top[1].legend(handles, labels, loc="center", ncols=3, columnspacing=0.7, handlelength=0.9, handletextpad=0.4)
    key.set_in_layout(False)
    drawn.align_ylabels([row[0] for row in panels])
    return drawn


def _above(found: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz), and error above the floor, (place, frequency), in percent of the signal's measured power per octave; nil where it may be
    CHANCE, nan where no drive tells."""
    lines = found["frequency_map"].values
    rows = np.unique(np.round(PER_OCTAVE * np.log2(lines)), return_inverse=True)[1]
    mean = lambda values: np.stack([values[..., rows == row].mean(axis=-1) for row in range(rows.max() + 1)], axis=-1)  # noqa: E731
    frequency, power = mean(lines), float(found["measured_power"].sum())
    error, floor = mean(found["error_map"].values), mean(found["floor_density"].values)
    above = np.where(error <= CHANCE * floor, 0.0, error - floor)
    return frequency, 100 * np.log(2) * frequency * above / (power or np.inf)


def _boxes(axes, errors, signal: str, place: np.ndarray) -> None:
    """Numbered frames about the findings of a signal."""
    for number, each in enumerate(errors, start=1):
        if each.signal != signal:
            continue
        start, end = (edge / 1000 for edge in each.stretch) if each.stretch else (place[0], place[-1])
        bottom, top = axes.get_ylim()
        lower, upper = max(each.lower, 1.02 * bottom), min(each.upper, 0.98 * top)
        axes.add_patch(Rectangle((start, lower), end - start, upper - lower, fill=False, color="black", linewidth=0.9))
        axes.annotate(
            str(number), (start, upper), xytext=(1.5, -1.5), textcoords="offset points", fontsize=6, va="top", ha="left", weight="bold",
            color="white", bbox={"boxstyle": "square,pad=0.15", "facecolor": "black", "edgecolor": "none"},
        )  # fmt: skip


def _spectra(axes, found: xr.Dataset, signal: str) -> None:
    """Densities of signal, error and floor over frequency, which runs upwards as on the map."""
    factor, unit = printed(signal)
    frequency = found["frequency"].values
    kept = (frequency >= BANDS[0][0]) & (frequency <= BANDS[-1][1])
    densities = (("measured", "measured_density", style.MEASURED), ("error", "error_density", style.ERROR))
    for label, name, colour in densities:
        axes.plot(factor**2 * found[name].values[kept], frequency[kept], color=colour, label=label)
    floor = factor**2 * found["floor_density"].values
    if (floor > 0).any():
        axes.plot(floor, found["frequency_map"].values, color=style.FLOOR, linestyle=(0, (3, 1.5)), label="floor")
    axes.set_xscale("log")
    axes.set_xlabel(f"density [({unit})²/Hz]", labelpad=1, fontsize=6.5)
    axes.tick_params(axis="x", labelsize=6)
