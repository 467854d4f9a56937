"""A search with the vehicle's parameters put right beside one that keeps to their bounds."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import beyond, righted
from ridecomfort.discrepancy.refit import Fit
from ridecomfort.discrepancy.verdict import Verdict

NAN = float("nan")
BAR = beyond.Beyond("anti_roll_stiffness_rear", "N m/rad", 10000.0, (8500.0, 11500.0), (2833.0, 34500.0), 19900.0, (19000.0, 20800.0))
DAMPER = beyond.Beyond("damping_front", "N s/m", 2100.0, (1785.0, 2415.0), (595.0, 7245.0), 2560.0, (2500.0, 2620.0))
ALONE = beyond.BeyondBounds((BAR, DAMPER), 0.4, 0.3, is_first=True)


def ends(*removed):
    """A selection whose last model removes these shares of what was explainable at first."""
    return SimpleNamespace(states=(None, removed))


def search(*removed, kind="outside", suspected="", parameters=None):
    return righted.Ranked(SimpleNamespace(attrs={"suspected": suspected}), Verdict(kind, (), (), 0.0, 0.0), ends(*removed), None, parameters)


def outcome(kind="outside", form=None, is_sure=True):
    proposed = None if form is None else SimpleNamespace(selection=ends(*form), is_sure=is_sure)
    return righted.Outcome(None, Verdict(kind, (), (), 0.0, 0.0), proposed, ends(0.0, 0.0), None)


@pytest.fixture(autouse=True)
def made_up(monkeypatch):
    """Shares that are what selections say, forms that are as sure, and taken into the verdict, as they say."""
    monkeypatch.setattr(righted, "shares", lambda selection, before, after, *others: after)
    monkeypatch.setattr(righted, "is_sure", lambda proposal: proposal.is_sure)
    monkeypatch.setattr(righted, "beside_a_force", lambda verdict, proposal: Verdict(verdict.verdict, (), ("a form",), 0.0, 0.0))
    monkeypatch.setattr(righted, "still_beyond", lambda before, after: beyond.BeyondBounds((BAR,), NAN, NAN, is_first=True))


def chosen(first, its, second, other, found=None):
    """The outcome and the parameters that are told, and whether the second search was asked for its outcome."""
    asked = []
    told = righted.beside_the_vehicle(first, its, found, second, lambda search: asked.append(search) or other)
    return *told, bool(asked)


@pytest.mark.parametrize(
    ("kind", "suspected", "whole"),
    [("named", "", True), ("cluster", "", True), ("nothing", "", True), ("outside", "", False), ("suspect", "", False), ("suspect", "data", True),
     ("suspect", "fit", True), ("suspect", "road", False)],
)  # fmt: skip
def test_a_search_leaves_nothing_out_that_explains_the_drives_or_sees_that_they_are_wrong(kind, suspected, whole):
    assert search(0.5, 0.5, kind=kind, suspected=suspected).leaves_nothing_out is whole


def test_a_vehicle_put_right_that_leaves_less_is_the_better_explanation():
    other = outcome()
    best, told, _ = chosen(search(0.2, 0.3), outcome(), search(0.5, 0.6, parameters=ALONE), other)
    assert best is other and told is ALONE


def test_and_so_it_is_where_it_needs_no_form_for_as_much():
    other = outcome()
    best, told, _ = chosen(search(0.1, 0.1), outcome(form=(0.5, 0.5)), search(0.5, 0.49, parameters=ALONE), other)
    assert best is other and told is ALONE


def test_a_form_that_explains_more_keeps_the_vehicle_as_it_is_and_parameters_are_told_last():
    its = outcome(form=(0.7, 0.6))
    best, told, _ = chosen(search(0.1, 0.1), its, search(0.4, 0.3, parameters=ALONE), outcome())
    assert best is its and told.is_instead and not told.is_first
    assert told.words(is_more=True).startswith("another explanation, which is no better, 40 % of the explainable error, 30 % on drives held out: ")


def test_a_form_that_may_be_chance_speaks_for_neither():
    other = outcome()
    assert chosen(search(0.2, 0.3), outcome(form=(0.9, 0.9), is_sure=False), search(0.5, 0.6, parameters=ALONE), other)[0] is other
    its = outcome()
    assert chosen(search(0.4, 0.4), its, search(0.3, 0.3, parameters=ALONE), outcome(form=(0.9, 0.9), is_sure=False))[0].proposed is its.proposed


def test_a_verdict_stands_on_the_model_with_a_form_where_that_is_sure():
    with_form = outcome(form=(0.9, 0.9))
    assert with_form.stands_on is with_form.proposed.selection
    for one in (outcome(), outcome(form=(0.9, 0.9), is_sure=False)):
        assert one.stands_on is one.selection


def test_parameters_that_do_little_are_not_told_but_that_they_were_tried_is():
    best, told, _ = chosen(search(0.1, 0.1), outcome(form=(0.9, 0.9)), search(0.4, 0.3, parameters=ALONE), outcome())
    assert told is None and righted.TRIED in best.verdict.reasons


def test_parameters_found_beside_the_first_count_for_it():
    beside = beyond.BeyondBounds((BAR,), 0.3, 0.3)
    its = outcome()
    assert chosen(search(0.5, 0.5), its, search(0.7, 0.7, parameters=ALONE), outcome(), found=beside)[:2] == (its, beside)


def test_data_that_are_suspect_beside_a_vehicle_put_right_do_not_take_the_place_of_a_verdict():
    best, _, _ = chosen(search(0.2, 0.3), outcome(), search(0.9, 0.9, parameters=ALONE), outcome("suspect"))
    assert best.verdict.verdict == "outside"


def test_but_a_road_that_is_suspect_beside_it_is_a_reason():
    """Tyres that damp a hundredth of what the file says; beside them the drives fit a smoother road."""
    road = Verdict("suspect", (), ("a smoother road",), 0.0, 0.0)
    other = righted.Outcome(None, road, None, ends(0.0, 0.0), None)
    best, told, _ = chosen(search(0.2, 0.3), outcome(), search(0.9, 0.9, suspected="road", parameters=ALONE), other)
    assert told is ALONE and (best.verdict.verdict, best.verdict.reasons) == ("outside", ("a smoother road",))


@pytest.mark.parametrize("kind", ["named", "outside"])
def test_fewer_effects_with_parameters_that_do_as_well_are_told_last_and_take_no_place(kind):
    as_good = beyond.BeyondBounds((BAR,), 0.5, 0.6, is_instead=True, effects=("damper_knee",))
    second = search(0.5, 0.6, kind="named", parameters=as_good)
    assert not second.leaves_nothing_out
    its = outcome(kind)
    best, told, is_asked = chosen(search(0.5, 0.6), its, second, outcome())
    assert (best, told, is_asked) == (its, as_good, False)
    beside = beyond.BeyondBounds((DAMPER,), 0.1, 0.1)
    assert chosen(search(0.5, 0.6), its, second, outcome(), found=beside)[1] is beside


def test_a_second_search_is_not_asked_where_the_first_leaves_nothing_open():
    best, told, is_asked = chosen(search(0.9, 0.9), outcome("named"), search(0.95, 0.95, parameters=ALONE), outcome())
    assert not is_asked and told is None and best.verdict.verdict == "named" and righted.TRIED in best.verdict.reasons


def test_beside_a_sure_form_only_what_is_beyond_its_bounds_still_is_told(monkeypatch):
    """A damper that stood in for friction is within its bounds when that has a form."""
    first, second, other = search(0.2, 0.3), search(0.5, 0.6, parameters=ALONE), outcome(form=(0.9, 0.9))
    _, told, _ = chosen(first, outcome(), second, other)
    assert told.parameters == (BAR,) and told.words(is_more=False).startswith("beside what is missing, parameters of the vehicle lie beyond")
    monkeypatch.setattr(righted, "still_beyond", lambda before, after: None)
    best, told, _ = chosen(first, outcome(), second, other)
    assert told is None and righted.WITHIN in best.verdict.reasons


@pytest.mark.parametrize(
    ("form", "fits_better", "taken"),
    [((0.99, 0.98), True, True), ((0.99, 0.98), False, False), ((0.96, 0.98), True, False), ((0.99, 0.93), True, False), (None, True, False)],
)
def test_names_beside_a_vehicle_put_right_give_way_to_a_form_within_the_bounds_that_leaves_less(monkeypatch, form, fits_better, taken):
    """Dampers twice as firm with a knee did 97 and 92 % of what dry friction does whose name was taken out."""
    monkeypatch.setattr(righted, "surely_fits_better", lambda proposal, selection: fits_better)
    first, second = search(0.4, 0.5), search(0.97, 0.92, kind="named", parameters=ALONE)
    plain, other = outcome(form=form), outcome("named")
    best, told = righted.unless_a_form_alone(first, None, second, lambda search: plain if search is first else other)
    if taken:
        assert best.proposed is plain.proposed and told is None and righted.TRIED in best.verdict.reasons
    else:
        assert (best, told) == (other, ALONE)


def test_beside_such_a_form_parameters_are_told_as_wherever_a_vehicle_keeps_to_its_file(monkeypatch):
    monkeypatch.setattr(righted, "surely_fits_better", lambda proposal, selection: True)
    much, beside = replace(ALONE, share=0.8, held_out_share=0.7), beyond.BeyondBounds((BAR,), 0.1, 0.1)
    first, second = search(0.4, 0.5), search(0.97, 0.92, kind="named", parameters=much)
    plain = outcome(form=(0.99, 0.98))
    outcome_of = lambda search: plain if search is first else outcome("named")
    best, told = righted.unless_a_form_alone(first, None, second, outcome_of)
    assert best is plain and told.is_instead and told.share == 0.8
    assert righted.unless_a_form_alone(first, beside, second, outcome_of) == (plain, beside)


@pytest.mark.parametrize("kind", ["nothing", "outside", "suspect"])
def test_a_vehicle_put_right_that_needs_no_name_is_not_held_against_a_form(kind):
    first, second, asked = search(0.4, 0.5), search(0.97, 0.92, kind=kind, parameters=ALONE), []
    other = outcome(kind)
    assert righted.unless_a_form_alone(first, None, second, lambda search: asked.append(search) or other) == (other, ALONE)
    assert asked == [second]


@pytest.mark.parametrize(("ours", "theirs", "better"), [((NAN, NAN), (0.5, 0.5), False), ((0.7, NAN), (0.5, NAN), True), ((0.7, NAN), (0.5, 0.9), True)])
def test_shares_that_are_not_known_decide_nothing(ours, theirs, better):
    assert righted.is_better(ours, (NAN, NAN), theirs) is better
    assert not righted.is_much((NAN, NAN), theirs)


def test_what_lies_beyond_its_bounds_still_is_that_of_the_last_fit():
    before, after = (SimpleNamespace(frame=SimpleNamespace(experiment=experiment)) for experiment in (free(8500.0, 11500.0), free(2833.0, 34500.0)))
    after.final = Fit({BAR.parameter: 19900.0}, {}, (BAR.parameter,), np.ones((1, 2)), 0.0)
    after.intervals = {BAR.parameter: (19000.0, 20800.0)}
    assert beyond.still_beyond(before, after).parameters == (BAR,)
    after.intervals = {BAR.parameter: (11000.0, 28000.0)}
    assert beyond.still_beyond(before, after) is None


def free(lower, upper):
    """An experiment whose rear bar is free within bounds."""
    size = SimpleNamespace(key=BAR.parameter, unit=BAR.unit, lower=lower, upper=upper, probe=300.0)
    return SimpleNamespace(free=(size,), vehicle={BAR.parameter: 10000.0})
