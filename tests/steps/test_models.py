"""The chain of models: prefixes of the configured effects, then those of the verdict, each model named alike whatever the order."""

import json
import os
import shutil

import pytest

from ridecomfort import config
from ridecomfort.schema import read_yaml
from ridecomfort.steps import models
from ridecomfort.study import digest

NAMED = {
    "sites": ["ts1"],
    "verdict": "named",
    "effects": [{"name": "suspension_friction", "like": []}, {"name": "damper_asymmetry", "like": []}],
}


@pytest.fixture
def study(repository, tmp_path):
    shutil.copytree(repository / "config", tmp_path / "config")
    return lambda **given: config.load({**read_yaml(tmp_path / config.STUDY), **given}, tmp_path)


def test_without_effects_or_verdict_there_is_the_base_alone(study):
    assert models.chain(study()).models == ("base",) and models.chain(study()).titles == ()


def test_every_model_has_one_effect_more_in_the_order_of_the_configuration(study):
    found = models.chain(study(effects=["suspension_friction", {"damper_asymmetry": {"front": 0.2}}]))
    assert found.models == ("base", "suspension_friction", "damper_asymmetry+suspension_friction")
    assert found.titles == ("+ suspension_friction", "+ damper_asymmetry")


def test_the_last_configured_model_is_the_studys_own(study):
    own = study(effects=["suspension_friction", "damper_asymmetry"])
    assert models.chain(own).models[-1] == own.model


def test_a_verdict_goes_on_where_the_configuration_ends(study):
    found = models.chain(study(effects=["damper_asymmetry"]), NAMED)
    assert found.models == ("base", "damper_asymmetry", "damper_asymmetry+suspension_friction")


@pytest.mark.parametrize("kind", ["outside", "nothing", "suspect"])
def test_verdicts_that_name_nothing_add_nothing(study, kind):
    assert models.chain(study(), {**NAMED, "verdict": kind}).models == ("base",)


def test_a_cluster_is_called_by_all_of_its_names(study):
    cluster = {"verdict": "cluster", "effects": [{"name": "suspension_friction", "like": ["top_mount"]}]}
    assert models.chain(study(), cluster).titles == ("+ suspension_friction or top_mount",)


def test_the_verdict_on_disk_is_followed_unless_the_study_does_not_go_forward(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert models.known(study()).models == ("base",)
    file = tmp_path / models.verdict_file("base")
    file.parent.mkdir(parents=True)
    own = {**NAMED, "vehicle_digest": digest(tmp_path / "config" / "vehicles" / "midsize.yaml")}
    file.write_text(json.dumps(own))
    assert len(models.known(study()).models) == 3
    assert models.known(study(diagnosis={"forward": False})).models == ("base",)
    for other in ({"sites": ["another_site"]}, {"vehicle_digest": digest(tmp_path / "config" / "vehicles" / "van.yaml")}):
        file.write_text(json.dumps({**own, **other}))
        assert models.known(study()).models == ("base",)


@pytest.fixture
def told(tmp_path, monkeypatch):
    """Writes a verdict on a model that names these effects of the drives that were diagnosed, or of others."""
    monkeypatch.chdir(tmp_path)

    def write(model, *names, drives="those", kind="named"):
        file = tmp_path / models.verdict_file(model)
        file.parent.mkdir(parents=True, exist_ok=True)
        content = {"sites": ["ts1"], "verdict": kind, "effects": [{"name": name, "like": []} for name in names], "digests": {"ts1": drives}}
        file.write_text(json.dumps({**content, "vehicle_digest": digest(tmp_path / "config" / "vehicles" / "midsize.yaml")}))
        return file.relative_to(tmp_path).as_posix()

    return write


def test_what_a_verdict_makes_of_a_model_is_diagnosed_again_until_nothing_more_is_named(study, told):
    own, asked = study(), []
    told("base", "top_mount")
    assert models.known(own).models == ("base", "top_mount") and models.later(own) == []
    second = told("top_mount", "payload")
    third = told("payload+top_mount", kind="nothing")
    assert list(models.diagnosed(own, asked.append)) == asked == ["base", "top_mount", "payload+top_mount"]
    assert models.known(own).models == tuple(asked) and models.later(own) == [second, third]
    assert models.known(own).titles == ("+ top_mount", "+ payload")
    assert models.later(study(diagnosis={"forward": False})) == []
    told("top_mount", "payload", drives="others")
    assert models.known(own).models == ("base", "top_mount") and models.later(own) == []


def test_a_later_verdict_that_is_older_than_the_one_before_it_does_not_go_on_from_it(study, told):
    first = told("base", "top_mount")
    second = told("top_mount", "payload")
    os.utime(first, (2000.0, 2000.0))
    for time, is_later in ((1000.0, False), (2000.0, True), (3000.0, True)):
        os.utime(second, (time, time))
        assert models.later(study()) == ([second] if is_later else [])


def test_a_verdict_that_is_asked_for_is_made_before_it_is_read_and_no_more_than_three_are(study, told):
    names = ["top_mount", "payload", "crosswind", "bump_steer", "anti_dive"]
    made = lambda model: told(model, names[len(asked)]) and asked.append(model)
    asked = []
    assert list(models.diagnosed(study(), made)) == asked == ["base", "top_mount", "payload+top_mount"]
    assert models.known(study()).models[-1] == "crosswind+payload+top_mount"


def test_a_model_begins_from_the_one_before_it_in_the_chain(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    own = study(effects=["suspension_friction", "damper_asymmetry"])
    assert models.below(own, "base") is None and models.below(own, "suspension_friction") == "base"
    assert models.below(own, own.model) == "suspension_friction"
    assert models.below(study(effects=["damper_asymmetry", "suspension_friction"]), own.model) == "damper_asymmetry"
    assert models.below(study(), own.model) == "base"  # asked for by its name alone
    file = tmp_path / models.verdict_file("base")
    file.parent.mkdir(parents=True)
    file.write_text(json.dumps({**NAMED, "vehicle_digest": digest(tmp_path / "config" / "vehicles" / "midsize.yaml")}))
    assert models.below(study(), own.model) == "suspension_friction"


def test_files_are_those_of_the_measured_sites_model_by_model(study):
    files = models.chain(study(sites=["ts1", "ts2"], effects=["payload"])).files(study(sites=["ts1", "ts2"]), "comparison.nc")
    assert files == [f"results/{site}/{model}/comparison.nc" for site in ("ts1", "ts2") for model in ("base", "payload")]


def test_a_ladder_is_of_the_models_that_were_compared_even_if_a_verdict_has_come_since(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    own = study(sites=["ts1"])
    asked = models.known(own).files(own, "comparison.nc")
    file = tmp_path / models.verdict_file("base")
    file.parent.mkdir(parents=True)
    file.write_text(json.dumps({**NAMED, "vehicle_digest": digest(tmp_path / "config" / "vehicles" / "midsize.yaml")}))
    assert json.loads(models.ladder_settings(own, asked))["models"] == ["base"]
    later = json.loads(models.ladder_settings(own, models.known(own).files(own, "comparison.nc")))
    assert later["models"] == ["base", "suspension_friction", "damper_asymmetry+suspension_friction"]
    assert later["titles"] == ["+ suspension_friction", "+ damper_asymmetry"]
