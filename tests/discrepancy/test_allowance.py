"""Intervals allow for an effect that may be there beside the named ones, by how likely it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import allowance, amended, judge, probe, refit, select
from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy.allowance import Allowance, allowances

from .linear import Linear

NAMED, OTHER = "effect_0.size", "effect_1.size"
ALIKE = 0.7
"""What the column of the other effect has of the named one's."""


class Alike(Linear):
    """Another effect that does in part what the named one does; on the drive held out it does nothing."""

    def __init__(self, seed, truth, alike=ALIKE, library=6, others=1):
        super().__init__(seed, truth, library=library)
        for condition in (0, 3):  # repeats share their columns
            own = self.columns[condition]
            for k in range(1, others + 1):
                key = f"effect_{k}.size"
                own[key] = alike * own[NAMED] + np.sqrt(1.0 - alike**2) * own[key]

    def residual(self, values, index):
        return super().residual(values, index) + (self.truth.get(OTHER, 0.0) * self.columns[3][OTHER] if index == 3 else 0.0)


def allowed(made, start=3.0, count=2):
    """The named effect alone fitted, without a parameter beside it, and what the others would make of it."""
    made.free = ()
    sizes, values, indices = made.candidates[0].sizes, {NAMED: start}, range(3)
    residuals = exp.simulate(made, values, indices)
    frame = exp.frame(made, residuals, exp.nuisances(made, values, indices))
    raw = {(candidate.name, 0): probe.secants(made, values, residuals, candidate.sizes) for candidate in made.candidates}
    fit = refit.refit(made, frame, values, sizes, probe.white(frame, raw.pop(("effect_0", 0))), residuals=residuals)
    raw = {job: own for job, own in raw.items() if int(job[0][-2:].strip("_")) < count}
    return fit, frame, allowances(fit, frame, sizes, raw, {one.name: one for one in made.candidates}, count)[NAMED]


def own_interval(fit, frame):
    return refit.intervals(fit, frame, frame.experiment.candidates[0].sizes)[NAMED]


def test_the_shift_is_what_the_effect_that_is_not_named_has_moved_the_size_by():
    fit, frame, found = allowed(Alike(1, {NAMED: 3.0, OTHER: 0.3}))
    error = fit.values[NAMED] - 3.0
    assert found.name == "effect_1"
    assert error == pytest.approx(ALIKE * 0.3, rel=0.2) and found.shift == pytest.approx(error, rel=0.2)
    interval = own_interval(fit, frame)
    lower, upper = found.widened(interval)
    assert not interval[0] < 3.0 < interval[1] and lower < 3.0 < upper and found.is_notable(interval)


def test_an_interval_and_a_shift_add_as_two_standard_deviations_about_the_same_middle():
    lower, upper = Allowance(0.4, "another").widened((1.0, 2.0))
    assert (lower + upper) / 2 == 1.5 and (upper - lower) / 2 == pytest.approx(np.hypot(0.5, 1.6449 * 0.4), rel=1e-4)
    assert Allowance().widened((1.0, 2.0)) == (1.0, 2.0) and not Allowance().is_notable((1.0, 2.0))


def test_no_other_moves_a_size_by_more_than_it_may_plausibly_have():
    made = Alike(1, {NAMED: 3.0, OTHER: 0.3})
    made.candidates = tuple(replace(one, sizes=(replace(one.sizes[0], upper=0.1 if one.name == "effect_1" else 5.0),)) for one in made.candidates)
    assert allowed(made)[2].shift == pytest.approx(ALIKE * 0.1, rel=0.1)


def test_a_size_that_ended_at_nil_because_another_effect_opposes_it_is_allowed_to_be_there():
    fit, _, found = allowed(Alike(1, {NAMED: 0.2, OTHER: 0.5}, alike=-ALIKE), start=0.0)
    assert fit.values[NAMED] == pytest.approx(0.0, abs=1e-6) and found.shift == pytest.approx(0.2, rel=0.3)


def test_what_is_not_there_widens_little_however_many_alternatives_there_are():
    wider = []
    for seed in range(10):
        fit, frame, found = allowed(Alike(seed, {NAMED: 3.0}, library=30, others=29), count=30)
        wider.append(np.ptp(found.widened(own_interval(fit, frame))) / np.ptp(own_interval(fit, frame)))
    assert np.median(wider) < 1.1 and sum(times > allowance.NOTABLE for times in wider) <= 2


def test_one_that_does_something_else_is_not_allowed_for():
    fit, frame, found = allowed(Alike(1, {NAMED: 3.0, OTHER: 0.3}, alike=0.0))
    assert not found.is_notable(own_interval(fit, frame))


def test_one_that_drives_held_out_refute_has_no_name_but_intervals_allow_for_it_and_the_verdict_says_so():
    made = Alike(2, {NAMED: 3.0, OTHER: 0.3})
    selection = select.select(made, {"stiffness": 0.0})
    assert selection.accepted == ("effect_0",) and selection.allowed[NAMED].name == "effect_1"
    assert selection.allowed[NAMED].shift == pytest.approx(ALIKE * 0.3, rel=0.3)
    assert "stiffness" not in selection.allowed  # of the vehicle nothing is told here
    found = judge.judge(selection, made.candidates)
    size = found.effects[0].sizes[0]
    assert tuple(size["interval"]) == selection.told(NAMED)
    lower, upper = selection.allowed[NAMED].widened(selection.intervals[NAMED])
    assert size["interval"][0] < lower < upper < size["interval"][1]  # by the resolution
    assert tuple(size["interval_of_noise"]) == selection.intervals[NAMED]
    is_told = selection.allowed[NAMED].is_notable(selection.intervals[NAMED])
    assert size["allows_for"] == ("effect_1" if is_told else "")


def test_the_verdict_says_what_intervals_allow_for_but_not_for_what_it_says_already():
    made = Alike(2, {NAMED: 3.0, OTHER: 0.3})
    found = judge.judge(select.select(made, {"stiffness": 0.0}), made.candidates)
    effect = replace(found.effects[0], sizes=({**found.effects[0].sizes[0], "allows_for": "effect_1"},))
    said = "intervals of effect_0 allow for effect_1, which the drives leave open"
    told = lambda own, names=("effect_1",): amended.with_allowances(replace(found, effects=(own,)), set(names)).reasons
    assert told(effect)[-1] == said
    assert said not in told(replace(effect, like=("effect_1",))) and said not in told(effect, ("effect_2",))


def test_a_size_beyond_what_is_plausible_is_one_though_another_effect_may_have_moved_it():
    made = Alike(2, {NAMED: 3.0, OTHER: 0.3})
    found = judge.judge(select.select(made, {"stiffness": 0.0}), made.candidates).effects[0]
    size = {**found.sizes[0], "interval": [4.8, 5.8], "interval_of_noise": [5.28, 5.32]}
    assert replace(found, sizes=(size,)).beyond() == [size]
    assert not replace(found, sizes=({**size, "interval_of_noise": [4.9, 5.7]},)).beyond()
