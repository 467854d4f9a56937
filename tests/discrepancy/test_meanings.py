"""What usually makes a force of some form, in words."""

from __future__ import annotations

from ridecomfort.discrepancy.meanings import MEANINGS, such_as
from ridecomfort.discrepancy.places import PLACES


def test_every_form_of_every_place_has_a_meaning_and_none_is_of_a_form_that_is_not_looked_for():
    assert {place: set(terms) for place, terms in MEANINGS.items()} == {place: set(one.terms) for place, one in PLACES.items()}
    assert all(meaning for terms in MEANINGS.values() for meaning in terms.values())


def test_a_force_of_several_terms_is_told_by_all_of_them_and_by_none_twice():
    assert such_as("strut", ["bump_beyond", "rebound_beyond"]) == "a bump stop, a helper or tender spring; a rebound stop"
    tail = such_as("body", ["pitch_of_bounce", "lift_of_pitching"])
    assert tail == such_as("body", ["pitch_of_bounce"])
    assert such_as("", []) == ""
