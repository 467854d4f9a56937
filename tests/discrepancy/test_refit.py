"""How sure a fitted size is: intervals against truths that are known."""

from __future__ import annotations

import numpy as np

from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import probe, refit

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
