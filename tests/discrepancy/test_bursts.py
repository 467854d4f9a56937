"""What repeats differ by within moments is told from noise, which is there all the time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import bursts, judge
from ridecomfort.discrepancy.verdict import Verdict

from .linear import Linear, judged

RATE = 100.0


def test_shifts_of_gear_hold_half_of_their_power_in_a_hundredth_of_the_time_and_noise_in_much_more():
    """100 s: noise that is twice as large in half of the time; eight bursts of half a second, of ten times the noise; nothing at all."""
    noise = np.random.default_rng(1).standard_normal((3, 10000))
    noise[0] *= np.where(np.arange(10000) % 2000 < 1000, 1.0, 2.0)
    for start in range(600, 9000, 1100):
        noise[1, start : start + 50] *= 10.0
    noise[2] = 0.0
    share = bursts.time_share(np.split(noise, 2, axis=1), RATE)
    assert 0.25 < share[0] < 0.5
    assert 0.01 < share[1] < bursts.FEW
    assert np.isnan(share[2])


def test_moments_are_told_with_their_signals_and_all_else_is_not():
    (said,) = bursts.words({"a_x": 0.012, "a_y": 0.3, "pitch_rate": 0.02, "roll_rate": float("nan")})
    assert said.startswith("half of what repeats differ by in a_x, pitch_rate lies within 2.0 % of the time")
    assert bursts.words({"a_y": 0.3, "roll_rate": float("nan")}) == [] and bursts.words({}) == []


@pytest.fixture(scope="module")
def noisy():
    """A search that finds one effect beside noise that is there all the time."""
    model = Linear(1, {"effect_2.size": 1.0})
    return model, *judged(model)


def test_what_repeats_differ_by_is_that_of_the_model_in_the_end(noisy):
    _, selection, found = noisy
    assert set(selection.floor_time_share) == set(selection.frame.experiment.channels)
    assert min(selection.floor_time_share.values()) > bursts.FEW and not any("what repeats differ by" in reason for reason in found.reasons)


@pytest.mark.parametrize(("part", "is_named"), [(0.5, False), (2.0, True)])
def test_what_removes_less_than_moments_hold_is_not_named(noisy, part, is_named):
    """``part`` of the floor: what the effect removes where half of what repeats differ by lies within a hundredth of the time."""
    model, selection, _ = noisy
    (turn, *others), winner = selection.rounds, selection.rounds[0].winner
    squares = selection.floor_squares + part * selection.floor_squares
    trial = replace(winner, before=replace(winner.before, squares=squares), after=replace(winner.after, squares=selection.floor_squares))
    within = dict.fromkeys(selection.frame.experiment.channels, 0.01)
    of_moments = replace(selection, rounds=(replace(turn, winner=trial), *others), floor_time_share=within)
    found = judge.judge(of_moments, model.candidates)
    assert [effect.name for effect in found.effects] == ["effect_2"] * is_named
    assert any(reason.startswith("effect_2 helps in ") and "what a driver did" in reason for reason in found.reasons) is not is_named
    assert any("lies within 1.0 % of the time" in reason for reason in found.reasons)
    assert found.json()["of_moments"] == ["a", "b", "c", "d"]


def test_nothing_is_said_beside_the_moments_that_are_not_told_from_noise():
    verdict = Verdict("nothing", (), (), 0.0, 0.0, of_moments=("a_x", "pitch_rate"))
    assert verdict.words().startswith("Nothing is missing that would be worth a name, beside what drives differ by within moments in a_x, pitch_rate")
    assert replace(verdict, of_moments=()).words().startswith("Nothing is missing beyond the noise")


def test_without_repeats_nothing_is_known(noisy):
    _, selection, _ = noisy
    assert bursts.of_repeats(replace(selection.frame, indices=selection.frame.indices[:1]), selection.states[-1].fit.residuals) == {}
