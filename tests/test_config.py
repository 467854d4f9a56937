"""The configuration: the paper's defaults, and each mistake answered by name in one line."""

import shutil

import pytest
import xarray as xr
import yaml

from ridecomfort import config, schema, stepsettings
from ridecomfort.errors import InputError


@pytest.fixture
def project(repository, tmp_path):
    """A project folder with a copy of the configuration and a user's site without drives."""
    shutil.copytree(repository / "config", tmp_path / "config")
    (tmp_path / "road.crg").touch()
    write(tmp_path, "own", {"road": {"file": "road.crg"}})
    return tmp_path


def write(project, site, content):
    (project / config.SITES / f"{site}.yaml").write_text(yaml.safe_dump(content))


def read(project):
    return schema.read_yaml(project / config.STUDY)


def test_drives_handed_in_are_in_the_order_of_their_numbers(project):
    (project / "elsewhere").mkdir()
    for number in (10, 9, 1, 2, 11):
        (project / "elsewhere" / f"run{number}.csv").touch()
    write(project, "own", {"road": {"file": "road.crg"}, "simulated": "elsewhere"})
    study = config.load({**read(project), "sites": ["own"], "runs": 5}, project)
    assert study.handed_in("own") == [f"elsewhere/run{number}.csv" for number in (1, 2, 9, 10, 11)]


def test_the_study_file_states_the_defaults(repository):
    stated = schema.read_yaml(repository / config.STUDY)
    assert stated == schema.defaults("study", sites=stated["sites"])


def test_the_defaults_are_the_papers(shared):
    published = yaml.safe_load((shared / "paper" / "published.yaml").read_text())
    study = schema.defaults("study", sites=["ts1"])
    assert study["runs"] == published["sampling"]["runs_per_site"]
    assert study["comfort"]["critical_length"] == published["critical_length_m"]
    assert study["comfort"]["thresholds"] == published["acceleration_thresholds"]
    bands = {name: [low, None if high == float("inf") else high] for name, (low, high) in published["iso2631_bands"].items()}
    assert study["comfort"]["iso2631"]["bands"] == bands
    iri = dict(published["iri_thresholds"])
    assert study["comfort"]["iri"]["speed_km_h"] == iri.pop("kmh")
    assert study["comfort"]["iri"]["thresholds"] == iri
    bounds = published["calibration_bounds"].values()
    assert list(study["calibration"]["bounds"].values()) == list(bounds)


def test_the_sites_are_sampled_as_published(shared, repository):
    published = yaml.safe_load((shared / "paper" / "published.yaml").read_text())["sampling"]
    study = config.load(schema.read_yaml(repository / config.STUDY), repository)
    for site in ("ts1", "ts2", "ts3"):
        assert study.sites[site]["sampling"] == {
            name: published[name][site] for name in ("speed_deviation", "lateral_position", "road_friction")
        }


def test_every_key_says_what_it_means():
    def silent(part, path):
        for key, entry in part.get("properties", {}).items():
            if "description" not in entry and "$ref" not in entry and entry.get("type") != "object":
                yield f"{path}{key}"
            yield from silent(entry, f"{path}{key}: ")

    assert not list(silent(schema.load("study"), "")) and not list(silent(schema.load("site"), ""))


def test_shards_name_every_run_once(project):
    for runs, size in [(1, 250), (250, 250), (4000, 250), (4001, 250), (20000, 333)]:
        study = config.load({"sites": ["own"], "runs": runs, "simulation": {"runs_per_shard": size}}, project)
        named = [range(int(first), int(last) + 1) for first, last in (shard.split("-") for shard in study.shards)]
        assert [run for shard in named for run in shard] == list(range(runs))


def test_a_site_is_a_road_and_nothing_else(project):
    study = config.load({"sites": ["own"]}, project)
    assert study.calibrated_on("own") is None and study.measured == [] and study.made == []
    assert study.model == "base" and study.vehicle("own") == "config/vehicles/midsize.yaml"


def test_a_site_calibrated_elsewhere_brings_that_site_along(project):
    study = config.load({"sites": ["ts2"]}, project)
    assert study.names == ["ts2"] and set(study.sites) == {"ts2", "ts1"} and study.calibrations == ["ts1"]


EFFECT = """
from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    "{name}", "A test.", "none", "drive", (Parameter("size", "N", 0.0, 1.0, (0.0, 10.0), "how much"),)
)


def act(force, speed, size):
    return force + size
"""


@pytest.fixture
def own_effects(project):
    (project / "mine").mkdir()
    for name in ("pull", "headwind"):
        (project / "mine" / f"{name}.py").write_text(EFFECT.format(name=name))
    return {"sites": ["own"], "effects_folder": "mine"}


def test_effects_name_the_model_in_whatever_order(project, own_effects):
    study = config.load({**own_effects, "effects": [{"pull": {"size": 2.0}}, "headwind"]}, project)
    assert study.model == "headwind+pull"
    assert study.effects("headwind+pull") == {"headwind": {}, "pull": {"size": 2.0}}
    assert study.effects("base") == {}
    assert study.effect_files("headwind+pull") == ["mine/headwind.py", "mine/pull.py"]


def test_a_model_without_effects_of_ones_own_does_not_depend_on_their_folder(project, own_effects):
    """So that its results stay when the first one is added. A diagnosis looks among them all."""
    study = config.load({**own_effects, "effects": ["headwind"]}, project)
    folder = lambda step, model: stepsettings.of_step(study, step, "own", model)["effects_folder"]
    assert folder("compare", "base") is None and folder("simulate", "base") is None
    assert folder("compare", "headwind") == "mine" and folder("diagnose", "base") == "mine"


@pytest.mark.parametrize(
    ("effects", "said"),
    [
        (["magic"], "unknown effect 'magic'"),
        (["suspension friction"], "unknown effect 'suspension friction'; did you mean 'suspension_friction'?"),
        ([{"pull": {"sise": 1.0}}], "effect 'pull' has no parameter 'sise'"),
        ([{"pull": {"size": -3.0}}], "pull: size: -3 N, expected 0 to 10 N (how much)"),
    ],
)
def test_mistake_in_an_effect(project, own_effects, effects, said):
    assert_said(project, {**own_effects, "effects": effects}, f"effects: {said}", config.STUDY)


def test_a_file_that_is_no_effect_is_missed_before_anything_runs(project, own_effects):
    (project / "mine" / "bad.py").write_text("effect = (")
    with pytest.raises(InputError, match="bad.py: cannot be loaded: SyntaxError"):
        config.load(own_effects, project)


def test_a_whole_number_may_be_written_with_a_point(project):
    study = config.load({"sites": ["own"], "runs": 4000.0, "seed": 7.0, "calibration": {"restarts": 2.0}}, project)
    found = study.settings["runs"], study.settings["seed"], study.settings["calibration"]["restarts"]
    assert found == (4000, 7, 2) and all(isinstance(value, int) for value in found)
    assert isinstance(study.settings["simulation"]["step"], float)
    assert_said(project, {"sites": ["own"], "runs": "4000"}, "runs: '4000', expected a whole number; YAML reads this as text, write 4000 ", config.STUDY)


def test_a_diagnosis_is_told_the_bounds_of_what_is_calibrated_and_a_parameter_that_is_not_may_be_uncertain(project):
    chosen = {"parameters": ["damping_front", "spring_stiffness_front"], "bounds": {"damping_front": [900, 4000]}}
    study = config.load({"sites": ["own"], "calibration": chosen, "diagnosis": {"uncertain": {"tyre_friction": 0.1}}}, project)
    settings = stepsettings.of_step(study, "diagnose", model="base")
    assert settings["bounds"] == {"damping_front": [900, 4000], "spring_stiffness_front": [15000, 40000]}
    assert settings["uncertain"]["tyre_friction"] == 0.1


def test_a_key_that_stands_twice_is_refused(project):
    (project / config.SITES / "own.yaml").write_text("road:\n  file: road.crg\ntitle: one\ntitle: two\n")
    assert_said(project, {"sites": ["own"]}, "line 4: is not valid YAML (key 'title' stands in line 3 already)", project / config.SITES / "own.yaml")


def test_thresholds_may_name_their_source(project):
    stated = {"a_x": {"PT": [-1.0, 1.0, "our own"], "ND": [-2, 2], "AG": [-5, 3]}}
    jerk = {"lying": [-0.3, 0.3, "a guess"]}
    study = config.load({"sites": ["own"], "comfort": {"thresholds": stated, "jerk": jerk}}, project)
    told = stepsettings.of_step(study, "thresholds", "own")
    assert told["thresholds"]["a_x"]["PT"] == [-1.0, 1.0, "our own"] and told["jerk"] == jerk


@pytest.mark.parametrize("step", ["simulate", "thresholds", "road", "sample"])
def test_a_step_is_told_only_what_it_uses(project, step):
    plain = config.load({"sites": ["own"]}, project)
    sharded = config.load({"sites": ["own"], "simulation": {"runs_per_shard": 10, "keep_drives": True}}, project)
    assert stepsettings.as_json(plain, step, "own", "base") == stepsettings.as_json(sharded, step, "own", "base")
    assert "runs_per_shard" not in stepsettings.as_json(plain, step, "own", "base")


def test_another_speed_in_the_study_leaves_the_measured_drives_as_they_are(project):
    before = config.load({"sites": ["ts1"]}, project)
    content = schema.read_yaml(project / config.SITES / "ts1.yaml")
    write(project, "ts1", {**content, "speed": {"limit_km_h": 70}})
    after = config.load({"sites": ["ts1"]}, project)
    changed = {
        step
        for step in ("standin_road", "standin_drives", "road", "measured", "calibrate", "compare", "sample", "simulate")
        if stepsettings.as_json(before, step, "ts1", "base") != stepsettings.as_json(after, step, "ts1", "base")
    }
    assert changed == {"simulate"}


def test_a_number_on_the_command_line_may_stand_in_a_block(project):
    study = config.load({"sites": ["own"], "space": {"spacing": "0.5"}}, project, given=["space"])
    assert study.settings["space"]["spacing"] == 0.5


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
    ({"space": {"run_in": float("nan")}}, "space: run_in: nan, expected a finite number"),
    ({"comfort": {"critical_length": -5}}, "comfort: critical_length: -5, expected at least 1"),
    ({"calibration": {"parameters": ["dampers"]}}, "calibration: parameters: 'dampers' is no parameter of a vehicle"),
    ({"calibration": {"bounds": {"damping_front": [0, 9000]}}}, "calibration: bounds: 'damping_front' is not calibrated"),
    ({"calibration": {"bounds": {"tyre_friction": [1.4, 0.7]}}}, "tyre_friction: [1.4, 0.7], expected the lower value first"),
    ({"calibration": {"profiles": ["damping_front"]}}, "calibration: profiles: 'damping_front' is not calibrated"),
    ({"calibration": {"start": [{"damping_front": 1500}]}}, "calibration: start: 'damping_front' is not calibrated"),
    ({"calibration": {"start": [{"tyre_friction": 2}]}}, "start: tyre_friction: 2, expected within the bounds 0.7 to 1.4"),
    ({"calibration": {"start": {"tyre_friction": 1}}}, "calibration: start: {'tyre_friction': 1}, expected a list"),
    ({"diagnosis": {"uncertain": {"roll_inertai": 0.1}}}, "diagnosis: uncertain: 'roll_inertai' is no parameter of a vehicle"),
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
    ({"comfort": {"jerk": {"seated": [-2.9]}}}, "jerk: seated: [-2.9], expected at least 2"),
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
    ({"sites": []}, "sites: [], expected at least 1"),
    ({"sites": ["nowhere"]}, "unknown site 'nowhere'; known sites: "),
    ({"vehicle": "tank"}, "vehicle: unknown vehicle 'tank'; known vehicles: "),
    ({"effects": ["magic"]}, "effects: unknown effect 'magic'"),
    ({"effects": [{"a": {"b": "c"}}]}, "is not of the expected form"),
    ({"effects_folder": "missing"}, "effects_folder: no such folder"),
]


@pytest.mark.parametrize(("change", "said"), STUDY_MISTAKES, ids=[said for _, said in STUDY_MISTAKES])
def test_mistake_in_the_study(project, change, said):
    assert_said(project, {"sites": ["own"], **change}, said, config.STUDY)


@pytest.mark.parametrize(("change", "said"), STUDY_MISTAKES[:1])
def test_mistake_on_the_command_line(project, change, said):
    with pytest.raises(InputError, match="--config: runs"):
        config.load({"sites": ["own"], **change}, project, given=["runs"])


SENSOR = {"behind_front_axle": 1.4, "above_wheel_centres": 0.2}
DRIVE = {"file": "drive.csv", "sensor": SENSOR}
HEADER = "time,v_x,a_x,a_y,a_z,roll_rate,pitch_rate,yaw_rate\n"


def columns(*left_out, **named):
    """Columns of a drive in SI units, headed by the names of their quantities or as ``named``."""
    units = {"time": "s", "v_x": "m/s", **dict.fromkeys(("a_x", "a_y", "a_z"), "m/s2")}
    return {
        name: {"column": named.get(name, name), "unit": units.get(name, "rad/s")}
        for name in HEADER.strip().split(",") if name not in left_out
    }  # fmt: skip


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


def assert_said(project, settings, said, file):
    with pytest.raises(InputError) as problem:
        config.load(settings, project)
    text = str(problem.value)
    assert said in text and text.startswith(f"{file}: ") and "\n" not in text, text


def test_noise_densities_of_a_data_sheet_are_compared_with_in_si_units(project):
    drive = {**DRIVE, "noise_density": {"accelerometer_ug": 100.0, "gyroscope_deg_s": 0.01}}
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [drive]})
    study = config.load({**read(project), "sites": ["own"]}, project)
    density = stepsettings.of_step(study, "compare", "own", "base")["noise_density"]["drive"]
    assert density == pytest.approx({"accelerometer": 100e-6 * 9.80665, "gyroscope": 0.01 * 3.141592653589793 / 180})
    # Alignment does not depend on it.
    assert "noise_density" not in stepsettings.as_json(study, "measured", "own")


def test_without_calibration_the_drives_of_one_vehicle_are_diagnosed_together(project):
    """Those that only hold drives out come behind one that has some to fit; of another vehicle nothing is diagnosed beside them."""
    (project / "drive.csv").write_text(HEADER)
    site = {"road": {"file": "road.crg"}, "drives": [DRIVE], "calibrated_on": "none"}
    write(project, "checked", {**site, "drives": [{**DRIVE, "role": "check"}]})
    write(project, "fitted", site)
    write(project, "of_a_van", {**site, "vehicle": "van"})
    study = config.load({"sites": ["checked", "of_a_van", "fitted"]}, project)
    assert study.diagnosed == ["of_a_van"]
    study = config.load({"sites": ["checked", "fitted", "of_a_van"]}, project)
    assert study.diagnosed == ["fitted", "checked"]
    study = config.load({"sites": ["checked"]}, project)
    assert study.diagnosed == [] and not study.forward


def test_the_study_goes_forward_only_where_drives_are_diagnosed_and_is_scored_only_on_stand_ins(project):
    paper = config.load({**read(project), "sites": ["ts1"]}, project)
    assert paper.forward and paper.scored
    bare = config.load({**read(project), "sites": ["own"]}, project)
    assert not bare.forward and not bare.scored
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [DRIVE]})
    own = config.load({**read(project), "sites": ["own"]}, project)
    assert own.forward and not own.scored
    assert not config.load({**read(project), "diagnosis": {"forward": False}}, project).forward
