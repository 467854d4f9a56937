"""Agreement of methods along a road, and what a run's comfort is owed to."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from ridecomfort.comfort import agreement, assessment, influence, iriclass, iso2631, methods, thresholds
from ridecomfort.errors import InputError
from ridecomfort.sample import latin_hypercube

# Cohen (1968), Psychological Bulletin 70, table 1: proportions of 200 judgements, and weights of
# disagreement 0, 1, 3; 1, 0, 6; 3, 6, 0 for which he reports a weighted kappa of .348, unweighted .492.
COHEN = np.array([[88, 10, 2], [14, 40, 6], [18, 10, 12]])


def test_unweighted_kappa_of_cohen_1968():
    assert agreement.kappa(COHEN, "none") == pytest.approx(0.492, abs=5e-4)


def test_weighted_kappa_by_its_definition():
    """1 - observed over expected disagreement, by loops over pairs of judgements."""
    first = np.repeat(np.repeat([0, 1, 2], 3), COHEN.ravel())
    second = np.repeat(np.tile([0, 1, 2], 3), COHEN.ravel())
    observed = np.mean((first - second) ** 2)
    expected = np.mean([(a - b) ** 2 for a in first for b in second])
    assert agreement.kappa(COHEN, "quadratic") == pytest.approx(1 - observed / expected)
    assert np.array_equal(agreement.confusion(first, second, (3, 3)), COHEN)


def test_kappa_at_its_ends():
    assert agreement.kappa(np.diag([5, 3, 9])) == 1.0
    assert agreement.kappa(np.full((3, 3), 4)) == pytest.approx(0.0)
    assert np.isnan(agreement.kappa([[7, 0], [0, 0]]))


def test_spearman_with_ties_against_scipy():
    rng = np.random.default_rng(1)
    first, second = rng.integers(0, 6, 80), rng.integers(0, 9, 80) + 0.0
    assert agreement.spearman(first, second) == pytest.approx(stats.spearmanr(first, second).statistic)


def autoregressive(count: int, rho: float, rng) -> np.ndarray:
    noise = rng.standard_normal(count)
    values = np.empty(count)
    values[0] = noise[0]
    for k in range(1, count):
        values[k] = rho * values[k - 1] + np.sqrt(1 - rho**2) * noise[k]
    return values


def test_block_bootstrap_respects_correlation_along_the_road():
    """The spread of the mean of a correlated series is known: variance (1 + rho) / (1 - rho) / n."""
    rho, count = 0.9, 4000
    series = autoregressive(count, rho, np.random.default_rng(2))
    error = np.sqrt((1 + rho) / (1 - rho) / count)
    found = agreement.bootstrap(np.mean, [(series,)], 1.0, block=100.0)
    assert (found.upper - found.lower) / (2 * 1.96 * error) == pytest.approx(1.0, abs=0.25)
    single = agreement.bootstrap(np.mean, [(series,)], 1.0, block=1.0)
    assert (single.upper - single.lower) < 0.4 * (found.upper - found.lower)


def test_a_road_of_less_than_five_blocks_has_no_interval():
    series = np.random.default_rng(3).standard_normal(450)
    found = agreement.bootstrap(np.mean, [(series,)], 1.0, block=100.0)
    assert found.value == pytest.approx(series.mean()) and np.isnan([found.lower, found.upper]).all()
    assert agreement.verdict(found) == "cannot be said"
    assert np.isnan(agreement.lag([(series, series)], 1.0).lower)
    # Beside a longer road it would be drawn as it is, without any scatter.
    longer = np.random.default_rng(4).standard_normal(600)
    assert np.isnan(agreement.bootstrap(np.mean, [(longer,), (series,)], 1.0, block=100.0).lower)
    assert np.isfinite(agreement.bootstrap(np.mean, [(longer,)], 1.0, block=100.0).lower)


def test_the_ends_of_a_road_are_drawn_as_often_as_its_middle():
    rng = np.random.default_rng(5)
    often = np.bincount(np.concatenate([agreement.blocks([60], 10, rng) for _ in range(2000)]), minlength=60)
    assert often[:5].mean() == pytest.approx(often[25:35].mean(), rel=0.05) and often[-5:].mean() == pytest.approx(often.mean(), rel=0.05)


def test_a_method_of_one_grade_says_nothing_of_agreement():
    smooth = study(1)
    smooth["iri"] = smooth["iri"].assign(iri=0.0 * smooth["iri"]["iri"])
    found = methods.agree({"a": methods.site(**smooth)}, repetitions=20)
    assert np.isnan(found["kappa"].sel(pair="iso2631 - iri")).all() and found.attrs["verdict"] == "cannot be said"
    assert "one grade only" in found.attrs["reason"] and "By site: a none" in found.attrs["reason"] and "nan" not in found.attrs["reason"]


def test_a_kappa_without_interval_is_told_as_such():
    alone = agreement.Estimate(0.5, np.nan, np.nan)
    answer, reason = agreement.substantially_similar({"a": alone, "pooled": alone})
    assert answer == "cannot be said" and "kappa 0.50 without an interval" in reason and "nan" not in reason


def test_resamples_stay_within_their_site():
    places = agreement.blocks([30, 50], 8, np.random.default_rng(3))
    assert len(places) == 80 and places[:30].max() < 30 <= places[30:].min()


def test_lag_is_the_distance_that_was_put_in():
    rng = np.random.default_rng(4)
    road = np.convolve(rng.standard_normal(1600), np.ones(10) / 10, mode="valid")
    late = np.roll(road, 12) + 0.05 * rng.standard_normal(len(road))
    found = agreement.lag([(late, road)], 1.0)
    assert found.value == 12.0 and found.lower <= 12.0 <= found.upper
    assert agreement.lag([(road, late)], 1.0).value == -12.0


@pytest.mark.parametrize(
    "bounds, answer", [((0.65, 0.9), "holds"), ((0.2, 0.5), "does not hold"), ((0.5, 0.7), "cannot be said")]
)
def test_verdict(bounds, answer):
    assert agreement.verdict(agreement.Estimate(np.mean(bounds), *bounds)) == answer
    assert agreement.verdict(agreement.Estimate(np.nan, np.nan, np.nan)) == "cannot be said"


def study(seed: int) -> dict[str, xr.Dataset]:
    """A site whose a_v follows the road's IRI: all three comfort datasets from one road."""
    rng = np.random.default_rng(seed)
    s, u = 50.0 + 0.25 * np.arange(2400), np.arange(0.0, 700.0, 0.1)
    level = np.exp(np.interp(u, np.arange(0, 701, 50), rng.normal(0, 0.7, 15)))
    profile = np.cumsum(level * rng.standard_normal(len(u))) * 4e-4
    road = xr.Dataset({"elevation": (("u", "v"), np.repeat(profile[:, None], 3, 1))}, {"u": u, "v": [-1.0, 0.0, 1.0]})
    runs = 6
    rough = iriclass.iri.survey(profile, u, s)
    shard = xr.Dataset(
        {
            "v_x": (("run", "s"), np.full((runs, s.size), 22.0)),
            "a_v": (("run", "s"), np.tile(0.25 * rough, (runs, 1))),
            "a_x": (("run", "s"), np.zeros((runs, s.size))),
            "a_y": (("run", "s"), np.tile(np.sin(s / 30), (runs, 1))),
            "a_z": (("run", "s"), np.tile(0.05 * rough, (runs, 1))),
        },
        {"run": np.arange(runs), "s": s},
    )
    return {
        "thresholds": thresholds.evaluate([shard]),
        "iso2631": iso2631.evaluate([shard]),
        "iri": iriclass.evaluate([shard], road),
    }


def test_methods_that_follow_the_same_road_agree():
    sites = {name: methods.site(**study(seed)) for name, seed in (("a", 1), ("b", 2))}
    found = methods.agree(sites, repetitions=100)
    pair = found.sel(pair="iso2631 - iri")
    assert pair["spearman"].sel(bound="estimate").values == pytest.approx(1.0, abs=1e-6)
    assert pair["lag"].sel(bound="estimate").values == pytest.approx(0.0)
    assert np.all(pair["kappa"].sel(bound="lower") <= pair["kappa"].sel(bound="estimate"))
    assert int(pair["confusion"].sel(site="pooled").sum()) == 240
    unlike = found.sel(pair="thresholds - iri", site="pooled", bound="estimate")
    assert float(unlike["spearman"]) < 0.9
    assert found.attrs["verdict"] in ("holds", "does not hold", "cannot be said")
    assert "pooled weighted kappa" in found.attrs["reason"]


@pytest.mark.parametrize("constant", [0, 1])
def test_a_series_that_does_not_vary_tells_no_lag_and_blurs_none(constant):
    rng = np.random.default_rng(4)
    rough = [np.convolve(rng.standard_normal(1208), np.ones(9), mode="valid") for _ in range(2)]
    flat = [rough[1], rough[1]]
    flat[constant] = np.zeros(1200)
    alone = agreement.lag([flat], 1.0)
    assert np.isnan([alone.value, alone.lower, alone.upper]).all()
    shifted = [np.roll(rough[0], 7), rough[0]]
    assert agreement.lag([shifted, flat], 1.0) == pytest.approx(agreement.lag([shifted], 1.0), abs=2.0)


@pytest.mark.parametrize("runs", [400, 600, 1000])
def test_what_has_no_influence_has_none_on_average_however_few_runs(runs):
    """Of 25 Latin hypercubes; the bins of three factors are not orthogonal, which was 0.03 at 400 runs."""
    found = []
    for seed in range(25):
        rng = np.random.default_rng([runs, seed])
        factors = latin_hypercube(runs, 3, rng)
        found.append(influence.first_order(factors.T if factors.shape[0] == runs else factors, rng.standard_normal(runs)))
    assert np.mean(found) == pytest.approx(0.0, abs=4 * np.std(np.mean(found, axis=1)) / 5) and abs(np.mean(found)) < 0.01


def test_influence_of_a_known_model():
    """y = 2 a + b + a noise of variance 1: shares of the variance 4/6, 1/6, 0."""
    rng = np.random.default_rng(5)
    names = ("speed_deviation", "lateral_position", "road_friction")
    samples = xr.Dataset({name: ("run", rng.standard_normal(4000)) for name in names})
    measure = 2 * samples["speed_deviation"] + samples["lateral_position"] + rng.standard_normal(4000)
    found = influence.influence(measure, samples)
    assert found["first_order"].sel(bound="estimate").values == pytest.approx([4 / 6, 1 / 6, 0.0], abs=0.03)
    assert float(found["first_order"].sel(factor="road_friction", bound="lower")) < 0.0
    assert float(found["spearman"].sel(factor="speed_deviation", bound="lower")) > 0.75
    assert float(found["unexplained"]) == pytest.approx(1 / 6, abs=0.05)


def test_intervals_of_an_influence_hold_what_they_say():
    """Shares of 0.8, 0.1 and 0 in 200 small studies of 400 runs: each interval holds its share in about 95 % of them."""
    shares, held = np.array([0.8, 0.1, 0.0]), np.zeros(3)
    rng = np.random.default_rng(8)
    for _ in range(200):
        samples = xr.Dataset({name: ("run", column) for name, column in zip("abc", rng.standard_normal((3, 400)))})
        measure = samples["a"] * 0.8**0.5 + samples["b"] * 0.1**0.5 + 0.1**0.5 * rng.standard_normal(400)
        found = influence.influence(measure, samples, groups=20, bins=20)["first_order"].values
        held += (found[:, 1] <= shares) & (shares <= found[:, 2])
    assert np.all(held / 200 > 0.88)


@pytest.mark.parametrize("runs", [400, 4000])
def test_intervals_hold_the_share_of_a_factor_that_acts_most_in_its_tails(runs):
    """A quadratic influence of a normal factor, nine tenths of the variance, in 30 designs."""
    held = []
    for seed in range(30):
        rng = np.random.default_rng([runs, seed])
        factors = stats.norm.ppf(latin_hypercube(runs, 2, rng).T)
        measure = 0.9**0.5 * (factors[0] ** 2 - 1) / 2**0.5 + 0.1**0.5 * rng.standard_normal(runs)
        samples = xr.Dataset({name: ("run", column) for name, column in zip("ab", factors)})
        found = influence.influence(measure, samples)["first_order"].values
        held.append((found[:, 1] <= [0.9, 0.0]) & ([0.9, 0.0] <= found[:, 2]))
    assert np.all(np.mean(held, axis=0) >= 0.8)


def test_a_step_in_the_tail_is_owed_to_its_factor_alone():
    factor = stats.norm.ppf(latin_hypercube(4000, 1, np.random.default_rng(3)).T)
    assert influence.first_order(factor, (factor[0] > 1.7).astype(float)) == pytest.approx([1.0], abs=0.01)


def test_what_one_factor_does_does_not_blur_the_others():
    """A factor without influence beside one that decides all but a hundredth: known to be without, from 400 runs."""
    rng = np.random.default_rng(7)
    samples = xr.Dataset({name: ("run", rng.standard_normal(400)) for name in ("speed_deviation", "road_friction")})
    measure = samples["speed_deviation"] + 0.1 * rng.standard_normal(400)
    found = influence.influence(measure, samples)["first_order"].sel(factor="road_friction")
    assert influence.verdict(*found.values[1:]) == "does not matter"


def test_measures_of_the_runs():
    found = influence.measures(**study(3))
    assert set(found) == {"a_v", "a_x", "a_y", "a_z", "iri"}
    assert all(values.shape == (6,) for values in found.values())
    assert found["a_x"] == pytest.approx(0.0) and np.all(found["a_y"] > 0.0)


def test_assessment_of_a_study_with_few_runs_is_agreement_alone():
    samples = xr.Dataset({"lateral_position": ("run", np.arange(6.0))})
    sites = {name: assessment.SiteResults(**study(seed), samples=samples) for name, seed in (("a", 1), ("b", 2))}
    found = assessment.gather(sites, repetitions=50)
    assert found["site"].values.tolist() == ["a", "b", "pooled"] and found["place"].values.tolist() == ["a", "b"]
    assert np.isfinite(found["kappa"]).any() and np.isnan(found["first_order"]).all() and not found["width"].size


def test_assessment_tells_what_moves_a_run():
    """A site of 400 runs whose a_v follows the lateral position alone."""
    parts, runs = study(1), 400
    lateral, friction = latin_hypercube(runs, 2, np.random.default_rng(9)).T
    names = ("a_x", "a_y", "a_z", "v_x", "a_v")
    s = parts["iso2631"]["s"].values
    signals = {name: (("run", "s"), np.full((runs, s.size), 20.0 if name == "v_x" else 0.0)) for name in names}
    signals["a_v"] = ("run", "s"), 0.45 + 0.1 * lateral[:, None] + 0.02 * np.sin(s / 40)
    shard = xr.Dataset(signals, {"run": np.arange(runs), "s": s})
    samples = xr.Dataset({"lateral_position": ("run", lateral), "road_friction": ("run", friction)})
    parts |= {"iso2631": iso2631.evaluate([shard]), "thresholds": thresholds.evaluate([shard])}
    parts["iri"] = parts["iri"].drop_vars("run_share").drop_vars("run").assign(
        run_share=(("quality", "run"), np.tile(np.arange(5.0)[:, None], (1, runs)))
    )
    found = assessment.gather({"a": assessment.SiteResults(**parts, samples=samples)}, repetitions=50).sel(place="a")
    told = found["rank_correlation"].sel(measure="a_v", bound="estimate")
    assert float(told.sel(factor="lateral_position")) == pytest.approx(1.0)
    assert abs(float(told.sel(factor="road_friction"))) < 0.3
    assert found["size"].values.tolist() == [25, 50] and int(found["open_sections"]) > 0
    width = found["width"]
    assert np.all(width.sel(scheme="latin_hypercube") < 0.7 * width.sel(scheme="monte_carlo"))


def test_a_quadratic_influence_shows_in_variance_and_not_in_rank():
    lateral = np.random.default_rng(6).standard_normal(4000)
    found = influence.influence(lateral**2, xr.Dataset({"lateral_position": ("run", lateral)}))
    assert float(found["first_order"].sel(bound="estimate").item()) > 0.9
    assert abs(found["spearman"].sel(bound="estimate").item()) < 0.1


INTERVALS = [
    ((0.2, 0.4), "matters"),
    ((-0.01, 0.02), "does not matter"),
    ((0.01, 0.2), "cannot be said"),
    ((np.nan, np.nan), "cannot be said"),
]


@pytest.mark.parametrize("interval, said", INTERVALS)
def test_what_an_interval_says_of_an_influence(interval, said):
    assert influence.verdict(*interval) == said


def test_what_is_closer_to_the_iri_comes_with_an_interval():
    sites = {name: methods.site(**study(seed)) for name, seed in (("a", 1), ("b", 2))}
    found = methods.agree(sites, repetitions=100)
    kappa = found["kappa"].sel(bound="estimate")
    difference = kappa.sel(pair="iso2631 - iri") - kappa.sel(pair="thresholds - iri")
    assert found["kappa_difference"].sel(bound="estimate").values == pytest.approx(difference.values)
    assert np.all(found["kappa_difference"].sel(bound="lower") <= found["kappa_difference"].sel(bound="upper"))


def test_mistakes_are_named():
    with pytest.raises(InputError, match="square"):
        agreement.kappa(np.ones((2, 3)))
    with pytest.raises(InputError, match="beyond"):
        agreement.confusion([0, 7], [0, 1], (5, 5))
    with pytest.raises(InputError, match="too short"):
        agreement.lag([(np.arange(50.0), np.arange(50.0))], 1.0)
    with pytest.raises(InputError, match="too few"):
        influence.first_order([np.arange(5)], np.arange(5))
