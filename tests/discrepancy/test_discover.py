"""What a discovery writes is an effect like any other."""

from __future__ import annotations

from math import cos, sin, tanh
from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy.places import AXLES, PLACES, WHEELS, WHOLE, effect_source, in_words, scale
from ridecomfort.effects import library

KNOWN = {"tanh": tanh, "cos": cos, "sin": sin, "abs": abs, "max": max, "min": min}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("wheel", range(4))
def test_every_term_of_every_place_can_be_written_as_an_effect(place, wheel, tmp_path):
    where = PLACES[place]
    factors = {name: {part: 2.0 + k for k, part in enumerate(term.parts)} for name, term in where.terms.items()}
    for name, own in factors.items():
        (tmp_path / f"found_{name}.py").write_text(effect_source(f"found_{name}", place, {name: own}, "Found."))
    found = library.find(tmp_path)
    seen = {name: 0.7 for name in where.arguments} | {"wheel": wheel}
    if "motion" in seen:
        seen = {"motion": SimpleNamespace(**{key: 0.1 + 0.2 * k for k, key in enumerate(vars(where.typical["motion"]))})}
    for name, term in where.terms.items():
        entry = found[f"found_{name}"]
        own = {WHOLE: "", AXLES: AXLES[wheel // 2], WHEELS: WHEELS[wheel]}[term.parts]
        value = factors[name][own] * eval(term.expression, KNOWN, dict(seen))
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
