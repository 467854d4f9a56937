"""A second search, with the vehicle's parameters put right, beside the first."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy import beyond, righted

BAR = beyond.Beyond("anti_roll_stiffness_rear", "N m/rad", 10000.0, (8500.0, 11500.0), (2833.0, 34500.0), 19900.0, (19000.0, 20800.0))
DAMPER = beyond.Beyond("damping_front", "N s/m", 2100.0, (1785.0, 2415.0), (595.0, 7245.0), 2560.0, (2500.0, 2620.0))


NAN = float("nan")


def share(fitted, held_out=NAN):
    return SimpleNamespace(share=fitted, held_out_share=held_out)


def search(kind="outside", suspected="", parameters=None):
    return righted.Search(SimpleNamespace(attrs={"suspected": suspected}), SimpleNamespace(verdict=kind), None, None, parameters)


@pytest.mark.parametrize(
    ("kind", "suspected", "whole"),
    [("named", "", True), ("cluster", "", True), ("nothing", "", True), ("outside", "", False), ("suspect", "data", True), ("suspect", "road", False)],
)
def test_a_search_leaves_nothing_out_that_explains_the_drives_or_sees_that_they_are_wrong(kind, suspected, whole):
    assert search(kind, suspected).leaves_nothing_out is whole


def test_what_goes_in_all_is_that_of_the_better_of_a_verdict_and_a_form():
    assert search().removed(share(0.2, 0.3), share(0.9, 0.8)) == (0.9, 0.8)
    assert search().removed(share(0.2, 0.3), None) == (0.2, 0.3)
    assert search().removed(share(0.2, 0.3), share(NAN)) == (0.2, 0.3)


def test_beside_parameters_shares_are_of_what_these_leave():
    found = beyond.BeyondBounds((BAR,), 0.4, 0.5, is_first=True)
    assert search(parameters=found).removed(share(0.5, 0.2), None) == pytest.approx((0.7, 0.6))


@pytest.mark.parametrize(
    ("ours", "of_these", "theirs", "better"),
    [
        ((0.7, 0.7), (0.3, 0.3), (0.5, 0.5), True),
        ((0.6, 0.6), (0.3, 0.3), (0.5, 0.5), False),
        ((0.9, 0.5), (0.3, 0.3), (0.5, 0.5), False),
        ((0.6, 0.6), (0.52, 0.52), (0.5, 0.5), True),
        ((0.6, 0.6), (0.52, 0.3), (0.5, 0.5), False),
        ((0.7, NAN), (0.3, NAN), (0.5, NAN), True),
    ],
)
def test_an_explanation_is_better_that_leaves_less_or_needs_no_form_for_as_much(ours, of_these, theirs, better):
    assert righted.is_better(ours, of_these, theirs) is better


def test_parameters_that_remove_half_as_much_as_what_explains_more_are_told_in_its_place():
    found = beyond.BeyondBounds((BAR,), 0.4, 0.5, is_first=True, is_instead=True)
    assert found.is_much_of((0.7, 0.9)) and not found.is_much_of((0.9, 0.9)) and found.is_much_of((0.7, NAN))
    said = "would remove 40 % of the explainable error, 50 % on drives held out: anti_roll_stiffness_rear 19900 N m/rad for 10000"
    assert found.words(is_more=True).endswith(said)


def test_beside_a_form_only_what_is_beyond_its_bounds_yet_is_told(monkeypatch):
    """A damper that stood in for friction is within its bounds when that has a form."""
    found = beyond.BeyondBounds((BAR, DAMPER), 0.4, 0.5, is_first=True)
    after = SimpleNamespace(frame=SimpleNamespace(experiment=None), final=SimpleNamespace(values={}), intervals={})
    monkeypatch.setattr(beyond, "_beyond", lambda *known: (BAR,))
    assert [one.parameter for one in beyond.beside(found, after, after).parameters] == ["anti_roll_stiffness_rear"]
    monkeypatch.setattr(beyond, "_beyond", lambda *known: ())
    assert beyond.beside(found, after, after) is None


def test_parameters_are_told_with_what_they_were_given_as():
    assert beyond.BeyondBounds((BAR, DAMPER), 0.4, 0.5).told() == "anti_roll_stiffness_rear 19900 N m/rad for 10000, damping_front 2560 N s/m for 2100"
