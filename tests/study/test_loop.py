"""The user's loop as Snakemake plans it: compare, diagnose, switch on, compare again; and the study that runs it forward."""

from __future__ import annotations

import json
import re
import shutil

import pytest
import yaml

from ridecomfort.study import digest
from tests.study.conftest import Project

pytestmark = pytest.mark.slow

NAMED = {"sites": ["ts1"], "verdict": "named", "effects": [{"name": "suspension_friction", "like": []}], "reasons": []}


@pytest.fixture(scope="module")
def plan(repository, tmp_path_factory):
    """The jobs that a call plans in the paper's study before anything has run; ``verdict`` lies there already if given."""
    folder = tmp_path_factory.mktemp("loop")
    shutil.copytree(repository / "config", folder / "config")
    project = Project(folder, repository)

    def jobs(*arguments, verdict=None):
        file = folder / "results" / "diagnosis" / "base" / "verdict.json"
        if verdict:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(json.dumps({**verdict, "vehicle_digest": digest(folder / "config" / "vehicles" / "midsize.yaml")}))
        answer = project.snakemake("--dry-run", *arguments)
        file.unlink(missing_ok=True)
        assert answer.status == 0, answer.text
        return set(answer.jobs)

    return jobs


def test_compare_needs_neither_a_diagnosis_nor_the_simulated_study(plan):
    jobs = plan("compare")
    assert {"comparison ts3 base", "critical ts2 base", "located ts1", "ladder", "compared"} <= jobs
    assert not any(job.startswith(("diagnosis", "simulate", "iri")) for job in jobs)


def test_an_effect_that_is_switched_on_is_a_rung_more(plan):
    jobs = plan("compare", "--config", "effects=[suspension_friction]")
    for model in ("base", "suspension_friction"):
        assert f"calibrate ts1 {model}" in jobs and f"comparison ts2 {model}" in jobs and f"critical ts3 {model}" in jobs


def test_every_model_is_fitted_to_drives_that_are_aligned_for_it(plan):
    jobs = plan("compare", "--config", "effects=[suspension_friction]")
    models = ("base", "suspension_friction")
    assert {job for job in jobs if job.startswith("realigned")} == {f"realigned {site} {model}" for site in ("ts1", "ts2", "ts3") for model in models}


def test_a_calibration_begins_from_that_of_the_model_with_an_effect_less(plan):
    target = "results/ts1/damper_asymmetry+suspension_friction/calibration.nc"
    jobs = plan(target, "--config", "effects=[suspension_friction, damper_asymmetry]")
    models = {job.removeprefix("calibrate ts1 ") for job in jobs if job.startswith("calibrate")}
    assert models == {"base", "suspension_friction", "damper_asymmetry+suspension_friction"}


def test_compare_goes_on_with_a_verdict_that_is_there(plan):
    assert "comparison ts1 suspension_friction" in plan("compare", verdict=NAMED)


def test_a_ladder_takes_its_titles_from_the_verdict_as_it_is_now(repository, tmp_path):
    """Its models are the same whether the verdict is named or a cluster."""
    shutil.copytree(repository / "config", tmp_path / "config")
    project, ladder, one = Project(tmp_path, repository), "results/ladder/base.nc", ("--config", "sites=[ts1]")
    verdict = tmp_path / "results" / "diagnosis" / "base" / "verdict.json"
    named = {**NAMED, "vehicle_digest": digest(tmp_path / "config" / "vehicles" / "midsize.yaml")}
    cluster = {**named, "verdict": "cluster", "effects": [{"name": "suspension_friction", "like": ["top_mount"]}]}
    verdict.parent.mkdir(parents=True)
    verdict.write_text(json.dumps(named))
    table = [line.split("\t") for line in project.snakemake(ladder, "--summary", *one).text.splitlines()]
    for made in (tmp_path / row[0] for row in table if row[-1] == "update pending"):
        made.parent.mkdir(parents=True, exist_ok=True)
        made.touch()
    assert project.snakemake("-j1", ladder, "--touch", *one).status == 0
    assert project.snakemake("--dry-run", ladder, *one).jobs == []
    verdict.write_text(json.dumps(cluster))
    assert project.snakemake("--dry-run", ladder, *one).jobs == ["ladder"]


def test_the_study_diagnoses_before_it_knows_its_ladder(plan):
    jobs = plan()
    assert {"diagnosis base", "report", "tables", "figures"} <= jobs
    assert "ladder" not in jobs  # which models stand on it, the verdict decides


def test_the_study_can_be_left_without_the_loop(plan):
    jobs = plan("--config", "diagnosis={forward: false}")
    assert {"ladder", "compared", "report"} <= jobs
    assert not any(job.startswith(("diagnosis", "diagnosed", "standin_score")) for job in jobs)


def test_diagnose_shows_its_evidence(plan):
    assert {"diagnosis base", "diagnosed"} <= plan("diagnose")


def test_what_is_not_diagnosed_is_said(project, repository):
    """The sites of the first car alone are searched, and a user who put his own behind the paper's would take their verdict for his."""
    shutil.copytree(repository / "config", project.folder / "config", dirs_exist_ok=True)
    second = project.folder / "config" / "sites" / "ts2.yaml"
    second.write_text(re.sub("(?m)^calibrated_on.*$", "", second.read_text()))
    said = "ts2: not diagnosed, being of another car than ts1 (expected alone: --config sites=[ts2])"
    answer = project.snakemake("--dry-run", "diagnose", "--config", "sites=[ts1, ts2]")
    assert said in answer.text and "measured ts1" in answer.jobs and "measured ts2" not in answer.jobs
    answer = project.snakemake("--dry-run", "diagnose", "--config", "sites=[ts1, ts3]")
    assert "not diagnosed" not in answer.text and "measured ts3" in answer.jobs
    content = yaml.safe_load(second.read_text())
    second.write_text(yaml.safe_dump({**content, "calibrated_on": "none"}))
    answer = project.snakemake("--dry-run", "diagnose", "--config", "sites=[ts1, ts2]")
    said = "ts2: not diagnosed, being compared with the nominal vehicle, not the calibrated one of ts1 (expected alone: --config sites=[ts2])"
    assert said in answer.text and "of another car" not in answer.text
    held_out = [{**drive, "role": "check"} for drive in content["drives"]]
    second.write_text(yaml.safe_dump({**content, "calibrated_on": "none", "drives": held_out}))
    answer = project.snakemake("--dry-run", "diagnose", "--config", "sites=[ts1, ts2]")
    assert "ts2: not diagnosed, being calibrated nowhere, with all drives held out (expected drives with role: fit)" in answer.text
    assert "of another car" not in answer.text


def test_sites_without_drives_have_nothing_to_compare(project):
    answer = project.snakemake("--dry-run")
    assert answer.status == 0, answer.text
    assert "report" in answer.jobs
    assert not any(job.split()[0] in ("comparison", "located", "ladder", "compared", "diagnosis", "diagnosed") for job in answer.jobs)
    assert project.snakemake("--dry-run", "compare", "diagnose").jobs == []
