"""What a discovery writes is an effect like any other."""

from __future__ import annotations

import pytest

from ridecomfort.discrepancy import discover as _  # noqa: F401
from ridecomfort.discrepancy.discover import PLACES, effect_source
from ridecomfort.effects import library


@pytest.mark.parametrize("place", PLACES)
def test_every_term_of_every_place_can_be_written_as_an_effect(place, tmp_path):
    terms = {term: {"front": 2.0, "rear": 3.0} for term in PLACES[place].terms}
    for term, factors in terms.items():
        (tmp_path / f"found_{term}.py").write_text(effect_source(f"found_{term}", place, {term: factors}, "Found."))
    found = library.find(tmp_path)
    for term, (expression, _unit) in PLACES[place].terms.items():
        entry = found[f"found_{term}"]
        seen = {name: 0.7 for name in PLACES[place].arguments} | {"wheel": 2}
        from math import cos, sin, tanh

        value = eval(expression, {"tanh": tanh, "cos": cos, "sin": sin, "abs": abs, "max": max, "min": min}, seen)
        assert entry.act(**seen, **entry.effect.values()) == pytest.approx(3.0 * value)
        assert entry.act(**seen, **entry.effect.neutral) == 0.0
