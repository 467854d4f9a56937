"""What to do next after a verdict, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ...discrepancy.balance import ENOUGH, LITTLE
from ...discrepancy.confirm import EQUAL
from ...discrepancy.explain import NIL
from ...discrepancy.verdict import SMALL, at_most, claimed_of, is_file_alone, is_of_little, is_vehicle_first, left_without, told_beyond
from ...effects import library
from ...schema import as_written, as_yaml
from ...vehicle.parameters import PARAMETERS
from ...vocabulary import CALIBRATED
from ..study import Diagnosis

NEXT = {
    "named": "Switch on what is missing, effects: [{keys}] in config/study.yaml, compare and diagnose again: something smaller may show beside it. "
    "The loop ends where this row says so.",
    "cluster": "Switch one of each cluster on, effects: [{keys}] in config/study.yaml, and compare again; then another in its place. Keep the "
    "one with which the error ladder is lowest on drives held out; drive what would tell them apart.",
    "nothing": "Nothing is to be switched on.",
    "suspect": "Put the data right first, then diagnose again.",
}

SAME_ERROR = " Where they cannot be, effects: [{keys}] in config/study.yaml puts the same error into the model."
"""What is added where an effect of the library is what is wrong with the data."""

TRY_FORM = (
    "Look at the proposed form in the rows above. To try it, put {file} into a folder of your own that effects_folder in config/study.yaml names, "
    "switch it on, effects: [{keys}], compare and diagnose again: beside it the rest shows better."
)

OPEN = (
    "Switch on what may be missing, effects: [{keys}] in config/study.yaml, and compare again; keep it if the error ladder falls on drives held out. Another "
    "drive, or fewer parameters that are calibrated along, may tell whether it is that."
)
"""What to do where each of the effects of a cluster may as well be none, and nothing is known that may stand in their place."""

IN_PLACE = (
    " Something else is the proposed form in the rows above: to try that in their place, put {file} into a folder of your own that effects_folder in "
    "config/study.yaml names, and switch it on, effects: [{keys}]."
)
"""What is added where a form explains as much as the effects that are named."""

GO_ON = (
    "Go on from what the library has, effects: [{keys}] in config/study.yaml, compare and diagnose again: beside it the rest shows "
    "better. Take out again what does not lower the error ladder on drives held out."
)

NO_FORM = "No form was found that would take the error away. "

LITTLE_FOUND = "Nothing that was found explains much. "

MAY_END = "The loop may end here. Else: "
"""What comes before advice where all that there was to explain is little, and what was found is not most of it."""

END = "What is left is no more than {most} of the power of any signal: the loop may end here."

GO_DEEPER = "What is left, {most} of the power of {signal}, is worth a look at where it lies (compare): the loop ends here, unless an effect of your own explains it."

ROAD_FIRST = (
    "First set road: options: interpolation: {other} in the site file, which the drives fit better, and diagnose again, unless the road's "
    "file is known to be meant otherwise. Then: "
)
"""What comes before anything else where the road may be another between its points."""

FLOOR_FIRST = (
    "First tell the noise of the instruments (noise_density of the drives in the site file), or drive a stretch again at the same speed: until then noise "
    "counts as an error that something is missing for. Then: "
)
"""What comes before anything else where something is missing that is not in the library, and no floor is known."""

FILE_FIRST = "First, or in the same go, put the vehicle's file right, as the row above says. Then: "
"""What comes before where calibration holds parameters beside the drives."""

WITH_VEHICLE = "This was found with the vehicle put right as above, so that both may be done in one go. "
"""What comes before where parameters of the vehicle beyond their bounds came before any effect."""

STAND_IN = " The model holds a form of its own, which may not be exact: take out again what does not lower the error ladder on drives held out."
"""What is added to names beside a proposed form, for the rest of which they may stand in."""


AS_GOOD = 0.005
"""Share of the explainable error of held-out drives up to which a form that does better may be the library's effect by another name."""

WORTHWHILE = 0.1
"""Share of the explainable error from which on effects that help are worth going on from where no form is."""


def next_step(found: Diagnosis) -> str:
    """What to do next, a sentence or a few."""
    said, proposal = found.verdict, found.verdict.get("proposal") or {}
    own = [_entry(name, found.held.get(name, {})) for name in found.switched_on]
    other = next((word for word in ("linear", "cubic") if f"interpolation: {word})" in found.ranking.attrs.get("road", "")), "")
    before = ROAD_FIRST.format(other=other) if other and said["verdict"] != "suspect" else ""
    before += FILE_FIRST if said.get("off_file") else ""
    named = ", ".join([*own, *(effect["name"] for effect in said["effects"])])
    if said["verdict"] == "nothing":
        return f"{before}{NEXT['nothing']} {left(said)}"
    if said["verdict"] == "outside":
        before += FLOOR_FIRST if found.ranking.attrs.get("floor") == NIL else ""
        return before + _outside(found, proposal, own, named)
    if said["verdict"] == "suspect":
        wrong = [effect["name"] for effect in claimed_of(said)]
        return NEXT["suspect"] + (SAME_ERROR.format(keys=", ".join([*own, *wrong])) if wrong else "")
    before += WITH_VEHICLE if is_vehicle_first(said) else ""
    before += _may_end(said, said)
    caution = STAND_IN if said["verdict"] in ("named", "cluster") and not set(found.switched_on) <= set(library.find()) else ""
    in_place = IN_PLACE.format(file=_file(found, proposal), keys=", ".join([*own, proposal["name"]])) if proposal.get("form") else ""
    has_others = in_place or any(effect.get("like") for effect in said["effects"]) or (said.get("beyond_bounds") or {}).get("is_as_good")
    then = NEXT[said["verdict"]] if said["verdict"] == "named" or has_others else OPEN
    return before + then.format(keys=named) + in_place + caution


def _entry(name: str, held: Mapping[str, float]) -> str:
    """An effect as it stands in the configuration, with the sizes that are ``held``."""
    return f"{{{name}: {{{', '.join(f'{size}: {as_yaml(value)}' for size, value in held.items())}}}}}" if held else name


def library_helps(verdict: Mapping) -> bool:
    """Whether something is missing that the library does not have, and effects of it help on drives held out yet."""
    helps = verdict["held_out_share"] is None or verdict["held_out_share"] > 0
    return verdict["verdict"] == "outside" and bool(verdict["effects"]) and helps


def farther(beyond: Mapping) -> str:
    """What to do where parameters of the vehicle want to lie beyond their bounds."""
    those = told_beyond(beyond)
    names = ", ".join(one["parameter"] for one in those)
    bounds = ", ".join("{}: [{}, {}]".format(one["parameter"], *map(as_written, _farther(one))) for one in those)
    begin = "In place of that" if beyond.get("is_instead") else "First of all"
    if beyond.get("effects"):
        begin += f", with {', '.join(beyond['effects'])} alone of the effects above"
    return (
        f"{begin}: if the vehicle's file may be that wrong, have it calibrated. Add {names} to calibration: parameters in config/study.yaml, unless "
        f"they are there{_no_longer_uncertain(those)}, and put {bounds} into calibration: bounds; then compare and diagnose again. If it cannot be, they "
        "stand in for something else."
    )


def calibrated_too(off_file: Mapping, calibrated: Sequence[str] = ()) -> str:
    """What to do where calibration holds parameters of the vehicle to which the drives give other values, beside those that are ``calibrated``."""
    names = [one["parameter"] for one in off_file["parameters"]]
    whole = f", calibration: {{parameters: [{', '.join(dict.fromkeys([*calibrated, *names]))}]}} with those that stand there" if calibrated else ""
    return (
        f"Add {', '.join(names)} to calibration: parameters in config/study.yaml{whole}{_no_longer_uncertain(off_file['parameters'])}, compare and diagnose again: the search "
        "lets them be wrong, but calibration holds them, "
        "so that the error ladder falls less than is said here, and calibrated sizes of effects may make up for them."
    )


def _no_longer_uncertain(those: Sequence[Mapping]) -> str:
    """What else is to be done with parameters of the paper, which are calibrated or uncertain, not both."""
    names = [one["parameter"] for one in those if one["parameter"] in CALIBRATED]
    return f" (and take {', '.join(names)} out of diagnosis: uncertain, if it stands there)" if names else ""


def _farther(one: Mapping) -> tuple[float, float]:
    """Bounds to calibrate a parameter in: a value at the end of the wider ones that were tried wants to go on, as far as any vehicle does."""
    known = PARAMETERS[one["parameter"]]
    return max(min(one["wider"][0], 0.5 * one["value"]), known.lower), min(max(one["wider"][1], 2.0 * one["value"]), known.upper)


def _shares(one: Mapping) -> tuple[float, float]:
    """Shares that go on the fitted drives, 0 where nothing of their error was explainable, and on drives held out, or without any the same."""
    fitted = one["share"] or 0.0
    return fitted, fitted if one["held_out_share"] is None else one["held_out_share"]


def _may_end(verdict: Mapping, *found: Mapping) -> str:
    """What is said before one of those ``found`` is to be switched on, of which none removes most of an error that is little."""
    is_most = any(min(_shares(one)) >= ENOUGH for one in found)
    return MAY_END if is_of_little(verdict) and not is_most else ""


def left(verdict: Mapping) -> str:
    """Whether what is left matters where nothing is to be switched on."""
    remainder = left_without(verdict)
    if not remainder:
        return "See where the error lies (compare)."
    signal = max(remainder, key=remainder.get)
    return (END if remainder[signal] < SMALL else GO_DEEPER).format(most=at_most(remainder[signal]), signal=signal)


def _outside(found: Diagnosis, proposal: Mapping, own: Sequence[str], named: str) -> str:
    """The better of the proposed form and the effects that help comes first."""
    said = found.verdict
    if is_file_alone(said):
        return f"{NEXT['nothing']} {left(said)}"
    go_on = GO_ON.format(keys=named)
    may_end = _may_end(said, said, *([proposal] if proposal.get("form") else []))
    if not proposal.get("form"):
        return may_end + go_on if library_helps(said) and _shares(said)[0] >= LITTLE else NO_FORM + left(said)
    (fitted, held_out), (fitted_of_form, held_out_of_form) = map(_shares, (said, proposal))
    if (min if may_end else max)(fitted_of_form, held_out_of_form) < LITTLE:
        return may_end + go_on if library_helps(said) and min(fitted, held_out) >= WORTHWHILE else LITTLE_FOUND + left(said)
    try_form = TRY_FORM.format(file=_file(found, proposal), keys=", ".join([*own, *_by_share(proposal)]))
    if not library_helps(said) or said.get("is_beside_form"):
        return may_end + try_form
    library_is_better = fitted > fitted_of_form - EQUAL and held_out > held_out_of_form - AS_GOOD
    first, second = (go_on, try_form) if library_is_better else (try_form, go_on)
    return f"{may_end}{first} The second choice: {second[:1].lower()}{second[1:]}"


def _file(found: Diagnosis, proposal: Mapping) -> Path:
    """That of a proposed form."""
    return Path(found.files.get("verdict", "")).parent / f"{proposal['name']}.py"


def _by_share(proposal: Mapping) -> list[str]:
    """A proposed form and what stands beside it, in the order in which they are to be switched on: the form first where most goes with it, since
    beside a large error a small effect may seem to make things worse."""
    name, beside = proposal["name"], list(proposal.get("beside") or ())
    is_most = (proposal.get("own_share") or 0.0) > 0.5 * (proposal.get("share") or 0.0)
    return [name, *beside] if is_most else [*beside, name]
