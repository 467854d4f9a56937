"""Classes of a condition hold equal times, and tell nothing apart that is alike."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import classes


def _drive(error, signal, **series):
    return SimpleNamespace(rate=100.0, error=error, signal=signal, series=series)


def _held(values) -> list[int]:
    edge = classes.edges(np.asarray(values))
    return np.bincount(classes._class(np.asarray(values), edge), minlength=classes.CLASSES).tolist()


def test_classes_of_what_changes_evenly_last_equally_long():
    values = np.random.default_rng(0).permutation(np.linspace(10.0, 30.0, 1000))
    assert classes.edges(values) == pytest.approx([10.0, 14.0, 18.0, 22.0, 26.0, 30.0])
    assert _held(values) == [200] * 5


def test_a_steady_speed_has_no_classes():
    assert sorted(_held(20.0 + 0.1 * np.sin(np.arange(1000)))) == [0, 0, 0, 0, 1000]
    assert sorted(_held(np.full(1000, 20.0))) == [0, 0, 0, 0, 1000]


@pytest.mark.parametrize("slow", [200, 450, 500, 800])
def test_two_steady_speeds_are_two_classes_whose_edge_lies_between_them(slow):
    values = np.where(np.arange(1000) < slow, 14.0, 22.0) + 0.1 * np.sin(np.arange(1000))
    assert [held for held in _held(values) if held] == [slow, 1000 - slow]
    assert 18.0 in classes.edges(values).round(1)


def test_a_drive_shorter_than_the_running_mean_has_that_of_all_of_it():
    assert classes._slow(np.arange(76.0), 100.0).shape == (76,)
    assert classes._slow(np.full(76, 3.0), 100.0) == pytest.approx(np.full(76, 3.0))


def test_what_is_near_nil_keeps_its_classes_however_small_beside_the_largest():
    """Curvature of a road with few bends."""
    assert _held(np.geomspace(1e-5, 1e-1, 1000)) == [200] * 5


def test_powers_of_classes_make_that_of_the_drives_and_shares_make_one():
    rng = np.random.default_rng(1)
    drives = []
    for speed, count in ((14.0, 3000), (22.0, 2000)):
        error, signal = rng.standard_normal((2, 3, count))
        drives.append(_drive(error, signal, v_x=np.full(count, speed), yaw_rate=rng.random(count)))
    found = classes.by_condition(drives, [(2.0, 8.0), (8.0, 40.0)])
    np.testing.assert_allclose(found["condition_share"].sum("class"), 1.0)
    for key in ("error", "measured"):
        whole = (found["condition_share"] * found[f"condition_{key}"]).sum("class")
        np.testing.assert_allclose(whole.sel(condition="speed"), whole.sel(condition="curvature"))
    np.testing.assert_allclose(whole.sum("band").sel(condition="speed"), 38.0 / 50.0, rtol=0.1)
    level = found["condition_level"].sel(condition="speed").values
    assert level[np.isfinite(level)] == pytest.approx([14.0, 22.0])


def test_a_condition_that_one_drive_does_not_know_is_left_out():
    known = _drive(np.ones((1, 500)), np.ones((1, 500)), v_x=np.arange(500.0), yaw_rate=np.arange(500.0))
    unknown = _drive(np.ones((1, 500)), np.ones((1, 500)), v_x=np.arange(500.0))
    assert classes.by_condition([known, unknown], [(2.0, 8.0)])["condition"].values.tolist() == ["speed"]
