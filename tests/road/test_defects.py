"""Dips and bumps of a road are found where they are; unevenness, hills and bends are none."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.road import clean, defects
from ridecomfort.standin import defects as planting
from ridecomfort.standin import texture

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


@pytest.mark.parametrize("height", [-0.01, -0.002, 0.002])
def test_a_joint_across_the_road_is_one_joint_also_where_it_is_low(road, height):
    found = defects.find(changed(road, np.s_[700:702, :], height))
    assert found["kind"].values.tolist() == ["joint"] and found.width.item() == pytest.approx(4.1)
    assert found.u_middle.item() == pytest.approx(70.05) and found.length.item() == pytest.approx(0.2)
    assert found.height.item() == pytest.approx(height, abs=2e-4)


def test_a_pothole_in_a_joint_is_found_beside_it(road):
    joint = changed(road, np.s_[700:702, :], -0.006)
    found = defects.find(changed(joint, np.s_[699:704, 8:13], -0.03))
    assert sorted(found["kind"].values.tolist()) == ["dip", "joint"]


def test_what_crosses_less_than_half_of_the_road_is_no_joint(road):
    found = defects.find(changed(road, np.s_[700:702, :18], -0.01))
    assert found["kind"].values.tolist() == ["dip"]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("unevenness, joints_found", [(16e-6, 0.9), (64e-6, 0.6)])
def test_potholes_and_joints_of_a_rough_road_are_found(seed, unevenness, joints_found):
    """Of class A and B (ISO 8608), waviness 2.1, with potholes and joints of the sizes that stand-in roads have."""
    rng = np.random.default_rng(seed)
    u, v = np.arange(10_000) * 0.1, np.linspace(-2, 2, 41)
    unit = texture.fields(rng, u.size, 0.1, v, wavinesses=[2.1], wavenumber_minimum=0.01, wavenumber_maximum=5.0)[0]
    elevation = np.sqrt(unevenness / texture.UNIT_DENSITY) * unit
    planted = [planting.draw(rng, kind, at, 4.0) for at, kind in zip(np.arange(20.0, 980, 20), 24 * ["pothole", "joint"])]
    for defect in planted:
        planting.add(elevation, u, v, defect)
    found = defects.find(xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", 0 * u)}, {"u": u, "v": v}))
    near = np.abs(found.u_middle.values - np.array([[one.u] for one in planted])) < 1.0
    for kind, seen, least in (("pothole", "dip", 0.9), ("joint", "joint", joints_found)):
        which = [one.kind == kind for one in planted]
        assert (near & (found["kind"].values == seen)).any(axis=1)[which].mean() >= least
    false = ~near.any(axis=0) & (found["kind"].values == "joint")
    assert false.sum() <= 5


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
