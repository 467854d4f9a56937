"""What drives say of parameters: intervals that hold the truth as often as they say, and words on what is not known."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import identifiability


def test_intervals_hold_the_truth_as_often_as_they_say_though_residuals_are_correlated():
    """Linear model with residuals correlated over 30 samples: 90 % by blocks, far fewer by the usual formula."""
    rng = np.random.default_rng(3)
    count, trials, held, naive = 3000, 400, 0, 0
    time = np.arange(count)
    jacobian = np.stack([np.sin(time / 40), np.cos(time / 17)], axis=1)[None]
    kernel = np.ones(30) / 30**0.5
    for _ in range(trials):
        residual = np.convolve(rng.standard_normal(count + 29), kernel, mode="valid")
        error = np.linalg.lstsq(jacobian[0], residual, rcond=None)[0]
        left = (residual - jacobian[0] @ error)[None]
        known = identifiability.assess(jacobian, left, time // 100)
        held += abs(error[0]) < known.half_width[0]
        naive += abs(error[0]) < 1.645 * left.std() / np.linalg.norm(jacobian[0, :, 0])
    assert held / trials == pytest.approx(0.90, abs=0.06)  # four standard errors of 400 trials
    assert naive / trials < 0.5


def test_intervals_are_those_of_the_fit_that_takes_errors_out():
    """Local errors of a usual size, taken out as far as the data ask for it: scores of the residual itself are too wide."""
    rng = np.random.default_rng(8)
    count, errors, trials, size = 2000, 100, 300, 0.5
    time = np.arange(count)
    columns = np.maximum(0.0, 1.0 - np.abs(time[:, None] / 20 - np.arange(errors)))
    own = np.convolve(rng.standard_normal(count + 29), np.ones(30) / 30**0.5, mode="valid") + 0.3 * rng.standard_normal(count)
    project = np.eye(count) - columns @ np.linalg.solve(columns.T @ columns + np.eye(errors) / size**2, columns.T)
    jacobian = (project @ own)[None, :, None]
    influence = (project @ project @ own)[None, :, None]
    held, wide = 0, 0
    for _ in range(trials):
        residual = columns @ (size * rng.standard_normal(errors)) + rng.standard_normal(count)
        error = float(jacobian[0, :, 0] @ project @ residual) / float(np.sum(jacobian**2))
        left = (residual - error * own)[None]
        held += abs(error) < identifiability.assess(jacobian, left, time // 50, influence).half_width[0]
        wide += abs(error) < identifiability.assess(jacobian, left, time // 50).half_width[0]
    assert held / trials == pytest.approx(0.90, abs=0.07)  # four standard errors of 300 trials
    assert wide > held


def test_what_a_single_block_knows_is_not_known():
    """One bend in a straight road: no second one says how well the first is understood."""
    rng = np.random.default_rng(1)
    block = np.arange(2000) // 100
    jacobian = np.stack([rng.standard_normal(2000), rng.standard_normal(2000) * (block == 7)], axis=1)[None]
    known = identifiability.assess(jacobian, 0.01 * rng.standard_normal((1, 2000)), block)
    assert known.half_width[0] < 0.01 and known.half_width[1] > 100


@pytest.mark.parametrize("apart", [1e-3, 1e-4, 3e-5])
def test_nearly_collinear_parameters_have_the_intervals_that_their_sum_and_difference_give_them(apart):
    """However little is known of a direction: the covariance of other parameters of the same model is that of these, transformed."""
    rng = np.random.default_rng(3)
    one, other, third, residual = rng.normal(size=(4, 2000))
    block = np.arange(2000) // 100
    alike = identifiability.assess(np.stack([one, one + apart * other, third], axis=1)[None], residual[None], block)
    plain = identifiability.assess(np.stack([one, other, third], axis=1)[None], residual[None], block)
    back = np.linalg.inv([[1.0, 1.0, 0.0], [0.0, apart, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(alike.covariance, back @ plain.covariance @ back.T, rtol=1e-5, atol=1e-6 * alike.covariance.max())


def test_a_record_of_one_block_knows_nothing():
    """A stretch of two seconds fits as well as any; no other says by how much it would differ."""
    rng = np.random.default_rng(2)
    known = identifiability.assess(rng.standard_normal((1, 200, 2)), 0.01 * rng.standard_normal((1, 200)), np.zeros(200, int))
    assert np.isinf(known.half_width).all()


def test_a_collinear_pair_is_named():
    rng = np.random.default_rng(0)
    first = rng.standard_normal(2000)
    jacobian = np.stack([first, first + 0.05 * rng.standard_normal(2000), rng.standard_normal(2000)], axis=1)[None]
    known = identifiability.assess(jacobian, 0.01 * rng.standard_normal((1, 2000)), np.arange(2000) // 50)
    (words,) = identifiability.remarks(["a", "b", "c"], np.full(3, 0.5), known)
    assert words.startswith("a and b are hard to tell apart (correlation -1.00)")


@pytest.mark.parametrize(("name", "is_of_effect"), [("tyre_friction", False), ("suspension_friction.front", True)])
def test_what_ends_at_a_bound_is_said_of_an_effect_it_may_be_none(name, is_of_effect):
    known = identifiability.Knowledge(0.01 * np.eye(1), np.array([0.01]), np.ones(1), np.ones((1, 6)))
    (words,) = identifiability.remarks([name], np.zeros(1), known)
    assert words.startswith(f"{name} is at its lower bound: the data ask for less than the bounds allow")
    assert ("none of it" in words) is is_of_effect


@pytest.mark.parametrize("other", [0.0, 1e-6])
def test_what_only_shows_as_a_sum_is_not_identified(other):
    rng = np.random.default_rng(0)
    first, third = rng.standard_normal((2, 2000))
    jacobian = np.stack([first, 2.0 * first * (1.0 + other), third], axis=1)[None]
    known = identifiability.assess(jacobian, 0.01 * rng.standard_normal((1, 2000)), np.arange(2000) // 50)
    assert np.isinf(known.half_width[:2]).all() and known.half_width[2] < 0.01
    assert identifiability.verdict(0.5, known.half_width[0]) == "not identified"


def test_many_that_are_alike_are_named_together():
    covariance = np.full((5, 5), 0.95) + 0.05 * np.eye(5)
    covariance[4, :4] = covariance[:4, 4] = 0.0
    known = identifiability.Knowledge(covariance, np.full(5, 0.1), np.ones(5), np.ones((5, 1)))
    (words,) = identifiability.remarks(["a", "b", "c", "d", "e"], np.full(5, 0.5), known)
    assert words == "a, b, c and d are hard to tell apart (correlation up to +0.95)"
