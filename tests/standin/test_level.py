"""How rough the road is along its length: shares, levels, defects and gain."""

import numpy as np
import pytest

from ridecomfort.comfort.iri import iri
from ridecomfort.errors import InputError
from ridecomfort.standin import level

CENTRES = np.arange(25.0, 2000.0, 50.0)
S = np.arange(50.0, 1975.0, 0.5)
EVALUATION = level.Evaluation(S, 10, np.array([1.0, 1.5, 2.0, 3.0])[:, None] * np.ones(len(S)))
DRAWING = {"smoothest": 0.5, "correlation_length": 100.0, "draws": 5000}

U, V = np.arange(0.0, 1000.05, 0.1), np.linspace(-2.0, 2.0, 9)


def survey(elevation):
    return iri(elevation[:, [2, 6]].T, 0.1, 50.0).mean(axis=0)


def test_only_windows_wholly_in_a_class_count():
    signal = np.where((S >= 102.0) & (S < 118.0), 1.2, 0.8)
    found = level.shares(signal, EVALUATION) * len(S) / 10
    np.testing.assert_allclose(found, [2.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_interpolation_is_linear_and_held_at_the_ends():
    between = level.interpolation(np.array([10.0, 20.0, 40.0]), np.array([0.0, 15.0, 35.0, 50.0]))
    np.testing.assert_allclose(np.array([1.0, 3.0, 7.0]) @ between, [1.0, 2.0, 6.0, 7.0])


def test_drawn_levels_meet_the_shares_and_are_correlated():
    wanted = np.array([0.2, 0.1, 0.05, 0.0])
    rows = [
        level.draw_levels(np.random.default_rng(seed), CENTRES, EVALUATION, wanted, tolerance=0.01, **DRAWING)
        for seed in range(5)
    ]
    for row in rows:
        found = level.shares(np.interp(S, CENTRES, row), EVALUATION)
        np.testing.assert_allclose(found, wanted, atol=0.01)
        assert row.min() >= 0.5
    logs = np.log(rows) - np.mean(np.log(rows))
    assert np.mean(logs[:, 1:] * logs[:, :-1]) / np.var(logs) > 0.3


def test_shares_that_cannot_be_had_are_refused():
    with pytest.raises(InputError, match="misses the share"):
        level.draw_levels(
            np.random.default_rng(1), CENTRES, EVALUATION, np.array([0.0, 0.0, 0.9, 0.0]), tolerance=0.01, **DRAWING
        )


def test_defects_keep_to_rough_stretches_and_to_their_allowance():
    centres = np.arange(25.0, 1000.0, 50.0)
    levels = np.where(centres < 500.0, 0.7, 4.0)
    placed, surface = level.place_defects(
        np.random.default_rng(3), np.zeros((len(U), len(V))), U, V, centres, levels, survey,
        per_km={"pothole": 30.0, "patch": 30.0}, allowance=0.5,
    )  # fmt: skip
    assert np.all(survey(surface) <= 0.5 * levels)
    rough = sum(defect.u > 500.0 for defect in placed)
    assert rough > 10 and rough > 5 * (len(placed) - rough)


def test_the_solved_gain_gives_the_levels_also_on_top_of_a_rough_base():
    rng = np.random.default_rng(5)
    surface = 1e-3 * np.cumsum(rng.standard_normal((len(U), len(V))), axis=0) * np.sqrt(0.1)
    base = 3e-4 * np.cumsum(rng.standard_normal((len(U), len(V))), axis=0) * np.sqrt(0.1)
    centres = np.arange(25.0, 1000.0, 50.0)
    levels = rng.uniform(0.8, 3.0, len(centres))
    gain = level.solve_gain(surface, base, U, centres, levels, survey)
    steps = 0.5 * (gain[1:] + gain[:-1])[:, None] * np.diff(surface, axis=0)
    built = base + np.concatenate([gain[0] * surface[:1], gain[0] * surface[:1] + np.cumsum(steps, axis=0)])
    np.testing.assert_allclose(survey(built), levels, rtol=0.003)


def test_a_base_rougher_than_asked_is_refused():
    base = 5e-3 * np.cumsum(np.random.default_rng(5).standard_normal((len(U), len(V))), axis=0)
    centres = np.arange(25.0, 1000.0, 50.0)
    with pytest.raises(InputError, match="instead of"):
        level.solve_gain(1e-3 * base, base, U, centres, np.ones(len(centres)), survey, iterations=5)
