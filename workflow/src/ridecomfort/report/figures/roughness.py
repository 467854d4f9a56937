"""What the resolution of a survey hides of the IRI."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from .. import style
from ..study import Study
from ..tables.roughness import QUALITIES, classes, length, resolution


def iri_resolution(study: Study) -> Figure:
    """Share of the road by class, by the survey and in full resolution: one bar each, site by site."""
    drawn = style.figure(style.DOUBLE, 0.85 + 0.5 * len(study.sites))
    axes = drawn.subplots()
    names = []
    for row, site in enumerate(study.sites):
        for place, variable in ((2 * row + 0.1, "iri"), (2 * row + 0.9, "iri_full")):
            found = classes(site.iri, variable)
            shares = 100.0 * np.bincount(found, minlength=len(QUALITIES)) / found.size
            left = np.concatenate([[0.0], np.cumsum(shares)])
            for name, share, start in zip(QUALITIES, shares, left):
                axes.barh(
                    place, share, left=start, height=0.66, color=style.SEVERITY[name], edgecolor="#555555", linewidth=0.4
                )
                if share >= 3:
                    axes.text(start + share / 2, place, f"{share:.0f}", ha="center", va="center", fontsize=6)
        names += [f"{site.label}, survey", f"{site.label}, full"]
    axes.set_yticks([2 * row + offset for row in range(len(study.sites)) for offset in (0.1, 0.9)], names)
    axes.tick_params(axis="y", length=0)
    axes.invert_yaxis()
    axes.set_xlim(0, 100)
    axes.set_xlabel("share of the road [%]")
    handles = [
        Patch(facecolor=style.SEVERITY[name], edgecolor="#555555", linewidth=0.4, label=name) for name in QUALITIES
    ]
    axes.set_title(f"survey: {resolution(study):g} m; full: continuous over {length(study):g} m; classes at the mean speed")
    drawn.legend(handles=handles, loc="outside upper center", ncols=len(handles), handlelength=1.2, columnspacing=1.2)
    return drawn
