"""Thresholds of acceleration and jerk, and what is kept of many runs."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import iso2631, limits, sections, thresholds
from ridecomfort.errors import InputError

S = 50.0 + 0.25 * np.arange(407)


def shard(runs: int = 30) -> xr.Dataset:
    """Slow waves along the road that differ from run to run, as a space shard holds them."""
    rng = np.random.default_rng(7)
    waves = {}
    for name, scale in (("a_x", 2.0), ("a_y", 5.0), ("a_z", 0.3)):
        phase, offset = rng.normal(0, 0.3, (runs, 1)), rng.normal(0, scale / 5, (runs, 1))
        waves[name] = (scale * np.sin(S / 9 + phase) + offset).astype(np.float32)
    waves["a_v"] = np.abs(waves["a_x"])
    signals = {name: (("run", "s"), values) for name, values in waves.items()}
    return xr.Dataset(signals, {"run": 100 + np.arange(runs), "s": S})


def test_published_thresholds():
    """tab:thresholds_manual; AG deceleration -5.08 m/s2 (docs/method.md)."""
    assert (limits.ACCELERATION["a_x"]["AG"].lower, limits.ACCELERATION["a_x"]["AG"].upper) == (-5.08, 3.07)
    assert limits.ACCELERATION["a_y"]["ND"].upper == 4.0
    assert all(band.source for styles in limits.ACCELERATION.values() for band in styles.values())


def test_evaluate_by_plain_loops():
    runs = shard()
    found = thresholds.evaluate([runs])
    assert found.sizes["window"] == 20
    for axis in ("a_x", "a_y", "a_z"):
        values = runs[axis].values.astype(float)
        assert found[axis].values == pytest.approx(values.mean(axis=0))
        for style, band in limits.ACCELERATION[axis].items():
            outside = (values < band.lower) | (values > band.upper)
            critical = outside[:, :400].reshape(30, 20, 20).all(axis=2)
            here = found.sel(axis=axis, style=style)
            assert here["exceedance_probability"].values == pytest.approx(critical.mean(axis=0))
            assert here["run_share"].values == pytest.approx(100 * critical.mean(axis=1))
            mean = values.mean(axis=0)[:400].reshape(20, 20)
            expected = np.all((mean < band.lower) | (mean > band.upper), axis=1)
            assert here["critical"].values.tolist() == expected.tolist()
            assert int(here["critical_count"]) == expected.sum()
            assert float(here["critical_share"]) == pytest.approx(100 * expected.mean())
    assert np.all(found["exceedance_lower"] <= found["exceedance_probability"])
    assert np.all(found["exceedance_upper"] >= found["exceedance_probability"])


@pytest.mark.parametrize("evaluate", [thresholds.evaluate, iso2631.evaluate])
def test_shards_do_not_matter(evaluate):
    runs = shard()
    parts = evaluate(runs.isel(run=slice(a, a + 4)) for a in range(0, 30, 4))
    xr.testing.assert_identical(evaluate([runs]), parts)


def test_sliding_windows_hold_the_sequential_ones():
    found, sliding = (thresholds.evaluate([shard()], sliding=each) for each in (False, True))
    assert sliding.sizes["window"] == 388
    same = sliding["exceedance_probability"].values[..., ::20]
    assert np.array_equal(same, found["exceedance_probability"].values)


def test_bands_of_the_mean_run_may_both_hold_a_window():
    runs = shard(1).assign(a_v=(("run", "s"), np.full((1, S.size), 0.55, np.float32)))
    found = iso2631.evaluate([runs])
    assert found["band"].values[found["critical"].values.all(axis=1)].tolist() == ["LU", "FU"]
    assert found["critical_count"].values.tolist() == [0, 20, 20, 0, 0, 0]
    assert found["window_mean"].values == pytest.approx(0.55)


@pytest.mark.parametrize(
    "shards, message",
    [
        ([], "no run"),
        ([shard(2).assign(a_y=(("run", "s"), np.full((2, S.size), np.nan)))], "run 100: a_y has a gap"),
        ([shard(2), shard(2).isel(s=slice(5, None))], "same places"),
    ],
)
def test_mistakes_are_named(shards, message):
    with pytest.raises(InputError, match=message):
        thresholds.evaluate(shards)


def test_configured_bands():
    bands = limits.bands({"a_x": {"PT": [-1, 2]}})
    assert bands["a_x"]["PT"] == limits.Band(-1, 2, "as configured")
    assert limits.bands({"a_z": {"AG": [-0.3, 0.3]}})["a_z"]["AG"].source == limits.DATA
    assert limits.bands({"a_z": {"AG": [-0.2, 0.2, "own survey"]}})["a_z"]["AG"].source == "own survey"
    mixed = limits.bands({"a_y": {"AG": [-5, 5], "PT": [-1, 1], "ND": [-3, 3]}})
    assert list(mixed["a_y"]) == ["PT", "ND", "AG"]  # mildest first, in whatever order they are written
    with pytest.raises(InputError, match=r"thresholds: a_x: PT: \[2, -1\], expected a value below 0 and one above it"):
        limits.bands({"a_x": {"PT": [2, -1]}})
    with pytest.raises(InputError, match="expected PT"):
        thresholds.evaluate([shard()], {"a_x": {"PT": [-1, 1]}, "a_y": {"ND": [-1, 1]}})


def test_sections_of_the_mean_agree_with_the_public_door():
    runs = shard()
    found = thresholds.evaluate([runs])
    band = limits.ACCELERATION["a_y"]["PT"]
    door = sections.critical(found["a_y"], S, (band.lower, band.upper))
    assert np.array_equal(door["critical"].values, found["critical"].sel(axis="a_y", style="PT").values.astype(bool))
