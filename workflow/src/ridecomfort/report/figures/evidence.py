"""Evidence for the effects of the library, round after round."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...discrepancy.propose import CERTAIN, LEVEL
from ...discrepancy.ranking import forms as forms_of
from .. import style
from ..notation import words
from ..study import Diagnosis
from ..table import MISSING
from ..tables.diagnosis import NO_FORMS, STRONGEST, outcomes, refits

NONE_REFITTED = "none was refitted"
"""What stands in place of refits in a round without."""

LEAST = 1.0
"""Percent to both sides of zero that shares are drawn over at least: what removes nothing must look like nothing."""

MOST = 110.0
"""Percent to both sides of zero that shares are drawn over at most: of drives that have little to explain a share may be anything, and one such
would press all others together."""

PAGE, HEAD, AROUND, EACH = 9.0, 0.9, 0.5, 0.155
"""Inches: the height that a page has room for, and what the figure, a round and a bar take of it."""

FOUR_DIGITS, THREE_DIGITS, LONG = 9999, 999, 30
"""Gain beyond which labels of four ticks collide, and where names of so many letters leave less room for them."""

FEWEST = 6
"""Bars of a round that are drawn however many rounds there are: more than are refitted."""

SIGNIFICANT, OTHER, ACCEPTED = "#0072B2", "#C9D3DA", "#D55E00"

DOT = {"marker": "o", "linestyle": "", "color": style.CALIBRATED, "markersize": 4.5}
DIAMOND = {**DOT, "marker": "D", "markerfacecolor": "none", "markeredgewidth": 1.0, "markersize": 6}
"""How shares are drawn that a refit removes: open on drives held out, so that both are seen where they agree."""

OBJECTIONS = {
    "lies outside what is plausible": "size not plausible",
    "not surely better on drives held out": "not surely better held out",
    "of the explainable error": "removes too little",
    "of what repeats share yet": "removes too little",
    "that gain most were": "not refitted",
    "its refit gains less": "refit gains too little",
    "opposite sign": "not refitted: opposite sign",
    "makes the error larger": "taken back: error grows",
}
"""How objections of the search are said in a few words, by a part of each."""


def evidence(found: Diagnosis) -> Figure:
    """Score test of the strongest effects (left) and, of those refitted, the explainable error removed (right), a row each round."""
    return _drawn(found.ranking, "No effect of the library could be tested.")


def forms(found: Diagnosis) -> Figure:
    """The same of forces of any form."""
    tried = forms_of(found.ranking)
    return _drawn(xr.Dataset(coords={"round": [], "effect": []}) if tried is None else tried, NO_FORMS)


def _drawn(ranking: xr.Dataset, none: str) -> Figure:
    """The evidence of a ``ranking``; where it holds nothing, the words for ``none``."""
    rounds = ranking["round"].values
    room = int(((PAGE - HEAD) / max(len(rounds), 1) - AROUND) / EACH)
    shown = min(max(room, FEWEST), STRONGEST, ranking.sizes["effect"])
    drawn = style.figure(style.DOUBLE, HEAD + (AROUND + EACH * shown) * max(len(rounds), 1))
    if not len(rounds) or not shown:
        axes = drawn.subplots()
        axes.set_axis_off()
        axes.text(0.5, 0.5, none, ha="center")
        return drawn
    is_checked = bool(np.isfinite(ranking["trial_held_out_share"].values).any())
    panels = drawn.subplots(len(rounds), 2, squeeze=False, sharey="row", width_ratios=(1.4, 1.0))
    for (left, right), turn in zip(panels, rounds):
        one = ranking.sel(round=turn)
        names = _shown(one, shown)
        winner = str(one["winner"].item())
        _scores(left, one.sel(effect=names), names, winner)
        tested = int(np.isfinite(one["gain"].values).sum())
        drawn_of = f", {len(names)} of {tested}" if len(names) < tested else ""
        came = f": none of {tested} accepted" if tested else ": nothing left to test"
        left.set_title(f"round {turn}{drawn_of if winner else came}")
        _refits(right, one, names, is_checked)
        is_narrow = max((len(_label(name)) for name in names), default=0) > LONG
        is_crowded = left.get_xlim()[1] > (THREE_DIGITS if is_narrow else FOUR_DIGITS)
        for axes, count in ((left, 3 if is_crowded else 4), (right, 3 if is_narrow else 5)):
            axes.locator_params(axis="x", nbins=count)
            axes.tick_params(axis="y", length=0)
    panels[0][1].set_title("refits: fitted / held out" if is_checked else "refits: on fitted drives")
    panels[-1][0].set_xlabel("gain of 2 ln L, square-root scale [-]")
    refitted = [right for _, right in panels if right.xaxis.get_tick_params()["labelbottom"]]
    (refitted or [panels[-1][1]])[-1].set_xlabel("error removed [%]")
    handles = [
        Patch(color=ACCEPTED, label="accepted into the next round"),
        Patch(color=SIGNIFICANT, label=f"significant over all (p ≤ {LEVEL:g})"),
        Patch(color=OTHER, label="not significant"),
        Line2D([], [], **DOT, label="on fitted drives"),
        *([Line2D([], [], **DIAMOND, label="on drives held out")] if is_checked else ()),
    ]
    drawn.legend(handles=handles, loc="outside upper center", ncols=3)
    return drawn


def _shown(one: xr.Dataset, most: int) -> list[str]:
    """Names of the ``most`` candidates of a round that gain most, the largest gain first; those that were refitted go before others."""
    gain, tried = one["gain"].values, refits(one)
    tested = [str(one["effect"].values[k]) for k in np.argsort(-gain) if np.isfinite(gain[k])]
    kept = sorted(tested, key=lambda name: name not in tried)[:most]
    return [name for name in tested if name in kept]


def _scores(axes: Axes, tested: xr.Dataset, names: Sequence[str], winner: str) -> None:
    """Bars of the score test of these effects, the first at the top."""
    for place, (name, gain, p_value) in enumerate(zip(names, tested["gain"].values, tested["p_value"].values)):
        colour = ACCEPTED if name == winner else SIGNIFICANT if p_value <= LEVEL else OTHER
        axes.barh(place, max(gain, 0.0), height=0.7, color=colour)
        said = f"p = {p_value:.2g}" if p_value > CERTAIN else f"p < {CERTAIN:g}"
        axes.annotate(said, (max(gain, 0.0), place), xytext=(3, 0), textcoords="offset points", va="center", fontsize=6)
    axes.set_yticks(range(len(names)), [_label(name) for name in names])
    axes.invert_yaxis()
    axes.set_xscale("function", functions=(np.sqrt, np.square))  # as a z-value: beside one large gain the others would be invisible
    axes.set_xlim(0.0, 1.4 * max([1.0, *tested["gain"].values]))


def _refits(axes: Axes, one: xr.Dataset, names: Sequence[str], is_checked: bool) -> None:
    """What the refits of a round removed, on drives held out too where any are ``is_checked``, and what came of them, or why a significant
    effect was not refitted."""
    came = {name: _shortened(said) for name, said in outcomes(one).items()}
    for name, trial in refits(one).items():
        shares = [100 * float(trial[key]) for key in ("trial_share", "trial_held_out_share")]
        if name in names:
            place = names.index(name)
            axes.plot(np.clip(shares, -MOST, MOST), [place, place], color=style.FAINT, linewidth=0.8, zorder=1)
            for share, mark in zip(shares, (DOT, DIAMOND)):
                beyond = {} if not abs(share) > MOST else {"marker": ">" if share > 0 else "<"}
                axes.plot(np.clip(share, -MOST, MOST), place, **{**mark, **beyond}, clip_on=False)
        told = np.round(shares if is_checked else shares[:1]) + 0.0
        said = " / ".join(f"{share:.0f}".replace("-", "−") if np.isfinite(share) else MISSING for share in told)
        came[name] = f"{said} %  {came[name]}" if np.isfinite(told).any() else came[name]
    for place, name in enumerate(names):
        axes.text(1.06, place, came[name], transform=axes.get_yaxis_transform(), va="center", fontsize=6)
    if not axes.lines:
        said = "" if any(came[name] for name in names) else NONE_REFITTED
        axes.text(0.5, 0.5, said, transform=axes.transAxes, ha="center", va="center", fontsize=6)
        axes.tick_params(axis="x", bottom=False, labelbottom=False)
        axes.spines[:].set_visible(False)
        return
    axes.set_xlim(min(axes.get_xlim()[0], -LEAST), max(axes.get_xlim()[1], LEAST))
    axes.axvline(0.0, color=style.FLOOR, linewidth=0.7)


def _label(name: str) -> str:
    return words(name).replace(":", ": ")


def _shortened(came: str) -> str:
    """What came of a refit, in a few words."""
    return next((short for part, short in OBJECTIONS.items() if part in came), came)
