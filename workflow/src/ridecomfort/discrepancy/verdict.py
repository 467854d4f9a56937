"""What a diagnosis says: named, a cluster, outside the library, nothing, or suspect data, with effects and reasons, in words and as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace

import numpy as np

from .beyond import AtBound, BeyondBounds, other_name
from .off_file import OffFile

SAID = {
    "named": "Missing: {names}.",
    "cluster": "Missing: {names}; the data do not tell those apart.",
    "outside": "Something is missing that is not in the library.",
    "nothing": "Nothing is missing beyond the noise that would be worth a name.",
    "suspect": "The data are suspect{names}.",
}
"""What every kind of verdict says of the ``names`` of effects."""

SOMETHING_ELSE = "something else"
"""What effects are not told from of which each may as well be none, or which a force of another form may be as well."""

FILE_ALONE = "No effect of the library is missing: parameters of the vehicle lie far from its file."
"""What the verdict "outside" says where those are all that was found."""

UNNAMED = "Nothing is missing that would have a name; what is left above the floor, the search cannot explain."
"""What the verdict "nothing" says where more is left than SMALL."""

BESIDE_MOMENTS = "Nothing is missing that would be worth a name, beside what drives differ by within moments in {signals}: that these drives do not tell from noise."
"""What it says where such moments make the floor."""

SMALL = 0.02
"""Share of a signal's power; an error below it changes its rms by a hundredth at most."""

IS_MISSING = ("named", "cluster", "outside")
"""Verdicts which say that something is missing."""

LITTLE_TO_EXPLAIN = " It is little: no signal has more than {most} of its power above the floor."
"""What such a verdict adds where all that could be explained is SMALL."""

LEAST_TOLD = 0.001
"""Share of a signal's power below which what is left of it is not told, and the least that a limit is said to be: "no more than 0.0 %" would say
that there is none."""


@dataclass(frozen=True)
class Named:
    """An effect that was found: its sizes with units and 90 % intervals, and the evidence for it.

    ``share`` of the explainable error that it removed when it was added, on fitted and on held-out drives (nan
    without; ``selection.shares_of``); ``absorbed``: share of its response that calibration had taken up; ``like``: what it cannot be told from,
    ``differ_on``: the drive on which each of those differs most from it.
    """

    name: str
    sizes: tuple[dict, ...]
    sentence: str
    p_value: float
    share: float
    held_out_share: float
    absorbed: float
    like: tuple[str, ...]
    differ_on: dict[str, str]
    is_of_measurement: bool = False
    """Whether it is an error of the measurement, not of the vehicle."""
    held: tuple[dict, ...] = ()
    """What shapes it and was not fitted, or came out as is typical: ``parameter``, ``size``, ``unit``, and ``is_typical``."""
    is_open: bool = False
    """Whether the intervals of all its sizes hold none: something is there, but these drives do not tell how large it is."""

    def beyond(self) -> list[dict]:
        """The sizes whose intervals do not reach into what is plausible."""
        return [size for size in self.sizes if not _may_be_plausible(size)]


@dataclass(frozen=True)
class Verdict:
    """``verdict`` is one of SAID; ``effects`` in the order in which they were found; ``reasons`` in words; ``may_be_shared``: whether repeats
    surely share an error still, or none tells, ``is_left``: one that is worth explaining."""

    verdict: str
    effects: tuple[Named, ...]
    reasons: tuple[str, ...]
    share: float
    held_out_share: float
    is_left: bool = False
    may_be_shared: bool = False
    beyond_bounds: BeyondBounds | None = None
    """Parameters of the vehicle that would explain more if they lay beyond their bounds, where effects explain too little."""
    at_bounds: tuple[AtBound, ...] = ()
    """Parameters of the vehicle that end at a bound in the model that the verdict stands on."""
    off_file: OffFile | None = None
    """Parameters of the vehicle that calibration holds, and to which the drives give other values than its file."""
    is_beside_form: bool = False
    """Whether the effects are those that are missing beside the proposed form, and shares of what goes beside it; else of what the library
    does alone."""
    of_all: tuple[float, float] | None = None
    """Shares that go with all effects of the model that it was found with, fitted and held out, where some of them have no name."""
    is_like_force: bool = False
    """Whether a force of another form explains as much as the effects."""
    is_like_error: bool = False
    """Whether an error of the measurement would help beside the effects, which stands in for something else."""
    remainder: Mapping[str, float] = field(default_factory=dict)
    """Share of the power of each signal, of what is judged, that the last model leaves above the floor."""
    at_first: Mapping[str, float] = field(default_factory=dict)
    """The same of the model that was diagnosed, before anything was found."""
    of_moments: tuple[str, ...] = ()
    """Signals of which half of what repeats differ by lies within moments (``bursts``)."""
    may_be_more: bool = False
    """Whether more than parameters of the vehicle may be missing: an error comes back with the way or the time, or drives held out hardly confirm an
    effect beside them."""

    def whole(self) -> Verdict:
        """The same with the shares of the model that it was found with (``of_all``), against which a force of another form is held."""
        return self if self.of_all is None else replace(self, share=self.of_all[0], held_out_share=self.of_all[1], of_all=None)

    def json(self) -> dict:
        """Plain numbers, text and lists; null where a number is not known. Each effect has the first of its ``sizes`` as ``size``, ``unit`` and
        ``interval`` as well; ``names``: what the verdict says is there, the first of each cluster."""
        said = asdict(self)
        for effect in said["effects"]:
            effect |= {key: effect["sizes"][0][key] if effect["sizes"] else None for key in ("size", "unit", "interval")}
        return plain({**said, "names": [effect.name for effect in self.claimed]})

    @property
    def claimed(self) -> tuple[Named, ...]:
        """The effects that it says are there: beside data that are suspect none of the vehicle."""
        return tuple(effect for effect in self.effects if self.verdict != "suspect" or effect.is_of_measurement)

    def words(self, form: str = "") -> str:
        """The verdict as a few sentences; ``form``: that of the force that is proposed, if any."""
        names = [" or ".join((effect.name, *effect.like)) for effect in self.claimed]
        return " ".join([first_sentence({**self.json(), "proposal": {"form": form}}, names), *map(sentence, self.reasons)])


def claimed_of(said: Mapping) -> list[Mapping]:
    """``Verdict.claimed`` of a verdict as ``Verdict.json`` gives it."""
    return [effect for effect in said["effects"] if said["verdict"] != "suspect" or effect.get("is_of_measurement")]


def kind_of(effects: Sequence[Named]) -> str:
    """What effects that explain enough are: a "cluster" where one has others like it, and where all are open: what may as well be none may
    as well be something else."""
    return "cluster" if any(effect.like for effect in effects) or are_open(effects) else "named"


def are_open(effects: Sequence[Named]) -> bool:
    """Whether none of these effects, of which there are any, has a size that is surely another than none."""
    return bool(effects) and all(effect.is_open for effect in effects)


def not_told_from(said: Mapping) -> str:
    """What all effects that a verdict names, as ``Verdict.json`` gives it, are not told from, in words: parameters of the vehicle beyond their
    bounds, or, where each may as well be none or a force of another form explains as much, something else; empty where there is nothing."""
    beyond = said.get("beyond_bounds") or {}
    if said["verdict"] in ("named", "cluster") and beyond.get("is_as_good") and not beyond.get("effects"):
        return other_name([one["parameter"] for one in told_beyond(beyond)])
    is_open = said.get("is_like_force") or all(effect.get("is_open") for effect in said["effects"])
    return SOMETHING_ELSE if said["verdict"] == "cluster" and is_open else ""


def told_beyond(beyond: Mapping) -> list[Mapping]:
    """All parameters of the vehicle that a verdict tells beyond their bounds."""
    return [*beyond["parameters"], *beyond.get("less_sure", ())]


def is_vehicle_first(said: Mapping) -> bool:
    """Whether the search of a verdict, as ``Verdict.json`` gives it, began with parameters of the vehicle put right that lie beyond their bounds."""
    return bool((said.get("beyond_bounds") or {}).get("is_first"))


def is_file_alone(said: Mapping) -> bool:
    """Whether parameters of the vehicle that lie far from its file, put right before any effect, leave nothing that has a name or a form, no error
    that repeats share and that is worth explaining, no more than SMALL of any signal, and no sign of anything else."""
    is_more = said["effects"] or (said.get("proposal") or {}).get("form") or any(said.get(key) for key in ("is_left", "may_be_more", "is_like_error"))
    # What effects without a name took of it, they leave as well: that is there at first.
    is_all = not is_more and max(left_without(said).values(), default=0.0) < SMALL
    return is_vehicle_first(said) and said["verdict"] == "outside" and is_all


def first_sentence(said: Mapping, names: Sequence[str]) -> str:
    """What a verdict, as ``Verdict.json`` gives it, begins with; ``names`` of its effects, each with what it is not told from."""
    kind, at_first = said["verdict"], said.get("at_first") or {}
    if kind == "nothing" and max(left_of(said).values(), default=0.0) >= SMALL:
        return UNNAMED
    if kind == "nothing" and said.get("of_moments"):
        return BESIDE_MOMENTS.format(signals=", ".join(said["of_moments"]))
    if is_file_alone(said):
        return FILE_ALONE
    other = not_told_from(said)
    told = ", ".join(names) + (f" or {other}" if other else "")
    first = SAID[kind].format(names=f": {told}" if kind == "suspect" and told else told)
    return first + LITTLE_TO_EXPLAIN.format(most=at_most(max(at_first.values()))) if is_of_little(said) else first


def left_of(said: Mapping) -> Mapping[str, float]:
    """Share of the power of each signal that the model leaves above the floor with what a verdict, as ``Verdict.json`` gives it, finds: where that
    is nothing, what it left at first, whatever was tried."""
    return (said.get("at_first") if said["verdict"] == "nothing" else None) or said.get("remainder") or {}


def left_without(said: Mapping) -> Mapping[str, float]:
    """Share of the power of each signal that is left above the floor where nothing of what a verdict, as ``Verdict.json`` gives it, finds is switched on:
    what was left at first, or now where that is more."""
    if said["verdict"] == "nothing":
        return left_of(said)
    first, now = (said.get(key) or {} for key in ("at_first", "remainder"))
    return {signal: max(first.get(signal, 0.0), now.get(signal, 0.0)) for signal in {**first, **now}}


def is_of_little(said: Mapping) -> bool:
    """Whether something is missing by a verdict, as ``Verdict.json`` gives it, and all that it could explain, by signal, is SMALL; not where
    parameters of the vehicle were put right before, for which there was more to explain."""
    most = max((said.get("at_first") or {}).values(), default=1.0)
    return said["verdict"] in IS_MISSING and most < SMALL and not is_vehicle_first(said)


def at_most(share: float) -> str:
    """A share of a signal's power as a limit in words, LEAST_TOLD or more."""
    return f"{100 * max(share, LEAST_TOLD):.1f} %"


def percent(share: float | None) -> str:
    """A share of the explainable error in words; nan, or None in a file, where nothing was explainable."""
    return f"{round(100 * share)} %" if share is not None and np.isfinite(share) else "an unknown share"


def sentence(reason: str) -> str:
    """A reason as a sentence; one that begins with the name of an effect or a drive keeps it as it is written."""
    first = reason.partition(" ")[0]
    begun = reason if "_" in first or first.endswith(":") else f"{reason[:1].upper()}{reason[1:]}"
    return begun if begun.endswith("?") else f"{begun}."


def _may_be_plausible(size: Mapping) -> bool:
    """Whether the interval of a size reaches into what is plausible; that which another effect may widen does not count: one more effect is
    just what a size beyond may say."""
    (lower, upper), (least, most) = size["interval_of_noise"], size["plausible"]
    return upper >= least and lower <= most


def plain(value):
    """A value as JSON knows it: Python's own numbers and lists, None for what is not a finite number."""
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not np.isfinite(value) else value
