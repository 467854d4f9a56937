"""What a scanner recorded: the files that are read, and those that are not."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ridecomfort.errors import InputError
from ridecomfort.road import recording, survey

TIME = np.arange(50) / 200
POSE = {"x": 20 * TIME, "y": 0 * TIME, "z": 2 + 0 * TIME, "heading": 0.1 * TIME, "roll": 0.02 * TIME, "pitch": 0 * TIME}


def table(**columns) -> pd.DataFrame:
    return pd.DataFrame({"time": TIME, **POSE} | columns)


def test_netcdf_and_csv_hold_the_same(tmp_path):
    xr.Dataset({name: ("time", values) for name, values in POSE.items()}, {"time": TIME}).to_netcdf(tmp_path / "t.nc")
    table().to_csv(tmp_path / "t.csv", index=False)
    one, other = recording.trajectory(tmp_path / "t.nc"), recording.trajectory(tmp_path / "t.csv")
    xr.testing.assert_allclose(one, other)


def test_columns_may_carry_their_unit_and_azimuth_stand_for_heading(tmp_path):
    data = table().drop(columns=["heading", "roll"])
    data["azimuth [deg]"] = 90 - np.degrees(POSE["heading"])
    data["roll [deg]"] = np.degrees(POSE["roll"])
    data["satellites"] = 12
    data.to_csv(tmp_path / "t.csv", index=False)
    found = recording.trajectory(tmp_path / "t.csv")
    assert set(found.data_vars) == set(survey.POSE)
    for name in ("heading", "roll"):
        np.testing.assert_allclose(found[name], POSE[name], atol=1e-12)


@pytest.mark.parametrize(
    "data, said",
    [
        (table().drop(columns="pitch"), "has no column 'pitch'"),
        (table(z=["high"] + [2.0] * 49), "line 2, column 'z': 'high', expected a number"),
        (table(**{"pitch [gon]": 0.0}), "column 'pitch \\[gon\\]': unit 'gon', expected one of rad, deg"),
    ],
)
def test_a_trajectory_that_cannot_be_used_is_refused_in_one_line(tmp_path, data, said):
    data.to_csv(tmp_path / "t.csv", index=False)
    with pytest.raises(InputError, match=said) as refusal:
        recording.trajectory(tmp_path / "t.csv")
    assert "\n" not in str(refusal.value) and "t.csv" in str(refusal.value)


def test_a_trajectory_whose_rows_are_longer_than_its_header_is_refused_by_line(tmp_path):
    table().to_csv(tmp_path / "t.csv", index=False, lineterminator=",\n")
    text = (tmp_path / "t.csv").read_text()
    (tmp_path / "t.csv").write_text(text.replace(",\n", "\n", 1))
    with pytest.raises(InputError, match="line 2: 8 fields, expected one for each of the 7 names"):
        recording.trajectory(tmp_path / "t.csv")


def netcdf(path, time=("s", TIME), **variables):
    """A trajectory of (unit, values); None: without a unit."""
    pose = {name: ("m" if name in "xyz" else None, values) for name, values in POSE.items()} | variables
    described = {name: ("time", values, {"units": unit} if unit else {}) for name, (unit, values) in {"time": time, **pose}.items()}
    xr.Dataset({name: described[name] for name in POSE}, {"time": described["time"]}).to_netcdf(path)
    return path


@pytest.mark.parametrize(
    "given",
    [
        {"roll": ("degree", np.degrees(POSE["roll"]))},
        {"heading": ("degrees", np.degrees(POSE["heading"])), "x": ("cm", 100 * POSE["x"])},
        {"time": ("ms", 1000 * TIME)},
        {"time": ("milliseconds", 1000 * TIME)},
    ],
)
def test_variables_of_a_netcdf_trajectory_are_read_in_their_units(tmp_path, given):
    found = recording.trajectory(netcdf(tmp_path / "t.nc", **given))
    np.testing.assert_allclose(found["time"], TIME, atol=1e-9)
    for name, expected in POSE.items():
        np.testing.assert_allclose(found[name], expected, atol=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"roll": ("gon", POSE["roll"])}, "variable 'roll': unit 'gon', expected one of rad, deg"),
        ({"x": ("deg", POSE["x"])}, "variable 'x': unit 'deg', expected one of m, km, cm, mm"),
        ({"time": ("ticks", TIME)}, "variable 'time': unit 'ticks', expected one of s, ms, us, ns"),
        ({"time": ("seconds since 2020-01-01", TIME)}, "variable 'time': holds dates, expected numbers in s"),
    ],
)
def test_a_netcdf_trajectory_in_units_that_do_not_fit_is_refused_in_one_line(tmp_path, given, said):
    path = netcdf(tmp_path / "t.nc", **given)
    with pytest.raises(InputError) as refusal:
        recording.trajectory(path)
    assert str(refusal.value) == f"{path}: {said}"


def test_profiles_are_read_in_their_units(tmp_path):
    height = np.arange(12.0).reshape(3, 4)
    recorded = {"height": (("profile", "point"), height, {"units": "mm"}), "across": ("point", np.arange(4.0), {"units": "cm"})}
    xr.Dataset({**recorded, "time": ("profile", np.arange(3.0), {"units": "milliseconds"})}).to_netcdf(tmp_path / "p.nc")
    with recording.profiles(tmp_path / "p.nc") as blocks:
        (found,) = blocks
    np.testing.assert_allclose(found.height, 1e-3 * height)
    np.testing.assert_allclose(found.across, 1e-2 * np.arange(4.0))
    np.testing.assert_allclose(found.time, 1e-3 * np.arange(3.0))


def test_a_trajectory_without_time_is_refused(tmp_path):
    xr.Dataset({name: ("record", values) for name, values in POSE.items()}).to_netcdf(tmp_path / "t.nc")
    with pytest.raises(InputError, match="t.nc: expected every variable over a dimension time"):
        recording.trajectory(tmp_path / "t.nc")


def test_profiles_whose_clock_cannot_be_read_are_refused_in_one_line(tmp_path):
    recorded = {"height": (("profile", "point"), np.zeros((3, 4))), "across": ("point", np.arange(4.0))}
    time = ("profile", np.arange(3.0), {"units": "seconds since start"})
    xr.Dataset({**recorded, "time": time}).to_netcdf(tmp_path / "p.nc")
    with pytest.raises(InputError, match="p.nc: not a readable NetCDF file .*seconds since start") as refusal:
        with recording.profiles(tmp_path / "p.nc"):
            pass
    assert "\n" not in str(refusal.value)


def test_profiles_with_other_dimensions_are_refused(tmp_path):
    xr.Dataset({"height": (("a", "b"), np.zeros((3, 4))), "time": ("a", np.zeros(3)), "across": ("b", np.zeros(4))}).to_netcdf(
        tmp_path / "p.nc"
    )
    with pytest.raises(InputError, match="height has dimensions .*expected height \\(profile, point\\)"):
        with recording.profiles(tmp_path / "p.nc"):
            pass
