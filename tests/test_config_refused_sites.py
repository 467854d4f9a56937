"""Each mistake in the file of a site, its road and its drives is answered by name in one line, before anything runs."""

import re

import pytest
import xarray as xr

from ridecomfort import config, schema
from ridecomfort.errors import InputError
from ridecomfort.report.tables import agreement, comfort
from tests.projects import DRIVE, HEADER, assert_said, columns, write

SITE_MISTAKES = [
    ({"road": {"file": "gone.crg"}}, "road: file: no such file 'gone.crg'"),
    ({"rode": {"file": "road.crg"}}, "'rode'"),
    ({"road": {"options": {}}}, "road: expected either a file or a scan"),
    (
        {"road": {"scan": {"profiles": "road.crg", "trajectory": "t.csv"}}},
        "road: scan: trajectory: no such file 't.csv'",
    ),
    ({}, "key 'road' is missing"),
    ({"road": {"file": "road.crg"}, "speed": {"limit_km_h": -50}}, "speed: limit_km_h: -50, expected at least 5"),
    ({"road": {"file": "road.crg"}, "drives": [DRIVE]}, "drives: entry 1: file: no such file 'drive.csv'"),
    ({"road": {"file": "road.crg"}, "drives": [{**DRIVE, "role": "fix"}]}, "role: 'fix', expected one of fit, check"),
    ({"road": {"file": "road.crg"}, "drives": {**DRIVE, "role": "check"}}, "drives: a mapping of file, role, sensor, expected a list, each entry of which begins with '- '"),
    ({"road": {"file": "road.crg"}, "drives": [{**DRIVE, "name": " "}]}, "drives: entry 1: name: ' ', expected some text (Name of the drive"),
    (
        {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "file": "road.crg", "columns": {"time": {"column": "t", "unit": "m"}}}]},
        "drives: entry 1: columns: time: unit 'm' does not fit time (expected one of s, ms",
    ),
    (
        {
            "road": {"file": "road.crg"},
            "drives": [{**DRIVE, "file": "road.crg", "columns": {"roll_rate": {"column": "gyro_x [rad/s]", "unit": "deg/s"}}}],
        },
        "drives: entry 1: columns: roll_rate: unit 'deg/s' for roll_rate, but its column is headed 'gyro_x [rad/s]'",
    ),
    (
        {
            "road": {"file": "road.crg"},
            "drives": [{**DRIVE, "file": "road.crg", "columns": {n: {"column": "rate", "unit": "deg/s"} for n in ("roll_rate", "pitch_rate")}}],
        },
        "drives: entry 1: columns: pitch_rate: column 'rate' stands for roll_rate already",
    ),
    (
        {"road": {"file": "road.crg"}, "drives": [{"file": "road.crg", "sensor": {"above_wheel_centres": 1.0}}]},
        "drives: entry 1: sensor: key 'behind_front_axle' is missing",
    ),
    ({"road": {"file": "road.crg"}, "drives": [{"file": "road.crg"}]}, "drives: entry 1: key 'sensor' is missing"),
    (
        {
            "road": {"file": "road.crg"},
            "drives": [{**DRIVE, "file": "road.crg", "columns": {"s": {"column": "d", "unit": "m"}}, "distance_start": 222}],
        },
        "drives: entry 1: distance_start: 222 beside a column for s, which says so itself, expected one of them",
    ),
    (
        {
            "road": {"file": "road.crg"},
            "drives": [{**DRIVE, "file": "road.crg", "columns": {"e": {"column": "y", "unit": "m"}}, "lateral_position": 0.3}],
        },
        "drives: entry 1: lateral_position: 0.3 beside a column for e, which says so itself, expected one of them",
    ),
    (
        {"road": {"file": "road.crg"}, "sampling": {"road_friction": {"uniform": [-0.1, 1]}}},
        "-0.1, expected more than 0",
    ),
    (
        {"road": {"file": "road.crg"}, "sampling": {"lateral_position": {"normal": [0, -1]}}},
        "-1, expected at least 0",
    ),
    ({"road": {"file": "road.crg"}, "sampling": {"lateral_position": {"cauchy": [0, 1]}}}, "unknown key 'cauchy'"),
    ({"road": {"file": "road.crg"}, "calibrated_on": "own"}, "calibrated_on: site 'own' has no measured drives"),
    ({"road": {"file": "road.crg"}, "standin": True}, "makes no data for 'own'; remove `standin`"),
    ({"road": {"file": "road.crg"}, "vehicle": "tank"}, "vehicle: unknown vehicle 'tank'"),
]


@pytest.mark.parametrize(("content", "said"), SITE_MISTAKES, ids=[said for _, said in SITE_MISTAKES])
def test_mistake_in_a_site(project, content, said):
    write(project, "own", content)
    assert_said(project, {"sites": ["own"]}, said, config.SITES / "own.yaml")


def calibrated(project, **on):
    for site, other in on.items():
        (project / f"{site}.csv").write_text(f"{HEADER}{','.join([str(ord(site))] * 8)}\n")  # records of their own
        write(project, site, {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "file": f"{site}.csv"}], "calibrated_on": other})


def test_sites_that_are_calibrated_on_each_other_are_refused(project):
    said = "calibrated_on: a on b on a is a circle, expected a site that is calibrated on its own drives"
    calibrated(project, a="b", b="a")
    assert_said(project, {"sites": ["a"]}, said, config.SITES / "a.yaml")
    calibrated(project, a="b", b="c", c="b")
    assert_said(project, {"sites": ["a", "b", "c"]}, "calibrated_on: b on c on b is a circle", config.SITES / "a.yaml")
    calibrated(project, a="b", b="c", c="c")
    config.load({"sites": ["a", "b", "c"]}, project)


def test_a_record_is_not_both_fitted_and_held_out(project):
    (project / "drive.csv").write_text(HEADER)
    twice = [{**DRIVE, "columns": columns()}, {**DRIVE, "name": "again", "file": "./drive.csv", "columns": columns(), "role": "check"}]
    write(project, "own", {"road": {"file": "road.crg"}, "drives": twice})
    assert_said(project, {"sites": ["own"]}, "drives: entry 2: file: './drive.csv' is entry 1 already", config.SITES / "own.yaml")
    other = {**columns(), "v_x": {"column": "a_x", "unit": "m/s"}, "a_x": {"column": "v_x", "unit": "m/s2"}}
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [twice[0], {**twice[1], "columns": other}]})
    config.load({"sites": ["own"]}, project)
    write(project, "second", {"road": {"file": "road.crg"}, "drives": [{**twice[1], "columns": other}], "calibrated_on": "own"})
    config.load({"sites": ["own", "second"]}, project)  # it is held out on both
    write(project, "second", {"road": {"file": "road.crg"}, "drives": [{**twice[0], "role": "check"}], "calibrated_on": "own"})
    said = "drives: entry 1: file: 'drive.csv' is fitted on 'own', on which this site is calibrated"
    assert_said(project, {"sites": ["own", "second"]}, said, config.SITES / "second.yaml")


def test_a_copy_of_a_record_is_no_other_record(project):
    """Its noise would be what repeats share, and what a model explains of a drive that nothing was fitted to."""
    row = "0,20,0,0,9.81,0,0,0\n"
    for name, text in (("first", HEADER + row), ("again", HEADER + row), ("other", HEADER + row.replace("20", "21"))):
        (project / f"{name}.csv").write_text(text)
    first, again, other = ({**DRIVE, "file": f"{name}.csv", "columns": columns()} for name in ("first", "again", "other"))
    said = "drives: entry 3: file: 'again.csv' holds the same as 'first.csv', which is entry 1 already, expected a record once"
    for role in ("fit", "check"):
        write(project, "own", {"road": {"file": "road.crg"}, "drives": [first, other, {**again, "role": role}]})
        assert_said(project, {"sites": ["own"]}, said, config.SITES / "own.yaml")
    for name in ("first", "again"):
        (project / f"{name}.nc").touch()
    empty = [{**DRIVE, "file": f"{name}.nc"} for name in ("first", "again")]
    write(project, "own", {"road": {"file": "road.crg"}, "drives": empty})
    config.load({"sites": ["own"]}, project)  # no record at all, which is said where it is read
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [first, {**other, "role": "check"}]})
    write(project, "second", {"road": {"file": "road.crg"}, "drives": [other, again], "calibrated_on": "own"})
    said = "drives: entry 2: file: 'again.csv' holds the same as 'first.csv', which is fitted on 'own', on which this site is calibrated"
    assert_said(project, {"sites": ["own", "second"]}, said, config.SITES / "second.yaml")
    write(project, "second", {"road": {"file": "road.crg"}, "drives": [other], "calibrated_on": "own"})
    config.load({"sites": ["own", "second"]}, project)  # it is held out on both


def wide(project, width):
    """A road's header, as wide as that."""
    sections = f"LONG_SECTION_V_RIGHT = {-width / 2}\nLONG_SECTION_V_LEFT = {width / 2}\nLONG_SECTION_V_INCREMENT = 0.1"
    head = f"$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 0.1\n{sections}\n$\n$KD_DEFINITION\n#:LRFI\nD:long section 1,m\n$\n$$$$\n"
    (project / "road.crg").write_text(head)


@pytest.mark.parametrize(
    ("width", "runs", "lateral", "said"),
    [
        (4.0, 4000, {"uniform": [-3, 3]}, "4000 runs from -3 to 3 m, with wheels 0.75 m to either side, expected on the road of own"),
        (4.0, 4000, {"normal": [0, 0.5]}, "4000 runs from -1.831 to 1.831 m, with wheels"),
        (4.0, 4000, {"normal": [0, 0.2]}, None),
        (4.0, 4000, {"uniform": [-1.25, 1.25]}, None),
        (1.8, 4000, {"normal": [0, 0.2]}, "expected on the road of own, -0.9 to 0.9 m"),
        (None, 4000, {"uniform": [-3, 3]}, None),
    ],
)
def test_runs_that_would_leave_the_road_are_missed_before_anything_runs(project, width, runs, lateral, said):
    """Of what the header of the road says; one that says nothing is seen to when it is read."""
    if width is not None:
        wide(project, width)
    write(project, "own", {"road": {"file": "road.crg"}, "sampling": {"lateral_position": lateral}})
    settings = {"sites": ["own"], "runs": runs}
    if said is None:
        config.load(settings, project)
    else:
        assert_said(project, settings, f"sampling: lateral_position: {said}" if said[0].isdigit() else said, config.SITES / "own.yaml")


def test_wheel_tracks_beside_a_road_are_missed_before_anything_runs(project):
    wide(project, 4.0)
    settings = {"sites": ["own"], "comfort": {"iri": {"wheel_tracks": [-7, 7]}}}
    assert_said(project, settings, "comfort: iri: wheel_tracks: -7 m, expected a place on the road of own, -2 to 2 m", config.STUDY)
    assert_said(project, {**settings, "sites": ["ts1"]}, "expected a place on the road of ts1, -2 to 2 m", config.STUDY)


def test_a_column_that_a_drive_does_not_have_is_missed_before_anything_runs(project):
    (project / "drive.csv").write_text(HEADER.replace("a_z", "acc"), encoding="utf-8-sig")
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "columns": columns(a_z="acc_z")}]})
    with pytest.raises(InputError, match=r"own.yaml: drives: entry 1: .*drive.csv: no column 'acc_z' for a_z \(found time, .*acc, "):
        config.load({"sites": ["own"]}, project)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "columns": columns(a_z="acc")}]})
    config.load({"sites": ["own"]}, project)


@pytest.mark.parametrize(
    ("left_out", "said"),
    [
        (("roll_rate", "pitch_rate", "yaw_rate"), "no roll_rate, pitch_rate, yaw_rate (expected time, a_x, "),
        (("time",), "no time (expected time, a_x, "),
        (("v_x",), "no v_x or s (expected time, a_x, "),
    ],
)
def test_a_quantity_that_a_drive_needs_is_missed_before_anything_runs(project, left_out, said):
    kept = columns(*left_out)
    (project / "drive.csv").write_text(",".join(kept) + "\n")
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "columns": kept}]})
    assert_said(project, {"sites": ["own"]}, f"drives: entry 1: columns: {said}", config.SITES / "own.yaml")
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [DRIVE]})
    assert_said(project, {"sites": ["own"]}, f"drive.csv: line 1: {said}", config.SITES / "own.yaml")
    empty = lambda names: xr.Dataset({name: ("time", [0.0, 1.0]) for name in names})
    empty(kept).to_netcdf(project / "drive.nc")
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "file": "drive.nc"}]})
    assert_said(project, {"sites": ["own"]}, f"drive.nc: variables: {said}", config.SITES / "own.yaml")
    empty(columns()).to_netcdf(project / "drive.nc")
    config.load({"sites": ["own"]}, project)


def test_a_variable_that_a_netcdf_drive_does_not_have_is_missed_before_anything_runs(project):
    xr.Dataset({name: ("time", [0.0, 1.0]) for name in columns()}).to_netcdf(project / "drive.nc")
    drive = {**DRIVE, "file": "drive.nc", "columns": {"a_z": {"column": "heave", "unit": "g"}}}
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [drive]})
    assert_said(project, {"sites": ["own"]}, "drive.nc: has no variable 'heave' for a_z", config.SITES / "own.yaml")


def test_a_drive_of_a_format_that_nothing_reads_is_missed_before_anything_runs(project):
    (project / "drive.txt").touch()
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [{**DRIVE, "file": "drive.txt"}]})
    said = "drives: entry 1: file: drive.txt: no reader for '.txt' (expected .csv, .nc, .nc4)"
    assert_said(project, {"sites": ["own"]}, said, config.SITES / "own.yaml")


def test_a_site_may_not_be_named_like_a_target(project):
    write(project, "tables", {"road": {"file": "road.crg"}})
    assert_said(project, {"sites": ["tables"]}, "'tables' is the name of something else", config.STUDY)


def test_every_name_of_a_rule_or_beside_sites_in_tables_is_taken(repository):
    files = [repository / "Snakefile", *(repository / "workflow" / "rules").glob("*.smk")]
    rules = {name for file in files for name in re.findall(r"^ *(?:rule|checkpoint) (\w+):", file.read_text(), re.MULTILINE)}
    assert {"all", "calibrate", "diagnosis", "standin_score"} < rules
    folders = {name for file in files for name in re.findall(r"results/(\w+)/", file.read_text())}
    assert (rules | folders | {agreement.POOLED, comfort.PAPER}) - config.TAKEN == set()


def test_a_stand_in_lies_in_its_folder(project):
    content = schema.read_yaml(project / config.SITES / "ts1.yaml")
    content["road"]["file"] = "elsewhere/road.crg"
    write(project, "ts1", content)
    assert_said(project, {"sites": ["ts1"]}, "expected a file in data/ts1/", config.SITES / "ts1.yaml")
