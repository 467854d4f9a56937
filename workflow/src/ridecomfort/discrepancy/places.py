"""Where a force that is in no library may act, the terms it may be made of, and the effect file that holds them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

FORCE = 30.0
"""N (or N m) that a term is probed with at typical motion."""

STRONGEST = 1500.0
"""N (or N m) at typical motion beyond which a term is not plausible."""

WIDTH = 3.0
"""Times its estimate that a factor which was found may plausibly be."""

AXLES = ("front", "rear")


@dataclass(frozen=True)
class Term:
    """A part of a force: its ``expression`` in what the place sees, the ``unit`` of its factor, and the ``result`` it adds to."""

    expression: str
    unit: str
    result: str = "force"


@dataclass(frozen=True)
class Place:
    """Where a force may act: its port, what an effect file calls what it sees, the parts of a car that have a factor of their
    own, typical values of what it sees to scale terms by, the terms, and what the port returns."""

    port: str
    arguments: tuple[str, ...]
    parts: tuple[str, ...]
    typical: Mapping[str, object]
    terms: Mapping[str, Term]
    results: tuple[str, ...] = ("force",)


PLACES: Mapping[str, Place] = {
    "strut": Place(
        "suspension",
        ("wheel", "deflection", "velocity", "stiffness", "damping", "force_x", "force_y"),
        AXLES,
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
            "side_force": Term("force_y * (1.0 - 2.0 * (wheel % 2))", "1"),
            "forward_force": Term("force_x", "1"),
        },
    ),
    "tyre": Place(
        "tyre_vertical",
        ("wheel", "deflection", "velocity", "stiffness", "rest", "rotation", "spin"),
        AXLES,
        {"deflection": 0.016, "velocity": 0.15, "stiffness": 280000.0, "rest": 0.015, "rotation": 0.0, "spin": 70.0},
        {
            "deflection_square": Term("(deflection - rest)**2", "N/m2"),
            "deflection_cube": Term("(deflection - rest)**3", "N/m3"),
            "velocity_direction": Term("tanh(velocity / 0.02)", "N"),
            "velocity_signed_square": Term("velocity * abs(velocity)", "N s2/m2"),
            "deflection_times_velocity": Term("(deflection - rest) * velocity", "N s/m2"),
            "velocity_per_spin": Term("velocity / (1.0 + abs(spin) / 30.0)", "N s/m"),
            "phase_cosine": Term("cos(rotation)", "N"),
            "phase_sine": Term("sin(rotation)", "N"),
            "phase_cosine_spin_square": Term("spin**2 * cos(rotation)", "kg m"),
            "phase_sine_spin_square": Term("spin**2 * sin(rotation)", "kg m"),
        },
    ),
    "body": Place(
        "body",
        ("motion",),
        ("",),
        {
            "motion": SimpleNamespace(
                speed=20.0, side_speed=0.1, vertical_speed=0.04, roll=0.01, pitch=0.008, roll_rate=0.03, pitch_rate=0.02,
                yaw_rate=0.05, vertical_acceleration=0.6, roll_acceleration=0.4, pitch_acceleration=0.3,
            )
        },
        {
            "drag": Term("motion.speed**2", "N s2/m2", "force_x"),
            "side_slip": Term("motion.speed * motion.side_speed", "N s2/m2", "force_y"),
            "lift": Term("motion.speed**2", "N s2/m2", "force_z"),
            "heave_damping": Term("motion.vertical_speed", "N s/m", "force_z"),
            "heave_mass": Term("motion.vertical_acceleration", "kg", "force_z"),
            "roll_damping": Term("motion.roll_rate", "N m s", "moment_x"),
            "roll_stiffness": Term("motion.roll", "N m", "moment_x"),
            "roll_inertia": Term("motion.roll_acceleration", "kg m2", "moment_x"),
            "roll_of_turning": Term("motion.speed * motion.yaw_rate", "kg m", "moment_x"),
            "pitch_damping": Term("motion.pitch_rate", "N m s", "moment_y"),
            "pitch_stiffness": Term("motion.pitch", "N m", "moment_y"),
            "pitch_inertia": Term("motion.pitch_acceleration", "kg m2", "moment_y"),
            "pitch_of_speed": Term("motion.speed**2", "kg", "moment_y"),
            "yaw_damping": Term("motion.yaw_rate", "N m s", "moment_z"),
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
    """Size of a term with a factor of one at typical motion, in N or N m."""
    known = {**PLACES[place].typical, "wheel": 0, "tanh": np.tanh, "abs": abs, "max": max, "min": min, "cos": np.cos}
    known["sin"] = np.cos
    expression = PLACES[place].terms[term].expression
    if "20_mm" in term or "rest" in expression:
        known |= {key: 2 * value for key, value in PLACES[place].typical.items() if key != "rest"}
    if "rebound" in term:
        known |= {key: -known[key] for key in PLACES[place].typical}
    return abs(float(eval(expression, {"__builtins__": {}}, known)))  # an expression of this file, not of a user


def in_words(place: str, terms: Factors) -> str:
    """The force as a formula with the sizes of its factors."""
    by_result: dict[str, list[str]] = {}
    for name, factors in terms.items():
        term = PLACES[place].terms[name]
        size = " and ".join(f"{value:.4g} {term.unit} {part}".rstrip() for part, value in factors.items())
        by_result.setdefault(term.result, []).append(f"({size}) {term.expression}")
    return ", ".join(f"{result} = {' + '.join(parts)}" for result, parts in by_result.items())


def effect_source(name: str, place: str, terms: Factors, sentence: str) -> str:
    """Text of an effect file (``effects.contract``) with these terms and their factors as typical values."""
    where = PLACES[place]
    parameters, lines, arguments = [], [], []
    for key, factors in terms.items():
        term = where.terms[key]
        reach = STRONGEST / scale(place, key)
        for part in where.parts:
            typical = float(factors.get(part, FORCE / scale(place, key)))
            limit = float(f"{WIDTH * abs(typical) if factors.get(part) else reach:.3g}")
            meaning = f"factor of {term.expression}" + (f", {part}" if part else "")
            parameters.append(
                f'        Parameter("{parameter(key, part)}", "{term.unit}", 0.0, {typical:.6g}, ({-limit:g}, {limit:g}), "{meaning}"),'
            )
            arguments.append(parameter(key, part))
        factor = f"({key}_front if wheel < 2 else {key}_rear)" if where.parts == AXLES else key
        lines.append(f"    {term.result} += {factor} * ({term.expression})")
    body = "\n".join([*(f"    {result} = 0.0" for result in where.results), *lines])
    used = sorted({function for function in ("tanh", "cos", "sin") if re.search(rf"\b{function}\(", body)})
    imports = f"from math import {', '.join(used)}\n\n" if used else ""
    listed = "\n".join(parameters)
    return (
        f'"""{sentence}"""\n\n{imports}from ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="{sentence}",\n'
        f'    source="estimated from measured drives by ridecomfort.discrepancy.discover",\n    port="{where.port}",\n'
        f"    parameters=(\n{listed}\n    ),\n)\n\n\n"
        f"def act({', '.join([*where.arguments, *arguments])}):\n{body}\n    return {', '.join(where.results)}\n"
    )
