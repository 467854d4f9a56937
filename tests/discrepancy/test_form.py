"""What is said of the formula of a force."""

from __future__ import annotations

import re

import pytest

from ridecomfort.discrepancy.form import NAMES, in_words, names_in
from ridecomfort.discrepancy.places import PLACES, settings


def test_what_stands_in_a_form_is_told_and_nothing_else_of_its_port():
    terms = {"velocity_saturating": {"front": 12.3, "rear": -3511.0}}
    form = in_words("strut", terms, {"velocity_saturating": {"knee": 0.08, "linear": 0.02}})
    assert names_in("strut", f"{form} Hz", terms) == (
        "force in N between body and wheel, positive pushing apart; velocity in m/s, positive in compression; "
        "knee: velocity at which it is half of what it would be without"
    )
    whirl = names_in("body", in_words("body", {"whirling": {part: 1.0 for part in PLACES["body"].terms["whirling"].parts}}), ["whirling"])
    assert whirl.startswith("force_y in N on the sprung mass; force_z in N on the sprung mass; way s in m; period: way after which")
    bend = in_words("structure", {"bending": {"": 1.0}})
    assert " Hz" in bend and "frequency at which" in names_in("structure", bend, ["bending"])
    assert "y of the sensor" not in names_in("structure", "a_z = 0.1 motion.speed, frequency = 18 Hz", [])


@pytest.mark.parametrize("place", PLACES)
def test_every_name_that_a_form_of_a_place_may_hold_is_told(place):
    known = PLACES[place]
    for name, term in known.terms.items():
        form = in_words(place, {name: {part: 1.0 for part in term.parts}}, {name: {one.name: 0.1 for one in settings(place, name)}})
        form = form.replace("(wheel % 2)", "")  # a side, which is told beside the formula
        seen = {other for other in known.arguments if other != "motion" and re.search(rf"\b{other}\b", form)} | set(re.findall(r"motion\.\w+", form))
        made = set(term.by_result())
        assert seen | made <= set(NAMES[place]) | {one.name for one in settings(place, name)}, name
        assert names_in(place, form, [name])
    assert set(known.results) <= set(NAMES[place])
