"""What a configured study has: sites, runs, models, and which drives are calibrated on and diagnosed."""

from pathlib import Path

import yaml

from ridecomfort import config, modules, schema, stepsettings
from ridecomfort.steps import models
from tests.projects import DRIVE, HEADER, read, write


def test_drives_handed_in_are_in_the_order_of_their_numbers(project):
    (project / "elsewhere").mkdir()
    for number in (10, 9, 1, 2, 11):
        (project / "elsewhere" / f"run{number}.csv").touch()
    (project / "elsewhere" / "run12.CSV").touch()
    (project / "elsewhere" / "._run12.CSV").touch()  # as some systems leave beside a copy
    write(project, "own", {"road": {"file": "road.crg"}, "simulated": "elsewhere"})
    study = config.load({**read(project), "sites": ["own"], "runs": 6}, project)
    assert study.handed_in("own") == [*(f"elsewhere/run{number}.csv" for number in (1, 2, 9, 10, 11)), "elsewhere/run12.CSV"]


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


def test_effects_name_the_model_in_whatever_order(project, own_effects):
    study = config.load({**own_effects, "effects": [{"pull": {"size": 2.0}}, "headwind"]}, project)
    assert study.model == "headwind+pull"
    assert study.effects("headwind+pull") == {"headwind": {}, "pull": {"size": 2.0}}
    assert study.effects("base") == {}
    assert {"mine/headwind.py", "mine/pull.py"} <= set(study.effect_files("headwind+pull"))
    assert "mine/pull.py" not in study.effect_files("headwind")


def test_files_of_effects_come_with_those_of_the_package_that_they_import(project, own_effects):
    """Those that lie below a helper, too, else a change of it would leave the results as they were."""
    package = modules.PACKAGE.resolve()
    with (project / "mine" / "headwind.py").open("a") as file:
        file.write("\n\nfrom ridecomfort.effects import library\n")
    study = config.load({**own_effects, "effects": ["headwind", "steering_lag"]}, project)
    for files, helpers in (
        (study.effect_files("headwind+steering_lag"), ("effects/lag.py", "effects/contract.py", "effects/library.py", "errors.py")),
        (study.effect_files("steering_lag"), ("effects/steering_lag.py", "effects/lag.py", "effects/contract.py")),
        (study.library_files(), ("effects/lag.py", "effects/wave.py", "effects/swing.py", "errors.py")),
    ):
        assert {package / name for name in helpers} <= {(project / file).resolve() for file in files}
    assert not any(file.endswith(("wave.py", "errors.py")) for file in study.effect_files("steering_lag"))


def test_stand_in_drives_rest_on_every_effect_that_they_may_hide_and_on_no_other(project):
    """On all candidates of a draw: which it takes is a secret. A name that there is no effect of is passed over in the draw, too."""
    standin = schema.read_yaml(project / config.STANDIN)
    standin["measurement"]["effects"] = [{"among": ["payload", "tyre_runout", "magic"], "size": [1, 1]}, {"among": ["imu_tilt"], "size": [1, 1]}]
    (project / config.STANDIN).write_text(yaml.safe_dump(standin))
    files = config.load({"sites": ["ts1"]}, project).standin_files()
    effects = {Path(file).stem for file in files if Path(file).parent.name == "effects"}
    assert effects == {"payload", "tyre_runout", "imu_tilt", "wave", "contract", "__init__"}


def test_without_calibration_the_drives_of_one_vehicle_are_diagnosed_together(project):
    """Those that only hold drives out come behind one that has some to fit; of another vehicle nothing is diagnosed beside them."""
    (project / "drive.csv").write_text(HEADER)
    site = {"road": {"file": "road.crg"}, "drives": [DRIVE], "calibrated_on": "none"}
    write(project, "checked", {**site, "drives": [{**DRIVE, "role": "check"}]})
    write(project, "fitted", site)
    write(project, "of_a_van", {**site, "vehicle": "van"})
    bounds = {"spring_stiffness_rear": [20000, 78000], "tyre_radial_stiffness": [106000, 425000], "tyre_radial_damping": [100, 7000]}
    study = config.load({"sites": ["checked", "of_a_van", "fitted"], "calibration": {"bounds": bounds}}, project)
    assert study.diagnosed == ["of_a_van"]
    study = config.load({"sites": ["checked", "fitted", "of_a_van"], "calibration": {"bounds": bounds}}, project)
    assert study.diagnosed == ["fitted", "checked"]
    study = config.load({"sites": ["checked"]}, project)
    assert study.diagnosed == [] and not study.forward


def test_drives_are_aligned_for_every_model_but_that_which_they_were_aligned_for_first(project):
    (project / "drive.csv").write_text(HEADER)
    site = {"road": {"file": "road.crg"}, "drives": [DRIVE]}
    write(project, "fitted", site)
    write(project, "nominal", {**site, "calibrated_on": "none"})
    study = config.load({"sites": ["fitted", "nominal"], "effects": ["steering_lag"]}, project)
    assert study.aligned("fitted", "base") == "results/fitted/base/measured.nc"
    assert study.aligned("nominal", "base") == "results/nominal/measured.nc"
    assert study.aligned("nominal", "steering_lag") == "results/nominal/steering_lag/measured.nc"
    assert models.aligned_before(study, "fitted", "base") == "results/fitted/measured.nc"
    assert models.aligned_before(study, "fitted", "steering_lag") == "results/fitted/base/measured.nc"
    (project / "other.csv").write_text(HEADER + "0,21,0,0,9.81,0,0,0\n")
    write(project, "other", {**site, "drives": [{**DRIVE, "file": "other.csv"}], "calibrated_on": "nominal"})
    assert config.load({"sites": ["other"]}, project).is_fitted("nominal") and not study.is_fitted("nominal")
    told = {name: stepsettings.of_step(study, "realigned", name, "steering_lag") for name in study.names}
    assert "restarts" not in told["fitted"]["calibration"], "a rough fit has none"
    assert told["fitted"]["calibration"] and told["nominal"]["calibration"] is None, "only on drives of its own is a vehicle fitted"


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
