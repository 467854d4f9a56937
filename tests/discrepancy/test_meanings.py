"""What usually makes a force of some form, in words."""

from __future__ import annotations

import numpy as np
import pytest
from ridecomfort.discrepancy.form import effect_source
from ridecomfort.discrepancy.meanings import MEANINGS, SENSES, senses, such_as, told
from ridecomfort.discrepancy.places import PLACES
from ridecomfort.effects import library


def test_every_form_of_every_place_has_a_meaning_and_none_is_of_a_form_that_is_not_looked_for():
    assert {place: set(terms) for place, terms in MEANINGS.items()} == {place: set(one.terms) for place, one in PLACES.items()}
    assert all(meaning for terms in MEANINGS.values() for meaning in terms.values())


def test_a_force_of_several_terms_is_told_by_all_of_them_and_by_none_twice():
    assert such_as("strut", ["bump_beyond", "rebound_beyond"]) == "a bump stop, a helper or tender spring; a rebound stop"
    tail = such_as("body", ["pitch_of_bounce", "lift_of_pitching"])
    assert tail == such_as("body", ["pitch_of_bounce"])
    assert such_as("", []) == ""


def test_what_a_force_does_here_is_told_by_the_signs_of_its_factors():
    assert senses("strut", {"rebound_at_first": {"front": -1090.0, "rear": -820.0}}) == "softer at the beginning of each rebound (front and rear)"
    unlike = {"velocity_size": {"front": 300.0, "rear": -20.0}}
    assert senses("strut", unlike) == "firmer in compression than in rebound (front), firmer in rebound than in compression (rear)"
    assert senses("body", {"roll_damping": {"": -50.0}, "lift_of_turning": {"": 3.0}}) == "more damping"
    assert told("body", {"lift_of_turning": {"": 3.0}}) == such_as("body", ["lift_of_turning"])
    assert told("body", {"drag": {"": -0.3}}) == "drag of the air, a head wind; here: more resistance"


def test_of_a_factor_that_may_be_of_either_sign_no_sense_is_told():
    sizes = [
        {"parameter": "velocity_saturating_front", "interval": [-143.0, 167.0]}, {"parameter": "velocity_saturating_rear", "interval": [-4232.0, -2790.0]},
        {"parameter": "velocity_saturating_knee", "interval": None},
    ]  # fmt: skip
    terms = {"velocity_saturating": {"front": 12.3, "rear": -3511.0}}
    assert senses("strut", terms, sizes) == "softer at low velocities (rear)"
    assert told("strut", terms, sizes).endswith("; here: softer at low velocities (rear)")
    assert senses("strut", terms, [size | {"interval": [-1.0, 1.0]} for size in sizes]) == ""


def test_senses_are_of_forms_that_are_looked_for():
    assert all(set(senses) <= set(PLACES[place].terms) for place, senses in SENSES.items())


DAMPING, STIFFNESS = ("firmer", "more friction"), ("stiffer",)

SYMMETRIC = [
    (place, term) for place in ("strut", "tyre") for term, (more, less) in SENSES[place].items()
    if " than " not in more and " on the " not in more and "in bends" not in more and "braked" not in more
]  # fmt: skip


@pytest.mark.parametrize("place, term", SYMMETRIC)
def test_what_is_called_firmer_or_more_friction_takes_energy_and_what_is_called_stiffer_pushes_back(place, term, tmp_path):
    """Work over a cycle of motion that is quick and goes far, and the force along the travel."""
    factors = {part: 1.0 for part in PLACES[place].terms[term].parts}
    (tmp_path / "found.py").write_text(effect_source("found", place, {term: factors}, "Found."))
    entry = library.find(tmp_path)["found"]
    step, turns = 1e-4, 2 * np.pi * 8.0
    time = np.arange(0.0, 3.0, step)
    travel, velocity = 0.03 * np.sin(turns * time), 0.03 * turns * np.cos(turns * time)
    seen = {**PLACES[place].typical, "wheel": 0}
    rest = seen.get("rest", 0.0)
    states, force = np.zeros(len(entry.effect.states)), []
    for at, rate in zip(travel, velocity):
        moves = {"deflection": rest + at + 0.02 * (place == "tyre"), "velocity": rate}
        found = entry.act(**{**seen, **moves}, **dict(zip(entry.effect.states, states)), **entry.effect.values())
        own, *slopes = found if isinstance(found, tuple) else (found,)
        states = states + step * np.array(slopes)
        force.append(own)
    settled = time > 1.0
    work, push = (np.mean(np.array(force)[settled] * of[settled]) for of in (velocity, travel))
    more, less = SENSES[place][term]
    is_damping = any(word.startswith(("firmer", "more friction")) for word in (more, less))
    does = more if (work if is_damping else push) > 0 else less
    assert does.startswith(DAMPING if is_damping else STIFFNESS)
