"""The command for one recording or profile of a user's own."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from ridecomfort.__main__ import main
from ridecomfort.comfort import alone, weighting
from ridecomfort.errors import InputError

TIME = np.arange(3000) / 100.0


def write(path, **columns):
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


@pytest.fixture
def recording(tmp_path):
    """A steady sine of 4 Hz on gravity, in g."""
    return write(tmp_path / "my.csv", time=TIME, up=1.0 + 0.1 * np.sin(2 * np.pi * 4 * TIME))


def test_comfort_table_and_plot(recording, capsys):
    main(["comfort", "--iso2631", str(recording), "--column", "a_z=up", "--unit", "g", "--exposure", "60"])
    printed = capsys.readouterr().out
    table = pd.read_csv(recording.with_name("my_iso2631.csv"))
    expected = weighting.WEIGHTINGS["Wk"].factor(4.0) * 0.980665 / np.sqrt(2)
    assert table["a_w [m/s2]"].iloc[0] == pytest.approx(expected, rel=0.01)
    assert "FU" in printed and "60.0 min a day" in printed and "lacks the other axes" in printed
    assert recording.with_name("my_iso2631.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("rate", "duration", "said"),
    [
        (10.0, 60.0, "time: 10 samples per second hold nothing above 5 Hz (expected 20 or more"),
        (100.0, 0.5, "time: lasts 0.5 s (expected 4 s or more"),
        (100.0, 0.02, "time: lasts 0.02 s (expected 4 s or more"),
    ],
)
def test_a_recording_that_cannot_hold_what_the_standard_weighs_is_refused(tmp_path, rate, duration, said):
    """Its band is 0.5 to 80 Hz. Shares of time outside of an acceleration can be told all the same."""
    time = np.arange(round(rate * duration)) / rate
    file = write(tmp_path / "my.csv", time=time, a_z=np.sin(2 * np.pi * 2 * time))
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iso2631", str(file)])
    assert str(end.value).startswith(f"error: {file}: {said}") and "\n" not in str(end.value)
    assert [each.name for each in tmp_path.iterdir()] == ["my.csv"]
    alone.styles(alone.recording(file))


@pytest.mark.parametrize(("rate", "highest"), [(20.0, "10"), (100.0, "50"), (160.0, None)])
def test_the_highest_frequency_heard_is_told_where_it_lies_below_that_of_the_weightings(tmp_path, rate, highest):
    time = np.arange(round(10 * rate)) / rate
    file = write(tmp_path / "my.csv", time=time, a_z=np.sin(2 * np.pi * 2 * time))
    remarks = " ".join(alone.ride(alone.recording(file)).remarks)
    assert ("is not heard" in remarks) == bool(highest)
    assert highest is None or f"span 0.5 to 80 Hz: at {rate:g} Hz vibration above {highest} Hz is not heard" in remarks


def test_a_floor_recording_goes_through_a_seat(recording, tmp_path):
    """At 4 Hz through a seat of 2 Hz and damping 0.3: transmissibility sqrt((1 + 1.44) / (9 + 1.44))."""
    common = ["comfort", "--iso2631", str(recording), "--column", "a_z=up", "--unit", "g", "--output"]
    main([*common, str(tmp_path / "floor")])
    main([*common, str(tmp_path / "seat"), "--seat", "2", "0.3"])
    floor, seat = (pd.read_csv(tmp_path / each / "my_iso2631.csv")["a_w [m/s2]"].iloc[0] for each in ("floor", "seat"))
    assert seat / floor == pytest.approx(np.sqrt(2.44 / 10.44), rel=0.02)


def test_a_seat_without_a_vertical_acceleration_is_refused(tmp_path):
    file = write(tmp_path / "my.csv", time=TIME, a_x=np.sin(2 * np.pi * TIME), a_y=0 * TIME)
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iso2631", str(file), "--seat", "2", "0.3"])
    assert str(end.value) == "error: --seat: a seat changes a_z alone, which is not among a_x, a_y"


def test_thresholds_take_gravity_off_and_say_so(recording, capsys):
    main(["comfort", "--thresholds", str(recording), "--column", "a_z=up", "--unit", "g"])
    said = capsys.readouterr().out
    assert "gravity" in said and said.startswith("Driving styles, 30.0 s")  # the title of the plot, too, which has no jerk
    table = pd.read_csv(recording.with_name("my_thresholds.csv")).set_index("style")
    share = 100 * (1 - 2 / np.pi * np.arcsin(0.3 / 0.980665))
    assert table.loc["AG", "time outside [%]"] == pytest.approx(share, abs=1.0)


def test_local_roughness_names_the_place_of_a_step(tmp_path, capsys):
    """A smooth profile with one step of 20 mm at 60 m."""
    s = 0.1 * np.arange(1200)
    profile = write(tmp_path / "profile.csv", s=s, left=np.where(s < 60.0, 0.0, 0.02))
    main(["comfort", "--iri", str(profile), "--local", "3"])
    printed = capsys.readouterr().out
    _, _, told = printed.partition("left: 1 stretch with more than 3 m/km over 7.62 m (25 ft)\n")
    start, stop = (float(part) for part in told.split(" m,")[0].split(" to "))
    assert 55.0 < start < 60.0 < stop < 70.0


@pytest.mark.parametrize(("length", "said"), [(149.0, "the last 49.0 m, less than half a segment, are in no row (--segment)"), (151.0, None), (200.0, None)])
def test_what_of_a_profile_is_in_no_segment_is_said(tmp_path, length, said):
    s = np.arange(0.0, length + 0.05, 0.1)
    found = alone.roughness(write(tmp_path / "profile.csv", s=s, left=0.001 * np.sin(s)), 100.0)
    assert [remark for remark in found.remarks if "in no row" in remark] == ([said] if said else [])
    assert (found.table["to [m]"].iloc[-1] < s[-1]) == bool(said)


def test_places_far_along_a_road_are_printed_to_the_centimetre(tmp_path):
    s = 1_000_000.5 + 0.1 * np.arange(3001)
    printed = alone.roughness(write(tmp_path / "profile.csv", s=s, left=0.001 * np.sin(s)), 100.0).text()
    assert "1000000.50 1000100.50" in printed and "1000200.50 1000300.50" in printed and "e+06" not in printed


def test_iri_of_two_tracks(tmp_path, capsys):
    s = np.arange(0, 400.01, 0.1)
    left = 0.002 * np.sin(2 * np.pi * s / 12)
    profile = write(tmp_path / "profile.csv", s=s, left=left, right=left)
    main(["comfort", "--iri", str(profile), "--output", str(tmp_path / "out")])
    table = pd.read_csv(tmp_path / "out/profile_iri.csv")
    assert len(table) == 4
    # Golden car at 12 m: gain 1.3738928 (Sayers 1995), IRI 4 A gain / wavelength; 100 m are not whole waves.
    assert table["MRI [m/km]"].iloc[-1] == pytest.approx(2 * 0.45796428, rel=0.05)
    assert np.allclose(table["MRI [m/km]"], table["HRI [m/km]"])


@pytest.mark.parametrize(
    "content, arguments, message",
    [
        ("time,a_z\n0,1\n0.01,2\n0.005,3\n", [], "does not advance"),
        ("time,a_z\n0,1\n0.01,hm\n0.02,3\n", [], "'hm'"),
        ("a_z\n1\n2\n", [], "no column"),
        ("time,up\n0,1\n0.01,2\n", [], "found time, up"),
        ("time,a_z\n0,1\n0.01,2\n", ["--unit", "furlong"], "'furlong'"),
        ("time,a_z\n0,1\n0.01,2\n", ["--column", "w=up"], "NAME=COLUMN"),
    ],
)
def test_mistakes_are_one_line_and_leave_nothing(tmp_path, content, arguments, message):
    file = tmp_path / "my.csv"
    file.write_text(content)
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iso2631", str(file), *arguments])
    assert str(end.value).startswith("error: ") and message in str(end.value) and "\n" not in str(end.value)
    assert [each.name for each in tmp_path.iterdir()] == ["my.csv"]


@pytest.mark.parametrize(
    ("method", "arguments", "message"),
    [
        ("--iri", ["--unit", "mm"], "--unit: means nothing to --iri (expected of --column, --segment, --local, --smoothed)"),
        ("--iri", ["--exposure", "10"], "--exposure: means nothing to --iri"),
        ("--thresholds", ["--seat", "4", "0.3"], "--seat: means nothing to --thresholds"),
        ("--iso2631", ["--segment", "50"], "--segment: means nothing to --iso2631"),
        ("--iri", ["--column", "elevation=h"], "no column 'h'"),
        ("--iri", ["--column", "a_z=h"], "NAME of s, left, right, elevation"),
    ],
)
def test_options_that_a_method_has_no_use_for_are_refused(tmp_path, method, arguments, message):
    file = write(tmp_path / "my.csv", s=S, elevation=PROFILE, time=S / 10.0, a_z=PROFILE)
    with pytest.raises(SystemExit) as end:
        main(["comfort", method, str(file), *arguments])
    assert message in str(end.value) and [each.name for each in tmp_path.iterdir()] == ["my.csv"]


def test_columns_of_a_profile_may_be_named(tmp_path):
    plain = write(tmp_path / "plain.csv", s=S, elevation=PROFILE)
    other = write(tmp_path / "other.csv", **{"way": S, "h [mm]": 1e3 * PROFILE})
    main(["comfort", "--iri", str(plain)])
    main(["comfort", "--iri", str(other), "--column", "s=way", "--column", "elevation=h [mm]"])
    first, second = (pd.read_csv(tmp_path / f"{name}_iri.csv") for name in ("plain", "other"))
    pd.testing.assert_frame_equal(first, second)


@pytest.mark.parametrize("method", ["--iso2631", "--thresholds"])
def test_a_clock_in_milliseconds_is_refused_unless_its_column_says_so(tmp_path, method):
    wave = np.sin(2 * np.pi * 4 * TIME)
    with pytest.raises(SystemExit, match=r"column 'time': 0.1 samples per second .*as in time \[ms\]"):
        main(["comfort", method, str(write(tmp_path / "my.csv", time=1e3 * TIME, a_z=wave))])
    assert alone.recording(write(tmp_path / "said.csv", **{"time [ms]": 1e3 * TIME, "a_z": wave})).attrs["rate"] == 100.0


def test_a_folder_that_is_a_file_is_refused(recording, tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(SystemExit, match="taken: is no folder"):
        main(["comfort", "--thresholds", str(recording), "--column", "a_z=up", "--unit", "g", "--output", str(tmp_path / "taken")])


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(SystemExit, match="no such file"):
        main(["comfort", "--iri", str(tmp_path / "none.csv")])


def test_a_real_recording(shared, tmp_path):
    """comma2k19: 60 s of an IMU with gravity, 104 Hz, upside down."""
    folder = shared / "data/comma2k19/processed_log/IMU/accelerometer"
    time, values = np.load(folder / "t.npy"), np.load(folder / "value.npy")
    file = write(tmp_path / "imu.csv", time=time - time[0], a_x=values[:, 0], a_y=values[:, 1], a_z=values[:, 2])
    recording = alone.recording(file)
    assert recording.attrs["rate"] == pytest.approx(104.26, abs=0.01)
    total = float(alone.ride(recording).signals["a_v"].median())
    assert 0.1 < total < 1.0


def test_units_may_stand_behind_the_names_of_columns(tmp_path):
    time = np.arange(0, 20, 0.01)
    wave = np.sin(2 * np.pi * 8 * time)
    plain = pd.DataFrame({"time": time, "a_z": wave})
    plain.to_csv(tmp_path / "plain.csv", index=False)
    pd.DataFrame({"time [s]": time, "a_z [g]": wave / 9.80665}).to_csv(tmp_path / "headed.csv", index=False)
    first, second = (alone.recording(tmp_path / f"{name}.csv") for name in ("plain", "headed"))
    np.testing.assert_allclose(second["a_z"], first["a_z"], atol=1e-6)


@pytest.mark.parametrize(
    ("columns", "arguments", "message"),
    [
        ({"time": TIME, "a_z [m/s2]": np.sin(TIME)}, ["--unit", "g"], "'g' for a_z, but its column is headed 'a_z [m/s2]'"),
        ({"time": TIME, "a_z": 150.0 * np.sin(50 * TIME)}, [], "and rms 106 m/s2"),
        ({"time": TIME, "a_z": 9.81 + np.sin(TIME)}, ["--unit", "g"], "a_z: mean 96"),
    ],
)
def test_accelerations_in_another_unit_are_refused(tmp_path, columns, arguments, message):
    file = write(tmp_path / "my.csv", **columns)
    with pytest.raises(SystemExit, match="is the unit right|expected the unit of the header") as end:
        main(["comfort", "--iso2631", str(file), *arguments])
    assert message in str(end.value)


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("acc_z [G]", "unit 'G' does not fit a_z (expected one of m/s2, mm/s2, g)"),
        ("acc z (raw) [counts]", "unit 'counts' does not fit a_z (expected one of m/s2, mm/s2, g)"),
    ],
)
def test_an_unknown_unit_behind_the_name_of_a_named_column_is_refused_unless_its_unit_is_given(tmp_path, column, said):
    file = write(tmp_path / "my.csv", time=TIME, **{column: np.sin(2 * np.pi * 4 * TIME)})
    with pytest.raises(InputError) as refusal:
        alone.recording(file, {"columns": {"a_z": {"column": column}}})
    assert str(refusal.value) == f"{file}: column {column!r}: {said}"
    assert alone.recording(file, {"columns": {"a_z": {"column": column}}, "unit": "g"})["a_z"].max() > 9.7


def test_a_known_unit_counts_among_other_brackets_and_empty_ones_are_none(tmp_path):
    wave = np.sin(2 * np.pi * 4 * TIME)
    file = write(tmp_path / "my.csv", **{"time []": TIME, "acc [g] (raw)": wave})
    found = alone.recording(file, {"columns": {"time": {"column": "time []"}, "a_z": {"column": "acc [g] (raw)"}}})
    np.testing.assert_allclose(found["a_z"], 9.80665 * wave)


def test_rows_with_a_field_more_than_there_are_names_are_refused(tmp_path):
    """Read on, a_z would be what stands behind it."""
    rows = "\n".join(f"{time},{np.sin(time)}," for time in TIME)
    (tmp_path / "my.csv").write_text(f"time,a_z\n{rows}\n")
    with pytest.raises(InputError, match="my.csv: line 2: 3 fields, expected one for each of the 2 names"):
        alone.recording(tmp_path / "my.csv")


def test_columns_that_are_not_read_are_named(tmp_path, capsys):
    file = write(tmp_path / "my.csv", time=TIME, a_x=np.sin(TIME), az=np.cos(TIME), speed=0 * TIME)
    main(["comfort", "--iso2631", str(file)])
    assert "columns not read: az (if it is a_z: --column a_z='az'), speed" in capsys.readouterr().out


def test_the_first_time_constant_counts_in_no_band(recording):
    """A steady sine is in one band for all of the time that its running rms is known."""
    found = alone.ride(alone.recording(recording, {"columns": {"a_z": {"column": "up"}}, "unit": "g"}))
    assert any(sentence.endswith("FU 100.0 %; bands overlap") for sentence in found.remarks), found.remarks
    assert np.isnan(found.signals["a_v"][:100]).all() and np.isfinite(found.signals["a_v"][101:]).all()
    assert "NaN" not in found.text()


S = np.arange(0, 400.01, 0.1)
PROFILE = 0.002 * np.sin(2 * np.pi * S / 12)


def test_units_may_stand_behind_the_names_of_a_profile(tmp_path):
    plain = write(tmp_path / "plain.csv", s=S, elevation=PROFILE)
    headed = write(tmp_path / "headed.csv", **{"s [m]": S, "elevation [mm]": 1e3 * PROFILE})
    first, second = (alone.roughness(file, 100.0).table for file in (plain, headed))
    pd.testing.assert_frame_equal(first, second)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"distance": S, "z": PROFILE}, "expected columns s and any of left, right, elevation (found distance, z)"),
        ({"s": S, "elevation": 1e3 * PROFILE}, "expected less than 100 m/km: are s and heights in m"),
        ({"s": S, "elevation [furlong]": PROFILE}, "unit 'furlong' does not fit"),
    ],
)
def test_profiles_that_cannot_be_meant_are_refused(tmp_path, columns, message):
    file = write(tmp_path / "my.csv", **columns)
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iri", str(file)])
    assert message in str(end.value) and str(file) in str(end.value)


@pytest.mark.parametrize(
    ("columns", "named", "said"),
    [
        ({"dist [ft]": S, "elevation": PROFILE}, {"s": "dist [ft]"}, "column 'dist [ft]': unit 'ft' does not fit s (expected one of m, km, cm, mm)"),
        ({"s [ft]": S, "elevation": PROFILE}, {}, "column 's [ft]': unit 'ft' does not fit s"),
        ({"s": S, "h [in]": PROFILE}, {"left": "h [in]"}, "column 'h [in]': unit 'in' does not fit elevation"),
    ],
)
def test_a_profile_in_an_unknown_unit_is_refused_by_the_quantity_it_is_in(tmp_path, columns, named, said):
    file = write(tmp_path / "my.csv", **columns)
    with pytest.raises(InputError) as refusal:
        alone.roughness(file, 100.0, columns={name: {"column": column} for name, column in named.items()})
    assert str(refusal.value).startswith(f"{file}: {said}")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--local", "nan"], "--local: nan, expected an IRI above 0 m/km"),
        (["--local", "-1"], "--local: -1.0, expected"),
        (["--segment", "0.1"], "--segment: 0.1 m, expected 0.5 m or more, what the profile resolves"),
        (["--segment", "nan"], "segment: nan is not a length"),
    ],
)
def test_what_means_nothing_for_a_profile_is_refused(tmp_path, arguments, message):
    """Samples 0.5 m apart: within less than that nothing is known."""
    file = write(tmp_path / "my.csv", s=S[::5], elevation=PROFILE[::5])
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iri", str(file), *arguments])
    assert message in str(end.value) and [each.name for each in tmp_path.iterdir()] == ["my.csv"]
    main(["comfort", "--iri", str(file), "--local", "3", "--segment", "0.5"])


@pytest.mark.parametrize(("every", "told"), [(1, False), (3, False), (5, True), (10, True)])
def test_an_iri_of_samples_too_far_apart_is_told_to_be_too_low(tmp_path, every, told):
    """A random walk: at 1 m its IRI is four fifths of that at 0.1 m."""
    heights = 1e-3 * np.random.default_rng(1).standard_normal(S.size).cumsum()
    file = write(tmp_path / "my.csv", s=S[::every], elevation=heights[::every])
    remarks = alone.roughness(file, 100.0).remarks
    said = f"samples up to {every / 10:g} m apart, expected 0.3 m or less (ASTM E1926)"
    assert any(remark.startswith(said) for remark in remarks) == told


@pytest.mark.parametrize("positions", [np.arange(0, 400, 1.25), np.delete(S, range(1000, 1015))])
def test_a_profile_whose_samples_lie_more_than_1_m_apart_somewhere_is_refused(tmp_path, positions):
    file = write(tmp_path / "my.csv", **{"s [m]": positions, "elevation": np.zeros(positions.size)})
    with pytest.raises(InputError) as refusal:
        alone.roughness(file, 100.0)
    apart = f"{np.diff(positions).max():.4g}"
    assert str(refusal.value).startswith(f"{file}: column 's [m]': samples up to {apart} m apart, expected 1 m or less")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("way,left\n0,0\n0.2,0\n\n0.1,0\n0.3,0\n", "line 5, column 'way': 0.1 m after 0.2 m (expected positions that ascend)"),
        ("way,left\n0,0\n0.2,0\n0.2,0\n", "line 4, column 'way': 0.2 m after 0.2 m"),
        ("way,left\n0,0\n,0\n0.2,0\n", "line 3, column 'way': no number"),
        ("way,left\n,0\n0.1,0\n0.2,0\n", "line 2, column 'way': no number"),
    ],
)
def test_positions_that_do_not_ascend_are_told_by_line_and_column(tmp_path, content, said):
    file = tmp_path / "my.csv"
    file.write_text(content)
    with pytest.raises(SystemExit) as end:
        main(["comfort", "--iri", str(file), "--column", "s=way"])
    assert str(end.value).startswith(f"error: {file}: {said}")


def test_help_says_which_columns_are_needed(capsys):
    with pytest.raises(SystemExit):
        main(["comfort", "--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert "a column s, the distance" in said and "elevation [mm]" in said


@pytest.mark.parametrize("rate", [100.009, 99.991])
def test_a_long_record_of_nearly_100_hz_is_kept_to_its_end_and_no_further(tmp_path, rate):
    """25 min: at 100 Hz it lasts as long, which are 13 samples fewer or more."""
    time = np.arange(150_000) / rate
    found = alone.recording(write(tmp_path / "my.csv", time=time, a_z=np.sin(2 * np.pi * time)))
    assert found.attrs["rate"] == 100.0
    assert 0.0 <= time[-1] - float(found["time"][-1]) < 0.01
    inside = slice(50, -50)
    np.testing.assert_allclose(found["a_z"][inside], np.sin(2 * np.pi * found["time"])[inside], atol=1e-3)


def test_a_recording_without_time_is_refused(tmp_path):
    pd.DataFrame({"t": [0.0, 0.01], "a_z": [0.0, 1.0]}).to_csv(tmp_path / "my.csv", index=False)
    with pytest.raises(InputError, match="no column time .found t, a_z.; name it with --column"):
        alone.recording(tmp_path / "my.csv")
