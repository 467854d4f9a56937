"""All methods and sites at a glance, this study beside the paper."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import published, style
from ..classes import CRITICAL_BANDS, CRITICAL_QUALITIES, STYLES
from ..notation import symbol
from ..study import Study

_CLASSES = (
    [
        ("thresholding_table", "thresholds", (axis, name))
        for axis in ("a_x", "a_y", "a_z")
        for name in STYLES
    ]
    + [("rid_comf_res", "iso2631", (name,)) for name in CRITICAL_BANDS]
    + [("rid_comf_res2", "iri", (name,)) for name in CRITICAL_QUALITIES]
)
_DIAMOND = {"marker": "D", "linestyle": "", "color": style.PAPER, "markersize": 3.6, "markerfacecolor": "white"}
_TITLES = {"rid_comf_res": "ISO 2631", "rid_comf_res2": "IRI"}
_DIMENSIONS = {"thresholds": ("axis", "style"), "iso2631": ("band",), "iri": ("quality",)}


def critical_shares(study: Study) -> Figure:
    """Share of critical sections R_c by method and class: bars of this study, diamonds of the paper."""
    drawn, panels = style.panels(len(study.sites), 2.1, 4.3, margin=0.9)
    columns = panels[0].get_subplotspec().get_gridspec().ncols
    places = _places()
    names = [f"{_TITLES.get(table, symbol(row[0]))} {row[-1]}" for table, _, row in _CLASSES]
    with_paper = False
    for axes, site in zip(panels, study.sites):
        for place, (table, dataset, row) in zip(places, _CLASSES):
            chosen = getattr(site, dataset).sel(dict(zip(_DIMENSIONS[dataset], row)))
            share = float(chosen["critical_share"])
            axes.barh(place, share, height=0.72, color=style.SEVERITY[row[-1]], edgecolor="#555555", linewidth=0.4)
            printed = published.detection(table, row, site.name)
            if printed:
                with_paper = True
                axes.plot(printed[1], place, **_DIAMOND, clip_on=False, zorder=3)
        style.panel_title(axes, site.label, margin=0.9)
        axes.set_xlabel("share of critical sections $R_c$ [%]" if columns < 4 else "share $R_c$ [%]")
        axes.xaxis.grid(True)
        axes.set_axisbelow(True)
    panels[0].set_xlim(left=0)
    panels[0].set_yticks(places, names)
    panels[0].invert_yaxis()
    for axes in panels:
        axes.tick_params(axis="y", length=0)
    handles = [Patch(facecolor="#BBBBBB", edgecolor="#555555", linewidth=0.4, label="this study")]
    if with_paper:
        handles.append(Line2D([], [], **_DIAMOND, label="paper"))
    drawn.legend(handles=handles, loc="outside upper right", ncols=2)
    return drawn


def _places() -> np.ndarray:
    """Heights of the bars, with a gap where axis or method changes."""
    groups = [(table, row[:-1]) for table, _, row in _CLASSES]
    gaps = np.cumsum([0.0] + [0.6 * (one != other) for one, other in zip(groups, groups[1:])])
    return np.arange(len(groups)) + gaps
