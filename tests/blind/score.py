"""A verdict against the truth, and figures of many of them with their uncertainty."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.stats import binomtest

from ridecomfort.calibrated import with_values
from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import floor, opening
from ridecomfort.discrepancy.ranking import SHARED
from ridecomfort.discrepancy.selection import around
from ridecomfort.errors import InputError

from .kinds import KAPPAS, SUSPECT, Draw

FORM = 0.8
"""Share of what the true effect removes of the error held out from which on a form counts as that of the effect, up to one over it: what removes
more than that takes up something else."""

CLOSE = 0.05
"""Share of its true value within which a parameter counts as told."""

LEVEL = 0.05
"""p-value of the best of the whole library, below which it is an alarm where nothing is missing."""

VISIBLE = 0.8
"""Share of a kappa that must be reached for a trial to count as one of that kappa."""


SECONDS = 20
"""s of CPU time that a search should take."""


def score(draw: Draw, truth: Mapping, table, verdict) -> dict:
    """What a verdict got right, as a row of trials.csv. Where it calls the data suspect it names no effect of the vehicle, whatever it lists."""
    named = verdict.claimed
    found, names = ([effect.name for effect in effects] for effects in (verdict.effects, named))
    likely = set(names).union(*(effect.like for effect in named))
    sizes = [
        size["interval"][0] <= truth["effects"][effect.name][size["parameter"]] <= size["interval"][1]
        for effect in verdict.effects
        if effect.name in truth["effects"]
        for size in effect.sizes
    ]
    return {
        "verdict": verdict.verdict, "found": "+".join(found), "likely": "+".join(sorted(likely)),
        "first_right": bool(names) and names[0] in draw.right, "in_cluster": bool(likely & draw.right),
        "wrong_named": verdict.verdict == "named" and not set(found) <= draw.there, "exact": set(names) == set(draw.right),
        "covered": sum(sizes), "sizes": len(sizes), "share": verdict.share, "held_out_share": verdict.held_out_share,
        "p_value": float(table["p_value"][0].min()), **{name: float(table[name]) for name in SHARED},
    }  # fmt: skip


def told(draw: Draw, car, verdict) -> int:
    """How many of the parameters that the vehicle's file has wrong are told, right to CLOSE."""
    beyond = verdict.beyond_bounds.parameters if verdict.beyond_bounds else ()
    true = {name: factor * car[name] for name, factor in draw.wrong.items()}
    return sum(one.parameter in true and abs(one.value / true[one.parameter] - 1.0) < CLOSE for one in beyond)


def form(place: str | None, proposal, opened: np.ndarray, fall: Callable) -> dict:
    """What a ``proposal`` (``Discovery``, or None) got right of a force at ``place`` (None: at a port that no form has), as more of a row:
    ``place`` is the proposed one, ``form_share`` what its terms alone remove of the error held out, ``together_share`` that with effects of
    the library beside them, each against the truth. ``opened``: mean squares (record, channel) that no proposal leaves; ``fall``: of
    ``against_oracle``, by those before and after. Empty where a share or a place cannot be judged."""
    row = {"place": proposal.place if proposal else "", "place_right": "", "form_share": "", "together_share": ""}
    if place is None:
        return row
    gone, own = np.zeros_like(opened), np.zeros_like(opened)
    for name in proposal.selection.kept if proposal else ():
        before, after = around(proposal.selection, name)
        fell = before.held_out_squares - after.held_out_squares
        gone, own = gone + fell, own + fell * (":" in name)  # terms are called by place and term, effects by a name alone
    first = proposal.selection.states[0].held_out_squares if proposal and proposal.selection.states else opened
    shares = {key: fall(first, first - those) for key, those in (("form_share", own), ("together_share", gone))}
    # Where who knows the truth gains nothing held out, no form can be judged by what it does there.
    return row | {"place_right": row["place"] == place} | {key: share for key, share in shares.items() if np.isfinite(share)}


def against_oracle(trial, vehicle, effects_folder, first, last) -> float:
    """Fall of the held-out error, mean squares (record, channel) from ``first`` to ``last``, relative to that of who knows the effects and
    all parameters; nan where there is none."""
    sizes = trial.truth["effects"]
    true_vehicle, _ = with_values(vehicle, {}, trial.truth["car"])
    try:
        knowing = opening.car(
            opening.sites_of(trial.measured), true_vehicle, effects=sizes, effects_folder=effects_folder, library_names=[]
        )
        held_out = [index for index, record in enumerate(knowing.records) if record.role != "fit"]
        values = opening.start_values(knowing)
        residuals = exp.simulate(knowing, values, held_out)
    except InputError:  # the truth was made with half the step, and does not bear the whole one
        return float("nan")
    frame = exp.frame(knowing, residuals, exp.nuisances(knowing, values, held_out))
    oracle = floor.squares(knowing, {index: frame.cleaned(index, residuals[index]) for index in held_out})
    possible = np.sum((first - oracle) / first)
    return float(np.sum((first - last) / first) / possible) if possible > floor.LEAST else float("nan")


def level(reached: float) -> float:
    """The largest of KAPPAS that a trial comes up to; 0 below all of them."""
    return max((kappa for kappa in KAPPAS if reached >= VISIBLE * kappa), default=0.0)


def met(aim: str, hits: int, count: int) -> str:
    """Whether so many hits of a count meet an aim in percent ("95 %" or more, "at most 3 %", "3-8 %"): "yes", "missed", or "missed by chance, perhaps"
    where its 95 % interval (Wilson) reaches into it; empty without one, or any trial."""
    numbers = [float(number) / 100.0 for number in re.findall(r"\d+", aim)]
    if not (numbers and count):
        return ""
    least, most = numbers if len(numbers) > 1 else (0.0, numbers[0]) if "at most" in aim else (numbers[0], 1.0)
    lower, upper = binomtest(hits, count).proportion_ci(method="wilson")
    if least <= hits / count <= most:
        return "yes"
    return "missed by chance, perhaps" if lower <= most and upper >= least else "missed"


def summary(rows: Sequence[Mapping]) -> list[str]:
    """Lines of a Markdown table: each figure with what it should be, its 95 % interval (Wilson), whether it is met, and the number of trials that it
    is counted over, of all of their kinds where some are left out."""
    lines = ["| figure | aim | reached (95 % interval) | met | trials |", "|---|---|---|---|---|"]

    def line(what, chosen, hit, aim="", among=()):
        hits = sum(bool(hit(row)) for row in chosen)
        if chosen:
            lower, upper = binomtest(hits, len(chosen)).proportion_ci(method="wilson")
            share = f"{100 * hits / len(chosen):.0f} % ({100 * lower:.0f}-{100 * upper:.0f} %)"
        count = f"{len(chosen)} of {len(among)}" if len(among) > len(chosen) else f"{len(chosen)}"
        lines.append(f"| {what} | {aim} | {share if chosen else '-'} | {met(aim, hits, len(chosen))} | {count} |")

    of = lambda *kinds: [row for row in rows if row["kind"] in kinds]
    reached = {id(row): level(row["reached"]) if row["hidden"] else 0.0 for row in rows}
    strong = lambda chosen: [row for row in chosen if reached[id(row)] >= 0.3]

    def strong_line(what, chosen, hit, aim=""):
        line(what, strong(chosen), hit, aim, chosen)

    alone = ("clean", "messy", "another shape", "another setting")
    names = lambda key: lambda row: row[key] and row["verdict"] in ("named", "cluster")  # beside "outside" effects are no explanation
    for kind in alone:
        aim = {"clean": "95 %", "messy": "85 %"}.get(kind, "")
        strong_line(f"first name right, {kind}, kappa >= 0.3", of(kind), names("first_right"), aim)
    strong_line("true effect named or in the named cluster, kappa >= 0.3", of(*alone), names("in_cluster"), "97 %")
    for kappa in KAPPAS:
        at = [row for row in of("clean") if reached[id(row)] == kappa]
        line(f"found, clean, kappa {kappa:g}", at, names("in_cluster"), "90 %" if kappa >= 0.1 else "")
    nulls = ("nothing", "path error", "clock error, aligned", "another interpolation", "brisk foot", "brisk foot, clean speed")
    for kind in nulls:
        line(f"an effect named where nothing is missing: {kind}", of(kind), lambda row: row["found"])
    for kind in nulls:
        line(f"p of the whole library below {100 * LEVEL:.0f} %: {kind}", of(kind), lambda row: row["p_value"] < LEVEL, "3-8 %")
    line(f"p of the whole library below {100 * LEVEL:.0f} %: all of these", of(*nulls), lambda row: row["p_value"] < LEVEL, "3-8 %")
    line("wrong effect named with confidence", rows, lambda row: row["wrong_named"], "at most 3 %")
    is_outside = lambda row: row["verdict"] == "outside"
    is_placed = lambda row: is_outside(row) and row["place"]
    with_library, beside_wrong = of("outside, beside the library"), of("outside, beside a wrong file")
    for kind in ("outside", "outside, messy", "outside, beside the library"):
        strong_line(f'"outside the library" said when it is, {kind[9:] or "clean"}, kappa >= 0.3', of(kind), is_outside, "80 %")
    strong_line('"outside the library" said when it is, with a place, beside a wrong file, kappa >= 0.3', beside_wrong, is_placed, "80 %")
    without = [row for row in of("wrong file") if not row["hidden"]]
    line('"outside the library" said where nothing but the vehicle\'s file is wrong', without, is_outside)
    line("the same, with a place", without, is_placed)
    outside = of("outside", "outside, messy")
    placed = [row for row in strong(outside) if row["place_right"] != ""]
    what = "place of such an effect right (strut, tyre, contact, links, body, steering, structure)"
    line(what, placed, lambda row: row["place_right"], among=outside)
    to = f"{100 * FORM:.0f} to {100 / FORM:.0f} %"
    is_right = lambda share: share != "" and FORM <= share <= 1.0 / FORM
    is_formed = lambda row: is_right(row["form_share"])
    judged = [row for row in placed if row["form_share"] != ""]
    line(f"its proposed form alone removes {to} of what the true one does, held out", judged, is_formed, "70 %", outside)
    line('the same where "outside" is said', [row for row in judged if is_outside(row)], is_formed, among=judged)
    line("effect of the library beside such a force named, and no other", strong(with_library), lambda row: row["exact"], among=with_library)
    both = [row for row in strong(with_library) if row["together_share"] != ""]
    what = f"both together remove {to} of what the true ones do, held out"
    line(what, both, lambda row: is_right(row["together_share"]), among=with_library)
    has_told = lambda row: row["told"] == row["wrong"]
    strong_line(f"all that is wrong in the file told to {100 * CLOSE:.0f} %, beside such a force", beside_wrong, has_told)
    theirs = [row for row in strong(beside_wrong) if row["form_share"] != ""]
    line(f"its form removes {to} of what is left to who knows file and force, held out", theirs, is_formed, among=beside_wrong)
    every = strong([*outside, *with_library, *beside_wrong])
    nowhere = [row for row in every if row["place_right"] == ""]
    unseen = [row for row in every if row["place_right"] != "" and row["form_share"] == ""]
    lines.append(f"| force at a port that no form has (left out of places and forms) | | {len(nowhere)} | | {len(every)} |")
    lines.append(f"| force that changes nothing held out (left out of forms) | | {len(unseen)} | | {len(every)} |")
    strong_line("exact set of 2 effects, each at kappa >= 0.3", of("two"), names("exact"), "85 %")
    strong_line("exact set of 3 effects, each at kappa >= 0.3", of("three"), names("exact"), "70 %")
    beside = [row for row in of("wrong file") if row["hidden"]]
    strong_line("what is missing named, and nothing else, beside a wrong file of the vehicle, kappa >= 0.3", beside, names("exact"))
    line("no effect named where nothing but the vehicle's file is wrong", without, lambda row: not row["found"])
    line(f"all that is wrong in the file told to {100 * CLOSE:.0f} %", of("wrong file"), has_told)
    is_suspect = lambda row: row["verdict"] == "suspect"
    for kind in SUSPECT:
        line(f"suspect data flagged: {kind}", of(kind), is_suspect, "90 %")
    flagged = lambda row: is_suspect(row) and row["first_right"]
    strong_line("suspect data flagged, by name: another error of the measurement, kappa >= 0.3", of("measurement"), flagged)
    seen = [row for row in rows if reached[id(row)]]
    for what, chosen in (("messy", [row for row in seen if row["kind"] == "messy"]), ("others", [row for row in seen if row["kind"] != "messy"])):
        covered, sizes = (sum(row[key] for row in chosen) for key in ("covered", "sizes"))
        aim, share = "80-95 %", f"{100 * covered / max(sizes, 1):.0f} %"
        lines.append(f"| 90 % interval of a size covers the truth, {what} | {aim} | {share} | {met(aim, covered, sizes)} | {sizes} sizes |")
    falls = [row["against_oracle"] for row in strong(of(*alone)) if np.isfinite(row["against_oracle"])]
    if falls:
        median, tenth = np.median(falls), np.quantile(falls, 0.1)
        found = f"{median:.2f} ({tenth:.2f}) | {'yes' if median >= 0.9 and tenth >= 0.7 else 'missed'} | {len(falls)}"
        lines.append(f"| held-out error removed, relative to the oracle, median (10th percentile) | 0.90 (0.7) | {found} |")
    small = sum(bool(row["hidden"]) for row in rows) - len(seen)
    lines.append(f"| hidden effect below kappa {VISIBLE * KAPPAS[0]:g} at any plausible size (left out above) | | {small} | | {len(rows)} |")
    seconds = np.median([row["cpu_seconds"] for row in rows])
    lines.append(f"| CPU seconds of a search, median | below {SECONDS} | {seconds:.0f} | {'yes' if seconds < SECONDS else 'missed'} | {len(rows)} |")
    return lines
