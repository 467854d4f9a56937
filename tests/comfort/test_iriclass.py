"""Classes of ride quality at the speed driven."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import iri, iriclass
from ridecomfort.errors import InputError


def study(runs: int = 40):
    rng = np.random.default_rng(3)
    u = np.arange(0, 400, 0.1)
    profile = np.cumsum(rng.standard_normal(len(u))) * 3e-4 * (1 + (u > 200))
    road = xr.Dataset({"elevation": (("u", "v"), np.repeat(profile[:, None], 3, 1))}, {"u": u, "v": [-1.0, 0.0, 1.0]})
    s = 50.0 + 0.25 * np.arange(1200)
    speed = (15.0 + 5 * rng.standard_normal((runs, 1)) + 0.01 * s).astype(np.float32)
    shard = xr.Dataset({"v_x": (("run", "s"), speed)}, {"run": np.arange(runs), "s": s})
    return road, shard


def test_evaluate_counts_whole_windows_by_plain_loops():
    road, shard = study()
    found = iriclass.evaluate([shard], road)
    survey = iri.survey(road["elevation"].values[:, 1], road["u"].values, shard["s"].values)
    assert found["iri"].values == pytest.approx(survey)
    edges = iriclass.Edges()
    for run in (0, 7):
        quality = edges.quality(survey, shard["v_x"].values[run].astype(float)).reshape(-1, 20)
        whole = [np.sum(np.all(quality == q, axis=1)) for q in range(5)]
        assert np.round(found["run_share"].values[:, run] * 60 / 100) == pytest.approx(whole)
    quality = edges.quality(survey, shard["v_x"].values.astype(float).mean(axis=0)).reshape(-1, 20)
    assert found["critical_count"].values.tolist() == [np.all(quality == q, axis=1).sum() for q in range(5)]
    assert found.sizes["window"] == 60
    assert np.isinf(found["threshold"].sel(quality="P")).all()
    assert found["iri_track"].mean("track").values == pytest.approx(found["iri"].values)
    assert found["hri"].values == pytest.approx(found["iri"].values)  # both tracks of this road are equal


def test_places_beyond_the_road_are_refused():
    road, shard = study()
    with pytest.raises(InputError, match="leave the road"):
        iriclass.evaluate([shard], road.isel(u=slice(0, 2000)))


def test_shards_do_not_matter():
    road, shard = study()
    whole = iriclass.evaluate([shard], road)
    parts = iriclass.evaluate([shard.isel(run=slice(a, a + 7)) for a in range(0, 40, 7)], road)
    xr.testing.assert_identical(whole, parts)


def test_the_survey_hides_what_the_continuous_iri_shows():
    """A pothole of 40 mm on a smooth road: poor where it lies, not so in the mean of 50 m."""
    u = np.arange(0, 400, 0.1)
    rng = np.random.default_rng(4)
    profile = np.cumsum(rng.standard_normal(len(u))) * 2e-4
    profile[(u > 210) & (u < 210.6)] -= 0.04
    road = xr.Dataset({"elevation": (("u", "v"), np.repeat(profile[:, None], 3, 1))}, {"u": u, "v": [-1.0, 0.0, 1.0]})
    s = 50.0 + 0.25 * np.arange(1200)
    shard = xr.Dataset({"v_x": (("run", "s"), np.full((3, 1200), 80 / 3.6))}, {"run": [0, 1, 2], "s": s})
    found = iriclass.evaluate([shard], road)
    assert int(found["critical_count"].sel(quality="P")) == 0
    rough = found["critical_full"].sel(quality="P").values.astype(bool)
    assert rough.any() and np.all(np.abs(found["window_start"].values[rough] - 210.0) < 15.0)
