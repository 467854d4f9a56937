"""How an instrument sits in the vehicle, and whether it did so on every drive."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from ridecomfort.drive import mounting, record
from ridecomfort.vocabulary import SIGNALS


def drives(*yaws: float) -> xr.Dataset:
    """Aligned drives whose instruments are turned about the vertical by these angles in degrees."""
    angles = {"roll": np.full(len(yaws), 0.005), "pitch": np.full(len(yaws), -0.003), "yaw": np.radians(yaws)}
    names = [f"lap_{number}" for number in range(1, len(yaws) + 1)]
    return xr.Dataset({f"mounting_{axis}": ("drive", found) for axis, found in angles.items()}, {"drive": names})


def test_an_instrument_that_was_moved_for_one_drive_is_told_with_its_angles():
    (said,) = mounting.moved(drives(-0.07, 2.13, -0.05, 0.02))
    assert said.startswith("lap_2: the instrument is turned by +0.0 deg in roll, +0.0 deg in pitch, +2.1 deg in yaw against the other drives")


def test_what_a_load_or_the_error_of_alignment_makes_is_not():
    assert mounting.moved(drives(0.3, -0.4, 0.1)) == []


def test_of_two_drives_nobody_knows_which_was_moved():
    assert mounting.moved(drives(0.0, 3.0)) == []


def test_drives_without_gravity_whose_mounting_is_not_sought_are_left_out():
    measured = drives(3.0, 3.1, 3.0, 0.0, 0.0, 0.0, 0.0)
    assert len(mounting.moved(measured)) == 3
    assert mounting.moved(measured.assign(gravity=("drive", [1, 1, 1, 0, 0, 0, 0]))) == []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert mounting.moved(measured.assign(gravity=("drive", [0] * 7))) == []


@pytest.fixture
def drive() -> xr.Dataset:
    """A record of white noise that holds gravity, with an attitude."""
    rng = np.random.default_rng(1)
    signals = {name: ("time", rng.standard_normal(50)) for name in SIGNALS}
    attitude = {name: ("time", 0.1 * rng.standard_normal(50)) for name in ("roll", "pitch")}
    return xr.Dataset(signals | attitude, {"time": 0.01 * np.arange(50)}, {"gravity": 1})


def read(drive: xr.Dataset, found: mounting.Mounting) -> xr.Dataset:
    """The drive as an instrument with this mounting reads it."""
    back = Rotation.from_rotvec(found.rotation).inv().as_matrix()
    force = found.gain * back @ record.felt(drive)
    rates = back @ np.stack([drive[name].values for name in SIGNALS[3:]]) + np.array(found.bias)[:, None]
    values = np.concatenate([record.acceleration(force, drive["roll"].values, drive["pitch"].values), rates])
    return drive.assign({name: ("time", row) for name, row in zip(SIGNALS, values)})


def test_an_instrument_that_is_turned_far_is_turned_back(drive):
    found = mounting.Mounting(1.02, (0.2, -0.25, 0.4), (0.01, -0.02, 0.03))
    xr.testing.assert_allclose(mounting.corrected(read(drive, found), found), drive, rtol=0, atol=1e-12)


def test_two_mountings_behind_one_another_are_one(drive):
    first, step = mounting.Mounting(1.02, (0.2, -0.25, 0.4), (0.01, -0.02, 0.03)), mounting.Mounting(0.99, (-0.1, 0.2, 0.3), (0.02, 0.01, -0.01))
    after_another = mounting.corrected(mounting.corrected(drive, first), step)
    xr.testing.assert_allclose(mounting.corrected(drive, first.then(step)), after_another, rtol=0, atol=1e-12)


def test_a_large_yaw_is_told():
    assert mounting.words(mounting.Mounting(rotation=(0.3, 0.3, np.radians(20.0)))) == ""
    assert mounting.words(mounting.Mounting(rotation=(0.0, 0.0, np.radians(-30.0)))).startswith("the instrument is turned by -30 deg in yaw: are a_x")
