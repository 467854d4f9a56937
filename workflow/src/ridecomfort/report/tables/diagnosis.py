"""The verdict on the missing effect, and the evidence behind it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...discrepancy.verdict import LITTLE, first_sentence, sentence
from ...effects.contract import PORTS
from .. import catalogue
from ..notation import unit, words
from ..study import Diagnosis
from ..table import Column, Source, Table
from . import advice

SUSPECT = "The data are suspect: what stands here explains their error as they are, and may be what is wrong with them."
"""What is said of effects that were found on such data."""

FILE_ALONE = "No effect of the library is missing: parameters of the vehicle lie far from its file."
"""What is said where those are all that was found."""


def _promise(proposal: Mapping) -> str:
    """What a proposed form removes of the error, and how sure it is."""
    held_out = proposal["held_out_share"]
    checked = "" if held_out is None else f", {100 * held_out:.0f} % on drives held out"
    fitted = f"{100 * proposal['share']:.0f} % of the explainable error on the fitted drives"
    little = ": too little to be what is missing" if proposal["share"] < LITTLE else ""
    return f"{fitted}{checked} (p = {proposal['p_value']:.2g}){little}."


def verdict(found: Diagnosis) -> Table:
    """The verdict in words: what it is, why, and what to do next."""
    said = found.verdict
    told = [effect for effect in said["effects"] if said["verdict"] != "suspect" or effect.get("is_of_measurement")]
    names = [_alike(effect) for effect in told]
    proposal, beyond = said.get("proposal") or {}, said.get("beyond_bounds")
    first = FILE_ALONE if advice.is_file_alone(said) else first_sentence(said["verdict"], names)
    rows = [("verdict", f"{first} ({said['verdict']})")]
    rows += [("reason", sentence(reason)) for reason in said["reasons"]]
    if beyond:
        rows.append(("the vehicle", advice.farther(beyond)))
    if advice.library_helps(said):
        held_out, take = said["held_out_share"], "together take" if len(said["effects"]) > 1 else "takes"
        checked = "" if held_out is None else f", {100 * held_out:.0f} % on drives held out"
        taken = f"{', '.join(names)} {take} {100 * said['share']:.0f} % on the fitted drives{checked}, and may stand in for what is missing."
        rows.append(("in the library", taken))
    if proposal.get("form"):
        rows.append(("proposed form", f"{proposal['form']} (at the {proposal['place']})"))
        rows.append(("in it", sentence(PORTS[proposal["port"]].meaning)))
        rows.append(("it removes", _promise(proposal)))
    rows.append(("next, after the vehicle" if beyond else "next", advice.next_step(found)))
    columns = Column("what", ("",)), Column("in_words", ("In words",))
    sources = (Source("all", found.files.get("verdict", ""), "verdict, effects, reasons, proposal", "as in the file"),)
    return _table(found, "verdict", columns, rows, sources)


def missing_effects(found: Diagnosis) -> Table:
    """Sizes of the named effects with intervals and plausible range, and the error that each removed."""
    columns = (
        Column("effect", ("", "Effect")),
        Column("parameter", ("", "Size")),
        Column("unit", ("", "Unit")),
        Column("size", ("Estimate", "value"), ".4g"),
        Column("interval_lower", ("Estimate", "90 % from"), ".4g"),
        Column("interval_upper", ("Estimate", "to"), ".4g"),
        Column("plausible", ("", "Plausible")),
        Column("p_value", ("", "p over the library"), ".2g"),
        Column("fitted_pct", ("Explainable error removed [%]", "fitted"), ".0f"),
        Column("held_out_pct", ("Explainable error removed [%]", "held out"), ".0f"),
        Column("absorbed_pct", ("Absorbed by", "calibration [%]"), ".0f"),
        Column("like", ("", "Not told from")),
    )
    rows, breaks = [], []
    for effect in found.verdict["effects"]:
        breaks.append(len(rows))
        shares = [_percent(effect[key]) for key in ("share", "held_out_share", "absorbed")]
        like = ", ".join(words(name) for name in effect["like"]) or "–"
        of_all = (effect["p_value"], *shares, like)
        for number, size in enumerate(effect["sizes"] or [{}]):
            lower, upper = size.get("interval", (None, None))
            plausible = {True: "yes", False: "no", None: ""}[size.get("is_plausible")]
            if size.get("plausible"):
                plausible += " ({:.4g} to {:.4g})".format(*size["plausible"])
            rows.append(
                (words(effect["name"]), words(size.get("parameter", "")), unit(size.get("unit", "")), size.get("size"), lower, upper,
                 plausible, *(of_all if number == 0 else (*(None,) * 4, "")))
            )  # fmt: skip
    if not rows:
        rows.append(("none", *("",) * 2, *(None,) * 3, "", *(None,) * 4, ""))
    sources = (Source("all", found.files.get("verdict", ""), "effects", "as in the file, shares in percent"),)
    notes = (
        "Shares are of the explainable error of the calibrated model before any effect was added. Removed is what goes when an effect "
        "joins those above it, all sizes fitted together and the drives aligned for them, above the floor that the last model shows: "
        "the evidence has the refit that it was chosen by, above the floor of that round, and the error ladder what is left when the "
        "study calibrates anew, site by site. They are of all sizes of an effect together and stand beside its first. Absorbed: "
        "share of the effect's response that calibration can take up, and so hide.",
        *([SUSPECT] if found.verdict["verdict"] == "suspect" and found.verdict["effects"] else []),
    )
    return _table(found, "missing_effects", columns, rows, sources, notes, breaks[1:])


def evidence(found: Diagnosis) -> Table:
    """Score test of every effect by round, strongest first, with the refits of those that were refitted."""
    columns = (
        Column("round", ("", "Round"), "d"),
        Column("effect", ("", "Effect")),
        Column("p_value", ("Score test", "p over the library"), ".2g"),
        Column("gain", ("Score test", "gain"), ".0f"),
        Column("absorbed_pct", ("Score test", "absorbed [%]"), ".0f"),
        Column("sizes", ("Refit", "sizes")),
        Column("refit_gain", ("Refit", "gain"), ".0f"),
        Column("bic", ("Refit", "BIC"), ".0f"),
        Column("fitted_pct", ("Explainable error removed [%]", "fitted"), ".0f"),
        Column("held_out_pct", ("Explainable error removed [%]", "held out"), ".0f"),
        Column("outcome", ("", "Outcome")),
    )
    ranking, rows, breaks = found.ranking, [], []
    for number, turn in enumerate(ranking["round"].values):
        breaks.append(len(rows))
        one = ranking.sel(round=turn)
        refitted = np.flatnonzero(ranking["trial_round"].values == turn)
        trials = {str(ranking["trial_effect"].values[k]): k for k in refitted}
        gain = one["gain"].values
        for place in sorted(range(len(gain)), key=lambda k: -np.nan_to_num(gain[k], nan=-np.inf)):
            name = str(ranking["effect"].values[place])
            if not np.isfinite(gain[place]):
                continue
            refit = (None,) * 5
            said = ""
            if name in trials:
                trial = ranking.isel(trial=trials[name])
                refit = (
                    str(trial["trial_sizes"].item()), *(float(trial[f"trial_{key}"]) for key in ("gain", "bic")),
                    *(_percent(float(trial[f"trial_{key}"])) for key in ("share", "held_out_share")),
                )  # fmt: skip
                said = outcome(name, str(one["winner"].item()), str(trial["trial_objection"].item()))
            score = float(one["p_value"][place]), float(gain[place]), _percent(float(one["absorbed"][place]))
            rows.append((int(turn), words(name), *score, refit[0] or "", *refit[1:], said))
    sources = (
        Source("score test", found.files.get("ranking", ""), "p_value, gain, absorbed", "as in the file"),
        Source("refit", found.files.get("ranking", ""), "trial_*", "as in the file, shares in percent"),
        Source("outcome", found.files.get("ranking", ""), "winner, trial_objection", "as in the file"),
    )
    notes = (
        "Gain: fall of twice the negative log-likelihood. The p-value is that of the largest gain over the whole library, by block "
        "wild bootstrap: a screen of what is worth a refit, too small on short drives (docs/diagnosis.md). Every effect is tested; the "
        "best are refitted together with the calibrated parameters, and what that removes "
        "is told above the floor as known in the round: for what an accepted effect removes in the end see the missing effects.",
    )
    return _table(found, "evidence", columns, rows, sources, notes, breaks[1:])


def outcome(name: str, winner: str, objection: str) -> str:
    """What came of the refit of an effect in a round that ``winner`` won (empty where none did)."""
    return "accepted" if name == winner else objection or "explains less"


def _alike(effect) -> str:
    return " or ".join(words(name) for name in (effect["name"], *effect["like"]))


def _percent(share: float | None) -> float | None:
    return None if share is None else 100 * share


def _table(found: Diagnosis, name, columns, rows, sources, notes=(), breaks=()) -> Table:
    sites = ", ".join(catalogue.label(site) for site in found.sites)
    notes = [*notes, f"Diagnosed: the model {found.model} on {sites}.", *filter(None, [found.standin_note()])]
    caption = catalogue.DIAGNOSIS_TABLES[name]
    return Table(name, caption, tuple(columns), tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks))
