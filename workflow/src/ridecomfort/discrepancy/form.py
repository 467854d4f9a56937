"""A force made of terms: in words, and as the effect file that holds it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from .places import FORCE, MOTION, PLACES, at_typical, expression, parameter, scale, settings
from .terms import AXLES, CLOSE, FIRM, LINEAR, WHEELS, Term

WIDTH = 3.0
"""Times the largest estimate of its term that a factor which was found may plausibly be."""

Factors = Mapping[str, Mapping[str, float]]
"""Factor of each term for each part of the car."""

Settings = Mapping[str, Mapping[str, float]]
"""What shapes each term, by name."""


def in_words(place: str, terms: Factors, shaped: Settings = {}) -> str:
    """The force as a formula with the sizes of its factors, and what shapes it."""
    by_result: dict[str, list[str]] = {}
    for name, factors in terms.items():
        term, own = PLACES[place].terms[name], shaped.get(name, {})
        slopes = "".join(f", {state.name}' = {state.slope}" for state in term.states)
        values = {setting: own.get(setting.name, setting.typical) for setting in settings(place, name)}
        written = term.written(expression(place, name, bool(values.get(LINEAR)), values.get(LINEAR)))
        is_sum = " + " in written or bool(values.get(LINEAR)) or term.states and " " in written
        written = f"({written})" if is_sum and not term.turn else written
        said = "".join(f", {s.name} = {value:.4g} {s.unit}".removesuffix(" 1") for s, value in values.items() if s is not LINEAR)
        for result, parts in term.by_result().items():
            at = " at " + " and ".join(term.arms(result)) if term.arms(result) else ""
            size = _sizes(term, {part: factors[part] for part in parts if part in factors})
            by_result.setdefault(result, []).append(f"({size}) {written}{at}{slopes}{said}")
    sign = lambda result: "+=" if result in PLACES[place].arguments else "="
    return "; ".join(f"{result} {sign(result)} {' + '.join(parts)}" for result, parts in by_result.items())


def plausibility(place: str, term: str, part: str, value: float) -> dict:
    """Of a factor of a term, or of what shapes it, whether it ``is_shaping``, what is ``plausible`` and whether its ``value`` is; the last two None
    of a period or an order, which are known as they were heard."""
    setting = next((one for one in settings(place, term) if one.name == part), None)
    if setting is not None and setting.name in FIRM:
        return {"is_shaping": True, "plausible": None, "is_plausible": None}
    limit = PLACES[place].strongest / scale(place, term)
    lower, upper = setting.plausible if setting else (-limit, limit)
    return {"is_shaping": setting is not None, "plausible": [lower, upper], "is_plausible": bool(lower <= value <= upper)}


RETURNED = {"force": "N", "pull": "N", "moment": "N m", "toe": "mrad", "angle": "mrad", "a": "m/s2"}
"""Unit of what a port returns, by the name of that up to its axis; shares have none."""

SEEN = {
    "deflection": "m", "velocity": "m/s",
    **{f"{motion}_{other}": unit for other in ("along", "across", "opposite") for motion, unit in (("deflection", "m"), ("velocity", "m/s"))},
    "speed": "m/s", "side_speed": "m/s", "vertical_speed": "m/s", "force_x": "N", "force_y": "N", "load": "N",
    "angle": "rad", "spin": "rad/s", "roll": "rad", "pitch": "rad", "roll_rate": "rad/s", "pitch_rate": "rad/s", "yaw_rate": "rad/s",
    "vertical_acceleration": "m/s2", "roll_acceleration": "rad/s2", "pitch_acceleration": "rad/s2", "slip_x": "", "slip_y": "", "slope": "",
}  # fmt: skip
"""Unit of what a place sees, where it is told."""

COMPRESSED = {"deflection": "deflection from rest in m, positive in compression", "velocity": "velocity in m/s, positive in compression"}

APART = {"force": "force in N between body and wheel, positive pushing apart", **COMPRESSED}

OTHERS = {"along": "the other strut on its side", "across": "the other strut of its axle", "opposite": "the strut opposite to it in both"}

OF_BODY = {f"motion.{name}": f"{name.replace('_', ' ')} of the body in {SEEN[name]}" for name in vars(MOTION) if name in SEEN} | {
    "motion.s": "way s in m", **{f"motion.{axle}": f"place of the {axle} axle in m ahead of the centre of gravity" for axle in AXLES}
}

NAMES: Mapping[str, Mapping[str, str]] = {
    "strut": {**APART, "force_x": "force_x of the tyre in N", "force_y": "force_y of the tyre in N"},
    "interconnection": APART | {f"{own}_{other}": f"{own}_{other}, the {own} of {which}" for other, which in OTHERS.items() for own in COMPRESSED},
    "tyre": {
        "force": "radial force in N, positive pushing the wheel up", "deflection": "deflection of the tyre in m, positive pressed",
        "velocity": "velocity of that in m/s, positive pressed", "rest": "rest, its deflection at rest in m",
        "rotation": "rotation, the turn of the wheel in rad", "spin": "spin of the wheel in rad/s",
    },
    "contact": {
        "slip_x": "slip_x, the longitudinal slip that the tyre answers to", "slip_y": "slip_y, the tangent of the slip angle that the tyre answers to",
        "pull": "pull, the extra force in N that pulls the axle forward", "load": "load of the tyre in N", "speed": "speed in m/s",
        "slope": "slope of the road under the wheel against the plane under all four", "force_x": "force_x that the tyre had the step before in N",
    },
    "links": {
        "recession": "recession, how far the wheel moves back per compression (m/m)", "toe": "toe, the angle in rad by which the wheel is turned to the left",
        "scrub": "scrub, how far to the left the wheel moves per compression (m/m; beside that of its roll centre)", "deflection": COMPRESSED["deflection"],
    },
    "body": {f"{kind}_{axis}": f"{kind}_{axis} in {RETURNED[kind]} on the sprung mass" for kind in ("force", "moment") for axis in "xyz"} | OF_BODY,
    "steering": {
        "angle": "angle of the front wheels in rad, positive to the left", "speed": "speed in m/s",
        "force_y": "force_y of both front tyres in N, positive to the left",
    },
    "structure": {f"a_{axis}": f"a_{axis} in m/s2 of the sensor's place against the rigid body" for axis in "xyz"}
    | {axis: f"{axis} of the sensor in m from the centre of gravity" for axis in "xyz"} | OF_BODY,
}  # fmt: skip
"""What the names in the formulas of a place mean; axes are those of ISO 8855."""


def names_in(place: str, form: str, terms: Iterable[str]) -> str:
    """What stands in the formula ``form`` of a force of these ``terms``, in words: what it sees and makes, and what shapes it."""
    used = re.findall(r"\b[a-z_]+(?:\.[a-z_]+)?\b", form)
    told = [meaning for name, meaning in NAMES[place].items() if name in used]
    shaping = [setting for term in terms for setting in settings(place, term) if setting is not LINEAR and setting.name in used]
    told += [one.meaning if one.meaning.startswith(one.name) else f"{one.name}: {one.meaning}" for one in shaping]
    return "; ".join(dict.fromkeys(told))


def typically(place: str, terms: Factors, shaped: Factors = {}) -> str:
    """How large each term of a force is at typical motion of what it sees, ``shaped`` as it was found, by part of the car; with signs where
    parts push against one another."""
    told = {name: _typically(place, name, factors, shaped.get(name, {})) for name, factors in terms.items() if factors}
    of = lambda name: f"{_spaced(name)}: " if len(told) > 1 else ""
    return "; ".join(f"{of(name)}{size}" for name, size in told.items())


def _typically(place: str, name: str, factors: Mapping[str, float], shaped: Mapping[str, float]) -> str:
    term = PLACES[place].terms[name]
    one, seen = at_typical(place, name, shaped)
    unit = RETURNED.get(term.result.partition("_")[0], "")
    times = 1e3 * one if unit == "mrad" else one
    sizes = {part: size for part, (size, _) in term.amplitudes(factors).items()} if term.turn else factors
    differ = len({size > 0 for size in sizes.values() if size}) > 1
    rounded = {part: float(f"{abs(times * size):.2g}") * (-1 if differ and size < 0 else 1) for part, size in sizes.items()}
    told = " and ".join(_spaced(f"{size:g}", unit, part) for part, size in rounded.items())
    at = ", ".join(_spaced(what, f"{value:g}", SEEN[what]) for what, value in seen.items() if what in SEEN)
    return f"{told} at {at}" if at else told


def _spaced(*words: str) -> str:
    """Those of the words that are not empty, names of the code as words."""
    return " ".join(filter(None, words)).replace("_", " ")


def _sizes(term: Term, factors: Mapping[str, float]) -> str:
    """The ``factors`` of a term with their parts of the car; of a wave, its amplitudes and the angles at which these are met."""
    unit = "" if term.unit == "1" else f" {term.unit}"
    if term.turn:
        waves = term.amplitudes(factors).items()
        return " and ".join(f"{f'{size:.4g}{unit} {part}'.rstrip()} at {angle:.0f} deg" for part, (size, angle) in waves)
    return " and ".join(f"{size:.4g}{unit} {part}".rstrip() for part, size in factors.items())


def _factor(key: str, term: Term, parts: Sequence[str], own: Mapping[str, str]) -> str:
    """The factor of these ``parts`` of a term at the wheel or axle in question, as source text; ``own``: the names of its states and settings
    in the file."""
    names = [parameter(key, part) for part in parts]
    if term.parts == AXLES:
        return f"({names[0]} if wheel < 2 else {names[1]})"
    if term.turn:
        turn = _renamed(term.turn, own)
        names = [f"{cosine} * cos({turn}) + {sine} * sin({turn})" for cosine, sine in zip(names[::2], names[1::2])]
    if len(names) == len(WHEELS):
        front, rear = (f"({left} if wheel % 2 == 0 else {right})" for left, right in (names[:2], names[2:]))
        return f"({front} if wheel < 2 else {rear})"
    return f"({names[0]})" if term.turn else names[0]


@dataclass(frozen=True)
class _Written:
    """A term as source text: its ``parameters`` in the file's ``Effect``, the ``names`` of these, its ``states``, and the ``slopes`` of those
    and ``lines`` of its force in ``act``."""

    parameters: list[str]
    names: list[str]
    states: list[str]
    slopes: list[str]
    lines: list[str]


def effect_source(name: str, place: str, terms: Factors, sentence: str, shaped: Settings = {}) -> str:
    """Text of an effect file (``effects.contract``) with these terms, their factors and what shapes them as typical values.

    A term whose linear part is given as nil has none. Terms act one after another in the order of their names, as effects of one term each do, and
    all before an effect of the library at their port, whatever the file is called.
    """
    where = PLACES[place]
    written = [_written(place, key, factors, shaped.get(key, {})) for key, factors in sorted(terms.items())]
    every = lambda part: [one for term in written for one in getattr(term, part)]
    states = every("states")
    nil = [f"    {result} = 0.0" for result in where.results if result not in where.arguments]
    body = "\n".join([*nil, *(line for term in written for line in (*term.slopes, *term.lines))])
    used = sorted({function for function in ("tanh", "cos", "sin") if re.search(rf"\b{function}\(", body)})
    imports = f"from math import {', '.join(used)}\n\n" if used else ""
    listed = "\n".join(every("parameters"))
    returned = ", ".join([*where.results, *(f"{state}_slope" for state in states)])
    named = ", ".join(f'"{state}"' for state in states) + ("," if len(states) == 1 else "")
    remembered = f"    states=({named}),\n" if states else ""
    return (
        f'"""{sentence}"""\n\n{imports}from ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="{sentence}",\n'
        f'    source="estimated from measured drives by ridecomfort.discrepancy.discover",\n    port="{where.port}",\n    order=-1,\n'
        f"    parameters=(\n{listed}\n    ),\n{remembered})\n\n\n"
        f"def act({', '.join([*where.arguments, *states, *every('names')])}):\n{body}\n    return {returned}\n"
    )


def _written(place: str, key: str, factors: Mapping[str, float], values: Mapping[str, float]) -> _Written:
    """A term with its factors by part of the car, and the ``values`` of what shapes it."""
    term, one = PLACES[place].terms[key], scale(place, key)
    parameters, names = [], []
    # Of cosine and sine, or front and rear, one may be nearly nil, and then be anything up to the size of the others.
    largest = max((abs(factors[part]) for part in term.parts if part in factors), default=0.0)
    limit = float(f"{WIDTH * largest if largest else PLACES[place].strongest / one:.3g}")
    for part in term.parts:
        typical = float(factors.get(part, FORCE / one))
        of_turn = f", cosine and sine of {term.turn}" if term.turn else ""
        meaning = f"factor of {term.expression}{of_turn}" + (f", {part}" if part else "")
        names.append(parameter(key, part))
        parameters.append(_parameter(names[-1], term.unit, "0.0", f"{typical:.6g}", (-limit, limit), meaning))
    is_linear = values.get(LINEAR.name) != 0.0
    own = {state.name: parameter(key, state.name) for state in term.states}
    states = list(own.values())
    for setting in settings(place, key):
        if setting is not LINEAR or is_linear:
            own[setting.name] = parameter(key, setting.name)
            value = values.get(setting.name, setting.typical)
            names.append(own[setting.name])
            plausible = (value * (1 - CLOSE), value * (1 + CLOSE)) if setting.name in FIRM else setting.plausible
            written = f"{value:.{8 if setting.name in FIRM else 6}g}"
            parameters.append(_parameter(names[-1], setting.unit, written, written, plausible, setting.meaning))
    lines = []
    for result, parts in term.by_result().items():
        force = f"{_factor(key, term, parts, own)} * ({_renamed(expression(place, key, is_linear), own)})"
        lines.append(f"    {result} += {force}")
        lines += [f"    {moment} {sign}= {_renamed(arm, own)} * {force}" for arm, (moment, sign) in term.arms(result).items()]
    slopes = [f"    {own[state.name]}_slope = {_renamed(state.slope, own)}" for state in term.states]
    return _Written(parameters, names, states, slopes, lines)


def _parameter(name: str, unit: str, neutral: str, typical: str, plausible: tuple[float, float], meaning: str) -> str:
    lower, upper = plausible
    return f'        Parameter("{name}", "{unit}", {neutral}, {typical}, ({lower:g}, {upper:g}), "{meaning}"),'


def _renamed(text: str, names: Mapping[str, str]) -> str:
    """An expression with other names for its states."""
    for old, new in names.items():
        text = re.sub(rf"\b{old}\b", new, text)
    return text
