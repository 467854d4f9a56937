"""A missing effect that is in no library: where it acts, what form it has, and an effect file that says so.

At every place where a force could act (strut, tyre, body) the force is written as a sum of
terms of what that place sees. Each term is simulated as an effect, so that the vehicle itself
carries it to the signals, and the terms are selected like effects of the library: over all
places at once, sparsely, decided by the drives held out (compare Brunton et al. 2016, PNAS
113:3932, for sparse regression on a library of terms).
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from .. import calibrated
from . import car as cars
from . import pool
from .experiment import Candidate, Size
from .select import select
from .selection import Selection
from .verdict import plain, total_shares

FORCE = 30.0
"""N (or N m) that a term is probed with at typical motion."""

STRONGEST = 1500.0
"""N (or N m) at typical motion beyond which a term is not plausible."""



@dataclass(frozen=True)
class Place:
    """Where a force may act: its port, what the file calls what it sees, and typical values of that to scale terms by."""

    port: str
    arguments: tuple[str, ...]
    by_axle: bool
    typical: Mapping[str, float]
    terms: Mapping[str, tuple[str, str]]
    """Name of each term to its expression and the unit of its factor."""
    results: tuple[str, ...] = ("force",)


PLACES: Mapping[str, Place] = {
    "strut": Place(
        "suspension",
        ("wheel", "deflection", "velocity", "stiffness", "damping", "force_x", "force_y"),
        True,
        {"deflection": 0.012, "velocity": 0.12, "stiffness": 28000.0, "damping": 2100.0, "force_x": 300.0, "force_y": 600.0},
        {
            "velocity_direction": ("tanh(velocity / 0.005)", "N"),
            "velocity_saturating": ("velocity / (1.0 + abs(velocity) / 0.1)", "N s/m"),
            "velocity_size": ("abs(velocity)", "N s/m"),
            "velocity_signed_square": ("velocity * abs(velocity)", "N s2/m2"),
            "velocity_cube": ("velocity**3", "N s3/m3"),
            "deflection_square": ("deflection**2", "N/m2"),
            "deflection_cube": ("deflection**3", "N/m3"),
            "deflection_size_times_velocity": ("abs(deflection) * velocity", "N s/m2"),
            "deflection_times_velocity": ("deflection * velocity", "N s/m2"),
            "bump_beyond_20_mm": ("max(deflection - 0.02, 0.0)", "N/m"),
            "rebound_beyond_20_mm": ("min(deflection + 0.02, 0.0)", "N/m"),
            "deflection_direction": ("tanh(deflection / 0.002)", "N"),
            "side_force": ("force_y * (1.0 - 2.0 * (wheel % 2))", "1"),
            "forward_force": ("force_x", "1"),
        },
    ),
    "tyre": Place(
        "tyre_vertical",
        ("wheel", "deflection", "velocity", "stiffness", "rest", "rotation", "spin"),
        True,
        {"deflection": 0.016, "velocity": 0.15, "stiffness": 280000.0, "rest": 0.015, "rotation": 0.0, "spin": 70.0},
        {
            "deflection_square": ("(deflection - rest)**2", "N/m2"),
            "deflection_cube": ("(deflection - rest)**3", "N/m3"),
            "velocity_direction": ("tanh(velocity / 0.02)", "N"),
            "velocity_signed_square": ("velocity * abs(velocity)", "N s2/m2"),
            "deflection_times_velocity": ("(deflection - rest) * velocity", "N s/m2"),
            "velocity_per_spin": ("velocity / (1.0 + abs(spin) / 30.0)", "N s/m"),
            "phase_cosine": ("cos(rotation)", "N"),
            "phase_sine": ("sin(rotation)", "N"),
            "phase_cosine_spin_square": ("spin**2 * cos(rotation)", "kg m"),
            "phase_sine_spin_square": ("spin**2 * sin(rotation)", "kg m"),
        },
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Discovery:
    """A proposed effect: ``place``, its ``terms`` with factors by axle, ``form`` in words, shares removed, and
    the ``source`` of an effect file; all empty where nothing was found."""

    place: str
    terms: dict[str, dict[str, float]]
    form: str
    share: float
    held_out_share: float
    p_value: float
    source: str
    by_place: dict[str, float]
    """Fall of twice the negative log-likelihood with the best term of every place."""
    selection: Selection

    def json(self) -> dict:
        """What a verdict file says of it; null where a number is not known."""
        names = ("place", "form", "terms", "share", "held_out_share", "p_value", "by_place")
        return plain({name: getattr(self, name) for name in names})


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
    most: int = 2,
    seed: int = 0,
    workers: int | None = None,
    options: Mapping | None = None,
    say: Callable[[str], None] = lambda words: None,
) -> Discovery:
    """Propose an effect that the library does not hold; arguments as for ``rank``, ``name`` is that of its file.

    ``most``: terms of its force. All terms of a proposal act at the place of the first.
    """
    vehicle, effects = calibrated.apply(calibration, vehicle, effects)
    count = pool.workers() if workers is None else workers
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(Path(effects_folder).glob("*.py")) if effects_folder else ():
            (Path(folder) / path.name).write_bytes(path.read_bytes())
        unknown = [(place, term) for place in PLACES for term in PLACES[place].terms]
        for place, term in unknown:
            text = effect_source(_name(place, term), place, {term: {}}, "A force that is looked for.")
            (Path(folder) / f"{_name(place, term)}.py").write_text(text, encoding="utf-8")
        experiment = cars.car(
            cars.sites_of(measured), vehicle, effects=effects, effects_folder=folder, fitted_on=fitted_on, bounds=bounds,
            library_names=[_name(place, term) for place, term in unknown], options=options,
            each_record=pool.side_by_side(count),
        )  # fmt: skip
        return _search(experiment, name, most, seed, pool.mapped(count), say)


def _search(experiment, name, most, seed, each, say) -> Discovery:
    start = cars.start_values(experiment)
    experiment.candidates = tuple(_terms(place) for place in PLACES)
    experiment.candidates = tuple(term for terms in experiment.candidates for term in terms)
    first = select(experiment, start, most=1, seed=seed, each=each, say=say)
    by_place = {
        place: max(g for n, g in zip(first.rounds[0].names, first.rounds[0].gain) if n.startswith(place)) for place in PLACES
    }
    if not first.accepted:
        return Discovery("", {}, "", float("nan"), float("nan"), 1.0, "", by_place, first)
    place = first.accepted[0].partition(":")[0]
    selection = first
    if most > 1:
        experiment.candidates = _terms(place)
        selection = select(experiment, start, most=most, seed=seed, each=each, say=say)
    values, terms = selection.final.values, {}
    for accepted in selection.accepted:
        term = accepted.partition(":")[2]
        terms[term] = {
            axle: values[_key(place, term, axle)] for axle in ("front", "rear") if _key(place, term, axle) in values
        }
    form = _form(place, terms)
    share, held_out = total_shares(selection)
    winner = first.rounds[0].winner
    p_value = float(first.rounds[0].p_value[first.rounds[0].names.index(winner.name)])
    sentence = f"Found on measured drives, not in the library: at the {place}, {form}."
    return Discovery(
        place, terms, form, share, held_out, p_value, effect_source(name, place, terms, sentence), by_place, selection
    )


def _name(place: str, term: str) -> str:
    """Name of the effect that stands for one term of an unknown force."""
    return f"unknown_{place}_{term}"


def _key(place: str, term: str, axle: str) -> str:
    return f"{_name(place, term)}.{term}_{axle}"


def _scale(place: str, term: str) -> float:
    """Size of a term at typical motion."""
    known = {**PLACES[place].typical, "wheel": 0, "tanh": np.tanh, "abs": abs, "max": max, "min": min, "cos": np.cos}
    known["sin"] = np.cos
    expression = PLACES[place].terms[term][0]
    larger = {key: 2 * value for key, value in PLACES[place].typical.items()} if "20_mm" in term or "rest" in expression else {}
    if larger and "rest" in larger:
        larger["rest"] = PLACES[place].typical["rest"]
    sign = -1 if "rebound" in term else 1
    values = {**known, **{key: sign * value for key, value in larger.items()}}
    return abs(float(eval(expression, {"__builtins__": {}}, values)))  # an expression of this file, not of a user


def _terms(place: str) -> tuple[Candidate, ...]:
    """Every term of a place as a candidate: a factor for each axle, of either sign."""
    candidates = []
    for term, (_, unit) in PLACES[place].terms.items():
        scale = _scale(place, term)
        sizes = tuple(
            Size(_key(place, term, axle), unit, 0.0, -STRONGEST / scale, STRONGEST / scale, FORCE / scale)
            for axle in ("front", "rear")
        )
        candidates.append(Candidate(f"{place}:{term}", sizes))
    return tuple(candidates)


def _form(place: str, terms: Mapping[str, Mapping[str, float]]) -> str:
    parts = []
    for term, factors in terms.items():
        expression, unit = PLACES[place].terms[term]
        size = " and ".join(f"{value:.4g} {unit} {axle}" for axle, value in factors.items())
        parts.append(f"({size}) {expression}")
    return "force = " + " + ".join(parts)


def effect_source(name: str, place: str, terms: Mapping[str, Mapping[str, float]], sentence: str) -> str:
    """Text of an effect file (``effects.contract``) with these terms and their factors by axle as typical values."""
    where = PLACES[place]
    parameters, lines, arguments = [], [], []
    for term, factors in terms.items():
        expression, unit = where.terms[term]
        reach = STRONGEST / _scale(place, term)
        for axle in ("front", "rear"):
            typical = float(factors.get(axle, FORCE / _scale(place, term)))
            limit = float(f"{max(reach, 2 * abs(typical)):.3g}")
            parameters.append(
                f'        Parameter("{term}_{axle}", "{unit}", 0.0, {typical:.6g}, ({-limit:g}, {limit:g}), '
                f'"factor of {expression}, {axle}"),'
            )
            arguments.append(f"{term}_{axle}")
        lines.append(f"    force += ({term}_front if wheel < 2 else {term}_rear) * ({expression})")
    body = "\n".join(lines)
    used = sorted({function for function in ("tanh", "cos", "sin") if re.search(rf"\b{function}\(", body)})
    imports = f"from math import {', '.join(used)}\n\n" if used else ""
    listed = "\n".join(parameters)
    return (
        f'"""{sentence}"""\n\n{imports}from ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="{sentence}",\n'
        f'    source="estimated from measured drives by ridecomfort.discrepancy.discover",\n    port="{where.port}",\n'
        f"    parameters=(\n{listed}\n    ),\n)\n\n\n"
        f"def act({', '.join([*where.arguments, *arguments])}):\n    force = 0.0\n{body}\n    return force\n"
    )
