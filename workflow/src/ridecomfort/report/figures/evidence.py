"""Evidence for the effects of the library, round after round."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...discrepancy.propose import CERTAIN, LEVEL
from .. import style
from ..notation import words
from ..study import Diagnosis
from ..tables.diagnosis import outcome

SHOWN = 12
"""Effects of each round that are drawn, the strongest."""

LEAST = 1.0
"""Percent to both sides of zero that shares are drawn over at least: what removes nothing must look like nothing."""

SIGNIFICANT, OTHER, ACCEPTED = "#0072B2", "#C9D3DA", "#D55E00"

DOT = {"marker": "o", "linestyle": "", "color": style.CALIBRATED, "markersize": 4.5}
DIAMOND = {**DOT, "marker": "D", "color": style.REFERENCE, "markeredgecolor": "black", "markeredgewidth": 0.4}


OBJECTIONS = {
    "lies outside what is plausible": "size not plausible",
    "not worth its parameters": "not worth its sizes (BIC)",
    "does not improve the drives held out": "not surely better held out",
    "of the explainable error": "too little",
}
"""How objections of the search are said in a few words, by a part of each."""


def evidence(found: Diagnosis) -> Figure:
    """Score test of the strongest effects (left) and, of those refitted, the explainable error removed (right), a row each round."""
    ranking = found.ranking
    rounds = ranking["round"].values
    shown = min(SHOWN, ranking.sizes["effect"])
    drawn = style.figure(style.DOUBLE, 0.9 + (0.5 + 0.155 * shown) * max(len(rounds), 1))
    if not len(rounds) or not shown:
        axes = drawn.subplots()
        axes.set_axis_off()
        axes.text(0.5, 0.5, "No effect of the library could be tested.", ha="center")
        return drawn
    panels = drawn.subplots(len(rounds), 2, squeeze=False, sharey="row", width_ratios=(1.4, 1.0))
    for (left, right), turn in zip(panels, rounds):
        one = ranking.sel(round=turn)
        gain = np.nan_to_num(one["gain"].values, nan=-np.inf)
        order = [k for k in np.argsort(-gain)[:shown] if np.isfinite(gain[k])]
        names = [str(ranking["effect"].values[k]) for k in order]
        p_value, winner = one["p_value"].values, str(one["winner"].item())
        for place, (k, name) in enumerate(zip(order, names)):
            colour = ACCEPTED if name == winner else SIGNIFICANT if p_value[k] <= LEVEL else OTHER
            left.barh(place, max(gain[k], 0.0), height=0.7, color=colour)
            end = max(gain[k], 0.0), place
            said = f"p = {p_value[k]:.2g}" if p_value[k] > CERTAIN else f"p < {CERTAIN:g}"
            left.annotate(said, end, xytext=(3, 0), textcoords="offset points", va="center", fontsize=6)
        left.set_yticks(range(len(names)), [words(name) for name in names])
        left.invert_yaxis()
        left.margins(x=0.15)
        left.set_xlim(left=0)
        left.tick_params(axis="y", length=0)
        left.set_title(f"round {turn}: " + (f"{words(winner)} accepted" if winner else "nothing accepted"))
        for k in np.flatnonzero(ranking["trial_round"].values == turn):
            name = str(ranking["trial_effect"].values[k])
            if name in names:
                place = names.index(name)
                shares = [100 * float(ranking[key].values[k]) for key in ("trial_share", "trial_held_out_share")]
                right.plot(shares, [place, place], color=style.FAINT, linewidth=0.8, zorder=1)
                right.plot(shares[0], place, **DOT, clip_on=False)
                right.plot(shares[1], place, **DIAMOND, clip_on=False)
                came = _shortened(outcome(name, winner, str(ranking["trial_objection"].values[k])))
                said = " / ".join(f"{share:.0f}" for share in np.round(shares) + 0.0 if np.isfinite(share)).replace("-", "−")
                right.text(1.06, place, f"{said} %  {came}", transform=right.get_yaxis_transform(), va="center", fontsize=6)
        right.set_title("refits of the best: fitted / held out")
        right.set_xlim(min(right.get_xlim()[0], -LEAST), max(right.get_xlim()[1], LEAST))
        for axes, count in ((left, 4), (right, 5)):
            axes.locator_params(axis="x", nbins=count)
        right.axvline(0.0, color=style.FLOOR, linewidth=0.7)
        right.tick_params(axis="y", length=0)
    panels[-1][0].set_xlabel("fall of $-2$ ln likelihood in the score test [-]")
    panels[-1][1].set_xlabel("explainable error removed [%]")
    handles = [
        Patch(color=ACCEPTED, label="accepted"),
        Patch(color=SIGNIFICANT, label=f"significant over the library (p ≤ {LEVEL:g})"),
        Patch(color=OTHER, label="not significant"),
        Line2D([], [], **DOT, label="on fitted drives"),
        Line2D([], [], **DIAMOND, label="on drives held out"),
    ]
    drawn.legend(handles=handles, loc="outside upper center", ncols=3)
    return drawn


def _shortened(came: str) -> str:
    """What came of a refit, in a few words."""
    return next((short for part, short in OBJECTIONS.items() if part in came), came)
