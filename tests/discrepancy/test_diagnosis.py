"""What a force of any form and parameters of the vehicle decide beside what the library has."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy import diagnosis
from ridecomfort.discrepancy.beyond import BeyondBounds
from ridecomfort.discrepancy.diagnosis import _beside_the_file, _outcome
from ridecomfort.discrepancy.explain import REPEATS
from ridecomfort.discrepancy.righted import Outcome, Ranked
from tests.discrepancy.verdicts import FOUND, HELD, NOTHING, OUTSIDE, SURE


def test_a_form_that_explains_as_much_as_a_name_is_proposed_beside_it_and_decides_nothing_else(monkeypatch):
    named = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.6, held_out_share=0.5)
    table = SimpleNamespace(attrs={"turns": "", "suspected": "", "floor": REPEATS, "road": ""})
    search = Ranked(table, named, SimpleNamespace(probed={}), None)
    monkeypatch.setattr(diagnosis, "with_forms", lambda table, evidence: table)
    monkeypatch.setattr(diagnosis, "surely_fits_better", lambda proposal, selection: False)
    monkeypatch.setattr(diagnosis, "total_shares", lambda selection: (0.6, 0.5))
    for share, is_proposed in ((0.62, True), (0.58, False)):
        form = replace(SURE, share=share, held_out_share=share - 0.1)
        monkeypatch.setattr(diagnosis, "discovered", lambda rung, form=form, **settings: form)
        found = _outcome(search, SimpleNamespace(candidates=()), "discovered", {})
        assert found.verdict.is_like_force is is_proposed and found.proposed is (form if is_proposed else None) and found.sure is None


@pytest.mark.parametrize(("share", "held_out_share", "is_told"), [(0.84, 0.91, True), (0.7, 0.75, False), (0.9, float("nan"), True)])
def test_parameters_beside_the_file_are_told_with_a_form_that_explains_nearly_all(share, held_out_share, is_told):
    """What a form leaves may drive parameters of the vehicle elsewhere."""
    proposed = replace(SURE, share=share, held_out_share=held_out_share, off_file=HELD)
    found = _beside_the_file(OUTSIDE, Outcome(None, OUTSIDE, proposed, None, None), None)
    assert found is (HELD if is_told else None)
    assert _beside_the_file(OUTSIDE, Outcome(None, OUTSIDE, None, None, None), None) is None
    beyond = BeyondBounds((), 0.3, 0.3, is_first=True)
    assert _beside_the_file(OUTSIDE, Outcome(None, OUTSIDE, proposed, None, None), beyond) is None, "others may lie beyond beside a form, too"


@pytest.mark.parametrize(("kind", "share", "is_told"), [("named", 0.84, True), ("named", 0.64, False), ("nothing", 0.0, True)])
def test_beside_effects_of_the_library_too_parameters_are_told_only_where_these_explain_most(monkeypatch, kind, share, is_told):
    """In a car of another program, where 69 % were explained, a roll inertia came out at 416 kg m2 (413 to 418) for 470."""
    monkeypatch.setitem(_beside_the_file.__globals__, "off_file", lambda selection, told, is_named: HELD)
    verdict = replace(NOTHING, verdict=kind, share=share, held_out_share=share)
    assert _beside_the_file(verdict, Outcome(None, verdict, None, None, None), None) is (HELD if is_told else None)


@pytest.mark.parametrize(("remainder", "is_told"), [({"a_z": 0.0002, "a_y": 0.0006}, True), ({"a_z": 0.0002, "a_y": 0.004}, False), ({}, False)])
def test_where_next_to_nothing_is_left_they_are_told_however_little_there_was_to_explain(monkeypatch, remainder, is_told):
    """A tyre that progresses took 63 and 84 % of an error of 0.1 %. The centre of gravity lay 0.04 m above that of the file, of which nothing was
    said: on the ladder, where it is held, the right effect took nothing."""
    monkeypatch.setitem(_beside_the_file.__globals__, "off_file", lambda selection, told, is_named: HELD)
    verdict = replace(NOTHING, verdict="named", share=0.63, held_out_share=0.84, remainder=remainder)
    assert _beside_the_file(verdict, Outcome(None, verdict, None, None, None), None) is (HELD if is_told else None)


@pytest.mark.parametrize(("suspected", "is_tried"), [("", True), ("fit", True), ("data", False), ("road", False)])
def test_a_gain_or_clock_that_only_the_fit_tells_may_be_a_vehicle_beyond_its_bounds(monkeypatch, suspected, is_tried):
    monkeypatch.setattr(diagnosis, "ends_at_bounds", lambda selection: True)
    search = Ranked(SimpleNamespace(attrs={"suspected": suspected}), replace(NOTHING, verdict="suspect" if suspected else "outside"), None, None)
    assert diagnosis._may_lie_beyond(search) is is_tried
