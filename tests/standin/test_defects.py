"""Local defects have the size that they say, where they say."""

import numpy as np
import pytest

from ridecomfort.standin import defects

U, V = np.arange(0.0, 100.05, 0.1), np.linspace(-2.0, 2.0, 41)


def surface_of(defect):
    elevation = np.zeros((len(U), len(V)))
    defects.add(elevation, U, V, defect)
    return elevation


def test_a_pothole_is_a_bowl_of_its_depth():
    hole = surface_of(defects.Defect("pothole", 50.0, 0.7, 0.8, 0.6, -0.04))
    assert hole.min() == pytest.approx(-0.04)
    assert np.unravel_index(hole.argmin(), hole.shape) == (500, 27)
    touched = np.argwhere(hole < 0.0)
    assert np.ptp(U[touched[:, 0]]) <= 0.8 and np.ptp(V[touched[:, 1]]) <= 0.6
    assert hole.max() == 0.0


def test_a_patch_is_flat_inside_with_edges_that_the_grid_can_hold():
    patch = surface_of(defects.Defect("patch", 50.0, -1.0, 4.0, 1.2, 0.006))
    inside = patch[np.abs(U - 50.0) < 1.9][:, np.abs(V + 1.0) < 0.49]
    np.testing.assert_allclose(inside, 0.006)
    assert np.abs(np.diff(patch, axis=0)).max() <= 0.5 * 0.006 + 1e-12


def test_a_joint_crosses_the_whole_road():
    joint = surface_of(defects.Defect("joint", 50.0, 0.0, 0.3, 8.0, 0.003))
    np.testing.assert_allclose(joint[500], 0.003)
    assert np.flatnonzero(joint[:, 20]).size < 6


@pytest.mark.parametrize("kind", ["pothole", "patch", "joint", "settlement"])
def test_drawn_defects_touch_the_road_and_stay_within_bounds(kind):
    rng = np.random.default_rng(4)
    for _ in range(50):
        defect = defects.draw(rng, kind, 50.0, 4.0)
        assert 0.001 < np.abs(surface_of(defect)).max() <= 0.05
        if kind == "pothole":
            assert defect.height < 0.0


def test_an_unknown_kind_is_refused():
    with pytest.raises(ValueError, match="crater"):
        defects.draw(np.random.default_rng(0), "crater", 1.0, 4.0)
