"""How an instrument sits in the vehicle, and whether it did so on every drive."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort.drive import mounting


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
