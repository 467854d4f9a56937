"""Drives held out that ask for other sizes than the fitted ones make intervals wider, and those that agree do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import judge, refit, select
from ridecomfort.discrepancy.consistency import birge_ratio
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.rung import begin, final_fit

from .linear import Linear

SIZE = "effect_2.size"


class Otherwise(Linear):
    """The drive held out was driven by a car that has a little less of an effect, and another stiffness."""

    def residual(self, values, index):
        own = {SIZE: values.get(SIZE, 0.0) + 0.3, "stiffness": values.get("stiffness", 0.0) - 0.3} if index == 3 else {}
        return super().residual({**values, **own}, index)


def half_widths(selection):
    own = refit.intervals(selection.final, selection.frame, [selection.frame.experiment.candidates[2].sizes[0]])[SIZE]
    return [0.5 * (upper - lower) for lower, upper in (selection.intervals[SIZE], own)]


def test_intervals_stay_as_they_are_where_held_out_drives_have_the_same_sizes():
    ratios = [select.select(Linear(seed, {SIZE: 2.0}), {"stiffness": 0.0}, most=1).birge_ratio for seed in range(60, 80)]
    assert ratios.count(1.0) >= 19


def test_intervals_are_widened_by_what_held_out_drives_disagree_and_the_verdict_says_so():
    model = Otherwise(60, {SIZE: 2.0})
    selection = select.select(model, {"stiffness": 0.0}, most=1)
    told, own = half_widths(selection)
    assert selection.birge_ratio > 2.0 and told > 1.5 * own
    found = judge.judge(selection, model.candidates)
    assert any(f"ask for other sizes by {selection.birge_ratio:.1f} times" in reason for reason in found.reasons)


@pytest.mark.parametrize(("own", "off", "least", "most"), [(0.1, 0.0, 0.0, 0.3), (0.0, 0.2, 1.0, 1.0)])
def test_what_every_drive_has_of_its_own_is_in_the_intervals_already_and_no_disagreement(own, off, least, most):
    """Of each of four drives' sizes a tenth; and, of the drive held out alone, a fifth in one direction."""
    ratios, held = [], 0
    for seed in range(20):
        model, rng = Linear(seed, {"stiffness": 1.0}, library=0), np.random.default_rng([seed, 1])
        for index in range(4):
            astray = own * rng.standard_normal() + (off if index == 3 else 0.0)
            model.noise[index] = model.noise[index] + astray * model.columns[index]["stiffness"]
        rung = begin(model, {"stiffness": 0.0})
        fit, frame = final_fit(rung, model.free)
        ratios.append(birge_ratio(rung, fit, frame, model.free))
        lower, upper = refit.intervals(fit, frame, model.free, wider=ratios[-1])["stiffness"]
        held += lower <= 1.0 <= upper
    assert least <= np.mean(np.array(ratios) > 1.0) <= most and held >= 17


@pytest.mark.parametrize(("wider", "is_said"), [(1.0, False), (60.0, True)])
def test_an_effect_whose_interval_holds_none_once_it_is_widened_is_told_with_a_word_on_it_and_may_be_something_else(monkeypatch, wider, is_said):
    monkeypatch.setattr(select, "birge_ratio", lambda *_: wider)
    model = Linear(60, {SIZE: 0.6})
    selection = select.select(model, {"stiffness": 0.0}, most=1)
    found = judge.judge(selection, model.candidates)
    lower, upper = found.effects[0].sizes[0]["interval"]
    assert (lower <= 0.0 <= upper) is is_said
    assert any("the interval of its size holds none, too" in reason for reason in found.reasons) is is_said
    assert found.verdict == ("cluster" if is_said else "named") and found.json()["effects"][0]["is_open"] is is_said
    assert found.words().startswith(f"Missing: effect_2{' or something else; the data do not tell those apart' if is_said else ''}.")


@pytest.mark.parametrize(("is_open", "names"), [("effect_4", ["effect_2"]), ("effect_2", ["effect_2", "effect_4"])])
def test_a_lesser_effect_of_an_open_size_is_not_named_beside_one_that_is_surely_there(is_open, names):
    """As `roll_centre_height` beside a bump steer that goes by the load, which the library's does not."""
    model = Linear(2, {SIZE: 1.2, "effect_4.size": 0.9})
    selection = select.select(model, {"stiffness": 0.0}, most=2)
    blurred = judge.judge(replace(selection, intervals={**selection.intervals, f"{is_open}.size": (-9.0, 9.0)}), model.candidates)
    assert [effect.name for effect in judge.judge(selection, model.candidates).effects] == ["effect_2", "effect_4"]
    assert blurred.verdict == "named" and [effect.name for effect in blurred.effects] == names
    said = "effect_4 is not named for that: it may make good what another shape of effect_2 would do"
    assert (said in blurred.reasons) is (is_open == "effect_4")


def test_beside_an_error_of_the_measurement_what_may_as_well_be_none_leaves_the_data_suspect():
    """As of an instrument of a bandwidth of a few Hz, for which three effects of the vehicle and two of the instrument did 85 and 90 %."""
    model = Linear(2, {SIZE: 1.2, "effect_4.size": 0.9})
    model.candidates = tuple(replace(one, instrument=one.name == "effect_4") for one in model.candidates)
    selection = select.select(model, {"stiffness": 0.0}, most=2)
    assert set(selection.accepted) == {"effect_2", "effect_4"}
    named = judge.judge(selection, model.candidates)
    assert named.verdict == "named" and [effect.name for effect in named.effects] == ["effect_2"]
    found = judge.judge(replace(selection, intervals=dict.fromkeys(selection.intervals, (-9.0, 9.0))), model.candidates)
    assert found.verdict == "suspect" and found.words().startswith("The data are suspect: effect_4.")


def test_what_no_fitted_drive_meets_is_not_widened_beyond_its_bounds():
    model = Otherwise(60, {SIZE: 2.0})
    unmet = Size("effect_2.unmet", "N", 0.0, 0.0, 5.0, 0.1)
    for own in model.columns:
        own[unmet.key] = 0.0 * own[SIZE]
    model.candidates = (*model.candidates[:2], replace(model.candidates[2], sizes=(*model.candidates[2].sizes, unmet)))
    selection = select.select(model, {"stiffness": 0.0}, most=1)
    assert selection.birge_ratio > 2.0 and selection.intervals[unmet.key] == (0.0, 5.0)


def test_without_a_drive_held_out_nothing_is_widened():
    model = Linear(60, {SIZE: 2.0})
    model.records, model.columns, model.noise = model.records[:3], model.columns[:3], model.noise[:3]
    assert select.select(model, {"stiffness": 0.0}, most=1).birge_ratio == 1.0
