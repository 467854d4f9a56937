"""Drives from files: columns and units, readers by suffix, and one clear line for what cannot be read."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ridecomfort import schema, store
from ridecomfort.drive import configured, readers, units
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS, STANDARD_GRAVITY, VARIABLES

COLUMNS = {
    "time": {"column": "t [ms]", "unit": "ms"},
    "v_x": {"column": "speed [km/h]", "unit": "km/h"},
    "s": {"column": "way [km]", "unit": "km"},
    "a_x": {"column": "ax [g]", "unit": "g"},
    "a_y": {"column": "ay right [m/s2]", "unit": "m/s2", "factor": -1},
    "a_z": {"column": "az [g]", "unit": "g"},
    "roll_rate": {"column": "p [deg/s]", "unit": "deg/s"},
    "pitch_rate": {"column": "q [deg/s]", "unit": "deg/s"},
    "yaw_rate": {"column": "r [deg/s]", "unit": "deg/s"},
}


def table():
    time = np.arange(0, 10, 0.01)
    return pd.DataFrame(
        {
            "t [ms]": 1e3 * time,
            "speed [km/h]": 72.0 + 0 * time,
            "way [km]": 0.02 * time,
            "ax [g]": 0.1 * np.sin(time),
            "ay right [m/s2]": np.cos(time),
            "az [g]": 1 + 0.1 * np.sin(time),
            "p [deg/s]": np.cos(3 * time),
            "q [deg/s]": 10 * np.sin(time),
            "r [deg/s]": np.sin(0.3 * time),
        }
    )


@pytest.fixture
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def write(folder, frame):
    path = folder / "drive.csv"
    frame.to_csv(path, index=False)
    return path


def test_columns_become_quantities_in_si_units(tmp_path):
    drive = readers.read(write(tmp_path, table()), COLUMNS)
    time = drive["time"].values
    np.testing.assert_allclose(drive["v_x"], 20.0)
    np.testing.assert_allclose(drive["s"], 20 * time, atol=1e-9)
    np.testing.assert_allclose(drive["a_x"], 0.1 * STANDARD_GRAVITY * np.sin(time), atol=1e-9)
    np.testing.assert_allclose(drive["a_y"], -np.cos(time), atol=1e-9)
    np.testing.assert_allclose(drive["pitch_rate"], np.radians(10) * np.sin(time), atol=1e-9)
    assert drive.attrs["name"] == "drive" and drive["pitch_rate"].attrs["units"] == "rad/s"


def test_a_place_of_the_sensor_that_lacks_a_direction_is_refused(tmp_path):
    drive = readers.read(write(tmp_path, table()), COLUMNS, sensor=(0.1, 0.2, 0.3))
    del drive.attrs["sensor_y"]
    store.write(drive, tmp_path / "drive.nc", title="a drive")
    with pytest.raises(InputError, match="drive.nc: has no attribute 'sensor_y'"):
        readers.read(tmp_path / "drive.nc")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda drive: drive.assign_attrs(sensor_y="left"), "attribute sensor_y: holds 'left' .expected a number"),
        (lambda drive: drive.assign_attrs(lateral_position="unknown"), "attribute lateral_position: holds 'unknown'"),
        (lambda drive: drive.assign(a_x=("time", np.array(["1.0"] * drive.sizes["time"]))), "a_x: holds .'1.0'. for a_x .expected numbers"),
    ],
)
def test_text_in_a_netcdf_file_where_a_number_belongs_is_refused(tmp_path, change, words):
    drive = change(readers.read(write(tmp_path, table()), COLUMNS, sensor=(0.1, 0.2, 0.3)))
    drive.to_netcdf(tmp_path / "drive.nc")
    with pytest.raises(InputError, match=rf"drive.nc: {words}"):
        readers.read(tmp_path / "drive.nc")


def test_a_column_whose_name_stands_twice_is_refused(tmp_path):
    path = write(tmp_path, table())
    head, _, rest = path.read_text().partition("\n")
    path.write_text(f"{head},ax [g]\n" + "".join(f"{line},9.9\n" for line in rest.splitlines()))
    for read in (readers.read, readers.check):
        with pytest.raises(InputError, match=r"line 1: 2 columns are called 'ax \[g\]' .expected one, for a_x"):
            read(path, COLUMNS)


def test_a_netcdf_file_of_the_drive_schema_comes_back_as_it_was(tmp_path):
    drive = readers.read(write(tmp_path, table()), COLUMNS, role="check", sensor=(0.1, 0.2, 0.3), lateral_position=0.4)
    store.write(drive, tmp_path / "drive.nc", title="a drive")
    back = readers.read(tmp_path / "drive.nc")
    for name in (*SIGNALS, "v_x", "s"):
        np.testing.assert_allclose(back[name], drive[name], atol=1e-12)
    assert back.attrs["role"] == "check" and back.attrs["gravity"] == 1
    assert (back.attrs["sensor_x"], back.attrs["sensor_z"], back.attrs["lateral_position"]) == (0.1, 0.3, 0.4)


def test_a_netcdf_file_that_says_to_be_held_out_is_not_fitted(tmp_path):
    drive = readers.read(write(tmp_path, table()), COLUMNS, role="check")
    store.write(drive, tmp_path / "drive.nc", title="a drive")
    with pytest.raises(InputError, match=r"drive.nc: attribute role: holds 'check' where the drive is to be fitted"):
        readers.read(tmp_path / "drive.nc", role="fit")
    store.write(drive.assign_attrs(role="fit"), tmp_path / "fitted.nc", title="a drive")
    assert readers.read(tmp_path / "fitted.nc", role="check").attrs["role"] == "check"


@pytest.mark.parametrize(("columns", "both"), [({"a_x": "a_y"}, "a_x and a_y"), ({"v_x": "yaw_rate"}, "v_x and yaw_rate"), ({"a_z": "t"}, "time and a_z")])
def test_a_variable_of_a_netcdf_file_stands_for_one_quantity(tmp_path, columns, both):
    path, _ = netcdf(tmp_path / "drive.nc")
    named = {"time": {"column": "t"}, **{quantity: {"column": column} for quantity, column in columns.items()}}
    for read in (readers.read, readers.check):
        with pytest.raises(InputError, match=f"drive.nc: columns: variable .* stands for both {both}"):
            read(path, named)
    swapped = readers.read(path, {"time": {"column": "t"}, "a_x": {"column": "a_y"}, "a_y": {"column": "a_x"}})
    assert swapped.sizes["time"] == 1000


@pytest.mark.parametrize("said, holds", [("false", 0), ("0", 0), ("True", 1), ("yes", 1)])
def test_whether_a_netcdf_file_holds_gravity_may_be_told_in_words(tmp_path, said, holds):
    drive = readers.read(write(tmp_path, table()), COLUMNS, sensor=(0.1, 0.2, 0.3)).assign_attrs(gravity=said)
    drive["a_z"] = drive["a_z"] + STANDARD_GRAVITY * (holds - 1)
    drive.to_netcdf(tmp_path / "drive.nc")
    assert readers.read(tmp_path / "drive.nc").attrs["gravity"] == holds


def test_a_netcdf_file_in_other_units_and_names_is_converted(tmp_path):
    time = np.arange(0, 10, 0.01)
    other = xr.Dataset({name: ("time", np.sin(time), {"units": "deg/s"}) for name in SIGNALS[3:]}, {"time": time})
    for name in SIGNALS[:3]:
        other[name] = "time", 0.1 * np.sin(time), {"units": "g"}
    other["speed"] = "time", np.full(time.size, 36.0), {"units": "km/h"}
    other.to_netcdf(tmp_path / "other.nc")
    drive = readers.read(tmp_path / "other.nc", {"v_x": {"column": "speed"}}, distance_start=100.0)
    np.testing.assert_allclose(drive["v_x"], 10.0)
    np.testing.assert_allclose(drive["s"], 100 + 10 * drive["time"], atol=1e-9)
    np.testing.assert_allclose(drive["yaw_rate"], np.radians(np.sin(time)), atol=1e-12)
    assert drive.attrs["gravity"] == 0


def netcdf(path, **units):
    """A drive whose clock runs for 10 s and whose variables have these units."""
    time = np.arange(0, 10, 0.01)
    values = {"v_x": 20.0 + 0 * time, **{name: 0.1 * np.sin(time) for name in SIGNALS}}
    drive = xr.Dataset({name: ("t", row, {"units": units[name]} if name in units else {}) for name, row in values.items()}, {"t": time})
    if "time" in units:
        drive = drive.assign_coords(t=("t", 1e3 * time, {"units": units["time"]}))
    drive.to_netcdf(path)
    return path, 0.1 * np.sin(time)


def test_a_netcdf_file_has_the_units_and_axes_of_its_columns_where_it_does_not_say_itself(tmp_path):
    path, wave = netcdf(tmp_path / "drive.nc", time="ms", yaw_rate="deg/s")
    columns = {"time": {"column": "t", "unit": "ms"}, "a_y": {"column": "a_y", "unit": "g", "factor": -1}}
    drive = readers.read(path, columns | {"yaw_rate": {"column": "yaw_rate", "unit": "deg/s", "factor": -1}})
    assert float(drive["time"][-1]) == pytest.approx(9.99)
    np.testing.assert_allclose(drive["a_y"], -STANDARD_GRAVITY * wave, atol=1e-9)
    np.testing.assert_allclose(drive["yaw_rate"], -np.radians(wave), atol=1e-9)
    np.testing.assert_allclose(drive["a_x"], wave, atol=1e-9)


def test_a_netcdf_file_whose_units_are_others_than_those_of_the_columns_is_refused(tmp_path):
    path, _ = netcdf(tmp_path / "drive.nc", yaw_rate="deg/s")
    columns = {"time": {"column": "t", "unit": "s"}, "yaw_rate": {"column": "yaw_rate", "unit": "rad/s"}}
    with pytest.raises(InputError, match=r"drive.nc: yaw_rate: unit 'rad/s' for yaw_rate, but its variable has units 'deg/s'"):
        readers.read(path, columns)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("seconds", 1.0), ("milliseconds", 1e-3), ("seconds since 2020-01-01", 1.0), ("milliseconds since 2020-01-01 06:00:00", 1e-3)],
)
def test_the_clock_of_a_netcdf_file_may_be_spelled_out_or_hold_dates(tmp_path, unit, factor):
    path, wave = netcdf(tmp_path / "drive.nc")
    dataset = xr.open_dataset(path).load()
    dataset.assign_coords(t=("t", (dataset["t"].values + 5.0) / factor, {"units": unit})).to_netcdf(tmp_path / "stamped.nc")
    drive = readers.read(tmp_path / "stamped.nc", {"time": {"column": "t"}})
    assert float(drive["time"][-1]) == pytest.approx(9.99)
    np.testing.assert_allclose(drive["a_z"], wave, atol=1e-6)


def test_dates_of_another_calendar_and_of_no_calendar_are_refused_in_one_line(tmp_path):
    for name, unit, calendar in (("noleap", "seconds since 2020-01-01", "noleap"), ("none", "fortnights since yesterday", "standard")):
        path, _ = netcdf(tmp_path / "drive.nc")
        dataset = xr.open_dataset(path).load()
        dataset = dataset.assign_coords(t=("t", dataset["t"].values, {"units": unit, "calendar": calendar}))
        dataset.to_netcdf(tmp_path / f"{name}.nc")
        with pytest.raises(InputError) as problem:
            readers.read(tmp_path / f"{name}.nc", {"time": {"column": "t"}})
        assert "\n" not in str(problem.value) and f"{name}.nc" in str(problem.value)


@pytest.mark.parametrize(
    ("quantity", "unit", "written"),
    [
        ("time", "s", ("seconds", "second", "sec")),
        ("a_x", "m/s2", ("m s-2", "m/s^2", "m/s²", "m/s**2", "m s^-2", "m s**-2", "m*s-2", "m.s-2", "m s⁻²", "meters per second^2")),
        ("v_x", "m/s", ("m/s", "m s-1", "m s^-1", "m s**-1", "metres per second", "meter second-1")),
        ("v_x", "km/h", ("km h-1", "kph", "kilometers/hour")),
        ("s", "m", ("m", "metre", "meter", "metres", "meters")),
        ("yaw_rate", "rad/s", ("rad s-1", "radian s-1", "radians/second")),
        ("yaw_rate", "deg/s", ("degree s-1", "degrees/s", "°/s", "deg s⁻¹")),
    ],
)
def test_units_may_be_spelled_as_udunits_and_headers_do(quantity, unit, written):
    for other in written:
        assert units.spelled(other) == unit, other
        assert units.factor(quantity, other) == units.factor(quantity, unit)


def test_a_site_may_name_every_unit_that_a_column_is_converted_from():
    known = schema.load("site")["$defs"]
    quantities = known["drive"]["properties"]["columns"]["properties"]
    convertible = {unit for quantity in quantities for unit in units.FACTORS[VARIABLES[quantity].unit]}
    assert set(known["column"]["properties"]["unit"]["enum"]) == convertible


@pytest.mark.parametrize("unit", ["s-1", "mph", "m s-3", "metre s-2 rad", "seconds since 2020-01-01", ""])
def test_units_that_are_not_known_stay_what_they_are_to_the_reader(unit):
    with pytest.raises(InputError, match=rf"unit '{unit}' does not fit v_x"):
        units.factor("v_x", unit)


def test_places_at_the_car_become_places_about_its_centre_of_gravity(tmp_path, car):
    entry = {
        "columns": COLUMNS,
        "sensor": {"behind_front_axle": 1.0, "left": 0.2, "above_wheel_centres": 0.95},
        "distance_of": "front_axle",
        "role": "check",
        "road_friction": 0.8,
    }
    path = write(tmp_path, table())
    drive = configured.read(path, entry, car)
    assert drive.attrs["sensor_x"] == pytest.approx(car["cg_to_front_axle"] - 1.0)
    assert drive.attrs["sensor_y"] == 0.2
    wheel_centre = drive.attrs["sensor_z"] - 0.95 + car["cg_height"]
    assert 0.01 < car["tyre_radius"] - wheel_centre < 0.02  # a loaded tyre is 1 to 2 cm shorter
    np.testing.assert_allclose(drive["s"], readers.read(path, COLUMNS)["s"] - car["cg_to_front_axle"])
    assert drive.attrs["role"] == "check" and drive.attrs["road_friction"] == 0.8


@pytest.mark.parametrize("suffix", [".nc", ".csv"])
@pytest.mark.parametrize(("key", "quantity"), [("distance_start", "s"), ("lateral_position", "e")])
def test_what_the_file_says_itself_is_refused_without_columns_too(tmp_path, car, suffix, key, quantity):
    time = np.arange(0, 10, 0.01)
    told = {name: 0.1 * np.sin((1.0 + number) * time) for number, name in enumerate(SIGNALS)}
    told |= {"a_z": told["a_z"] + STANDARD_GRAVITY, "v_x": 20.0 + 0 * time, "s": 20.0 * time, "e": 0.1 * np.sin(time)}
    path = tmp_path / f"drive{suffix}"
    if suffix == ".nc":
        xr.Dataset({name: ("time", values) for name, values in told.items()}, {"time": time}).to_netcdf(path)
    else:
        pd.DataFrame({"time": time} | told).to_csv(path, index=False)
    assert configured.read(path, {key: 0.0, "gravity": True}, car).sizes["time"] == time.size
    with pytest.raises(InputError, match=f"{key}: 0.9 beside {quantity} in the file, which says so itself"):
        configured.read(path, {key: 0.9, "gravity": True}, car)


def test_the_path_of_the_front_axle_becomes_that_of_the_body_which_follows_it(tmp_path, car):
    aside = lambda s: 0.3 * np.sin(2 * np.pi * s / 100)
    path = write(tmp_path, table().assign(**{"offset [m]": lambda frame: aside(1e3 * frame["way [km]"])}))
    entry = {"columns": COLUMNS | {"e": {"column": "offset [m]", "unit": "m"}}, "distance_of": "front_axle"}
    drive = configured.read(path, entry, car)
    ahead = car["cg_to_front_axle"]
    inside = drive["s"].values > 0  # the axle was there already
    np.testing.assert_allclose(drive["e"].values[inside], aside(drive["s"].values)[inside], atol=1e-4)
    assert np.abs(aside(drive["s"].values + ahead) - drive["e"].values).max() > 0.02


def broken(column, row, value):
    frame = table().astype({column: object})
    frame.loc[row, column] = value
    return frame


def since_1970(frame):
    return frame.assign(**{"t [ms]": frame["t [ms]"] + 1.7e12})


@pytest.mark.parametrize(
    ("frame", "columns", "words"),
    [
        (broken("ax [g]", 10, ""), COLUMNS, ("line 12", "'ax [g]'", "nothing")),
        (broken("ax [g]", 10, "n/a?"), COLUMNS, ("line 12", "'n/a?'")),
        (table().drop(columns="r [deg/s]"), COLUMNS, ("no column 'r [deg/s]' for yaw_rate", "az [g]")),
        (table(), COLUMNS | {"a_x": {"column": "ax [g]", "unit": "km/h"}}, ("'ax [g]'", "'km/h' does not fit a_x", "m/s2")),
        (table(), COLUMNS | {"jerk": {"column": "ax [g]", "unit": "g"}}, ("unknown quantity 'jerk'",)),
        (table(), {k: v for k, v in COLUMNS.items() if k != "time"}, ("no column stands for time",)),
        (table(), COLUMNS | {"v_x": {"column": "speed [km/h]", "unit": "m/s"}}, ("'m/s' for v_x", "'speed [km/h]'")),
        (broken("t [ms]", 500, 0.0), COLUMNS, ("line 502", "strictly increasing")),
        (since_1970(broken("t [ms]", 500, 0.0)), COLUMNS, ("line 502", "1700000000 s after 1700000004.99 s")),
    ],
)
def test_what_is_wrong_in_a_table_is_said_in_one_line(tmp_path, frame, columns, words):
    path = write(tmp_path, frame)
    with pytest.raises(InputError) as problem:
        readers.read(path, columns)
    message = str(problem.value)
    assert "\n" not in message and message.startswith(str(path))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("dead", "said"),
    [
        (0.0, "roll_rate holds 0 rad/s throughout its 1000 samples"),
        (np.r_[1.0, np.full(999, 0.0)], "roll_rate holds 0 and 0.0174533 rad/s"),
    ],
    ids=["filled", "filled behind its first sample"],
)
def test_a_dead_channel_is_refused_with_its_column_and_value(tmp_path, dead, said):
    path = write(tmp_path, table().assign(**{"p [deg/s]": dead}))
    with pytest.raises(InputError) as problem:
        readers.read(path, COLUMNS)
    message = str(problem.value)
    assert message.startswith(f"{path}: column 'p [deg/s]': {said}") and "expected at least 3 different values" in message


def test_a_rate_in_degrees_that_is_said_to_be_in_radians_is_refused_with_its_column(tmp_path):
    turning = table().assign(p=3.0 * np.sin(np.arange(1000)))
    wrong, right = ({**COLUMNS, "roll_rate": {"column": "p", "unit": unit}} for unit in ("rad/s", "deg/s"))
    path = write(tmp_path, turning)
    with pytest.raises(InputError) as problem:
        readers.read(path, wrong)
    assert str(problem.value) == (
        f"{path}: column 'p': roll_rate has a root mean square of 2.12 rad/s (expected at most 0.5 rad/s; is its unit right?)"
    )
    assert np.std(readers.read(path, right)["roll_rate"].values) < 0.05


def test_a_coarse_channel_is_kept_and_so_is_a_simulated_vehicle_that_does_not_roll(tmp_path):
    coarse = table().assign(**{"r [deg/s]": np.round(0.6 * np.sin(np.arange(1000)))})  # -1, 0 and 1: the last digit
    assert set(np.round(np.degrees(readers.read(write(tmp_path, coarse), COLUMNS)["yaw_rate"].values), 9)) == {-1.0, 0.0, 1.0}
    even = write(tmp_path, table().assign(**{"p [deg/s]": 0.0}))
    assert not readers.read(even, COLUMNS, measured=False)["roll_rate"].any()


def test_of_a_header_that_is_none_only_the_beginning_is_shown(tmp_path):
    path = tmp_path / "drive.csv"
    path.write_text(", ".join(map(str, range(5000))) + "\n1\n")
    with pytest.raises(InputError, match=r"found 0, 1, 2.* \.\.\.\)") as refused:
        readers.read(path, COLUMNS)
    assert len(str(refused.value)) < 600


@pytest.mark.parametrize("longer", ["the first", "all"])
def test_rows_with_a_field_more_than_the_header_are_refused_by_line(tmp_path, longer):
    """Read on, each column would hold the values of the one before it."""
    path = write(tmp_path, table())
    header, *lines = path.read_text().splitlines()
    count = 1 if longer == "the first" else len(lines)
    path.write_text("\n".join([header, "", *(f"{line}," for line in lines[:count]), *lines[count:]]))
    with pytest.raises(InputError) as refused:
        readers.read(path, COLUMNS)
    assert str(refused.value) == f"{path}: line 3: 10 fields, expected one for each of the 9 names of columns"


def test_decimal_commas_between_commas_are_asked_for(tmp_path):
    path = write(tmp_path, table())
    header, *lines = path.read_text().splitlines()
    path.write_text("\n".join([header, *(line.replace(".", ",") for line in lines)]))
    with pytest.raises(InputError, match=r"line 2: 1\d fields, expected one for each of the 9 names of columns: are there commas in decimal numbers\?"):
        readers.read(path, COLUMNS)


def test_text_in_another_encoding_is_asked_for(tmp_path):
    path = write(tmp_path, table())
    path.write_bytes(path.read_bytes().replace(b"\n", b" \xb0\n", 1))
    with pytest.raises(InputError, match="not a readable CSV file .*is it saved as UTF-8"):
        readers.read(path, COLUMNS)


def test_a_single_longer_row_further_down_is_refused_by_line(tmp_path):
    path = write(tmp_path, table())
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:9], f"{lines[9]},7", *lines[10:]]))
    with pytest.raises(InputError, match="9 fields in line 10, saw 10"):
        readers.read(path, COLUMNS)


def test_a_column_of_row_numbers_without_a_name_is_passed_over(tmp_path):
    table().to_csv(tmp_path / "drive.csv")
    assert readers.read(tmp_path / "drive.csv", COLUMNS)["a_x"].equals(readers.read(write(tmp_path, table()), COLUMNS)["a_x"])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_file_that_is_not_separated_by_commas_says_what_it_is_separated_by(tmp_path, separator):
    """With decimal commas its rows fall into more fields than its header, which is no news of use."""
    table().to_csv(tmp_path / "drive.csv", index=False, sep=separator, decimal=",")
    for look in (readers.read, readers.check):
        with pytest.raises(InputError) as refused:
            look(tmp_path / "drive.csv", COLUMNS)
        assert str(refused.value) == f"{tmp_path / 'drive.csv'}: line 1: one column only: separated by {separator!r}? (expected ',', and a point in decimal numbers)"


def test_blank_lines_are_counted_though_they_are_no_rows(tmp_path):
    path = write(tmp_path, broken("ax [g]", 10, "n/a?"))
    lines = path.read_text().split("\n")
    path.write_text("\n".join([*lines[:5], "", *lines[5:8], "  ", *lines[8:]]))
    with pytest.raises(InputError, match="line 14, column 'ax"):
        readers.read(path, COLUMNS)


@pytest.mark.parametrize(
    ("header", "unit"),
    [("gyro_x [rad/s]", "rad/s"), ("acc (m/s²)", "m/s2"), ("acc [m/s^2]", "m/s2"), ("rate [°/s]", "deg/s"),
     ("speed", None), ("speed [mph]", None), ("acc [filtered] [g]", "g")],
)  # fmt: skip
def test_a_header_may_state_its_unit(header, unit):
    assert units.of_header(header) == unit


def test_an_aligned_drive_whose_speed_fits_no_road_is_refused():
    """Recorded in m/s but called km/h: 3.6 times the speed fits."""
    drive = xr.Dataset(attrs={"speed_scale": 1.02})
    assert configured.check_speed(drive, "fast.csv") is drive
    with pytest.raises(InputError, match="^fast.csv: v_x: recorded speed times 3.6 .*expected 0.95 to 1.05.*units"):
        configured.check_speed(drive.assign_attrs(speed_scale=3.6), "fast.csv")


def test_files_that_cannot_be_read_are_named(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        readers.read(tmp_path / "absent.csv")
    (tmp_path / "drive.mf9").touch()
    with pytest.raises(InputError, match=r"no reader for '.mf9' \(expected .csv, .nc, .nc4\)"):
        readers.read(tmp_path / "drive.mf9")
    (tmp_path / "empty.csv").touch()
    with pytest.raises(InputError, match="not a readable CSV file"):
        readers.read(tmp_path / "empty.csv", COLUMNS)


def test_a_truncated_netcdf_file_is_refused(tmp_path):
    whole = tmp_path / "whole.nc"
    store.write(readers.read(write(tmp_path, table()), COLUMNS), whole, title="a drive")
    (tmp_path / "half.nc").write_bytes(whole.read_bytes()[:3000])
    with pytest.raises(InputError, match="half.nc: not a readable NetCDF file"):
        readers.read(tmp_path / "half.nc")
