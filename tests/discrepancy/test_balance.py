"""What effects that stand explain of what repeats share, on a model in which everything is known."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import balance, judge, select
from ridecomfort.discrepancy.selection import shares_of
from ridecomfort.discrepancy.shared import shared_error

from .linear import Linear, judged


def perhaps_chance(selection, name):
    """The selection where no drive held out meets an effect, of which the fitted ones are not sure."""
    rounds = []
    for turn in selection.rounds:
        if turn.winner is not None and turn.winner.name == name:
            p_value = turn.p_value.copy()
            p_value[turn.names.index(name)] = 0.02
            turn = replace(turn, winner=replace(turn.winner, met=False), p_value=p_value)
        rounds.append(turn)
    return replace(selection, rounds=tuple(rounds))


@pytest.fixture(scope="module")
def beside_what_is_not_in_the_library():
    """A model that lacks three effects of which the library has two, its selection and verdict: more than half goes with both."""
    model = Linear(2, {"effect_1.size": 1.0, "effect_4.size": 0.8, "effect_5.size": 0.9})
    model.candidates = model.candidates[:5]
    selection, _ = judged(model)
    found = judge.judge(selection, model.candidates, is_material=False)
    assert found.verdict == "named" and {effect.name for effect in found.effects} == {"effect_1", "effect_4"} and found.share > 0.5
    return model, selection


@pytest.mark.parametrize(("name", "other"), [("effect_1", "effect_4"), ("effect_4", "effect_1")])
def test_what_went_with_an_effect_that_has_no_name_does_not_count_as_explained(beside_what_is_not_in_the_library, name, other):
    model, selection = beside_what_is_not_in_the_library
    found = judge.judge(perhaps_chance(selection, name), model.candidates, is_material=False)
    assert found.verdict == "outside" and [effect.name for effect in found.effects] == [other]
    assert (found.share, found.held_out_share) == pytest.approx(shares_of(selection, other))
    whole = found.whole()
    assert (whole.share, whole.held_out_share) == pytest.approx(balance.total_shares(selection)) and whole.share > found.share + 0.1
    assert f"{name} may be chance: no drive held out meets it" in found.reasons
    assert f"{100 * found.share:.0f} % of the explainable error is removed on the fitted drives, by {other}" in found.reasons
    assert any(reason.endswith(f" with {name} as well") for reason in found.reasons) and "that is less than half of what repeats share" in found.reasons
    model = Linear(2, model.truth)
    model.candidates = tuple(one for one in model.candidates[:5] if one.name != name)
    alone = judge.judge(select.select(model, {"stiffness": 0.0}, most=3), model.candidates, is_material=False)
    assert alone.verdict == found.verdict, "as if it had not been found"


def test_what_the_last_effect_did_of_what_repeats_share_is_left_without_it(beside_what_is_not_in_the_library):
    _, selection = beside_what_is_not_in_the_library
    first, before, _ = (shared_error(selection.frame, state.fit.residuals) for state in selection.states)
    found = balance.balanced(selection, (), False, 0.5, [selection.accepted[-1]])
    gone = 1.0 - before.power / first.power
    assert found.explained == pytest.approx(max(gone, found.share)) and found.faster_gone == pytest.approx(1.0 - before.faster / first.faster)
    assert found.worth_gone == pytest.approx(0.5 * gone / selection.shared_gone)
    assert found.is_little and before.left_z(first, 0.5) > balance.LEFT_Z
    whole = balance.balanced(selection, (), False, 0.5)
    assert whole.explained >= selection.shared_gone and whole.faster_gone == selection.faster_gone and whole.worth_gone == 0.5


@pytest.mark.parametrize("is_unmet", [True, False])
def test_an_error_that_repeats_share_for_certain_and_of_which_all_went_with_what_has_no_name_is_not_nothing(is_unmet):
    """Be it perhaps chance, or of a size that may as well be none."""
    model = Linear(1, {"effect_2.size": 1.0})
    selection, found = judged(model)
    assert found.verdict == "named" and selection.shared_z > balance.SHARED_Z
    unsure = perhaps_chance(selection, "effect_2") if is_unmet else replace(selection, sure=frozenset())
    found = judge.judge(unsure, model.candidates, is_material=False, was_material=True, material_left=0.02)
    assert found.verdict == "outside" and not found.effects and found.share == 0.0
    assert "but that has no name, and nothing else explains what repeats share" in found.reasons
    assert judge.judge(unsure, model.candidates, is_material=False, was_material=False).verdict == "nothing"
    by_chance = replace(unsure, shared_z=1.0)
    assert judge.judge(by_chance, model.candidates, is_material=False).verdict == "nothing"


@pytest.fixture(scope="module")
def with_much_left():
    """A selection whose effect removes half, and leaves an error that repeats share for certain."""
    model = Linear(1, {"effect_2.size": 1.0, "effect_4.size": 0.9})
    model.candidates = model.candidates[:4]
    selection, _ = judged(model)
    assert selection.accepted == ("effect_2",) and balance.something_left(selection)
    return selection


@pytest.mark.parametrize(("upper", "is_little"), [(balance.IN_WAVES, True), (balance.IN_WAVES + 10.0, False)])
def test_an_error_that_no_other_road_makes_asks_as_much_of_what_is_named_as_on_any_road(with_much_left, monkeypatch, upper, is_little):
    """A road that may be another makes fast errors; a slow one that repeats share for certain is not its."""
    monkeypatch.setattr(balance, "named_shares", lambda selection, unnamed: (0.6, 0.6))
    band = SimpleNamespace(upper=upper, z=9.5)
    selection = replace(with_much_left, remaining=replace(with_much_left.remaining, band=band))
    assert balance.balanced(selection, ["the drives fit another road"], True, 1.0).is_little is is_little
    assert balance.balanced(selection, [], True, 1.0).is_little


@pytest.mark.parametrize(("held_out", "is_all"), [(0.2, True), (-0.4, False), (float("nan"), True)])
def test_what_was_worth_explaining_is_not_explained_by_what_makes_drives_held_out_worse(with_much_left, monkeypatch, held_out, is_all):
    monkeypatch.setattr(balance, "named_shares", lambda selection, unnamed: (0.3, held_out))
    monkeypatch.setattr(balance, "_gone", lambda selection, unnamed: balance._Gone(0.3, 0.3, 9.0))
    found = balance.balanced(with_much_left, (), False, 0.1)
    assert found.is_all_that_matters is is_all and found.is_little is not is_all


def test_a_force_is_held_against_what_effects_without_a_name_removed_also_where_none_is_named_or_the_data_are_suspect():
    model = Linear(1, {"effect_2.size": 1.0})
    selection, _ = judged(model)
    unsure, whole = replace(selection, sure=frozenset()), pytest.approx(balance.total_shares(selection))
    found = judge.judge(unsure, model.candidates, material_left=0.02)
    assert (found.verdict, found.effects, found.of_all) == ("outside", (), whole)
    suspect = judge.judge(unsure, model.candidates, ["drive_1: the model fits a gain of 1.030"])
    assert (suspect.verdict, suspect.of_all) == ("suspect", whole)
    assert judge.judge(selection, model.candidates).of_all is None


@pytest.mark.parametrize(
    ("gone", "left_z", "is_material", "verdict"), [(0.1, 6.0, True, "outside"), (0.9, 0.0, False, "named"), (0.6, 0.0, True, "outside")]
)
def test_where_hardly_anything_lies_above_the_floor_half_is_asked_of_what_repeats_share(gone, left_z, is_material, verdict):
    """A hundredth of the power of one signal: what share of that goes nobody knows; repeats share an error for certain, at first and still."""
    model = Linear(1, {"effect_2.size": 1.0})
    selection, _ = judged(model)
    first, last = selection.states
    above = dict(floor_squares=0.9975 * first.squares, held_out_floor_squares=0.9975 * first.held_out_squares)
    last = replace(last, squares=0.999 * first.squares, held_out_squares=0.999 * first.held_out_squares)
    still = replace(selection.remaining, z=8.0, share=0.06)
    selection = replace(selection, states=(first, last), **above, shared_gone=gone, left_z=left_z, shared_z=12.0, remaining=still)
    found = balance.balanced(selection, (), is_material, 1.0)
    assert np.isnan(found.share) and found.explained == gone
    told = judge.judge(selection, model.candidates, is_material=is_material)
    assert told.verdict == verdict and "the error hardly rises above the floor, too little to tell shares of it" in told.reasons
