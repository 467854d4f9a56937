"""What a discovery writes is an effect like any other."""

from __future__ import annotations

from math import cos, sin, tanh
from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy.places import PLACES, effect_source, in_words, scale
from ridecomfort.effects import library

KNOWN = {"tanh": tanh, "cos": cos, "sin": sin, "abs": abs, "max": max, "min": min}


@pytest.mark.parametrize("place", PLACES)
def test_every_term_of_every_place_can_be_written_as_an_effect(place, tmp_path):
    where = PLACES[place]
    factors = dict(zip(where.parts, (2.0, 3.0)))
    for term in where.terms:
        (tmp_path / f"found_{term}.py").write_text(effect_source(f"found_{term}", place, {term: factors}, "Found."))
    found = library.find(tmp_path)
    seen = {name: 0.7 for name in where.arguments} | {"wheel": 2}
    if "motion" in seen:
        seen = {"motion": SimpleNamespace(**{key: 0.1 + 0.2 * k for k, key in enumerate(vars(where.typical["motion"]))})}
    for name, term in where.terms.items():
        entry = found[f"found_{name}"]
        value = list(factors.values())[-1] * eval(term.expression, KNOWN, dict(seen))
        expected = [value if result == term.result else 0.0 for result in where.results]
        arguments = {key: seen[key] for key in where.arguments}
        assert entry.act(**arguments, **entry.effect.values()) == pytest.approx(expected if len(expected) > 1 else value)
        assert not any(map(float, _tuple(entry.act(**arguments, **entry.effect.neutral))))


def _tuple(found):
    return found if isinstance(found, tuple) else (found,)


@pytest.mark.parametrize("place", PLACES)
def test_every_term_has_a_size_at_typical_motion(place):
    assert all(scale(place, term) > 0 for term in PLACES[place].terms)


def test_a_form_is_said_with_its_sizes():
    assert in_words("strut", {"velocity_direction": {"front": 57.3, "rear": 48.0}}) == (
        "force = (57.3 N front and 48 N rear) tanh(velocity / 0.005)"
    )
    assert in_words("body", {"lift": {"": -0.5}}) == "force_z = (-0.5 N s2/m2) motion.speed**2"
