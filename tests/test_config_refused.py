"""Each mistake in the configuration is answered by name in one line, before anything runs."""

import re

import pytest
import xarray as xr
import yaml

from ridecomfort import config, schema
from ridecomfort.errors import InputError
from ridecomfort.report.tables import agreement, comfort
from ridecomfort.vocabulary import CALIBRATED
from tests.projects import DRIVE, HEADER, assert_said, columns, write


@pytest.mark.parametrize(
    ("effects", "said"),
    [
        (["magic"], "unknown effect 'magic'"),
        (["suspension friction"], "unknown effect 'suspension friction'; did you mean 'suspension_friction'?"),
        ([{"pull": {"sise": 1.0}}], "effect 'pull' has no parameter 'sise'"),
        ([{"pull": {"size": 3.0}}, "pull"], "'pull' stands twice, expected each effect once"),
        (["pull", "headwind", "pull"], "'pull' stands twice, expected each effect once"),
        ([{"pull": {"size": -3.0}}], "pull: size: -3 N, expected 0 to 10 N (how much)"),
    ],
)
def test_mistake_in_an_effect(project, own_effects, effects, said):
    assert_said(project, {**own_effects, "effects": effects}, f"effects: {said}", config.STUDY)


def test_a_form_is_not_used_where_the_next_diagnosis_would_delete_it(project):
    (project / "results" / "diagnosis" / "base").mkdir(parents=True)
    said = "effects_folder: '{}' is in results/, expected a folder of your own".format(project / "results" / "diagnosis" / "base")
    assert_said(project, {"sites": ["own"], "effects_folder": "results/diagnosis/base"}, said, config.STUDY)


def test_a_file_that_is_no_effect_is_missed_before_anything_runs(project, own_effects):
    (project / "mine" / "bad.py").write_text("effect = (")
    with pytest.raises(InputError, match="bad.py: cannot be loaded: SyntaxError"):
        config.load(own_effects, project)


def test_a_key_that_stands_twice_in_a_line_is_refused(project):
    vehicle = project / config.VEHICLES / "midsize.yaml"
    vehicle.write_text(vehicle.read_text().replace("sprung_mass: {value:", "sprung_mass: {value: 900, value:", 1))
    with pytest.raises(InputError, match=r"midsize.yaml: line \d+: is not valid YAML \(key 'value' stands in line \d+ already\)"):
        config.load({"sites": ["own"]}, project)


def test_a_key_that_stands_twice_is_refused(project):
    (project / config.SITES / "own.yaml").write_text("road:\n  file: road.crg\ntitle: one\ntitle: two\n")
    assert_said(project, {"sites": ["own"]}, "line 4: is not valid YAML (key 'title' stands in line 3 already)", project / config.SITES / "own.yaml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("sites: {[mine]}\n", "line 1: is not valid YAML (a key is a list or mapping, expected a name)"),
        ("runs: 3\n{a: b}: c\n", "line 2: is not valid YAML (a key is a list or mapping, expected a name)"),
        ("runs: 3\nsites: [2026-02-30]\n", "line 2: is not valid YAML ('2026-02-30': day is out of range for month)"),
        ("runs: 3\nseed: !!int many\n", "line 2: is not valid YAML ('many': invalid literal for int() with base 10: 'many')"),
    ],
)
def test_yaml_that_cannot_be_made_into_settings_is_answered_with_its_line(tmp_path, text, said):
    (tmp_path / "study.yaml").write_text(text)
    with pytest.raises(InputError) as refused:
        schema.read_yaml(tmp_path / "study.yaml")
    assert str(refused.value) == f"{tmp_path / 'study.yaml'}: {said}"


SPEEDS = [120, 100, 80, 70, 60, 50, 40, 30, 20, 10]


STUDY_MISTAKES = [
    ({"runs": 0}, "runs: 0, expected at least 1"),
    ({"runs": 2.5}, "runs: 2.5, expected a whole number"),
    ({"runs": "many"}, "runs: 'many', expected a whole number"),
    ({"runs": True}, "runs: True, expected a whole number"),
    ({"run": 3}, "unknown key 'run'; did you mean 'runs'"),
    ({"simulation": {"stepp": 1}}, "simulation: unknown key 'stepp'; did you mean 'step'"),
    ({"simulation": {"step": "1e-3"}}, "write 0.001"),
    ({"simulation": {"rate": 333}}, "expected a rate that a step of 0.001 s divides"),
    ({"space": {"spacing": -0.25}}, "space: spacing: -0.25, expected at least 0.1"),
    ({"calibration": {"tolerance": 1e-17}}, "calibration: tolerance: 1e-17, expected at least 1e-12"),
    ({"space": {"run_in": float("nan")}}, "space: run_in: nan, expected a finite number"),
    ({"comfort": {"critical_length": -5}}, "comfort: critical_length: -5, expected at least 1"),
    ({"calibration": {"parameters": ["dampers"]}}, "calibration: parameters: 'dampers' is no parameter of a vehicle"),
    ({"calibration": {"parameters": ["damping_frnt"]}}, "'damping_frnt' is no parameter of a vehicle; did you mean 'damping_front'?"),
    ({"calibration": {"bounds": {"tyre_frictoin": [0.7, 1.4]}}}, "'tyre_frictoin' is no parameter of a vehicle; did you mean 'tyre_friction'?"),
    ({"calibration": {"bounds": {"damping_front": [0, 9000]}}}, "calibration: bounds: 'damping_front' is not calibrated"),
    ({"calibration": {"bounds": {"tyre_friction": [1.4, 0.7]}}}, "tyre_friction: [1.4, 0.7], expected the lower value first"),
    ({"calibration": {"profiles": ["damping_front"]}}, "calibration: profiles: 'damping_front' is not calibrated"),
    ({"calibration": {"profiles": ["damper_knee.nee"]}}, "calibration: profiles: 'damper_knee.nee': effect 'damper_knee' has no parameter 'nee'"),
    ({"calibration": {"profiles": ["nope.nope"]}}, "calibration: profiles: 'nope.nope': unknown effect 'nope'"),
    ({"calibration": {"start": [{"damping_front": 1500}]}}, "calibration: start: 'damping_front' is not calibrated"),
    ({"calibration": {"start": [{"tyre_friction": 2}]}}, "start: tyre_friction: 2, expected within the bounds 0.7 to 1.4"),
    ({"calibration": {"start": {"tyre_friction": 1}}}, "calibration: start: {'tyre_friction': 1}, expected a list"),
    ({"diagnosis": {"uncertain": {"roll_inertai": 0.1}}}, "'roll_inertai' is no parameter of a vehicle; did you mean 'roll_inertia'?"),
    ({"diagnosis": {"uncertain": {"tyre_friction": 0.1}}}, "diagnosis: uncertain: 'tyre_friction' is calibrated"),
    ({"diagnosis": {"uncertain": {"roll_inertia": 0}}}, "diagnosis: uncertain: roll_inertia: 0, expected"),
    ({"calibration": {"signals": ["a_w"]}}, "'a_w', expected one of a_x"),
    ({"comfort": {"iri": {"speed_km_h": [50, 60]}}}, "comfort: iri: thresholds: VG: 10 values, expected one for each of the 2 speeds"),
    ({"comfort": {"iri": {"speed_km_h": SPEEDS[::-1]}}}, "VG: 11.44 m/km at 120 km/h and 5.72 m/km at 100 km/h, expected edges that fall"),
    ({"comfort": {"iri": {"speed_km_h": [*SPEEDS[:-1], 20]}}}, "comfort: iri: speed_km_h: 20 stands twice, expected different speeds"),
    (
        {"calibration": {"bounds": {"spring_stiffness_front": [2000000, 10000000]}}},
        "bounds: spring_stiffness_front: 2e+06 to 1e+07 N/m, expected an interval within 5000 to 300000 N/m",
    ),
    ({"calibration": {"bounds": {"tyre_friction": [1, 1]}}}, "tyre_friction: 1 to 1, expected an interval within 0.1 to 2"),
    ({"comfort": {"sections": "gliding"}}, "comfort: sections: 'gliding', expected one of sequential, sliding"),
    ({"comfort": {"jerk": {"seated": [2.9, -2.9]}}}, "jerk: seated: [2.9, -2.9], expected the lower value first"),
    ({"comfort": {"jerk": {"seated": [-2.9]}}}, "jerk: seated: [-2.9], expected at least 2 entries"),
    ({"comfort": {"jerk": {"seated": [2.9, 2.9]}}}, "comfort: jerk: seated: [2.9, 2.9], expected a value below 0 and one above it"),
    ({"comfort": {"jerk": {"seated": [0, 2.9]}}}, "comfort: jerk: seated: [0, 2.9], expected a value below 0 and one above it"),
    (
        {"comfort": {"thresholds": {"a_z": {"PT": [0.1, 0.1], "ND": [-0.1, 0.1], "AG": [-0.3, 0.3]}}}},
        "comfort: thresholds: a_z: PT: [0.1, 0.1], expected a value below 0 and one above it",
    ),
    ({"comfort": {"thresholds": {"a_x": {"PT": [-1, 1, 2], "ND": [-2, 2], "AG": [-5, 3]}}}}, "2, expected text"),
    ({"comfort": {"iri": {"wheel_tracks": [0.75, -0.75]}}}, "wheel_tracks: [0.75, -0.75], expected the lower value first"),
    ({"comfort": {"iri": {"wheel_tracks": []}}}, "wheel_tracks: [], expected at least 1"),
    ({"comfort": {"iri": {"moving_average": 0}}}, "moving_average: 0, expected more than 0"),
    ({"comfort": {"iso2631": {"seat": {"natural_frequency": 4}}}}, "seat: key 'damping_ratio' is missing"),
    ({"comfort": {"iso2631": {"seat": {"natural_frequency": -4, "damping_ratio": 0.3}}}}, "-4, expected at least 0.5"),
    ({"comfort": {"iso2631": {"label": "worst"}}}, "label: 'worst', expected one of severe, mild, middle"),
    ({"comfort": {"iso2631": {"bands": {"LU": [0.4, 0.63]}}}}, "nothing between NU and LU"),
    ({"comfort": {"exposure": {"trip": 0}}}, "trip: 0, expected at least 1"),
    ({"comfort": {"maps": {"probability": 1.5}}}, "probability: 1.5, expected at most 1"),
    ({"sites": []}, "sites: [], expected at least 1 entry (Names"),
    ({"sites": [None]}, "sites: entry 1: None, expected text; YAML reads what stands there as nothing (null, ~), write it in quotes if it is a name"),
    ({"sites": [True]}, "sites: entry 1: True, expected text; YAML reads what stands there as yes or no (true, false), write it in quotes"),
    ({"sites": ["nowhere"]}, "unknown site 'nowhere'; known sites: "),
    ({"vehicle": "tank"}, "vehicle: unknown vehicle 'tank'; known vehicles: "),
    ({"effects": ["magic"]}, "effects: unknown effect 'magic'"),
    ({"vehicle": ""}, "vehicle: unknown vehicle ''; known vehicles: "),
    ({"effects": [{"a": {"b": "c"}}]}, "effects: entry 1: {'a': {'b': 'c'}}, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{"damper_knee": None}]}, "effects: entry 1: {'damper_knee': None}, expected a name, or {name: {parameter: number}}"),
    ({"effects": ["pull", 3]}, "effects: entry 2: 3, expected a name, or {name: {parameter: number}}"),
    ({"effects": [None]}, "effects: entry 1: None, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{}]}, "effects: entry 1: {}, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{"pull": None, "size": 1}]}, "effects: entry 1: {'pull': None, 'size': 1}, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{"a": {"b": 1}, "c": {}}]}, "effects: entry 1: {'a': {'b': 1}, 'c': {}}, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{3: {"knee": 0.1}}]}, "effects: entry 1: {3: {'knee': 0.1}}, expected a name, or {name: {parameter: number}}"),
    ({"effects": [{"damper_knee": {"knee": "1e-1"}}]}, "effects: entry 1: damper_knee: knee: '1e-1', expected a number; YAML reads this as text, write 0.1"),
    ({"calibration": {"tolerance": "1e-20"}}, "tolerance: '1e-20', expected a number; YAML reads this as text, write 1.0e-20"),
    ({"effects": [{"damper_knee": {"knee": "0.1"}}]}, "knee: '0.1', expected a number; YAML reads this as text, write 0.1"),
    ({"effects": [{"damper_knee": {"knee": "0.1", "share": "small"}}]}, "'share': 'small'}}, expected a name, or {name: {parameter: number}}"),
    ({"comfort": {"jerk": {5: [-2.9, 2.9]}}}, "comfort: jerk: 5, expected text (a name of letters, digits and underscores)"),
    ({"effects_folder": "missing"}, "effects_folder: no such folder"),
]


@pytest.mark.parametrize(("change", "said"), STUDY_MISTAKES, ids=[said for _, said in STUDY_MISTAKES])
def test_mistake_in_the_study(project, change, said):
    assert_said(project, {"sites": ["own"], **change}, said, config.STUDY)


def test_names_that_would_have_been_right_are_always_said_in_the_same_order(project):
    said = "'damping_front' is not calibrated; expected of " + ", ".join(sorted(CALIBRATED))
    assert_said(project, {"sites": ["own"], "calibration": {"bounds": {"damping_front": [0, 9000]}}}, said, config.STUDY)


@pytest.mark.parametrize(("change", "said"), STUDY_MISTAKES[:1])
def test_mistake_on_the_command_line(project, change, said):
    with pytest.raises(InputError, match="--config: runs"):
        config.load({"sites": ["own"], **change}, project, given=["runs"])


def merged(project, file, line):
    """Settings as Snakemake hands them over: a block of the command line merged into that of the file."""
    (project / config.STUDY).write_text(yaml.safe_dump({"sites": ["own"], "calibration": file}))
    return {"sites": ["own"], "calibration": {**file, **line}}


@pytest.mark.parametrize(
    ("file", "line", "source"),
    [
        ({"tolerance": 5}, {"restarts": "3"}, config.STUDY),
        ({"tolerance": 5}, {"tolerance": "6"}, "--config"),
        ({}, {"tolerance": "5"}, "--config"),
        ({"start": [{"damping_rear": 1}]}, {"restarts": "3"}, config.STUDY),
        ({"parameters": ["damping_front"]}, {"start": [{"damping_rear": "1"}]}, "--config"),
    ],
)
def test_a_mistake_of_the_file_is_not_blamed_on_the_command_line(project, file, line, source):
    with pytest.raises(InputError, match=f"^{source}: calibration: (tolerance: .* expected at most|start: 'damping_rear' is not calibrated)"):
        config.load(merged(project, file, line), project, given=["calibration"])


def test_a_mistake_of_the_file_that_the_command_line_mends_is_none(project):
    study = config.load(merged(project, {"tolerance": 5}, {"tolerance": "0.01"}), project, given=["calibration"])
    assert study.settings["calibration"]["tolerance"] == 0.01


def test_a_bracket_on_the_command_line_that_is_not_closed_is_one_line(project):
    with pytest.raises(InputError, match="--config: '.damper_knee' is not valid YAML") as problem:
        config.load({"sites": ["own"], "effects": "[damper_knee"}, project, given=["effects"])
    assert "\n" not in str(problem.value)


def test_a_vehicle_outside_of_the_bounds_it_would_be_calibrated_in_is_refused_with_bounds_that_are_taken(project):
    """Calibrated in those of the paper's car, a van would be another one, for which effects would make up."""
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "vehicle": "van", "drives": [DRIVE]})
    with pytest.raises(InputError, match="calibration: bounds") as refused:
        config.load({"sites": ["own"]}, project)
    said, _, wanted = str(refused.value).partition(", such as ")
    assert "config/vehicles/van.yaml has spring_stiffness_rear" not in said and "tyre_radial_stiffness 212642, tyre_radial_damping 200" in said
    assert wanted == "tyre_radial_stiffness: [106000, 425000], tyre_radial_damping: [100, 400]"
    config.load({"sites": ["own"], "calibration": {"bounds": yaml.safe_load("{" + wanted + "}")}}, project)
    # What nobody calibrates may be anything, and so may a vehicle that was not measured.
    config.load({"sites": ["own"], "calibration": {"parameters": ["tyre_friction"]}}, project)
    write(project, "own", {"road": {"file": "road.crg"}, "vehicle": "van"})
    config.load({"sites": ["own"]}, project)


def test_what_a_vehicle_has_not_is_calibrated_in_bounds_of_ones_own(project):
    """Half and twice nil are no interval; no one would know of them when the step ends."""
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [DRIVE]})
    file = project / config.VEHICLES / "midsize.yaml"
    vehicle = yaml.safe_load(file.read_text())
    vehicle["parameters"]["anti_roll_stiffness_rear"]["value"] = 0.0
    file.write_text(yaml.safe_dump(vehicle))
    chosen = {"parameters": ["anti_roll_stiffness_rear"]}
    said = "calibration: bounds: config/vehicles/midsize.yaml has anti_roll_stiffness_rear 0, half and twice which are no bounds, expected some within 0 to"
    assert_said(project, {"sites": ["own"], "calibration": chosen}, said, config.STUDY)
    config.load({"sites": ["own"], "calibration": {**chosen, "bounds": {"anti_roll_stiffness_rear": [0, 20000]}}}, project)


def test_starting_values_lie_within_the_bounds_that_the_vehicle_gives(project):
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [DRIVE]})
    start = {"parameters": ["damping_front"], "start": [{"damping_front": 2000}, {"damping_front": 9000}]}
    said = "calibration: start: damping_front: 9000, expected within 1050 to 4200, half and twice the value of config/vehicles/midsize.yaml"
    assert_said(project, {"sites": ["own"], "calibration": start}, said, config.STUDY)
    config.load({"sites": ["own"], "calibration": {**start, "bounds": {"damping_front": [1000, 10000]}}}, project)


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
    ({"road": {"file": "road.crg"}, "drives": [{**DRIVE, "name": ""}]}, "drives: entry 1: name: '', expected some text (Name of the drive"),
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


def test_mistake_in_a_vehicle(project):
    file = project / config.VEHICLES / "midsize.yaml"
    vehicle = yaml.safe_load(file.read_text())
    vehicle["parameters"]["sprung_mass"]["unit"] = "t"
    file.write_text(yaml.safe_dump(vehicle))
    with pytest.raises(InputError, match="sprung_mass: unit 't', expected 'kg'"):
        config.load({"sites": ["own"]}, project)


def test_a_source_of_a_vehicle_says_something(project):
    file = project / config.VEHICLES / "midsize.yaml"
    vehicle = yaml.safe_load(file.read_text())
    vehicle["parameters"]["sprung_mass"]["source"] = ""
    file.write_text(yaml.safe_dump(vehicle))
    said = "parameters: sprung_mass: source: '', expected some text (Where the value comes from)"
    assert_said(project, {"sites": ["own"]}, said, file)
