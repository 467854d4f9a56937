"""Comfort along the sites: signals over distance, thresholds, and the sections that are critical."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from .. import style
from ..classes import CRITICAL_BANDS, CRITICAL_QUALITIES, STYLES
from ..notation import symbol
from ..study import Study

LIKELY = 0.5
"""How strongly the colour of a section shows that is critical in every run but not in the mean."""

COARSE = 8
"""Every how many places the edges of the IRI classes are drawn: they are smooth, and their polygons weigh."""

COLUMNS = 700
"""Columns of the strips of sections at most, so that each is as wide as a pixel and none is skipped."""

DISTANCE = "distance along the road $s$ [m]"


def thresholding_results_1(study: Study) -> Figure:
    """fig:thresholding_results_1: longitudinal and lateral acceleration, thresholds, critical sections."""
    return _thresholding(study, ("a_x", "a_y"))


def thresholding_results_2(study: Study) -> Figure:
    """fig:thresholding_results_2: vertical acceleration, thresholds, critical sections."""
    return _thresholding(study, ("a_z",))


def ride_comfors(study: Study) -> Figure:
    """fig:ride_comfors: vibration total value of ISO 2631 with its bands and critical sections."""
    drawn, panels = _panels(study, 1, len(CRITICAL_BANDS))
    for site, ((signal, strip),) in zip(study.sites, panels):
        dataset = site.iso2631
        s, values = dataset["s"].values, dataset["a_v"].values
        top = 1.12 * float(np.nanmax(values))
        lower = dataset["band_lower"].values
        for name, low, high in zip(dataset["band"].values.tolist(), lower, [*lower[1:], np.inf]):
            if low < top:
                signal.axhspan(low, min(high, top), color=style.SEVERITY[name], alpha=0.55, linewidth=0)
                _edge_label(signal, 0.5 * (low + min(high, top)), name)
        signal.plot(s, values, color=style.MEASURED, linewidth=0.7)
        signal.set_ylim(0, top)
        signal.set_ylabel(style.axis_label("a_v"))
        signal.set_title(site.label)
        _strip(strip, dataset, "band", CRITICAL_BANDS)
    _finish(drawn, panels)
    return drawn


def iri_thresholds(study: Study) -> Figure:
    """fig:IRI_thresholds: IRI of the survey and in full resolution, classes at the mean speed of the runs."""
    resolution = study.settings["comfort"]["iri"]["segment"]
    drawn, panels = _panels(study, 1, len(CRITICAL_QUALITIES))
    for site, ((signal, strip),) in zip(study.sites, panels):
        dataset = site.iri
        s, survey, full = dataset["s"].values, dataset["iri"].values, dataset["iri_full"].values
        top = 1.08 * max(float(np.nanmax(survey)), float(np.nanmax(full)))
        below = np.zeros(s.size)
        coarse = np.append(np.arange(0, s.size - 1, COARSE), s.size - 1)
        for name in dataset["quality"].values.tolist():
            edge = np.minimum(np.nan_to_num(dataset["threshold"].sel(quality=name).values, nan=np.inf), top)
            if name == "P":
                edge = np.full(s.size, top)
            fill = {"color": style.SEVERITY[name], "alpha": 0.55, "linewidth": 0}
            signal.fill_between(s[coarse], below[coarse], edge[coarse], **fill)
            if edge[-1] - below[-1] > 0.07 * top:
                _edge_label(signal, 0.5 * (edge[-1] + below[-1]), name)
            below = edge
        signal.plot(s, full, color=style.FAINT, linewidth=0.6, label="full resolution")
        signal.plot(s, survey, color=style.MEASURED, linewidth=1.1, label=f"survey, {resolution:g} m")
        signal.set_ylim(0, top)
        signal.set_ylabel("IRI [m/km]")
        signal.set_title(site.label)
        _strip(strip, dataset, "quality", CRITICAL_QUALITIES)
    handles, labels = panels[0][0][0].get_legend_handles_labels()
    _finish(drawn, panels, handles, labels)
    return drawn


def _thresholding(study: Study, axes: tuple[str, ...]) -> Figure:
    shown: dict = {}
    drawn, panels = _panels(study, len(axes), len(STYLES), 1.25 if len(axes) > 1 else 1.6)
    for site, row in zip(study.sites, panels):
        for axis, (signal, strip) in zip(axes, row):
            dataset = site.thresholds
            values = dataset[axis].values
            signal.plot(dataset["s"].values, values, color=style.SIGNAL, linewidth=0.5)
            low, high = _range(values)
            for name in STYLES:
                for edge in ("lower", "upper"):
                    level = float(dataset[edge].sel(axis=axis, style=name))
                    if low <= level <= high:
                        look = {"color": style.SEVERITY[name], "dashes": _DASHES[name], "linewidth": 1.1}
                        shown[name] = signal.axhline(level, **look)
            signal.set_ylim(low, high)
            signal.set_ylabel(style.axis_label(axis))
            signal.set_title(f"{site.label}, {symbol(axis)}")
            _strip(strip, dataset.sel(axis=axis), "style", STYLES)
    named = [name for name in STYLES if name in shown]
    _finish(drawn, panels, [shown[name] for name in named], [f"threshold {name}" for name in named])
    return drawn


_DASHES = {"PT": (5, 1.5), "ND": (3, 1.5), "AG": (1.5, 1.5)}


def _range(values) -> tuple[float, float]:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = 0.15 * max(high - low, 1e-9)
    return low - margin, high + margin


def _panels(study: Study, columns: int, classes: int, height: float = 1.25):
    """A figure with, for every site, one row of pairs: the signal above the strip of its sections."""
    rows = len(study.sites)
    heights = [height, 0.14 * classes] * rows
    drawn = style.figure(style.DOUBLE, 0.4 + rows * (height + 0.14 * classes))
    grid = drawn.add_gridspec(2 * rows, columns, height_ratios=heights)
    panels = []
    for row in range(rows):
        pairs = []
        for column in range(columns):
            signal = drawn.add_subplot(grid[2 * row, column])
            pairs.append((signal, drawn.add_subplot(grid[2 * row + 1, column], sharex=signal)))
        panels.append(pairs)
    return drawn, panels


def _strip(strip: Axes, dataset, dimension: str, classes) -> None:
    """Sections by class: full colour where the mean is critical, paler by the share of the runs elsewhere."""
    start = dataset["window_start"].values
    length = float(dataset.attrs["critical_length"])
    step = float(start[1] - start[0]) if start.size > 1 else length
    # Of sliding sections many lie over one place; the strip shows the strongest.
    size = max(1, round(length / step))
    # Nor do all fit beside each other on a long road.
    block = -(-(start.size + size - 1) // COLUMNS)
    columns = -(-(start.size + size - 1) // block)
    image = np.ones((len(classes), columns, 3))
    for row, name in enumerate(classes):
        chosen = dataset.sel({dimension: name})
        probability = np.nan_to_num(chosen["exceedance_probability"].values)
        strength = np.where(chosen["critical"].values > 0, 1.0, LIKELY * probability)
        strength = np.pad(strength, size - 1)
        strength = np.lib.stride_tricks.sliding_window_view(strength, size).max(axis=1)
        strength = np.pad(strength, (0, columns * block - strength.size)).reshape(columns, block).max(axis=1)
        image[row] += strength[:, None] * (np.array(to_rgb(style.SEVERITY[name])) - 1.0)
    strip.imshow(
        image,
        extent=(start[0], start[0] + columns * block * step, len(classes) - 0.5, -0.5),
        aspect="auto",
        interpolation="nearest",
    )
    strip.set_yticks(range(len(classes)), classes, fontsize=6)
    strip.tick_params(axis="y", length=0)
    for side in ("top", "right"):
        strip.spines[side].set_visible(True)
    for line in np.arange(0.5, len(classes) - 1):
        strip.axhline(line, color=style.GRID, linewidth=0.5)
    strip.set_xlim(start[0], start[-1] + length)


def _edge_label(axes: Axes, level: float, text: str) -> None:
    axes.annotate(
        text,
        (1.0, level),
        xycoords=("axes fraction", "data"),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        fontsize=6,
        annotation_clip=False,
    )


def _finish(drawn: Figure, panels, handles=(), labels=()) -> None:
    for row in panels:
        for signal, strip in row:
            signal.tick_params(labelbottom=False)
            signal.margins(x=0)
            strip.set_xlabel("")
    for _, strip in panels[-1]:
        strip.set_xlabel(DISTANCE)
    drawn.align_ylabels([signal for row in panels for signal, _ in row[:1]])
    handles = [*handles, Patch(color="#555555"), Patch(color="#BBBBBB")]
    labels = [*labels, "critical in the mean of the runs", "in some runs only (paler: fewer)"]
    drawn.legend(handles, labels, loc="outside upper right", ncols=len(handles), handlelength=1.8, columnspacing=1.2)


