"""NetCDF in and out: whole or not at all, and readable without the code that wrote it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.vocabulary import VARIABLES
from tests.described import WHERE_ITS_UNIT_STANDS


@pytest.fixture
def drive() -> xr.Dataset:
    rng = np.random.default_rng(0)
    return xr.Dataset(
        {"a_z": ("time", rng.normal(size=500).astype(np.float32))}, coords={"time": np.arange(500) / 100}
    )


def test_a_file_tells_what_it_holds(tmp_path, drive):
    store.write(drive, tmp_path / "a.nc", title="A drive", configuration={"runs": 4}, seed=7)
    back = store.read(tmp_path / "a.nc")
    assert back.a_z.attrs["units"] == "m/s2" and "z axis" in back.a_z.attrs["long_name"]
    assert back.attrs["Conventions"].startswith("CF-") and back.attrs["title"] == "A drive"
    assert back.attrs["seed"] == 7 and back.attrs["configuration"] == '{"runs": 4}'
    assert back.attrs["configuration_hash"] == store.configuration_hash({"runs": 4})
    assert "ridecomfort" in back.attrs["source"]
    np.testing.assert_array_equal(back.a_z, drive.a_z)


def test_equal_data_give_equal_bytes(tmp_path, drive):
    for name in ("a.nc", "b.nc"):
        store.write(drive, tmp_path / name, title="A drive")
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_kept_bits_bound_the_relative_error(tmp_path, drive):
    store.write(drive, tmp_path / "a.nc", title="A drive", keep_bits=10)
    rounded = store.read(tmp_path / "a.nc").a_z.values
    error = np.abs(rounded / drive.a_z.values - 1)
    assert 0 < error.max() < 2.0**-10


def test_a_write_that_fails_leaves_what_was_there(tmp_path, drive):
    path = tmp_path / "a.nc"
    store.write(drive, path, title="First")
    before = path.read_bytes()
    drive["odd"] = ("time", np.array([object()] * 500))
    with pytest.raises(Exception):
        store.write(drive, path, title="Second")
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.nc"]


def test_what_cannot_be_read_is_said_in_a_line(tmp_path, drive):
    path = tmp_path / "a.nc"
    with pytest.raises(InputError, match="a.nc: no such file"):
        store.read(path)
    store.write(drive, path, title="A drive")
    with pytest.raises(InputError, match="has no variable 'a_y'"):
        store.read(path, ["a_y"])
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(InputError, match="not a readable NetCDF file"):
        store.read(path)


@pytest.mark.parametrize("name", VARIABLES)
def test_every_variable_has_unit_and_meaning(name):
    """Or, of what is stacked over quantities of several units, says in its meaning where it stands."""
    variable = VARIABLES[name]
    assert variable.name == name and len(variable.long_name) > 3
    assert variable.unit or WHERE_ITS_UNIT_STANDS.search(variable.long_name)
