"""Intervals of probabilities, and how many runs they need."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from ridecomfort.comfort import enough, probability
from ridecomfort.errors import InputError
from ridecomfort.sample import latin_hypercube

# Newcombe (1998), Statistics in Medicine 17, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
NEWCOMBE = [
    (probability.wilson, 81, 263, 0.2553, 0.3662), (probability.clopper_pearson, 81, 263, 0.2527, 0.3676),
    (probability.wilson, 15, 148, 0.0624, 0.1605), (probability.clopper_pearson, 15, 148, 0.0578, 0.1617),
    (probability.wilson, 0, 20, 0.0000, 0.1611), (probability.clopper_pearson, 0, 20, 0.0000, 0.1684),
    (probability.wilson, 1, 29, 0.0061, 0.1718), (probability.clopper_pearson, 1, 29, 0.0009, 0.1776),
]  # fmt: skip


@pytest.mark.parametrize("method, count, runs, lower, upper", NEWCOMBE)
def test_published_intervals(method, count, runs, lower, upper):
    assert method(count, runs) == (pytest.approx(lower, abs=5e-5), pytest.approx(upper, abs=5e-5))


@pytest.mark.parametrize("name", probability.INTERVALS)
def test_against_scipy(name):
    scipys = {"wilson": "wilson", "clopper_pearson": "exact"}[name]
    for count in (0, 3, 40, 50):
        expected = stats.binomtest(count, 50).proportion_ci(0.9, scipys)
        assert probability.interval(count, 50, 0.9, name) == (pytest.approx(expected.low), pytest.approx(expected.high))


def test_mistakes_are_named():
    with pytest.raises(InputError, match="between 0"):
        probability.wilson(5, 4)
    with pytest.raises(InputError, match="'bayes' is unknown"):
        probability.interval(1, 4, method="bayes")


def test_runs_needed_is_the_least_number():
    needed = enough.runs_needed(0.05, share=0.3)

    def width(runs):
        return np.subtract(*probability.wilson(0.3 * runs, runs)[::-1])

    assert width(needed) <= 0.05 < width(needed - 1)


FACTORS = ("speed_deviation", "lateral_position")


def sliced(runs: int, seed: int) -> xr.Dataset:
    unit = latin_hypercube(runs, len(FACTORS), np.random.default_rng(seed))
    return xr.Dataset({name: ("run", stats.norm.ppf(column)) for name, column in zip(FACTORS, unit.T)})


def test_latin_hypercubes_need_fewer_runs_where_one_factor_decides():
    samples = sliced(4000, 1)
    critical = samples["speed_deviation"].values[:, None] > np.linspace(-1, 1, 15)
    found = enough.interval_width(critical, samples)
    assert found["size"].values.tolist() == [25, 125, 250, 500] and found["designs"].values.tolist() == [160, 32, 16, 8]
    plain, latin = found["width"].sel(scheme="monte_carlo"), found["width"].sel(scheme="latin_hypercube")
    assert np.all(latin < 0.5 * plain)
    assert plain.values == pytest.approx(found["wilson"].values, rel=0.3)
    assert np.all(np.diff(plain) < 0)


def test_latin_hypercubes_help_nothing_where_only_the_interaction_decides():
    """The sign of a product has no main effects: by Stein (1987) the scatter is that of plain Monte Carlo."""
    samples = sliced(4000, 2)
    critical = (samples["speed_deviation"] * samples["lateral_position"]).values[:, None] > np.zeros(1)
    ratio = [
        float(found["width"].sel(scheme="latin_hypercube", size=25) / found["width"].sel(scheme="monte_carlo", size=25))
        for found in (enough.interval_width(critical, samples, seed=seed) for seed in range(5))
    ]
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.15)


def test_scatter_of_slices_is_that_of_separate_latin_hypercubes():
    """160 slices of one design of 4000 scatter as 2000 designs of 25 that know nothing of each other."""

    def critical(unit):
        return (unit[..., 0] + unit[..., 1] ** 2)[..., None] > np.linspace(0.3, 1.5, 9)

    unit = latin_hypercube(4000, 2, np.random.default_rng(3))
    samples = xr.Dataset({name: ("run", column) for name, column in zip(FACTORS, unit.T)})
    told = float(enough.interval_width(critical(unit), samples)["width"].sel(scheme="latin_hypercube", size=25))
    rng = np.random.default_rng(4)
    means = np.array([critical(stats.qmc.LatinHypercube(2, rng=rng).random(25)).mean(axis=0) for _ in range(2000)])
    assert told == pytest.approx(2 * 1.96 * np.sqrt(means.var(axis=0, ddof=1).mean()), rel=0.12)


def test_a_plain_sample_has_no_latin_slices():
    rng = np.random.default_rng(1)
    assert enough.slice_sizes(xr.Dataset({name: ("run", rng.standard_normal(400)) for name in FACTORS})) == []
    assert enough.slice_sizes(sliced(400, 1)) == [25, 50]


def test_an_input_that_is_held_at_a_value_is_in_no_slices_way():
    drawn = sliced(400, 1)
    held = drawn.assign({FACTORS[0]: ("run", np.full(400, 0.3))})
    assert enough.slice_sizes(held) == [25, 50]
    assert enough.slice_sizes(held[[FACTORS[0]]]) == []


def test_nothing_to_estimate_is_said():
    samples = sliced(400, 1)
    with pytest.raises(InputError, match="nothing to estimate"):
        enough.interval_width(np.ones((400, 3)), samples)
    with pytest.raises(InputError, match="do not fall into"):
        enough.interval_width(np.eye(100), samples.isel(run=slice(100)))


def test_widths_by_the_root_of_the_runs():
    sizes = np.array([25, 100, 400])
    assert enough.by_root(sizes, 1.5 / np.sqrt(sizes)) == pytest.approx(1.5)
    assert enough.by_root(sizes, np.where(sizes == 100, np.nan, 1.5 / np.sqrt(sizes))) == pytest.approx(1.5)
    assert np.isnan(enough.by_root([25], [0.0]))
