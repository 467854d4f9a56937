"""What each step is told of the configuration, and so what makes it run again."""

import pytest

from ridecomfort import config, schema, stepsettings
from tests.projects import DRIVE, HEADER, read, write


def test_a_model_without_effects_of_ones_own_does_not_depend_on_their_folder(project, own_effects):
    """So that its results stay when the first one is added. A diagnosis looks among them all."""
    study = config.load({**own_effects, "effects": ["headwind"]}, project)
    folder = lambda step, model: stepsettings.of_step(study, step, "own", model)["effects_folder"]
    assert folder("compare", "base") is None and folder("simulate", "base") is None
    assert folder("compare", "headwind") == "mine" and folder("diagnose", "base") == "mine"


def test_a_diagnosis_is_told_the_bounds_of_what_is_calibrated_and_a_parameter_that_is_not_may_be_uncertain(project):
    chosen = {"parameters": ["damping_front", "spring_stiffness_front"], "bounds": {"damping_front": [900, 4000]}}
    study = config.load({"sites": ["own"], "calibration": chosen, "diagnosis": {"uncertain": {"tyre_friction": 0.1}}}, project)
    settings = stepsettings.of_step(study, "diagnose", model="base")
    assert settings["bounds"] == {"damping_front": [900, 4000], "spring_stiffness_front": [15000, 40000]}
    assert settings["uncertain"]["tyre_friction"] == 0.1


def test_thresholds_may_name_their_source(project):
    stated = {"a_x": {"PT": [-1.0, 1.0, "our own"], "ND": [-2, 2], "AG": [-5, 3]}}
    jerk = {"lying": [-0.3, 0.3, "a guess"]}
    study = config.load({"sites": ["own"], "comfort": {"thresholds": stated, "jerk": jerk}}, project)
    told = stepsettings.of_step(study, "thresholds", "own")
    assert told["thresholds"]["a_x"]["PT"] == [-1.0, 1.0, "our own"] and told["jerk"] == jerk


def test_the_inspection_of_a_road_is_told_where_the_wheel_tracks_lie_and_where_the_runs_drive(project):
    write(project, "own", {"road": {"file": "road.crg"}, "sampling": {"lateral_position": {"uniform": [0.1, 0.4]}}})
    study = config.load({"sites": ["own"], "comfort": {"iri": {"wheel_tracks": [-0.5, 1.0]}}}, project)
    inspection = stepsettings.of_step(study, "inspect", "own")
    assert inspection["wheel_tracks"] == [-0.5, 1.0]
    assert inspection["lateral_position"] == pytest.approx(0.25)


@pytest.mark.parametrize("step", ["simulate", "thresholds", "road", "sample"])
def test_a_step_is_told_only_what_it_uses(project, step):
    plain = config.load({"sites": ["own"]}, project)
    sharded = config.load({"sites": ["own"], "simulation": {"runs_per_shard": 10, "keep_drives": True}}, project)
    assert stepsettings.as_json(plain, step, "own", "base") == stepsettings.as_json(sharded, step, "own", "base")
    assert "runs_per_shard" not in stepsettings.as_json(plain, step, "own", "base")


def test_the_page_tells_how_its_roads_drives_and_diagnosis_were_made(project):
    study = config.load({"sites": ["own"], "alignment": {"search": 0.7}}, project)
    told = stepsettings.of_step(study, "report", model="base")
    assert told["alignment"] == {"search": 0.7} and "uncertain" in told["diagnosis"]
    assert told["sites"]["own"]["road"] == study.sites["own"]["road"]["options"] and told["sites"]["own"]["road"]
    # Tables and figures are not made anew for that.
    assert not {"alignment", "diagnosis"} & set(stepsettings.of_step(study, "tables", model="base"))


def test_what_is_told_of_verdicts_on_smaller_models_is_told_anew_when_these_are_others(project, monkeypatch):
    monkeypatch.chdir(project)
    study = config.load({"sites": ["ts1"], "effects": ["damper_knee"]}, project)
    told = lambda: stepsettings.of_step(study, "diagnosed", model=study.model)["told_before"]
    assert told() == {}
    seen = []
    for text in ("{}", '{"verdict": "named"}'):
        for model in ("base", "damper_knee", "payload"):
            (project / "results" / "diagnosis" / model).mkdir(parents=True, exist_ok=True)
            (project / "results" / "diagnosis" / model / "verdict.json").write_text(text)
        seen.append(told())
    assert [list(one) for one in seen] == [["base"], ["base"]] and seen[0] != seen[1]


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


def test_another_title_of_a_site_makes_its_pages_again_and_nothing_that_they_show(project):
    scan = {"road": {"scan": {"profiles": "road.crg", "trajectory": "road.crg"}}}
    steps = ("survey", "road", "inspect", "measured", "calibrate", "compare", "simulate", "iri", "maps", "tables", "report")
    told = []
    for title in ("Own", "Our own"):
        write(project, "own", {**scan, "title": title})
        study = config.load({"sites": ["own"]}, project)
        told.append({step: stepsettings.as_json(study, step, "own", "base") for step in steps})
    assert {step for step in steps if told[0][step] != told[1][step]} == {"tables", "report"}


def test_tables_and_figures_are_told_which_stand_ins_a_vehicle_is_calibrated_on(project):
    told = lambda site, step: stepsettings.of_step(config.load({"sites": [site]}, project), step, site, "base")["standin_calibrations"]
    for step in ("tables", "figures", "report", "compared", "located"):
        assert told("ts2", step) == ["ts1"] and told("own", step) == []


@pytest.mark.parametrize(
    ("comfort", "again"), [({"maps": {"probability": 0.7}}, {"maps", "report"}), ({"exposure": {"trip": 600}}, {"tables", "report"})]
)
def test_tables_and_figures_are_not_made_again_for_what_they_do_not_read(project, comfort, again):
    before, after = (config.load({"sites": ["own"], **changed}, project) for changed in ({}, {"comfort": comfort}))
    told = lambda study, step: stepsettings.as_json(study, step, "own", "base")
    assert {step for step in ("maps", "tables", "figures", "report") if told(before, step) != told(after, step)} == again


def test_noise_densities_of_a_data_sheet_are_compared_with_in_si_units(project):
    drive = {**DRIVE, "noise_density": {"accelerometer_ug": 100.0, "gyroscope_deg_s": 0.01}}
    (project / "drive.csv").write_text(HEADER)
    write(project, "own", {"road": {"file": "road.crg"}, "drives": [drive]})
    study = config.load({**read(project), "sites": ["own"]}, project)
    density = stepsettings.of_step(study, "compare", "own", "base")["noise_density"]["drive"]
    assert density == pytest.approx({"accelerometer": 100e-6 * 9.80665, "gyroscope": 0.01 * 3.141592653589793 / 180})
    # Alignment does not depend on it.
    assert "noise_density" not in stepsettings.as_json(study, "measured", "own")
