"""What a verdict gives as its reasons, on a model in which everything is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import balance, judge, reasoning, select
from ridecomfort.errors import InputError

from .linear import Linear, alone, judged


def test_a_size_that_ends_beyond_what_is_plausible_is_a_reason_more():
    """It was plausible when its effect was found; what is fitted beside it may have moved it since."""
    model = Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0})
    selection, found = judged(model)
    assert not any("beyond what is plausible" in reason for reason in found.reasons)
    narrow = lambda size: replace(size, upper=0.5) if size.key == "effect_2.size" else size
    candidates = [replace(one, sizes=tuple(map(narrow, one.sizes))) for one in model.candidates]
    (said,) = (reason for reason in judge.judge(selection, candidates).reasons if "beyond what is plausible" in reason)
    assert said.startswith("effect_2 ends at a size of ") and "to 0.5)" in said


def test_where_nothing_that_was_looked_among_has_a_size_no_candidate_was_tested():
    model = Linear(1, {})
    model.candidates = ()
    _, found = judged(model)
    assert found.verdict == "nothing" and "no candidate was tested: no effect that was looked among has a size to fit" in found.reasons


@pytest.mark.parametrize("size", [1.0, 0.15])
def test_what_the_drives_speak_for_and_no_drive_held_out_can_be_driven_with_is_told(size):
    model = Linear(1, {"effect_2.size": size})
    plain = model.residual

    def residual(values, index):
        if index == 3 and values.get("effect_2.size", 0.0) > 0.05:
            raise InputError("left the road")
        return plain(values, index)

    model.residual = residual
    selection, found = judged(model)
    assert not selection.accepted and selection.rounds[0].p_value.min() < 0.05 and not selection.rounds[0].trials
    assert "effect_2: could not be simulated" in found.reasons


@pytest.mark.parametrize(("part", "is_told"), [(0.95, True), (0.8, False)])
def test_what_would_have_done_nearly_as_much_is_told(part, is_told):
    model = Linear(1, {"effect_2.size": 1.5})
    selection, _ = judged(model)
    (turn, *others), winner = selection.rounds, selection.rounds[0].winner
    squares = winner.before.squares - part * (winner.before.squares - winner.after.squares)
    rival = replace(winner, name="effect_4", after=replace(winner.after, squares=squares), gain=winner.gain - 12.0)
    found = judge.judge(replace(selection, rounds=(replace(turn, trials=(winner, rival)), *others)), model.candidates)
    told = [reason for reason in found.reasons if reason.startswith("effect_4 in the place of effect_2 removes nearly as much (")]
    assert bool(told) is is_told and found.verdict == "named" and [effect.name for effect in found.effects] == ["effect_2"]
    assert not told or told[0].endswith("2 ln L is lower by 12")


def test_what_is_missing_too_does_not_stand_in_for_another():
    """Refitted in the first round, each of two takes as much; once the first is there, the second gains what it did before."""
    model = Linear(1, {"effect_2.size": 1.5, "effect_4.size": 1.5})
    selection, found = judged(model)
    turn, winner = selection.rounds[0], selection.rounds[0].winner
    other = {"effect_2": "effect_4", "effect_4": "effect_2"}[winner.name]
    alone = replace(selection, accepted=(winner.name,), rounds=(replace(turn, trials=(winner, replace(winner, name=other, gain=winner.gain - 12.0))), *selection.rounds[1:]))
    assert {effect.name for effect in found.effects} == {"effect_2", "effect_4"}
    (named,) = (effect for effect in found.effects if effect.name == winner.name)
    assert other in selection.rounds[1].names and reasoning.nearly_as_good(alone, named) == []
    without = replace(selection.rounds[1], gain=0.0 * selection.rounds[1].gain)
    (said,) = reasoning.nearly_as_good(replace(alone, rounds=(alone.rounds[0], without)), named)
    assert said.startswith(f"{other} in the place of {winner.name} removes as much (")


def test_drives_are_not_said_to_be_less_likely_with_what_gained_more_and_was_refused():
    selection, found = judged(Linear(1, {"effect_2.size": 1.5}))
    (turn, *others), winner = selection.rounds, selection.rounds[0].winner
    refused = replace(winner, name="effect_4", gain=winner.gain + 30.0, objection=select.VAIN)
    rounds = replace(turn, trials=(winner, refused)), *others
    assert reasoning.nearly_as_good(replace(selection, rounds=rounds), found.effects[0]) == []


@pytest.mark.parametrize("told", [3, 1])
@pytest.mark.parametrize(("times", "is_asked"), [(1.0, False), (10.0, True)])
def test_noise_that_is_told_far_larger_than_the_error_is_asked_about(times, is_asked, told):
    """Of all fitted drives, or of one of them."""
    model = alone(Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0}))
    low, high = model.records[0].band
    left = judged(model)[0].states[-1].squares.mean()
    noise = (times * np.sqrt(left / (high - low)),) * 4
    model.records = [replace(record, noise=noise if number < told else ()) for number, record in enumerate(model.records)]
    reasons = judged(model)[1].reasons
    assert any("is its unit right?" in reason for reason in reasons) is is_asked


@pytest.mark.parametrize("is_held_out", [True, False])
def test_it_is_said_where_no_drive_is_held_out(is_held_out):
    model = Linear(1, {"effect_2.size": 1.0})
    model.records = model.records if is_held_out else [replace(record, role="fit") for record in model.records]
    found = judged(model)[1]
    assert found.verdict == "named" and ("no drive is held out: this rests on the fitted drives alone" in found.reasons) is not is_held_out


@pytest.mark.parametrize(("is_repeated", "said"), [(False, "too little on drives held out"), (True, "repeats share an error that it leaves")])
def test_without_repeats_an_error_that_repeats_share_is_not_the_reason_why_too_little_was_found(is_repeated, said):
    """An error of the measurement that the drives held out have not, though they do not refute it: they do not meet it."""
    model = Linear(1, {"effect_2.size": 2.0})
    selection, _ = judged(model if is_repeated else alone(model))
    half = balance.Balance(0.8, 0.0, 0.8, is_refuted=False, is_shared=False, is_left=False, is_little=True)
    assert said in reasoning.unexplained(selection, half, is_little=True)
