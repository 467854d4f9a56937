"""Each mistake in the configuration is answered by name in one line, before anything runs."""

import pytest
import yaml

from ridecomfort import config, schema
from ridecomfort.errors import InputError
from ridecomfort.vocabulary import CALIBRATED
from tests.projects import DRIVE, HEADER, assert_said, write


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
