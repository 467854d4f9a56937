"""Planted measurement failures are found, planted defects of the road are kept."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.errors import InputError
from ridecomfort.road import clean

U, V = np.arange(3000) * 0.1, np.linspace(-2.0, 2.0, 41)


@pytest.fixture(scope="module")
def road() -> xr.Dataset:
    """300 m of a climbing, crowned, banked road, rough as class B along (w = 2) and textured by 0.3 mm."""
    rng = np.random.default_rng(1)
    n = np.fft.rfftfreq(len(U), 0.1)[1:]
    amplitude = np.sqrt(2 * 64e-6 * (n / 0.1) ** -2 * n[0]) * len(U) / 2
    phase = rng.random((len(n), 2)) * 2 * np.pi
    left, right = (np.fft.irfft(np.append(0, amplitude * np.exp(1j * phase[:, k])), len(U)) for k in (0, 1))
    share = (V - V[0]) / 4
    rough = left[:, None] * share + right[:, None] * (1 - share)
    bank = 0.06 * np.sin(2 * np.pi * U / 150)
    elevation = rough + 0.07 * U[:, None] - 0.01 * V**2 + bank[:, None] * V + rng.normal(0, 3e-4, rough.shape)
    return xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", bank)}, coords={"u": U, "v": V})


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("share", [1e-4, 1e-3, 1e-2])
def test_outliers_are_found_and_nothing_else(road, share, seed):
    rng = np.random.default_rng(seed)
    planted = rng.random(road.elevation.shape) < share
    size = rng.choice([-1, 1], planted.shape) * 10 ** rng.uniform(-2, 0.5, planted.shape)
    found = clean.find_outliers(road.elevation.values + planted * size)
    assert (found & planted).sum() >= 0.99 * planted.sum()
    assert (found & ~planted).sum() <= 0.01 * planted.sum()


def test_a_sound_road_has_no_outliers(road):
    assert not clean.find_outliers(road.elevation.values).any()


def disc(diameter, depth, shape):
    """Potholes every 10 m, alternately right and left: sharp-edged or bowls."""
    change = np.zeros((len(U), len(V)))
    for k, middle in enumerate(np.arange(5.03, 295, 10)):
        r = np.hypot(U[:, None] - middle, V - (0.75, -0.82)[k % 2]) / (diameter / 2)
        change += depth * (np.where(r < 1, 1.0, 0.0) if shape == "sharp" else np.cos(np.minimum(r, 1) * np.pi / 2) ** 2)
    return change


def line(which, depth):
    """Joints and cracks one cell wide: across the road, half across, along it, slanting, or a step of a patch."""
    change = np.zeros((len(U), len(V)))
    rows = np.arange(50, len(U) - 80, 97)
    if which == "across":
        change[rows] = depth
    elif which == "half across":
        change[rows, 20:] = depth
    elif which == "along":
        change[:, 17] = depth
    elif which == "slanting":
        for k in range(30):
            change[rows + k, 5 + k] = depth
    elif which == "patch":
        for row in rows:
            change[row : row + 40, 22:34] = depth
    return change


DEFECTS = {
    **{f"sharp pothole of {d} m, {h} m": disc(d, h, "sharp") for d in (0.3, 0.5, 0.8) for h in (-0.02, -0.1)},
    **{f"bowl of {d} m, {h} m": disc(d, h, "bowl") for d in (0.3, 0.5, 1.2) for h in (-0.02, -0.1)},
    **{
        f"{which}, {h} m": line(which, h)
        for which in ("across", "half across", "along", "slanting", "patch")
        for h in (-0.02, -0.006, 0.006)
    },
}


@pytest.mark.parametrize("name", DEFECTS)
def test_potholes_joints_and_patches_keep_their_depth(road, name):
    defect = DEFECTS[name]
    damaged = road.assign(elevation=road.elevation + defect)
    cleaned, _ = clean.clean(damaged, outliers="repair")
    kept = (cleaned.elevation - road.elevation).values
    deep = np.abs(defect) > 0.9 * np.abs(defect).max()
    assert kept[deep].mean() / defect[deep].mean() > 0.98


def test_a_leaf_in_the_beam_is_no_bump(road):
    elevation = road.elevation.values.copy()
    elevation[1000:1003, 10:13] += 0.2
    found = clean.find_outliers(elevation)
    assert np.argwhere(found).tolist() == [[i, j] for i in range(1000, 1003) for j in range(10, 13)]


@pytest.mark.parametrize("place", [np.s_[:, 8:10], np.s_[1000:1002, :], np.s_[:, 30:]])
def test_kerbs_and_ridges_are_no_leaves(road, place):
    elevation = road.elevation.values.copy()
    elevation[place] += 0.12
    assert clean.find_outliers(elevation).sum() <= 2


def test_repaired_outliers_come_back_to_the_road(road):
    rng = np.random.default_rng(3)
    planted = rng.random(road.elevation.shape) < 1e-3
    dirty = road.assign(elevation=road.elevation + planted * 0.2)
    cleaned, report = clean.clean(dirty, outliers="repair")
    error = (cleaned.elevation - road.elevation).values
    assert np.abs(error).max() < 0.006 and np.sqrt((error[planted] ** 2).mean()) < 0.001
    assert report.outliers == planted.sum() == int((cleaned.treated == clean.OUTLIER).sum())
    assert report.share_changed == pytest.approx(planted.mean())
    assert report.largest_change == pytest.approx(0.2, abs=0.006)
    before, after = report.spectra.unevenness.sel(state=["before", "after"]).mean("v").values
    assert before > after
    assert f"{planted.sum()} outliers repaired" in cleaned.treatment


def test_by_default_outliers_are_reported_and_kept(road):
    dirty = road.copy(deep=True)
    dirty.elevation[50, 20] += 0.05
    cleaned, report = clean.clean(dirty)
    np.testing.assert_array_equal(cleaned.elevation, dirty.elevation)
    assert "1 cells look like outliers, the first at u = 5 m, v = 0 m: kept" in cleaned.treatment
    assert report.outliers == 0
    with pytest.raises(InputError, match="1 outliers, the first at u = 5 m"):
        clean.clean(dirty, outliers="refuse")


def test_holes_are_refused_or_filled_inside_the_road_only(road):
    torn = road.copy(deep=True)
    torn.elevation[100:104, 10:20] = np.nan
    torn.elevation[200:202] = np.nan
    torn.elevation[:, :2] = np.nan
    with pytest.raises(InputError, match=r"118 cells without a height \(holes\), the first at u = 10 m.*holes: fill"):
        clean.clean(torn)
    filled, report = clean.clean(torn, holes="fill")
    assert report.filled == 118
    assert np.isnan(filled.elevation.values[:, :2]).all() and np.isfinite(filled.elevation.values[:, 2:]).all()
    assert float(np.abs(filled.elevation - road.elevation).max()) < 0.01


def test_a_plane_is_filled_exactly():
    plane = 3 + 0.07 * U[:50, None] - 0.05 * V
    torn = plane.copy()
    torn[20:25, 3:9] = np.nan
    np.testing.assert_allclose(clean.fill(torn, (0.1, 0.1)), plane, atol=1e-12)


def test_long_holes_are_not_made_up(road):
    torn = road.copy(deep=True)
    torn.elevation[100:115, 5] = np.nan
    with pytest.raises(InputError, match=r"road.holes: holes over 1.5 m to u = 11.4 m, v = -1.5 m; at most 1 m are filled"):
        clean.clean(torn, holes="fill")


def test_long_runs_of_outliers_are_called_so(road, monkeypatch):
    wild = np.zeros(road.elevation.shape, dtype=bool)
    wild[100:112, 20] = True
    monkeypatch.setattr(clean, "find_outliers", lambda *_: wild)
    with pytest.raises(InputError, match=r"road.outliers: outliers over 1.2 m to u = 11.1 m, v = 0 m"):
        clean.clean(road, outliers="repair")


@pytest.mark.parametrize("choice", ["report", "repair"])
def test_a_grid_too_coarse_to_be_tested_for_outliers_is_said_to_be(road, choice):
    wide = road.isel(u=slice(None, None, 10)).copy(deep=True)
    assert "no holes; cells of 1 m x 0.1 m are too coarse" in clean.clean(wide, outliers=choice)[0].treatment
    wide.elevation[20, 7] = np.nan
    assert "1 cells of holes filled" in (said := clean.clean(wide, outliers=choice, holes="fill")[0].treatment)
    assert "cells of 1 m x 0.1 m are too coarse to be tested for outliers" in said
    with pytest.raises(InputError, match="road.outliers: cells of 1 m x 0.1 m are too coarse"):
        clean.clean(wide, outliers="refuse")


def test_unknown_choices_are_named(road):
    with pytest.raises(InputError, match="road.outliers.*report, refuse, repair"):
        clean.clean(road, outliers="drop")


def test_a_dip_of_one_cell_is_kept_where_many_points_of_a_scan_saw_it(road):
    torn = road.copy(deep=True)
    torn["elevation"].values[[500, 900], [10, 30]] -= 0.03
    support = np.full(torn.elevation.shape, 90)
    support[900, 30] = 3
    cleaned, report = clean.clean(torn.assign(support=(("u", "v"), support)), outliers="repair")
    assert report.outliers == 1 and int(cleaned.treated[900, 30]) == clean.OUTLIER
    assert float(cleaned.elevation[500, 10]) == float(torn.elevation[500, 10])


def test_a_leaf_that_many_points_saw_is_no_road(road):
    leaf = road.copy(deep=True)
    leaf["elevation"][1000, 20] += 0.2
    cleaned, report = clean.clean(leaf.assign(support=(("u", "v"), np.full(leaf.elevation.shape, 90))), outliers="repair")
    assert report.outliers == 1


def test_a_cross_section_that_a_scan_lost_but_for_its_edge_is_filled(road):
    """And the edge of the swath, which wanders inwards over tens of metres, is left as it is."""
    torn = road.copy(deep=True)
    torn["elevation"][700, 1:] = np.nan
    torn["elevation"][1500:1900, 38:] = np.nan
    cleaned, report = clean.clean(torn.assign(support=(("u", "v"), np.full(torn.elevation.shape, 90))), holes="fill")
    assert report.filled == 40 and np.isfinite(cleaned.elevation[700]).all()
    assert np.isnan(cleaned.elevation[1500:1900, 38:]).all()
