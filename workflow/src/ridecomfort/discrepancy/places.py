"""Where a force that is in no library may act, the terms it may be made of, and the effect file that holds them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from types import SimpleNamespace

import numpy as np

FORCE = 30.0
"""N (or N m) that a term is probed with at typical motion."""

STRONGEST = 1500.0
"""N (or N m) at typical motion beyond which a term is not plausible."""

CORNERING = 8e4
"""N that a slip of one would make at typical stiffness."""

WIDTH = 3.0
"""Times its estimate that a factor which was found may plausibly be."""

AXLES = ("front", "rear")

WHOLE = ("",)

WHEELS = ("front_left", "front_right", "rear_left", "rear_right")

SIDE = "(1.0 - 2.0 * (wheel % 2))"
"""1 on the left, -1 on the right: what calibration, whose parameters are those of axles, cannot take up of a single wheel."""


@dataclass(frozen=True)
class State:
    """What a force remembers: its ``name``, its ``slope`` (an expression, per second), and a ``typical`` value."""

    name: str
    slope: str
    typical: float


@dataclass(frozen=True)
class Term:
    """A part of a force: its ``expression`` in what the place sees and in its own ``states``, the ``unit`` of its factor, the ``result``
    it adds to, and the ``parts`` of a car that have a factor of their own (one axle's, a wheel's, or the whole car's). A force on the body
    acts ``ahead`` (m, an expression) of the centre of gravity where that is given."""

    expression: str
    unit: str
    result: str = "force"
    parts: tuple[str, ...] = AXLES
    states: tuple[State, ...] = ()
    ahead: str = ""


@dataclass(frozen=True)
class Place:
    """Where a force may act: its port, what an effect file calls what it sees, typical values of what it sees to scale terms by,
    the terms, and what the port returns."""

    port: str
    arguments: tuple[str, ...]
    typical: Mapping[str, object]
    terms: Mapping[str, Term]
    results: tuple[str, ...] = ("force",)


def _below(frequency: float) -> Term:
    """Velocity through a low-pass of first order: what gives way in series with a damper, or creeps beside a spring."""
    return Term("slow", "N s/m", states=(State("slow", f"{2 * pi * frequency:.4g} * (velocity - slow)", 0.1),))


STRAIN = State("strain", "1000.0 * (velocity - abs(velocity) * strain) / (1.0 + abs(velocity) / 0.3)", 1.0)
"""The direction of motion, which it follows over a millimetre; no faster than the step of the kernel bears."""


def _on_spring(base: str, typical: float, frequency: float, unit: str, result: str, ahead: str = "") -> Term:
    """A part of the sprung mass that moves on a spring of its own where the body has the acceleration ``base`` (typically ``typical``),
    with a tenth of critical damping."""
    turns = 2 * pi * frequency
    against = f"{turns**2:.4g} * way + {0.2 * turns:.4g} * rate"
    states = State("way", "rate", typical / turns**2), State("rate", f"-({base} + {against})", typical / turns)
    return Term(f"{base} + {against}", unit, result, WHOLE, states, ahead)


def _resonance(axle: str, frequency: float) -> Term:
    """A part of the sprung mass above an axle."""
    body = f"motion.vertical_acceleration - motion.{axle} * motion.pitch_acceleration"
    return _on_spring(body, 0.6, frequency, "kg", "force_z", f"motion.{axle}")


def _roll_resonance(frequency: float) -> Term:
    """A part of the sprung mass that turns about the body's long axis."""
    return _on_spring("motion.roll_acceleration", 0.4, frequency, "kg m2", "moment_x")


PLACES: Mapping[str, Place] = {
    "strut": Place(
        "suspension",
        ("wheel", "deflection", "velocity", "stiffness", "damping", "force_x", "force_y"),
        {"deflection": 0.012, "velocity": 0.12, "stiffness": 28000.0, "damping": 2100.0, "force_x": 300.0, "force_y": 600.0},
        {
            "velocity_direction": Term("tanh(velocity / 0.005)", "N"),
            "velocity_saturating": Term("velocity / (1.0 + abs(velocity) / 0.1)", "N s/m"),
            "velocity_size": Term("abs(velocity)", "N s/m"),
            "velocity_signed_square": Term("velocity * abs(velocity)", "N s2/m2"),
            "velocity_cube": Term("velocity**3", "N s3/m3"),
            "deflection_square": Term("deflection**2", "N/m2"),
            "deflection_cube": Term("deflection**3", "N/m3"),
            "deflection_size_times_velocity": Term("abs(deflection) * velocity", "N s/m2"),
            "deflection_times_velocity": Term("deflection * velocity", "N s/m2"),
            "bump_beyond_20_mm": Term("max(deflection - 0.02, 0.0)", "N/m"),
            "rebound_beyond_20_mm": Term("min(deflection + 0.02, 0.0)", "N/m"),
            "deflection_direction": Term("tanh(deflection / 0.002)", "N"),
            "deflection_size_times_direction": Term("abs(deflection) * tanh(velocity / 0.005)", "N/m"),
            "deflection_of_sides": Term(f"deflection * {SIDE}", "N/m"),
            "velocity_of_sides": Term(f"velocity * {SIDE}", "N s/m"),
            "side_force": Term(f"force_y * {SIDE}", "1"),
            "forward_force": Term("force_x", "1"),
            "side_force_size_times_direction": Term("abs(force_y) * tanh(velocity / 0.005)", "1"),
            "forward_force_size_times_direction": Term("abs(force_x) * tanh(velocity / 0.005)", "1"),
            "direction_after_a_millimetre": Term("strain", "N", states=(STRAIN,)),
            "damping_after_a_millimetre": Term("abs(velocity) * strain", "N s/m", states=(STRAIN,)),
            **{f"velocity_below_{frequency}_Hz": _below(frequency) for frequency in (3, 10, 30)},
        },
    ),
    "tyre": Place(
        "tyre_vertical",
        ("wheel", "deflection", "velocity", "stiffness", "rest", "rotation", "spin"),
        {"deflection": 0.016, "velocity": 0.15, "stiffness": 280000.0, "rest": 0.015, "rotation": 0.0, "spin": 70.0},
        {
            "deflection_square": Term("(deflection - rest)**2", "N/m2"),
            "deflection_cube": Term("(deflection - rest)**3", "N/m3"),
            "velocity_direction": Term("tanh(velocity / 0.02)", "N"),
            "velocity_signed_square": Term("velocity * abs(velocity)", "N s2/m2"),
            "deflection_times_velocity": Term("(deflection - rest) * velocity", "N s/m2"),
            "velocity_per_spin": Term("velocity / (1.0 + abs(spin) / 30.0)", "N s/m"),
            "deflection_of_sides": Term(f"(deflection - rest) * {SIDE}", "N/m"),
            "velocity_of_sides": Term(f"velocity * {SIDE}", "N s/m"),
            "phase_cosine": Term("cos(rotation)", "N", parts=WHEELS),
            "phase_sine": Term("sin(rotation)", "N", parts=WHEELS),
            "phase_cosine_spin_square": Term("spin**2 * cos(rotation)", "kg m", parts=WHEELS),
            "phase_sine_spin_square": Term("spin**2 * sin(rotation)", "kg m", parts=WHEELS),
            "twice_a_turn_cosine": Term("cos(2.0 * rotation)", "N", parts=WHEELS),
            "twice_a_turn_sine": Term("sin(2.0 * rotation)", "N", parts=WHEELS),
            "direction_after_a_millimetre": Term("strain", "N", states=(STRAIN,)),
            **{f"velocity_below_{frequency}_Hz": _below(frequency) for frequency in (3, 10, 30)},
        },
    ),
    "contact": Place(
        "tyre_planar",
        ("wheel", "slip_x", "slip_y", "load", "speed", "slope", "force_x"),
        {"slip_x": 0.003, "slip_y": 0.01, "load": 4000.0, "speed": 20.0, "slope": 0.01, "force_x": 300.0},
        {
            "pull_of_load": Term("load", "1", "pull"),
            "pull_of_load_on_sides": Term(f"load * {SIDE}", "1", "pull"),
            "pull_of_load_and_speed": Term("load * speed**2", "s2/m2", "pull"),
            "pull_of_slope": Term("load * slope", "1", "pull"),
            "slip_of_load": Term("load", "1/N", "slip_x"),
            "side_slip_of_load": Term("slip_y * load", "1/N", "slip_y"),
            "side_slip_cube": Term("slip_y**3", "1", "slip_y"),
            "side_slip_of_sides": Term(SIDE, "1", "slip_y"),
            "side_slip_late": Term("late - slip_y", "1", "slip_y", states=(State("late", "2.0 * speed * (slip_y - late)", 0.005),)),
        },
        ("slip_x", "slip_y", "pull"),
    ),
    "body": Place(
        "body",
        ("motion",),
        {
            "motion": SimpleNamespace(
                speed=20.0, side_speed=0.1, vertical_speed=0.04, roll=0.01, pitch=0.008, roll_rate=0.03, pitch_rate=0.02,
                yaw_rate=0.05, vertical_acceleration=0.6, roll_acceleration=0.4, pitch_acceleration=0.3, front=1.2, rear=-1.5,
            )
        },
        {
            "drag": Term("motion.speed**2", "N s2/m2", "force_x", WHOLE),
            "side_slip": Term("motion.speed * motion.side_speed", "N s2/m2", "force_y", WHOLE),
            "lift": Term("motion.speed**2", "N s2/m2", "force_z", WHOLE),
            "heave_damping": Term("motion.vertical_speed", "N s/m", "force_z", WHOLE),
            "heave_mass": Term("motion.vertical_acceleration", "kg", "force_z", WHOLE),
            "roll_damping": Term("motion.roll_rate", "N m s", "moment_x", WHOLE),
            "roll_stiffness": Term("motion.roll", "N m", "moment_x", WHOLE),
            "roll_inertia": Term("motion.roll_acceleration", "kg m2", "moment_x", WHOLE),
            "roll_of_turning": Term("motion.speed * motion.yaw_rate", "kg m", "moment_x", WHOLE),
            "pitch_damping": Term("motion.pitch_rate", "N m s", "moment_y", WHOLE),
            "pitch_stiffness": Term("motion.pitch", "N m", "moment_y", WHOLE),
            "pitch_inertia": Term("motion.pitch_acceleration", "kg m2", "moment_y", WHOLE),
            "pitch_of_speed": Term("motion.speed**2", "kg", "moment_y", WHOLE),
            "yaw_damping": Term("motion.yaw_rate", "N m s", "moment_z", WHOLE),
            **{
                f"resonance_{axle}_{frequency}_Hz": _resonance(axle, frequency)
                for axle in AXLES
                for frequency in (7, 11, 17)
            },
            **{f"roll_resonance_{frequency}_Hz": _roll_resonance(frequency) for frequency in (7, 11, 17)},
        },
        ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"),
    ),
}  # fmt: skip


Factors = Mapping[str, Mapping[str, float]]
"""Factor of each term for each part of the car."""


def parameter(term: str, part: str) -> str:
    """Name of the factor of a term for one part of the car."""
    return f"{term}_{part}" if part else term


def scale(place: str, term: str) -> float:
    """Size of a term with a factor of one at typical motion, in N or N m; of a slip, the force that it makes."""
    known = {**PLACES[place].typical, "wheel": 0, "tanh": np.tanh, "abs": abs, "max": max, "min": min, "cos": np.cos}
    known["sin"] = np.cos
    known |= {state.name: state.typical for state in PLACES[place].terms[term].states}
    expression = PLACES[place].terms[term].expression
    if "20_mm" in term or "rest" in expression:
        known |= {key: 2 * value for key, value in PLACES[place].typical.items() if key != "rest"}
    if "rebound" in term:
        known |= {key: -known[key] for key in PLACES[place].typical}
    size = abs(float(eval(expression, {"__builtins__": {}}, known)))  # an expression of this file, not of a user
    return size * (CORNERING if PLACES[place].terms[term].result in PLACES[place].arguments else 1.0)


def in_words(place: str, terms: Factors) -> str:
    """The force as a formula with the sizes of its factors."""
    by_result: dict[str, list[str]] = {}
    for name, factors in terms.items():
        term = PLACES[place].terms[name]
        unit = "" if term.unit == "1" else f" {term.unit}"
        size = " and ".join(f"{value:.4g}{unit} {part}".rstrip() for part, value in factors.items())
        slopes = "".join(f", {state.name}' = {state.slope}" for state in term.states)
        at = f" at {term.ahead}" if term.ahead else ""
        expression = f"({term.expression})" if term.states and " " in term.expression else term.expression
        by_result.setdefault(term.result, []).append(f"({size}) {expression}{at}{slopes}")
    sign = lambda result: "+=" if result in PLACES[place].arguments else "="
    return ", ".join(f"{result} {sign(result)} {' + '.join(parts)}" for result, parts in by_result.items())


def _factor(key: str, term: Term) -> str:
    """The factor of a term at the wheel or axle in question, as source text."""
    names = [parameter(key, part) for part in term.parts]
    if term.parts == AXLES:
        return f"({names[0]} if wheel < 2 else {names[1]})"
    if term.parts == WHEELS:
        front, rear = (f"({left} if wheel % 2 == 0 else {right})" for left, right in (names[:2], names[2:]))
        return f"({front} if wheel < 2 else {rear})"
    return names[0]


def effect_source(name: str, place: str, terms: Factors, sentence: str) -> str:
    """Text of an effect file (``effects.contract``) with these terms and their factors as typical values."""
    where = PLACES[place]
    parameters, lines, arguments, states, slopes = [], [], [], [], []
    for key, factors in terms.items():
        term = where.terms[key]
        reach = STRONGEST / scale(place, key)
        for part in term.parts:
            typical = float(factors.get(part, FORCE / scale(place, key)))
            limit = float(f"{WIDTH * abs(typical) if factors.get(part) else reach:.3g}")
            meaning = f"factor of {term.expression}" + (f", {part}" if part else "")
            parameters.append(
                f'        Parameter("{parameter(key, part)}", "{term.unit}", 0.0, {typical:.6g}, ({-limit:g}, {limit:g}), "{meaning}"),'
            )
            arguments.append(parameter(key, part))
        own = {state.name: f"{key}_{state.name}" for state in term.states}
        value = f"{_factor(key, term)} * ({_renamed(term.expression, own)})"
        lines.append(f"    {term.result} += {value}")
        if term.ahead:
            lines.append(f"    moment_y -= {term.ahead} * {value}")
        states += own.values()
        slopes += [f"    {own[state.name]}_slope = {_renamed(state.slope, own)}" for state in term.states]
    body = "\n".join([*(f"    {result} = 0.0" for result in where.results if result not in where.arguments), *slopes, *lines])
    used = sorted({function for function in ("tanh", "cos", "sin") if re.search(rf"\b{function}\(", body)})
    imports = f"from math import {', '.join(used)}\n\n" if used else ""
    listed = "\n".join(parameters)
    returned = ", ".join([*where.results, *(f"{state}_slope" for state in states)])
    named = ", ".join(f'"{state}"' for state in states) + ("," if len(states) == 1 else "")
    remembered = f"    states=({named}),\n" if states else ""
    return (
        f'"""{sentence}"""\n\n{imports}from ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="{sentence}",\n'
        f'    source="estimated from measured drives by ridecomfort.discrepancy.discover",\n    port="{where.port}",\n'
        f"    parameters=(\n{listed}\n    ),\n{remembered})\n\n\n"
        f"def act({', '.join([*where.arguments, *states, *arguments])}):\n{body}\n    return {returned}\n"
    )


def _renamed(expression: str, names: Mapping[str, str]) -> str:
    """An expression with other names for its states."""
    for old, new in names.items():
        expression = re.sub(rf"\b{old}\b", new, expression)
    return expression
