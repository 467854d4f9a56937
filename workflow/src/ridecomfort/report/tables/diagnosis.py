"""The verdict on the missing effect, and the evidence behind it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from ...discrepancy import ranking
from ...discrepancy.balance import LITTLE
from ...discrepancy.contest import UNDRIVEN, UNSIZED
from ...discrepancy.form import names_in
from ...discrepancy.meanings import such_as
from ...discrepancy.places import PLACES
from ...discrepancy.propose import HELD_OUT_Z
from ...discrepancy.terms import SIDE
from ...discrepancy.verdict import claimed_of, first_sentence, is_vehicle_first, percent, sentence, told_beyond
from ...identifiability import AT_BOUND
from ...study import BASE, JOIN
from .. import catalogue
from ..notation import formula, literal, unit, words
from ..study import Diagnosis
from ..table import Column, Source, Table
from . import advice

SUSPECT = "The data are suspect: what stands here explains their error as they are, and may be what is wrong with them."
"""What is said of effects that were found on such data."""

NAMING = ("named", "cluster", "suspect")
"""Verdicts that tell of each effect what it comes to."""

HELD = {True: "typical: the drives ask for no other", False: "held, the best of a few"}
"""What is said of what only shapes an effect, by whether it is as is typical, where the drives did not ask for another value."""

OF_SIDE = "side is +1 on the left, −1 on the right"
"""What is said of that in a form."""

OF_LITTLE = "A share far below −100 % or above 100 % is one of drives that have next to nothing to explain."
"""What is said of such shares."""

RIGHTED = "These are the rounds of the search that began with the vehicle put right, as the verdict's row says."
"""What is said of the evidence where parameters of the vehicle beyond their bounds came before any effect."""

STRONGEST = 12
"""Candidates of a round that are drawn, and forms of a force that are told."""

OF_THE_LIBRARY = "library"
"""Place of an effect that was looked for together with forms."""

NO_FORMS = "No force of any form was looked for: the library explains the error, or the data are suspect."
"""What is said there."""


def _checked(found: Mapping) -> str:
    """What of the error goes on drives held out, if there are any."""
    return "" if found["held_out_share"] is None else f", {percent(found['held_out_share'])} on drives held out"


def _promise(proposal: Mapping) -> str:
    """What a proposed form removes of the error, and how sure it is."""
    checked = _checked(proposal)
    fitted = f"{percent(proposal['share'])} of the explainable error on the fitted drives"
    little = ": too little to be what is missing" if (proposal["share"] or 0.0) < LITTLE else ""
    return f"{fitted}{checked} (p = {proposal['p_value']:.2g}){little}."


def verdict(found: Diagnosis) -> Table:
    """The verdict in words: what it is, why, and what to do next."""
    said = found.verdict
    told = claimed_of(said)
    names = [_alike(effect) for effect in told]
    proposal, beyond = said.get("proposal") or {}, said.get("beyond_bounds")
    first = first_sentence(said, names)
    rows = [("verdict", f"{first} ({said['verdict']})")]
    rows += [(words(effect["name"]), _found(effect)) for effect in told if said["verdict"] in NAMING]
    if said["verdict"] == "suspect":
        beyond = None  # the data come first, and may be what drives parameters there
    if advice.library_helps(said):
        take = "together take" if len(said["effects"]) > 1 else "takes"
        role = "beside the proposed form" if said.get("is_beside_form") else "and may stand in for what is missing"
        taken = f"{', '.join(names)} {take} {percent(said['share'])} on the fitted drives{_checked(said)}, {role}."
        rows.append(("in the library", taken))
    if proposal.get("form"):
        of_side = f"; {OF_SIDE}" if SIDE in proposal["form"] else ""
        rows.append(("proposed form", f"At the {proposal['place']}: {formula(proposal['form'])}{of_side}."))
        rows.append(("in it", sentence(names_in(proposal["place"], proposal["form"], proposal["terms"]))))
        rows.append(("such as", sentence(proposal["such_as"])))
        rows += [(what, sentence(proposal[key])) for key, what in (("here", "here it is"), ("typically", "at typical motion")) if proposal.get(key)]
        beside = proposal.get("beside")
        fitted = [size for size in proposal["sizes"] if size["interval"]]
        rows += [("its sizes", sentence(", ".join(map(_size, fitted))))] if fitted else []
        rows.append((f"with {', '.join(map(words, beside))} it removes" if beside else "it removes", _promise(proposal)))
    rows += [("reason", sentence(reason)) for reason in said["reasons"]]
    rows += [(f"{words(name)}, switched on", _before(found.told_before[name])) for name in found.switched_on if name in found.told_before]
    comes_first = bool(beyond) and not beyond.get("is_instead")
    if comes_first:
        rows.append(("the vehicle", advice.farther(beyond)))
    if said.get("off_file"):
        calibrated = [name for name in found.ranking.attrs.get("calibrated", "").split(", ") if name and "." not in name]  # no sizes of effects
        calibrated += [one["parameter"] for one in told_beyond(beyond)] if calibrated and comes_first else []
        rows.append(("the vehicle's file", advice.calibrated_too(said["off_file"], calibrated)))
    rows.append(("next, after the vehicle" if comes_first else "next", advice.next_step(found)))
    if beyond and not comes_first:
        rows.append(("or, the vehicle", advice.farther(beyond)))
    rows += [(f"diagnosed again, model {model.replace(JOIN, f' {JOIN} ')}", _again(content)) for model, content in found.later.items()]
    columns = Column("what", ("",)), Column("in_words", ("In words",))
    sources = (Source("all", found.files.get("verdict", ""), "verdict, effects, reasons, proposal", "as in the file"),)
    return _table(found, "verdict", columns, rows, sources)


def _found(effect: Mapping) -> str:
    """The sizes of an effect with their intervals, and what it removes; of an error of the measurement, what that is comes first."""
    what = f"{literal(sentence(effect['sentence'].removesuffix('.')))} " if effect.get("is_of_measurement") else ""
    sizes = sentence(", ".join(map(_size, effect["sizes"]))) + _beside_held(effect)
    return f"{what}{sizes} It takes {percent(effect['share'])} of the explainable error{_checked(effect)}."


def _beside_held(effect: Mapping) -> str:
    """What shapes an effect and was held while its sizes were found, in words."""
    told = [f"{words(one['parameter'])} {one['size']:.3g} {unit(one['unit'])}".removesuffix(" 1").strip() for one in effect.get("held") or ()]
    return f" Found with {', '.join(told)} held: with another value these sizes and intervals may be others." if told else ""


def _again(said: Mapping) -> str:
    """What a later verdict says of the model with what was named switched on."""
    told = f"{first_sentence(said, [_alike(effect) for effect in claimed_of(said)])} ({said['verdict']})"
    if said["verdict"] in ("named", "cluster"):
        return f"{told} This takes {percent(said['share'])} of what is explainable then{_checked(said)}."
    return f"{told} {advice.left(said)}" if said["verdict"] == "nothing" else told


def _before(effect: Mapping) -> str:
    """The sizes of an effect as a verdict told them before it was switched on."""
    sizes = ", ".join(map(_size, effect["sizes"]))
    return f"The verdict on the model {effect['model']}: {sizes}. Where calibrated.md has another value, prefer this: what is uncertain of the vehicle was fitted beside it."


def _size(size: Mapping) -> str:
    """A size with its interval, in words: with as many digits as tell its ends apart."""
    if _is_left_open(size):
        return f"{words(size['parameter'])} left open by these drives"
    numbers = (size["size"], *_interval(size))
    value, lower, upper = (f"{number:.{_digits(numbers)}g}" for number in numbers)
    amount = value if size["unit"] == "1" else f"{value} {unit(size['unit'])}"
    return f"{words(size['parameter'])} {amount} ({lower} to {upper})"


def _is_left_open(size: Mapping) -> bool:
    """Whether a size may be anything that is plausible, as that of a stop that no drive meets: its value says nothing."""
    (lower, upper), (least, most) = size.get("interval") or (np.nan, np.nan), size.get("plausible") or (np.nan, np.nan)
    return lower <= least and most <= upper


def _interval(size: Mapping) -> Sequence[float] | None:
    """The interval of a size, if it has one; of what only shapes a force no farther than is plausible, where no other was tried."""
    interval, plausible = size.get("interval"), size.get("plausible")
    return np.clip(interval, *plausible).tolist() if interval and plausible and size.get("is_shaping") else interval


def _estimate(size: Mapping) -> tuple:
    """The value of a size, its interval and whether it is plausible, as they stand in the table; empty where it has none."""
    if not size:
        return None, None, None, ""
    value, (lower, upper), plausible = size["size"], _interval(size) or (None, None), {True: "yes", False: "no", None: ""}[size.get("is_plausible")]
    if lower is not None and lower <= 0.0 <= upper and not size.get("is_shaping"):
        plausible = f"{plausible}, may be nil".removeprefix(", ")
    if _is_left_open(size):
        value, lower, upper, plausible = None, None, None, "left open"
    if lower is None and value is not None:
        plausible = HELD.get(size.get("is_typical"), "held")
    if size.get("plausible"):
        plausible += " ({:.4g} to {:.4g})".format(*size["plausible"]) + (", at its bound" if _is_at_bound(size) else "")
    return value, lower, upper, plausible


def _digits(numbers: Sequence[float]) -> int:
    """Significant digits with which numbers are told: three, or as many as the distance between the least and the largest takes."""
    largest, width = max(map(abs, numbers)), max(numbers) - min(numbers)
    return 3 if width == 0.0 else min(max(int(np.ceil(np.log10(largest / width))) + 1, 3), 6)


def _is_at_bound(size: Mapping) -> bool:
    """Whether a size that was fitted lies at an end of what is plausible which is not nil: the drives ask for more than that."""
    value, (least, most) = size.get("size"), size["plausible"]
    is_fitted = value is not None and size.get("interval") is not None
    return is_fitted and any(end != 0.0 and abs(value - end) <= AT_BOUND * (most - least) for end in (least, most))


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
    stands_in = found.verdict["verdict"] == "outside" and not found.verdict.get("is_beside_form")
    for effect in found.verdict["effects"]:
        breaks.append(len(rows))
        name = f"{words(effect['name'])} (may stand in)" if stands_in else words(effect["name"])
        shares = [_percent(effect[key]) for key in ("share", "held_out_share", "absorbed")]
        like = ", ".join(words(name) for name in effect["like"]) or "–"
        of_all = (effect["p_value"], *shares, like)
        for number, size in enumerate([*effect["sizes"], *effect.get("held", ())] or [{}]):
            of_effect = of_all if number == 0 else (*(None,) * 4, "")
            rows.append((name, words(size.get("parameter", "")), unit(size.get("unit", "")), *_estimate(size), *of_effect))
    proposal = found.verdict.get("proposal") or {}
    if proposal.get("form"):
        breaks.append(len(rows))
        of_all = (proposal["p_value"], *(_percent(proposal[f"own_{key}"]) for key in ("share", "held_out_share")), None)
        told_of_form = [size for size in proposal["sizes"] if size["interval"] or size["size"]]  # a part that is held at nil is none
        for number, size in enumerate(told_of_form):
            of_form = of_all if number == 0 else (None,) * 4
            rows.append((f"{words(proposal['name'])} (proposed form)", words(size["parameter"]), unit(size["unit"]), *_estimate(size), *of_form, ""))
    if not rows:
        beside = "" if found.model == BASE else f" beside {found.model.replace(JOIN, ', ').replace('_', ' ')}"
        rows.append((f"none{beside}", *("",) * 2, *(None,) * 3, "", *(None,) * 4, ""))
    sources = (Source("all", found.files.get("verdict", ""), "effects", "as in the file, shares in percent"),)
    notes = (
        "Shares are of the explainable error of the calibrated model before any effect was added. Removed is what goes when an effect "
        "joins those above it, all sizes fitted together and the drives aligned for them, above the floor that the last model shows: "
        "the evidence has the refit that it was chosen by, above the floor of that round, and the error ladder what is left when the "
        "study calibrates anew, site by site. They are of all sizes of an effect together and stand beside its first. Absorbed: "
        "share of the effect's response that calibration can take up, and so hide. What only shapes an effect (a frequency, a place) is fitted "
        "where the drives asked for another value, else held at its typical one or the best of a few.",
        "Where calibrated.md has another size, prefer the one here: what is uncertain of the rest of the vehicle "
        "counts, and so does another effect that the drives leave open; calibrated.md holds these and rests on one site, but fits what only "
        "shapes an effect, which may be held here. Where the size of one there and here are farther apart than the wider interval, the effect "
        "may stand in for another, or what calibration holds "
        "of the vehicle is not as its file says (calibration: parameters). May be nil: the interval of this size alone holds "
        "nil; the effect is named for what all its sizes do together. Left open: any plausible size does as well on these drives.",
        *([SUSPECT] if found.verdict["verdict"] == "suspect" and found.verdict["effects"] else []),
    )
    return _table(found, "missing_effects", columns, rows, sources, notes, breaks[1:])


EVIDENCE = (
    Column("p_value", ("Score test", "p over all"), ".2g"),
    Column("gain", ("Score test", "gain"), ".0f"),
    Column("absorbed_pct", ("Score test", "absorbed [%]"), ".0f"),
    Column("sizes", ("Refit", "sizes")),
    Column("refit_gain", ("Refit", "gain"), ".0f"),
    Column("bic", ("Refit", "BIC"), ".0f"),
    Column("fitted_pct", ("Explainable error removed [%]", "fitted"), ".0f"),
    Column("held_out_pct", ("Explainable error removed [%]", "held out"), ".0f"),
    Column("outcome", ("", "Outcome")),
)
"""What is told of each candidate of a round."""


def evidence(found: Diagnosis) -> Table:
    """Score test of every effect by round, strongest first, with the refits of those that were refitted."""
    columns = (Column("round", ("", "Round"), "d"), Column("effect", ("", "Effect")), *EVIDENCE)
    rows, breaks = [], []
    for turn, told in _rounds(found.ranking):
        breaks.append(len(rows))
        rows += [(turn, words(name), *one) for name, one in told.items()]
    notes = (
        "Gain: fall of twice the negative log-likelihood. The p-value is that of the largest gain over the whole library, by block "
        "wild bootstrap: a screen of what is worth a refit; docs/diagnosis.md says how often it is small where nothing is missing. Every effect is tested that does what alignment does not do, too; the "
        "best are refitted together with the calibrated parameters, and what that removes "
        "is told above the floor as known in the round: for what an accepted effect removes, and its size, in the end see the missing effects. "
        f"{OF_LITTLE} "
        "Accepted is what the next round searches beside; the verdict says whether it is named in the end.",
        *([RIGHTED] if is_vehicle_first(found.verdict) else []),
    )
    return _table(found, "evidence", columns, rows, _evidence_sources(found), notes, breaks[1:])


def excluded(found: Diagnosis) -> Table:
    """How large every effect that was not accepted may be beside the last model of the search."""
    told = found.ranking
    columns = (
        Column("effect", ("", "Effect")), Column("size", ("", "Size")), Column("unit", ("", "Unit")), Column("estimate", ("", "By one step"), ".3g"),
        Column("lower", ("90 %", "from"), ".3g"), Column("upper", ("90 %", "to"), ".3g"),
        Column("least", ("Plausible", "from"), ".3g"), Column("most", ("Plausible", "to"), ".3g"),
    )  # fmt: skip
    keys = ("effect", "parameter", "unit", "size", "interval", "plausible")
    each = zip(*(told[f"other_{key}"].values.tolist() for key in keys)) if "other_effect" in told else ()
    rows = [
        (words(effect), words(parameter), unit(of), *(None if np.isnan(own) else own for own in (size, *interval)), *plausible)
        for effect, parameter, of, size, interval, plausible in sorted(each)
    ]
    notes = (
        "Each effect alone, by one step of least squares beside the last model of the search, with all that is calibrated and what alignment leaves open; what was found is in the missing effects. "
        "One in ten of the intervals leaves out the truth by chance, on long and quiet drives more, since what errs alike in all drives is in none: that one leaves out zero is no finding. "
        "One step takes an effect for linear, as it is while it is small, in the shape that fits best: of stops, clearances and the like it says little. "
        "Without an interval the sizes of an effect are not told from one another; without an estimate no plausible size would show on these drives.",
    )
    source = Source("all", found.files.get("ranking", ""), "other_*", "as in the file")
    return _table(found, "excluded", columns, rows or [("none", "", "", *(None,) * 5)], (source,), notes)


def forms(found: Diagnosis) -> Table:
    """Of forces of any form, by round, the STRONGEST and the best of every place."""
    said = Column("place", ("", "Place")), Column("form", ("", "Form")), Column("expression", ("", "In what the place sees"))
    such = Column("such_as", ("", "Such as"))
    columns = (Column("round", ("", "Round"), "d"), *said, *EVIDENCE, such)
    tried = ranking.forms(found.ranking)
    if tried is None:
        rows = [(None, NO_FORMS, "", "", *(None,) * 3, "", *(None,) * 4, "", "")]
        return _table(found, "forms", columns, rows, _evidence_sources(found))
    rows, breaks = [], []
    for turn, told in _rounds(tried):
        breaks.append(len(rows))
        places = set()
        for number, (name, one) in enumerate(told.items()):
            place, form = name.split(":") if ":" in name else (OF_THE_LIBRARY, name)
            if number < STRONGEST or place not in places:
                expression = such_a = ""
                if place != OF_THE_LIBRARY:
                    term = PLACES[place].terms[form]
                    expression, such_a = formula(term.written(term.expression)), such_as(place, [form])
                rows.append((turn, place, words(form), expression, *one, such_a))
            places.add(place)
    notes = (
        "Forms are terms that a force may be made of at each place where it could act. The first of "
        f"a place is its best, so that places are ranked by it. In their expressions {OF_SIDE}. Gain, p-value (over all terms of all places) and shares as in the evidence "
        "for the library, whose effects are looked for together with them where it explains too little alone: they may be missing, too. "
        f"{OF_LITTLE} "
        f"Told are the {STRONGEST} strongest of each round and the best of every place; all are in the file. Accepted is the best "
        "of a round. The verdict says whether it is proposed, and with which factors, all fitted together at the end; where the library does as well, the verdict takes the library.",
    )
    return _table(found, "forms", columns, rows, _evidence_sources(found, ranking.FORMS), notes, breaks[1:])


def _rounds(tested: xr.Dataset) -> Iterator[tuple[int, dict[str, tuple]]]:
    """What EVIDENCE tells of each candidate by name, the largest gain first, round by round; why, of one that could not be."""
    for number, turn in enumerate(tested["round"].values):
        one = tested.isel(round=number)
        gain, trials, came, told = one["gain"].values, refits(one), outcomes(one), {}
        for place in sorted(np.flatnonzero(np.isfinite(gain)), key=lambda k: -gain[k]):
            name, refit = str(tested["effect"].values[place]), ("", *(None,) * 4)
            if name in trials:
                trial = trials[name]
                refit = (
                    str(trial["trial_sizes"].item()), *(float(trial[f"trial_{key}"]) for key in ("gain", "bic")),
                    *(_percent(float(trial[f"trial_{key}"])) for key in ("share", "held_out_share")),
                )  # fmt: skip
            score = float(one["p_value"][place]), float(gain[place]), _percent(float(one["absorbed"][place]))
            told[name] = (*score, *refit, came[name])
        untested = {name: why for name, why in came.items() if name not in told and why.startswith((UNDRIVEN, UNSIZED))}
        told |= {name: (*(None,) * 3, "", *(None,) * 4, why) for name, why in untested.items()}
        yield int(turn), told


def _evidence_sources(found: Diagnosis, prefix: str = "") -> tuple[Source, ...]:
    file, named = found.files.get("ranking", ""), lambda *keys: ", ".join(f"{prefix}{key}" for key in keys)
    return (
        Source("score test", file, named("p_value", "gain", "absorbed"), "as in the file"),
        Source("refit", file, named("trial_*"), "as in the file, shares in percent"),
        Source("outcome", file, named("winner", "trial_objection", "trial_held_out_z", "passed_over"), "as in the file"),
    )


def refits(one: xr.Dataset) -> dict[str, xr.Dataset]:
    """The refits of a round by the name of their effect."""
    own = one.isel(trial=np.flatnonzero(one["trial_round"].values == one["round"].item()))
    return {str(name): own.isel(trial=k) for k, name in enumerate(own["trial_effect"].values)}


def outcomes(one: xr.Dataset) -> dict[str, str]:
    """What came of every effect of a round in words, by name: of its refit, or why it was not refitted; empty where there was no reason to."""
    told = {str(name): str(why) for name, why in zip(one["effect"].values, one["passed_over"].values)}
    winner, trials = str(one["winner"].item()), refits(one)
    sure = {name: not trial["trial_held_out_z"] <= HELD_OUT_Z for name, trial in trials.items()}
    for name, trial in trials.items():
        told[name] = "accepted" if name == winner else str(trial["trial_objection"].item()) or _less(name, winner, sure)
    return told


def _less(name: str, winner: str, sure: Mapping[str, bool]) -> str:
    """Why a refit that nothing speaks against was not the accepted one; ``sure``: of which drives held out are."""
    if sure.get(winner) and not sure[name]:
        return "less sure on drives held out"
    is_simpler = ":" in name and winner and ":" not in winner  # a force of any form, and an effect of the library
    return "no better than the accepted one" if is_simpler else "gains less than the accepted one"


def _alike(effect) -> str:
    return " or ".join(words(name) for name in (effect["name"], *effect["like"]))


def _percent(share: float | None) -> float | None:
    return None if share is None else 100 * share


def _table(found: Diagnosis, name, columns, rows, sources, notes=(), breaks=()) -> Table:
    notes = [*notes, found.subject(), *filter(None, [found.calibrated(), found.standin_note()])]
    caption = catalogue.DIAGNOSIS_TABLES[name]
    return Table(name, caption, tuple(columns), tuple(rows), tuple(sources), tuple(notes), breaks=tuple(breaks))
