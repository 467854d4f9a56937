"""A missing effect that is in no library: where it acts, what form it has, and an effect file that says so.

At every place where a force could act (strut, interconnection of struts, tyre, contact, links, body,
steering, structure) it is written as a sum of terms of what that place sees. Each term is simulated as an effect, so that the vehicle itself
carries it to the signals, and the terms are selected like effects of the library: over all
places at once, sparsely, decided by the drives held out (compare Brunton et al. 2016, PNAS
113:3932, for sparse regression on a library of terms).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .. import pool
from ..effects.contract import Parameter
from . import opening
from . import experiment as exp
from .balance import LITTLE
from .candidates import is_varied, shaping_size, towards
from .experiment import Candidate, Size
from .form import effect_source, in_words, plausibility, typically
from .found import turn_of
from .judge import ANOTHER_SHAPE, standing
from .made import beside
from .meanings import senses, such_as, told
from .off_file import OffFile, off_file
from .places import FORCE, PLACES, parameter, scale, settings
from .probe import Job, Raw
from .ranking import dataset
from .rung import Rung, begin
from .select import search
from .selection import Selection, shares_of
from .terms import DAMPING_RATIO, FIRM, LINEAR, ORDER, PERIOD, TURNING, Term
from .turns import Line
from .verdict import Named, plain

ROLLING = 0.05
"""Share by which the way of a turn may differ from the circumference of a wheel that is not loaded."""

NEAR = 3.0
"""Widths of a line within which what is once a turn of each wheel may be heard."""

WIDE = 10.0
"""Ratio of the ends of what is plausible from which on a term that is shaped by its typical value is hardly like one at an end."""

APART = 1.35
"""Ratio of the frequencies that a term is tried with which swings at its own: between two, half as far, it still shows at a tenth of critical
damping."""

TERMS, TOGETHER = 3, 5
"""Terms of a force at most (the rod that nods on a tail pushes with three accelerations), and terms and effects of the library together."""


@dataclass(frozen=True)
class Discovery:
    """A proposed effect: its ``name``, the ``place`` where it acts and the ``port`` of that, its ``terms`` with factors by part of the car
    and the ``settings`` that shape them, ``form`` in words, shares removed, and the ``source`` of an effect file; all empty where
    nothing was found."""

    name: str
    place: str
    port: str
    terms: dict[str, dict[str, float]]
    settings: dict[str, dict[str, float]]
    form: str
    share: float
    held_out_share: float
    p_value: float
    source: str
    by_place: dict[str, float]
    """Fall of twice the negative log-likelihood with the best term of every place."""
    selection: Selection
    is_large: bool = False
    """Whether the first of its terms gains so much on the fitted drives that the error changes its colour by it."""
    held_out_z: float = float("nan")
    """How surely the first of its terms makes drives held out better, as a z; nan without."""
    evidence: xr.Dataset | None = None
    """What became of every term, as for the library (``ranking.dataset``)."""
    beside: tuple[Named, ...] = ()
    """Effects of the library that are missing, too: shares are of what goes with all together."""
    sizes: tuple[dict, ...] = ()
    """Its factors and what shapes it as in an effect file, each with ``parameter``, ``unit``, ``size`` and, where it was fitted, the 90 %
    ``interval``; with ``form.plausibility``."""
    off_file: OffFile | None = None
    """Parameters of the vehicle that calibration holds, and to which the drives give other values than its file beside the force."""
    residuals: Mapping[int, np.ndarray] | None = None
    """Those of the fitted drives, as they were aligned for the model that was diagnosed, with it and what stands beside it."""

    def words(self) -> str:
        """Where it acts, what usually makes such a force, and what it removes, as two sentences; that there is none where none was found."""
        if not self.place:
            return "no form of a force was found."
        shares = {"on the fitted drives": self.share, "on drives held out": self.held_out_share}
        removed = ", ".join(f"{100 * share:.0f} % {where}" for where, share in shares.items() if np.isfinite(share))
        removes = f"Together with {', '.join(self.names_beside())} it removes" if self.beside else "It removes"
        little = ": too little to be what is missing" if self.share < LITTLE else ""
        return f"at the {self.place}, such as {told(self.place, self.terms, self.sizes)}. {removes} {removed}{little}."

    def names_beside(self) -> list[str]:
        """Names of the effects of the library that are missing, too."""
        return [effect.name for effect in self.beside]

    def json(self) -> dict:
        """What a verdict file says of it; null where a number is not known."""
        names = ("name", "place", "port", "form", "terms", "settings", "sizes", "share", "held_out_share", "p_value", "by_place")
        more = {"such_as": such_as(self.place, self.terms), "here": senses(self.place, self.terms, self.sizes), "beside": self.names_beside()}
        more["typically"] = typically(self.place, self.terms, self.settings)
        more |= {f"own_{key}": getattr(self, key) - sum(getattr(effect, key) for effect in self.beside) for key in ("share", "held_out_share")}
        return plain({name: getattr(self, name) for name in names} | more)


def discover(
    measured: Mapping[str, tuple],
    vehicle,
    *,
    name: str = "discovered",
    calibration: xr.Dataset | None = None,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    effects_folder=None,
    fitted_on: Sequence[str] | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    uncertain: Mapping[str, float] | None = None,
    most: int = TERMS,
    seed: int = 0,
    noise_density: Mapping[str, Mapping[str, Mapping[str, float]]] | None = None,
    workers: int | None = None,
    options: Mapping | None = None,
    say: Callable[[str], None] = lambda words: None,
) -> Discovery:
    """Propose an effect that the library does not hold; arguments as for ``rank``, ``name`` is that of its file.

    ``most``: terms of its force. All terms of a proposal act at the place of the first.
    """
    experiment = opening.opened(
        measured, vehicle, calibration=calibration, effects=effects, effects_folder=effects_folder, fitted_on=fitted_on,
        bounds=bounds, uncertain=uncertain, among=(), noise_density=noise_density, workers=workers, options=options,
    )  # fmt: skip
    each = pool.mapped(pool.workers() if workers is None else workers)
    rung = begin(experiment, opening.start_values(experiment), each)
    return discovered(rung, name=name, effects_folder=effects_folder, most=most, seed=seed, each=each, say=say)


def discovered(
    rung: Rung, *, name: str = "discovered", effects_folder=None, most: int = TERMS, seed: int = 0, each: Callable = map,
    say: Callable[[str], None] = lambda words: None, known: Sequence[Candidate] = (), probed: Mapping[Job, Raw] = {}, line: Line | None = None,
) -> Discovery:  # fmt: skip
    """``discover`` from the ``rung`` of a calibrated model; ``known``: effects of the library that may be missing, too, with their
    columns where these are ``probed``; ``line``: what was heard to come back with the way or the time, without which nothing that does is
    looked for.

    These are looked for at the same time, and one that explains as much as a term goes before it: with the larger of two that are missing left
    out, the other is not seen, or stood in for.
    """
    unknown = {_name(place, term): (place, term) for place in PLACES for term in _asked_for(place, line)}
    text = "A force that is looked for."
    with beside(effects_folder, {own: effect_source(own, place, {term: {}}, text) for own, (place, term) in unknown.items()}) as folder:
        radius = float(rung.experiment.vehicle["tyre_radius"])
        terms = [candidate for place in PLACES for candidate in terms_of(place, line, radius)]
        rung = replace(rung, experiment=rung.experiment.looking_for([*known, *terms], folder))
        selection = search(
            rung, most=TOGETHER if known else most, seed=seed, each=each, together=lambda accepted, other: may_follow(accepted, other, most),
            say=say, simpler={candidate.name for candidate in known}, probed=probed,
            known=heard_as(line, radius), alike={term.name for term in terms if not _is_of_turns(term.name)},
        )  # fmt: skip
        residuals = exp.simulate(rung.experiment, {**rung.fit.values, **selection.final.values}, rung.fit.residuals)
        held = off_file(selection) if selection.accepted else None
    evidence = dataset(rung.experiment, selection)
    found = proposed(replace(selection, probed={}), name, known)
    return replace(found, evidence=evidence, residuals=residuals, off_file=held)  # columns of all terms are large


def proposed(selection: Selection, name: str, known: Sequence[Candidate]) -> Discovery:
    """What a ``selection`` among terms of a force and effects that are ``known`` says of an effect of this ``name``."""
    first = selection.rounds[0]
    by_place = {
        place: max((gain for own, gain in zip(first.names, first.gain) if _place(own) == place), default=0.0) for place in PLACES
    }
    needed = [name for name in selection.kept if _is_term(name)]
    if not needed:
        return Discovery(name, "", "", {}, {}, "", float("nan"), float("nan"), 1.0, "", by_place, selection)
    place, terms, shaped = _place(needed[0]), {}, {}
    for accepted in needed:
        term = accepted.partition(":")[2]
        keys = {part: _key(place, term, part) for part in PLACES[place].terms[term].parts}
        terms[term] = {part: selection.final.values[key] for part, key in keys.items() if key in selection.final.values}
        own = {setting.name: setting.typical for setting in settings(place, term)}
        shaped[term] = {name: selection.final.values.get(_key(place, term, name), typical) for name, typical in own.items()}
    form = in_words(place, terms, shaped)
    effects = _beside(selection, known, PLACES[place].port, needed)
    share, held_out = np.add(_removed(selection, needed), _removed(selection, [effect.name for effect in effects])).tolist()
    turn = selection.rounds[selection.accepted.index(needed[0])]
    p_value = float(turn.p_value[turn.names.index(needed[0])])
    sizes = tuple(size for term in terms for size in _told(selection, place, term, {**terms[term], **shaped[term]}))
    sentence = f"Found on measured drives, not in the library: at the {place}, {form}. Such as {told(place, terms, sizes)}."
    source = effect_source(name, place, terms, sentence, shaped)
    return Discovery(
        name, place, PLACES[place].port, terms, shaped, form, share, held_out, p_value, source, by_place, selection, turn.is_large,
        turn.winner.held_out_z, beside=tuple(effects), sizes=sizes,
    )  # fmt: skip


def _told(selection: Selection, place: str, term: str, values: Mapping[str, float]) -> list[dict]:
    """``Discovery.sizes`` of a term with these ``values`` of its factors and settings."""
    units = {setting.name: setting.unit for setting in settings(place, term)}
    told = []
    for part, size in values.items():
        key, unit = _key(place, term, part), units.get(part, PLACES[place].terms[term].unit)
        interval = selection.told(key) if key in selection.intervals else None
        told.append({"parameter": parameter(term, part), "unit": unit, "size": size, "interval": interval, **plausibility(place, term, part, size)})
    return told


def _beside(selection: Selection, known: Sequence[Candidate], port: str, terms: Sequence[str]) -> list[Named]:
    """Effects of the library that stand beside the ``terms`` of a force at a ``port``, without what is small there beside these, or what makes
    the error of drives held out larger that meet it: no form need be exact, and what that leaves another shape may take up."""
    ports, least = {candidate.name: candidate.port for candidate in known}, ANOTHER_SHAPE * _removed(selection, terms)[0]
    is_another_shape = lambda effect: ports[effect.name] == port and effect.share < least
    is_refuted = lambda effect: effect.held_out_share < 0.0 and turn_of(selection, effect.name).winner.met
    return [effect for effect in standing(selection, known) if not (is_another_shape(effect) or is_refuted(effect))]


def _removed(selection: Selection, names: Sequence[str]) -> tuple[float, float]:
    """Share of the explainable error that went when these were accepted, on fitted and on held-out drives (nan without)."""
    fitted, held_out = np.sum([shares_of(selection, name) for name in names], axis=0) if names else (0.0, 0.0)
    return float(fitted), float(held_out)


def _is_term(name: str) -> bool:
    """Whether a candidate is a term of an unknown force, not an effect of the library."""
    return ":" in name


def may_follow(accepted: Sequence[str], other: str, most: int) -> bool:
    """Whether a candidate may follow those accepted: all of ``most`` terms act at one place."""
    terms = [name for name in accepted if _is_term(name)]
    return not (_is_term(other) and terms) or len(terms) < most and _place(other) == _place(terms[0])


def _is_of_turns(name: str) -> bool:
    """Whether a term goes by how far wheels have turned, or by what was heard, whose phase repeats do not share."""
    place, _, term = name.partition(":")
    return bool(PLACES[place].terms[term].often or PLACES[place].terms[term].after)


def _place(name: str) -> str:
    """The place of a term by the name of its candidate."""
    return name.partition(":")[0]


def _name(place: str, term: str) -> str:
    """Name of the effect that stands for one term of an unknown force."""
    return f"unknown_{place}_{term}"


def _key(place: str, term: str, part: str) -> str:
    return f"{_name(place, term)}.{parameter(term, part)}"


def _asked_for(place: str, line: Line | None) -> dict[str, Term]:
    """The terms of a place that are looked for where this ``line`` was heard, if any."""
    return {name: term for name, term in PLACES[place].terms.items() if not term.after or line is not None and term.after == line.unit}


def heard_as(line: Line | None, radius: float) -> dict[str, float]:
    """p-values of the candidates that come back as what was heard does, of wheels of this ``radius`` in m: one line in the spectrum is itself
    made white by its own power, with all that goes along with it in other signals, so that the score test hardly sees it."""
    if line is None:
        return {}
    turns = line.turns(radius) if line.unit == "m" else 0.0
    comes_so = lambda term: bool(term.after) or bool(term.often) and abs(turns / term.often - 1.0) < ROLLING
    asked = {place: _asked_for(place, line) for place in PLACES}
    return {f"{place}:{name}": line.p_value for place, terms in asked.items() for name, term in terms.items() if comes_so(term)}


def _heard(setting: Parameter, line: Line | None, radius: float) -> Parameter:
    """A setting of a term; a period, or an order (turns of wheels of this ``radius`` in m), begins at the line that was heard and stays within its width."""
    if setting.name not in FIRM or line is None:
        return setting
    value = line.period if setting.name == PERIOD else line.turns(radius)
    width = value * line.width / line.period
    return replace(setting, neutral=value, typical=value, plausible=(value - width, value + width))


def _whole_turn(line: Line | None, radius: float) -> float | None:
    """The way in m after which comes what does so a whole number of times in a turn of wheels of this ``radius`` in m, None where none is near
    what was heard: along the road, not along the wheels' own ways, which are longer outside in bends than inside."""
    if line is None or line.unit != "m":
        return None
    way = 2.0 * np.pi * radius / max(1, round(line.turns(radius)))
    return way if abs(way - line.period) < NEAR * line.width else None


def _is_wide(setting: Parameter) -> bool:
    """Whether what is plausible of a setting is WIDE."""
    lower, upper = setting.plausible
    return setting.name not in (*FIRM, DAMPING_RATIO) and 0.0 < WIDE * lower < upper


def _frequencies(setting: Parameter) -> list[float]:
    """Frequencies in Hz, APART at most, between the ends of what is plausible of a setting, beside its typical one."""
    (lower, upper), found = setting.plausible, []
    for start, end in ((lower, setting.typical), (setting.typical, upper)):
        found += np.geomspace(start, end, int(np.ceil(np.log(end / start) / np.log(APART))) + 1).tolist()
    return [frequency for frequency in found if not np.isclose(frequency, setting.typical)]


def terms_of(place: str, line: Line | None, radius: float) -> tuple[Candidate, ...]:
    """Every term of a place as a candidate: a factor for each part of the car, of either sign, and what shapes it; with those that come back
    as the ``line`` that was heard does, if any, in a car on wheels of this ``radius`` in m."""
    candidates, strongest = [], PLACES[place].strongest
    for name, term in _asked_for(place, line).items():
        one = scale(place, name)
        own = {_key(place, name, setting.name): _heard(setting, line, radius) for setting in settings(place, name)}
        period = _key(place, name, PERIOD)
        whole = _whole_turn(line, radius) if term.parts == TURNING and period in own else None
        if whole is not None:
            lower, upper = own[period].plausible
            own[period] = replace(own[period], plausible=(min(lower, whole), max(upper, whole)))
        typical = {key: setting.typical for key, setting in own.items()}
        # A linear part alone is what calibration changes: it is no other shape to try. Bends blur an order that is heard along the road.
        is_tried = lambda setting: setting.name == ORDER or setting is not LINEAR and (is_varied(setting) or _is_wide(setting))
        tried = {key: (towards(setting, 0), towards(setting, 1)) for key, setting in own.items() if is_tried(setting)}
        if DAMPING_RATIO in (setting.name for setting in own.values()):
            tried |= {key: _frequencies(setting) for key, setting in own.items() if setting.unit == "Hz"}
        shapes = [typical, *({**typical, key: value} for key, values in tried.items() for value in values)]
        shapes += [{**typical, period: whole}] if whole is not None else []
        shaping = tuple(shaping_size(setting, key) for key, setting in own.items())
        sizes = tuple(
            Size(_key(place, name, part), term.unit, 0.0, -strongest / one, strongest / one, FORCE / one)
            for part in term.parts
        )
        candidates.append(Candidate(f"{place}:{name}", sizes, tuple(shapes), shaping))
    return tuple(candidates)
