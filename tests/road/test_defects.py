"""Dips and bumps of a road are found where they are; unevenness, hills and bends are none."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.road import clean, defects

U, V = np.arange(2000) * 0.1, np.linspace(-2.0, 2.0, 41)


@pytest.fixture(scope="module")
def road() -> xr.Dataset:
    """200 m of a banked hill with waves of 10 mm and 20 m length, and texture of 0.3 mm."""
    bank = 0.05 * np.sin(U / 40)
    hill = 3.0 * np.sin(U / 50) + 0.01 * np.sin(2 * np.pi * U / 20)
    texture = np.random.default_rng(1).normal(0, 3e-4, (U.size, V.size))
    elevation = hill[:, None] + bank[:, None] * V + texture
    return xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", bank)}, coords={"u": U, "v": V})


def changed(road, at, by):
    road = road.copy(deep=True)
    road["elevation"][at] = road["elevation"][at] + by
    return road


def test_a_sound_road_has_none(road):
    assert defects.find(road).sizes["defect"] == 0


@pytest.mark.parametrize("depth, kind", [(-0.03, "dip"), (0.012, "bump")])
def test_place_size_and_height(road, depth, kind):
    found = defects.find(changed(road, np.s_[1000:1006, 25:29], depth))
    assert found["kind"].values.tolist() == [kind]
    assert found.u_middle.item() == pytest.approx(100.25, abs=0.051)
    assert found.v_middle.item() == pytest.approx(V[25:29].mean(), abs=0.051)
    assert (found.length.item(), found.width.item()) == pytest.approx((0.6, 0.4), abs=0.11)
    assert found.height.item() == pytest.approx(depth, abs=0.002) and found.cells.item() == pytest.approx(24, abs=3)


def test_neighbours_are_told_apart_and_stand_in_order(road):
    two = changed(changed(road, np.s_[1500:1504, 5:9], -0.02), np.s_[300:304, 30:34], 0.02)
    found = defects.find(two)
    assert found["kind"].values.tolist() == ["bump", "dip"]


def test_a_joint_across_the_road_is_one_dip(road):
    found = defects.find(changed(road, np.s_[700:702, :], -0.01))
    assert found.sizes["defect"] == 1 and found.width.item() == pytest.approx(4.1)


def test_treated_cells_are_listed_by_what_was_done(road):
    dirty = changed(road, np.s_[400, 10], 0.2)
    dirty["elevation"][800:803, 20:23] = np.nan
    for choice, kind in (("repair", "outlier repaired"), ("report", "outlier kept")):
        cleaned, _ = clean.clean(dirty, outliers=choice, holes="fill")
        assert defects.find(cleaned)["kind"].values.tolist() == [kind, "hole filled"]


def test_outside_the_edges_there_is_nothing(road):
    frayed = road.copy(deep=True)
    frayed["elevation"][500:900, :6] = np.nan
    assert defects.find(frayed).sizes["defect"] == 0
    assert np.isnan(defects.deviation(frayed)[500:900, :6]).all()
