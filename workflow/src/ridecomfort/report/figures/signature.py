"""The missing force against what it could depend on, to be checked by eye."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import style
from ..notation import words
from ..study import Diagnosis

BAND = 1.645
"""Standard errors of a 90 % interval."""

POORLY_KNOWN = 8.0
"""Times the usual standard error beyond which an estimate is not drawn: where the car was hardly ever."""

NOTHING = 0.01
"""Share of the largest force within reach below which the named effects show nothing."""

AXLE_LINES = {"front": ("#0072B2", "o"), "rear": ("#009E73", "s")}


def signature(found: Diagnosis) -> Figure:
    """Estimated missing force with its 90 % interval at every place it could act, a column each axle, one scale for all panels of
    the strut and one for those of the tyre, and what the named effects would show together."""
    ranking = found.ranking
    drawn = style.figure(style.DOUBLE, 5.8)
    if "missing_force" not in ranking:
        axes = drawn.subplots()
        axes.set_axis_off()
        axes.text(0.5, 0.5, "The missing force was not estimated.", ha="center")
        return drawn
    places, axles = ranking["seen"].values, ranking["axle"].values
    panels = drawn.subplots(len(places), len(axles), squeeze=False, sharex="row", sharey="row")
    reaches = {kind: max(_reach(ranking.sel(seen=place)) for place in places if _kind(place) == kind) for kind in map(_kind, places)}
    for row, place in zip(panels, places):
        one = ranking.sel(seen=place)
        factor, unit = (1e3, "mm") if str(one["seen_unit"].item()) == "m" else (1.0, str(one["seen_unit"].item()))
        reach, share = reaches[_kind(place)], 100 * float(one["seen_share"])
        for axes, axle in zip(row, axles):
            own = one.sel(axle=axle)
            force, error = own["missing_force"].values, BAND * own["missing_force_error"].values
            known = _known(one).sel(axle=axle).values
            at = factor * own["seen_at"].values
            colour, marker = AXLE_LINES[str(axle)]
            axes.axhline(0.0, color=style.FLOOR, linewidth=0.7)
            axes.fill_between(at[known], (force - error)[known], (force + error)[known], color=colour, alpha=0.2, linewidth=0)
            axes.plot(at[known], force[known], color=colour, marker=marker, markersize=3.5)
            shown = own["named_force"].fillna(0.0).sum("named_effect").values
            if np.abs(shown[known]).max(initial=0.0) > NOTHING * reach:
                axes.plot(at[known], shown[known], color=style.ERROR, linestyle="--")
            axes.set_ylim(-reach, reach)
            axes.set_title(f"{axle} {place}: {share:.0f} % of the error")
            axes.set_xlabel(f"{place}, in compression [{unit}]")
        row[0].set_ylabel("missing force,\npushing apart [N]")
    together = " and ".join(words(str(effect)) for effect in ranking["named_effect"].values)
    nothing = "nothing, what is named acts elsewhere" if found.verdict["effects"] else "nothing is named"
    handles = [
        Line2D([], [], color=colour, marker=marker, markersize=3.5, label=f"estimated, {axle}")
        for axle, (colour, marker) in AXLE_LINES.items()
    ]
    handles += [
        Patch(color=style.FAINT, alpha=0.5, label="90 % interval"),
        Line2D([], [], color=style.ERROR, linestyle="--", label=f"what would show: {together or nothing}"),
    ]
    drawn.legend(handles=handles, loc="outside upper center", ncols=3)
    return drawn


def _kind(place: str) -> str:
    """What a force acts on, whose panels have one scale: the strut, the tyre."""
    return str(place).split()[0]


def _reach(one) -> float:
    """N that a row of panels shows: the estimates that are drawn, with their intervals, and what the named effects would show."""
    known = _known(one).values
    estimated = np.abs(one["missing_force"]) + BAND * one["missing_force_error"]
    shown = np.abs(one["named_force"].fillna(0.0).sum("named_effect"))
    reach = np.maximum(estimated, shown).values[known]
    return 1.1 * float(reach.max(initial=0.0)) + 1e-9


def _known(one):
    """Whether (axle, knot) an estimate is about as well known as most of them of its row."""
    error = one["missing_force_error"].where(np.isfinite(one["missing_force"]))
    return error <= max(POORLY_KNOWN * float(error.median()), 1e-9)
