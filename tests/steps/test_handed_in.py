"""The step that takes drives of another simulator."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.steps import handed_in
from ridecomfort.vocabulary import SIGNALS, describe

TIME = np.arange(1000) / 100.0
SPEED = 20.0
PITCH = 0.3 * np.sin(2 * np.pi * 1.5 * TIME)
"""rad/s; the pitch rate of the drive."""
TURNING = 0.3 * 2 * np.pi * 1.5 * np.cos(2 * np.pi * 1.5 * TIME)
"""rad/s2; its derivative."""


def centre_of_gravity() -> dict[str, np.ndarray]:
    """A drive that heaves and pitches, at its centre of gravity."""
    still = np.zeros_like(TIME)
    heaving = 0.5 * np.sin(2 * np.pi * 1.2 * TIME)
    return {**dict.fromkeys(SIGNALS, still), "a_z": heaving, "pitch_rate": PITCH, "v_x": SPEED + still, "s": SPEED * TIME, "e": still}


@pytest.mark.parametrize("place", [None, (0.0, 0.0, 0.0), (1.0, 0.0, 0.5)])
def test_accelerations_of_a_place_on_the_body_are_handed_in_as_those_of_the_centre_of_gravity(tmp_path, place):
    """At (x, 0, z) a body that pitches by q has in addition a_x = q' z - q^2 x and a_z = -q' x - q^2 z."""
    x, _, z = place or (0.0, 0.0, 0.0)
    expected = centre_of_gravity()
    there = {**expected, "a_x": expected["a_x"] + TURNING * z - PITCH**2 * x, "a_z": expected["a_z"] - TURNING * x - PITCH**2 * z}
    drive = describe(xr.Dataset({name: ("time", values) for name, values in there.items()}, {"time": TIME}))
    if place:
        drive.attrs.update(sensor_x=x, sensor_y=0.0, sensor_z=z)
    store.write(drive, tmp_path / "drive.nc", title="a drive of another simulator")
    handed_in.main([tmp_path / "drive.nc"], "0-0", {"rate": 100.0, "site": "one"}, tmp_path / "out.nc")
    found = store.read(tmp_path / "out.nc").isel(run=0)
    inside = slice(5, -5)  # at the ends derivatives are of lower order
    for name in ("a_x", "a_y", "a_z", "pitch_rate"):
        np.testing.assert_allclose(found[name][inside], expected[name][inside], atol=2e-3, err_msg=name)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda table: table.drop(columns="s"), "s: is missing"),
        (lambda table: table.assign(s=table["s"] - 2.5 * (table["time"] > 4.995)), "s: falls from 99.80 to 97.50 m at 4.99 s"),
        (lambda table: table.assign(s=200.0 - table["s"]), "s: falls from 200.00 to 199.80 m at 0.00 s"),
    ],
)
def test_a_drive_without_a_distance_that_rises_is_named(tmp_path, spoil, said):
    path = tmp_path / "run7.csv"
    spoil(pd.DataFrame({"time": TIME, **centre_of_gravity()})).to_csv(path, index=False)
    with pytest.raises(InputError) as refused:
        handed_in.main([path], "0-0", {"rate": 100.0, "site": "one"}, tmp_path / "out.nc")
    assert str(refused.value).startswith(f"{path}: {said}")
