"""Samples of the runs: stratification, distributions, independence of everything but seed and site."""

import numpy as np
import pytest
from scipy import stats

from ridecomfort.errors import InputError
from ridecomfort.sample import INPUTS, latin_hypercube, sample, slices

PAPER = {  # tab:lhs_input, ts3
    "speed_deviation": {"normal": [-5, 0.2]},
    "lateral_position": {"normal": [0, 0.2]},
    "road_friction": {"uniform": [0.6, 1.0]},
}
DISTRIBUTIONS = {
    "speed_deviation": stats.norm(-5, 0.2),
    "lateral_position": stats.norm(0, 0.2),
    "road_friction": stats.uniform(0.6, 0.4),
}


@pytest.mark.parametrize("name", INPUTS)
def test_each_equally_probable_interval_is_drawn_from_once(name):
    runs = 500
    drawn = sample(PAPER, runs, seed=3, site="ts3")[name].values
    strata = np.floor(runs * DISTRIBUTIONS[name].cdf(drawn)).astype(int)
    assert sorted(strata) == list(range(runs))


@pytest.mark.parametrize("runs", [1, 7, 40, 360])
def test_every_slice_is_a_latin_hypercube(runs):
    points = latin_hypercube(runs, 2, np.random.default_rng(5))
    assert slices(runs)[0] == runs and slices(runs)[-1] == 1
    for size in slices(runs):
        for slice_ in points.reshape(-1, size, 2):
            for column in slice_.T:
                assert sorted(np.floor(size * column).astype(int)) == list(range(size))


def test_slices_are_drawn_from_everywhere():
    """The first slice of many designs fills the unit interval evenly, and its two inputs are unrelated."""
    rng = np.random.default_rng(6)
    points = np.concatenate([latin_hypercube(60, 2, rng)[:5] for _ in range(400)])
    assert all(stats.kstest(column, "uniform").pvalue > 1e-4 for column in points.T)
    assert abs(np.corrcoef(points.T)[0, 1]) < 4 / np.sqrt(len(points))


def test_monte_carlo_leaves_intervals_empty():
    drawn = sample(PAPER, 500, seed=3, site="ts3", method="monte_carlo")["road_friction"].values
    strata = np.floor(500 * DISTRIBUTIONS["road_friction"].cdf(drawn)).astype(int)
    # Of 500 cells with 500 independent draws a share of 1/e stays empty: 184, standard deviation 7.
    assert 150 < 500 - len(set(strata)) < 220


@pytest.mark.parametrize("method", ["latin_hypercube", "monte_carlo"])
def test_distributions(method):
    drawn = sample(PAPER, 2000, seed=1, site="ts3", method=method)
    for name in INPUTS:
        assert stats.kstest(drawn[name].values, DISTRIBUTIONS[name].cdf).pvalue > 1e-4


def test_inputs_are_uncorrelated():
    drawn = sample(PAPER, 2000, seed=1, site="ts3").to_dataframe()[list(INPUTS)].corr().values
    assert np.abs(drawn[np.triu_indices(3, 1)]).max() < 4 / np.sqrt(2000)


def test_seed_and_site_decide_and_nothing_else():
    first = sample(PAPER, 50, seed=1, site="ts1")
    assert first.identical(sample(PAPER, 50, seed=1, site="ts1"))
    for other in (sample(PAPER, 50, seed=2, site="ts1"), sample(PAPER, 50, seed=1, site="ts2")):
        assert not np.allclose(first["road_friction"], other["road_friction"])


def test_friction_that_is_not_positive_is_refused():
    with pytest.raises(InputError, match="road_friction"):
        sample({**PAPER, "road_friction": {"normal": [0.1, 0.2]}}, 200, seed=1, site="a")
