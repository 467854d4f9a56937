"""What the workflow does: a small study, what reruns, that shards leave no trace, and that drives computed elsewhere may take the place of ours."""

import math
import os
import shutil
import time

import numpy as np
import pandas as pd
import pytest
import yaml

from ridecomfort import config, stepsettings, store
from ridecomfort.steps import simulate
from ridecomfort.vocabulary import DRIVE
from tests.described import undescribed

pytestmark = pytest.mark.slow

METHODS = ("thresholds", "iso2631", "iri")


def test_lint_is_clean(project):
    answer = project.snakemake("--lint")
    assert answer.status == 0 and "good condition" in answer.text


def test_the_truth_is_sealed(repository):
    files = [repository / "Snakefile", *(repository / "workflow" / "rules").glob("*.smk")]
    users = [path.name for path in files if "truth" in path.read_text()]
    assert users == ["standin.smk"]


def test_sites_without_drives_cannot_be_compared(project):
    answer = project.snakemake("compare", "--dry-run")
    assert answer.status != 0 and "has measured drives, so that there is nothing to compare" in answer.text


def test_a_dry_run_of_the_papers_study_plans_every_step(repository, project):
    shutil.rmtree(project.folder / "config")
    shutil.copytree(repository / "config", project.folder / "config")
    answer = project.snakemake("--dry-run")
    assert answer.status == 0, answer.text
    study = yaml.safe_load((repository / "config" / "study.yaml").read_text())
    shards = math.ceil(study["runs"] / study["simulation"]["runs_per_shard"])
    assert sum(job.startswith("simulate ") for job in answer.jobs) == 3 * shards
    for once in ("calibrate ts1 base", "comparison ts3 base", "iri ts2 base", "agreement base", "maps ts3", "report"):
        assert once in answer.jobs
    assert "calibrate ts2 base" not in answer.jobs


def test_a_site_needs_no_more_than_a_road(finished):
    for site in ("one", "two"):
        for method in METHODS:
            found = store.read(finished.folder / "results" / site / "base" / "comfort" / f"{method}.nc")
            assert found.sizes["window"] == (250 - 50 - 25) // 5
            assert found.attrs["configuration_hash"]
    assert not any("calibration" in file or "comparison" in file for file in finished.files())


def test_every_file_tells_what_it_holds(finished):
    files = [file for file in finished.files() if file.endswith(".nc")]
    assert len(files) > 10
    assert {file: undescribed(store.read(finished.folder / file)) for file in files} == dict.fromkeys(files, [])
    by_samples = [file for file in files if "/base/" in file or "samples" in file]
    assert {store.seed(finished.folder / file) for file in by_samples} == {2021}


def test_drives_over_time_are_not_kept(finished):
    assert not any("/drives/" in file for file in finished.files())
    shards = {file for file in finished.files() if "/space/" in file}
    assert shards == {f"results/{site}/base/space/{runs}.nc" for site in ("one", "two") for runs in ("0000-0003", "0004-0005")}


def test_nothing_to_do_on_the_second_call(finished):
    answer = finished.snakemake("--dry-run", "one", "two")
    assert answer.status == 0 and "Nothing to be done" in answer.text


def test_deleted_tables_and_figures_are_made_again(project):
    """Of a study of one site, every file of which is there, and empty."""
    project.study(sites=["one"], runs=2)
    listed, now = project.snakemake("--summary").text.splitlines(), time.time()
    for file in [line.split("\t")[0] for line in listed if line.startswith("results/")]:
        path = project.folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        os.utime(path, (now, now))
    assert "Nothing to be done" in project.snakemake("--dry-run").text
    results = project.folder / "results"
    for deleted in ("tables/sites.csv", "figures/spectrum_one.pdf"):
        (results / deleted).unlink()
    assert {job.split()[0] for job in project.snakemake("--dry-run").jobs} == {"tables", "figures", "report"}
    for deleted in ("tables", "figures"):
        shutil.rmtree(results / deleted)
    assert {job.split()[0] for job in project.snakemake("--dry-run").jobs} == {"tables", "figures", "report"}


def test_touching_a_file_reruns_nothing(finished):
    for file in ("config/sites/one.yaml", "road.crg", "config/vehicles/midsize.yaml"):
        (finished.folder / file).touch()
    assert "Nothing to be done" in finished.snakemake("--dry-run", "one", "two").text


def test_changing_a_site_reruns_that_site_alone(finished):
    finished.site("two", speed={"limit_km_h": 50})
    try:
        jobs = finished.snakemake("--dry-run", "one", "two").jobs
    finally:
        finished.site("two")
    assert jobs and all(" two" in job for job in jobs)
    assert {job.split()[0] for job in jobs} == {"simulate", "space", *METHODS, "maps"}


def test_a_setting_reruns_the_step_that_uses_it(finished):
    jobs = finished.snakemake("--dry-run", "one", "--config", "comfort={iri: {segment: 25}}").jobs
    assert jobs == ["iri one base", "maps one"]


def test_maps_of_a_model_with_effects_lie_beside_those_of_the_base_model(finished):
    answer = finished.snakemake("--dry-run", "--summary", "one", "--config", "effects=[payload]")
    maps = {line.split("\t")[0] for line in answer.text.splitlines() if line.startswith("results/maps/")}
    assert maps == {f"results/maps/payload/one_{method}.geojson" for method in METHODS}
    assert {f"results/maps/one_{method}.geojson" for method in METHODS} <= finished.files()


def test_results_depend_neither_on_shards_nor_on_where_the_folder_lies(finished):
    moved = finished.copied(finished.folder.with_name("moved"))
    assert "Nothing to be done" in moved.snakemake("--dry-run", "one", "two").text
    comfort = [f"results/one/base/comfort/{method}.nc" for method in METHODS]
    answer = moved.snakemake("-j2", "--config", "simulation={runs_per_shard: 5}", "--", *comfort)
    assert answer.status == 0, answer.text
    assert "results/one/base/space/0000-0004.nc" in moved.files()
    for name in comfort:
        assert (moved.folder / name).read_bytes() == (finished.folder / name).read_bytes(), name


@pytest.fixture(scope="module")
def handed_in(finished, tmp_path_factory):
    """A project whose second site takes the drives of the first from files, one CSV and the others NetCDF."""
    project = finished.copied(tmp_path_factory.mktemp("handed_in"))
    results, elsewhere = project.folder / "results", project.folder / "elsewhere"
    elsewhere.mkdir()
    study = config.load(yaml.safe_load((project.folder / "config" / "study.yaml").read_text()), project.folder)
    one = {name: results / "one" / f"{name}.nc" for name in ("road", "samples")}
    one |= {"vehicle": project.folder / "config" / "vehicles" / "midsize.yaml", "calibration": None, "config": stepsettings.of_step(study, "simulate", "one", "base")}
    simulate.main(**one, runs="0000-0005", output=project.folder / "drives.nc")
    drives = store.read(project.folder / "drives.nc")
    for run in drives["run"].values:
        drive = drives.sel(run=run, drop=True)[list(DRIVE)].dropna("time").astype(float)
        if run == 0:
            drive.to_dataframe().to_csv(elsewhere / f"{run:04d}.csv")
        else:
            store.write(drive, elsewhere / f"{run:04d}.nc", title="a drive of another simulator")
    shutil.rmtree(results / "two" / "base")
    project.site("two", simulated="elsewhere")
    project.study(sites=["two"], runs=6, simulation={"runs_per_shard": 4})
    return project


def test_drives_from_files_give_the_comfort_that_they_gave_before(handed_in):
    answer = handed_in.snakemake("-j2", "two", "results/tables/rid_comf_res.csv")
    assert answer.status == 0, answer.text
    assert "handed_in" in answer.text and "simulate" not in answer.text.split("handed_in")[0]
    for method, name in zip(METHODS, ("exceedance_probability", "a_v", "iri")):
        ours, theirs = (store.read(handed_in.folder / f"results/{site}/base/comfort/{method}.nc")[name] for site in ("one", "two"))
        np.testing.assert_allclose(theirs, ours, rtol=1e-3)
    assert "two" in pd.read_csv(handed_in.folder / "results/tables/rid_comf_res.csv").to_string()


def test_one_drive_a_run_is_asked_for(handed_in):
    answer = handed_in.snakemake("--dry-run", "--config", "runs=7")
    (said,) = answer.errors
    assert said == "config/sites/two.yaml: simulated: 6 drives in 'elsewhere', expected one for each of the 7 runs"


def test_a_drive_that_ends_early_is_refused_by_name(handed_in, tmp_path):
    spoilt = handed_in.copied(tmp_path)
    path = spoilt.folder / "elsewhere" / "0000.csv"
    pd.read_csv(path).iloc[:400].to_csv(path, index=False)
    answer = spoilt.snakemake("-j1", "two")
    assert answer.status != 0 and "Traceback" not in answer.text
    assert any("run 0: covers" in line and "expected" in line for line in answer.errors), answer.text
