"""How sure a fitted size is: intervals against truths that are known."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import probe, refit
from ridecomfort.errors import InputError

from .linear import Linear

TRIALS, CYCLES = 40, 3


def interval(seed, own):
    """The 90 % interval of a parameter whose truth is 1, on three drives that each have ``own`` (rms) of it more or less."""
    made = Linear(seed, {"stiffness": 1.0}, library=0)
    rng = np.random.default_rng([seed, 1])
    for index in range(3):
        made.noise[index] = made.noise[index] + own * rng.standard_normal() * made.columns[index]["stiffness"]
    values, indices = {"stiffness": 0.0}, range(3)
    for _ in range(CYCLES):  # an error that makes itself white comes out too small
        residuals = exp.simulate(made, values, indices)
        frame = exp.frame(made, residuals, exp.nuisances(made, values, indices))
        columns = probe.white(frame, probe.secants(made, values, residuals, made.free))
        fit = refit.refit(made, frame, values, made.free, columns, residuals=residuals)
        values = fit.values
    return refit.intervals(fit, frame, made.free)["stiffness"]


def covered(own):
    found = np.array([interval(seed, own) for seed in range(TRIALS)])
    return np.mean((found[:, 0] < 1.0) & (found[:, 1] > 1.0)), np.median(found[:, 1] - found[:, 0])


def test_intervals_hold_the_truth_also_where_every_drive_has_an_error_of_its_own():
    share, width = covered(0.0)
    assert 0.8 <= share  # 90 % of 40 less two standard deviations
    share_with_own, wider = covered(0.1)
    assert 0.8 <= share_with_own
    assert wider > 3 * width


class Sooner(Linear):
    """The same with columns that are ``wrong`` by a share, as longer steps make them."""

    def __init__(self, seed, wrong, refused=False):
        super().__init__(seed, {"effect_0.size": 3.0}, library=1)
        self.columns = [{key: (1.0 + wrong) * column for key, column in own.items()} for own in self.columns]
        self.wrong, self.refused = wrong, refused

    def residual(self, values, index):
        if self.refused and values.get("effect_0.size"):
            raise InputError("did not stay finite")
        truth = self.truth["effect_0.size"] * self.columns[index]["effect_0.size"]
        return super().residual(values, index) + truth * self.wrong / (1.0 + self.wrong)  # equal where nothing is switched on


@pytest.mark.parametrize(("wrong", "refused", "is_trusted"), [(1e-4, False, True), (0.5, False, False), (0.0, True, False)])
def test_what_longer_steps_find_is_told_in_own_steps_and_found_in_them_where_the_gain_is_another(wrong, refused, is_trusted):
    made, values, indices = Linear(3, {"effect_0.size": 3.0}, library=1), {"stiffness": 0.0}, range(3)
    sooner = Sooner(3, wrong, refused)
    residuals = exp.simulate(made, values, indices)
    np.testing.assert_allclose(sooner.residual(values, 0), residuals[0], atol=1e-9)
    frame = exp.frame(made, residuals, exp.nuisances(made, values, indices))
    sizes = [*made.free, *made.candidates[0].sizes]
    columns = probe.white(frame, probe.secants(made, values, residuals, sizes))
    alone = refit.refit(made, frame, values, sizes, columns, residuals=residuals)
    found = refit.refit_sooner(made, sooner, frame, values, sizes, columns, residuals=residuals)
    assert found.values["effect_0.size"] == pytest.approx(alone.values["effect_0.size"], rel=1e-3 if is_trusted else 1e-8)
    assert (abs(found.values["effect_0.size"] - alone.values["effect_0.size"]) > 1e-8) is is_trusted
    for index, own in found.residuals.items():
        np.testing.assert_array_equal(own, made.residual(found.values, index))
    assert found.loss == pytest.approx(float(np.sum(frame.flat(found.residuals) ** 2)))


def test_a_size_that_changes_nothing_on_the_fitted_drives_may_be_anything_within_its_bounds():
    made, values, indices = Linear(3, {"effect_0.size": 3.0}, library=2), {"stiffness": 0.0}, range(3)
    for own in made.columns:
        own["effect_1.size"] = 0.0 * own["effect_1.size"]
    residuals = exp.simulate(made, values, indices)
    frame = exp.frame(made, residuals, exp.nuisances(made, values, indices))
    sizes = [size for candidate in made.candidates for size in candidate.sizes]
    columns = probe.white(frame, probe.secants(made, values, residuals, sizes))
    fit = refit.refit(made, frame, values, sizes, columns, residuals=residuals)
    found = refit.intervals(fit, frame, sizes)
    assert found["effect_1.size"] == (0.0, 5.0) and np.ptp(found["effect_0.size"]) < 0.5
