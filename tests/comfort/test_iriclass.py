"""Classes of ride quality at the speed driven."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import iri, iriclass
from ridecomfort.errors import InputError


def test_edges_at_the_printed_speeds_are_the_printed_ones():
    """tab:IRI_thresholds at 80 and 50 km/h."""
    edges = iriclass.Edges()
    assert edges.at(80 / 3.6) == pytest.approx([1.43, 2.24, 2.84, 4.05])
    assert edges.at(50 / 3.6) == pytest.approx([2.28, 3.59, 4.54, 6.25])


def test_edges_follow_one_over_v_between_and_beyond():
    """VG is 114 / v(km/h) but for rounding; linear interpolation in v errs by up to 13 %."""
    edges = iriclass.Edges()
    speed_km_h = np.array([8.0, 15.0, 25.0, 45.0, 90.0, 110.0, 130.0])
    assert edges.at(speed_km_h / 3.6)[0] == pytest.approx(114.4 / speed_km_h, rel=5e-3)
    linear = np.interp(15.0, [10.0, 20.0], [11.44, 5.72])
    assert linear / edges.at(15.0 / 3.6)[0] == pytest.approx(1.125, rel=1e-3)


def test_speed_at_which_a_class_is_lost_is_the_inverse():
    edges = iriclass.Edges()
    rough = np.array([0.5, 1.0, 2.5, 6.0, 40.0])
    for quality, speed in enumerate(edges.speed(rough)):
        assert [edges.at(v)[quality] for v in speed] == pytest.approx(rough)


def test_tracks_interpolate_across_the_road_and_name_holes():
    u, v = np.arange(0, 50, 0.5), np.array([-1.0, 0.0, 1.0])
    heights = 0.01 * u[:, None] + 0.1 * v
    road = xr.Dataset({"elevation": (("u", "v"), heights)}, {"u": u, "v": v})
    assert np.allclose(iriclass.tracks(road, (-0.75, 1.0)), 0.01 * u + [[-0.075], [0.1]])
    with pytest.raises(InputError, match="outside the road"):
        iriclass.tracks(road, (-2.0,))
    heights[20, 0] = np.nan
    with pytest.raises(InputError, match="u = 10 m"):
        iriclass.tracks(road, (-0.5,))


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


def test_edges_out_of_order_are_refused():
    with pytest.raises(InputError, match="rise from class to class"):
        iriclass.Edges((80, 60), {"VG": (1.0, 2.0), "G": (0.9, 3.0), "F": (3.0, 4.0), "M": (4.0, 5.0)})
    with pytest.raises(InputError, match="expected 2 edges"):
        iriclass.Edges((80, 60), {"VG": (1.0,), "G": (2.0,), "F": (3.0,), "M": (4.0,)})


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
