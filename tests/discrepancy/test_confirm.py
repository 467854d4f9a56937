"""What drives held out say of a refit, and which of several goes first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import confirm
from ridecomfort.discrepancy.experiment import simulate
from ridecomfort.discrepancy.propose import CERTAIN, HELD_OUT_Z
from ridecomfort.discrepancy.rung import begin
from ridecomfort.discrepancy.selection import State, Trial

from .linear import Linear, rounds


@pytest.mark.parametrize(("met", "share", "is_kept"), [(True, 0.03, True), (False, 0.03, False), (False, 0.3, True)])
def test_what_no_held_out_drive_meets_must_remove_more(met, share, is_kept):
    model = Linear(1, {"effect_2.size": 1.0})
    rung, nothing = begin(model, {"stiffness": 0.0}), float("nan")
    fit = replace(rung.fit, values={"stiffness": 0.0, "effect_2.size": 1.0})
    trial = Trial("effect_2", {}, fit, 100.0, 90.0, nothing, nothing, share, nothing, "", met=met)
    objection = confirm.objection(trial, model.candidates[2], False, 1.0)
    assert objection == ("" if is_kept else "removes 3.0 % of the explainable error, and no drive held out meets it")


@pytest.mark.parametrize(
    ("z", "share", "is_certain", "is_kept"),
    [(6.0, -0.01, True, True), (6.0, -0.01, False, True), (1.0, 0.01, True, True), (1.0, 0.01, False, False), (1.0, -0.01, True, False), (-1.0, 0.1, True, False)],
)  # fmt: skip
def test_drives_held_out_that_are_sure_confirm_whatever_fitted_ones_say_and_others_where_these_leave_no_doubt(z, share, is_certain, is_kept):
    """An effect of which the fitted drives left no doubt was refused at a z of 6 to 11, where one of which they did not was accepted."""
    model = Linear(1, {"effect_2.size": 1.0})
    rung = begin(model, {"stiffness": 0.0})
    fit = replace(rung.fit, values={"stiffness": 0.0, "effect_2.size": 1.0})
    trial = Trial("effect_2", {}, fit, 100.0, 90.0, float(np.sign(z)), z, 0.5, share, "", met=True)
    assert confirm.objection(trial, model.candidates[2], is_certain, 1.0) == ("" if is_kept else "not surely better on drives held out")


@pytest.mark.parametrize(("gone", "met", "is_kept"), [(0.4, True, True), (0.1, True, False), (float("nan"), True, False), (0.4, False, False)])
def test_what_is_small_beside_a_large_effect_counts_by_what_it_takes_of_all_that_repeats_share_yet(gone, met, is_kept):
    model = Linear(1, {"effect_2.size": 1.0})
    rung, nothing = begin(model, {"stiffness": 0.0}), float("nan")
    fit = replace(rung.fit, values={"stiffness": 0.0, "effect_2.size": 1.0})
    trial = Trial("effect_2", {}, fit, 100.0, 90.0, nothing, nothing, 0.002, nothing, "", met=met, rest_gone=gone)
    assert (confirm.objection(trial, model.candidates[2], False, 0.1) == "") is is_kept


@pytest.mark.parametrize(("gone", "objection"), [(0.4, ""), (0.1, "removes 10.0 % of what repeats share yet"), (float("nan"), "")])
def test_where_hardly_anything_lies_above_the_floor_it_is_asked_what_goes_of_what_repeats_share_for_certain(gone, objection):
    model = Linear(1, {"effect_2.size": 1.0})
    rung, nothing = begin(model, {"stiffness": 0.0}), float("nan")
    fit = replace(rung.fit, values={"stiffness": 0.0, "effect_2.size": 1.0})
    trial = Trial("effect_2", {}, fit, 100.0, 90.0, nothing, nothing, nothing, nothing, "", rest_gone=gone)
    assert confirm.objection(trial, model.candidates[2], False, nothing) == objection


@pytest.mark.parametrize("is_first", [True, False])
def test_that_is_asked_of_what_comes_after_a_first_effect(is_first):
    """A floor as high as the error, of which a fit to half of what is missing leaves a part that repeats share."""
    model = Linear(1, {"effect_2.size": 1.0})
    rung = begin(model, {"stiffness": 0.0})
    first = State.of(rung, "", rung.fit, rung.check)
    rung = replace(rung, floor_squares=first.squares, held_out_floor_squares=first.held_out_squares)
    values = {**rung.fit.values, "effect_2.size": 0.5}
    fit = replace(rung.fit, values=values, residuals=simulate(model, values, rung.frame.indices))
    trial = Trial("effect_2", {}, fit, 100.0, 90.0, *(float("nan"),) * 4, "")
    found = confirm.Confirmation(rung, {"effect_2": model.candidates[2]}, first, (), ("effect_2",), is_first)(trial)
    assert np.isnan(found.share) and bool(np.isnan(found.rest_gone)) is is_first


def gone_with(truth, values):
    """Share of what repeats have in common that is gone with these values of the effects, in a model that lacks those of the ``truth``."""
    model = Linear(1, truth)
    rung = begin(model, {"stiffness": 0.0})
    confirmation = confirm.Confirmation(rung, {}, State.of(rung, "", rung.fit, rung.check), (), (), True)
    return confirmation._rest_gone(replace(rung.fit, residuals=simulate(model, {**rung.fit.values, **values}, rung.frame.indices)))


def test_that_share_is_known_only_where_repeats_have_something_in_common_for_certain():
    assert gone_with({"effect_2.size": 1.0}, {"effect_2.size": 1.0}) == pytest.approx(1.0, abs=0.05)
    assert 0.6 < gone_with({"effect_2.size": 1.0}, {"effect_2.size": 0.5}) < 0.9
    assert abs(gone_with({"effect_2.size": 1.0}, {"effect_4.size": 0.02})) < 0.05
    assert np.isnan(gone_with({}, {"effect_2.size": 0.1}))


def weakly_held_out(seed, is_there=True):
    """The trial of an effect that fitted drives leave no doubt of, and of which the one held out has little, or nothing."""
    model = Linear(seed, {"effect_2.size": 0.3})
    model.columns[3] = {key: 0.15 * column for key, column in model.columns[3].items()}
    if not is_there:
        model.noise[3] = model.noise[3] + 0.3 * model.columns[3]["effect_2.size"]
    return next(trial for trial in rounds(model, 1)[0].trials if trial.name == "effect_2")


@pytest.mark.long
def test_where_the_held_out_drive_is_too_weak_to_decide_a_fall_beyond_chance_confirms_what_the_others_leave_no_doubt_of():
    trials = [weakly_held_out(seed) for seed in range(1, 13)]
    accepted = [trial for trial in trials if not trial.objection]
    assert all(trial.held_out_gain > 0 and trial.held_out_z > 0 for trial in accepted)
    assert len(accepted) > 6 and any(trial.held_out_z < HELD_OUT_Z for trial in accepted)
    assert sum(not weakly_held_out(seed, is_there=False).objection for seed in range(1, 25)) <= 3


def test_a_fall_confirms_a_first_effect_and_a_later_one_only_where_the_held_out_drive_is_weak(monkeypatch):
    monkeypatch.setattr(confirm, "WEAK", 0.0)

    def objections(number, truth):
        """Of effect_4 in a round, where the fitted drives leave no doubt of it and the weak one held out says yes without being sure."""
        for seed in range(1, 13):
            model = Linear(seed, truth)
            weak = lambda key: 0.07 if key == "effect_4.size" else 1.0
            model.columns[3] = {key: weak(key) * column for key, column in model.columns[3].items()}
            turn = rounds(model, number + 1)[number]
            for trial in turn.trials:
                is_certain = turn.p_value[turn.names.index(trial.name)] <= CERTAIN
                if trial.name == "effect_4" and is_certain and 0 < trial.held_out_z < HELD_OUT_Z:
                    if trial.held_out_gain > 0 and trial.held_out_share > 0:
                        yield trial.objection

    assert set(objections(0, {"effect_4.size": 0.5})) == {""}
    assert set(objections(1, {"effect_1.size": 1.0, "effect_4.size": 0.5})) == {"not surely better on drives held out"}


def a_trial(name, bic, held_out_gain, held_out_z, held_out_share, objection=""):
    return Trial(name, {}, None, bic, bic, held_out_gain, held_out_z, 0.5, held_out_share, objection)


def test_what_drives_held_out_confirm_goes_first_unless_another_explains_more_of_all_of_them():
    sure = a_trial("sure", 850.0, 180.0, 3.4, 0.3)
    much = a_trial("much", 3200.0, 610.0, 1.9, 0.7)
    assert confirm.best([sure, much]) is much
    for less in ({"bic": 800.0}, {"held_out_gain": 170.0}, {"held_out_share": 0.2}, {"objection": "not plausible"}):
        assert confirm.best([sure, replace(much, **less)]) is sure
    more = a_trial("more", 4000.0, 500.0, 1.8, 0.6)
    assert confirm.best([more, sure, much]) is more
    assert confirm.best([]) is None


def test_what_no_drive_held_out_meets_goes_first_only_if_it_explains_more_of_the_fitted_ones():
    unmet = a_trial("unmet", 12.0, float("nan"), float("nan"), float("nan"))
    weak = a_trial("weak", 4000.0, 610.0, 1.9, 0.85)
    assert confirm.best([unmet, weak]) is weak
    assert confirm.best([replace(unmet, bic=4100.0), weak]).name == "unmet"
