"""Another simulator: drives computed elsewhere take the place of ours in everything downstream."""

import numpy as np
import pandas as pd
import pytest

from ridecomfort import store
from ridecomfort.vocabulary import DRIVE

from .conftest import new_project

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory, repository):
    """A project whose second site takes the drives of the first from files, one CSV and two NetCDF."""
    project = new_project(tmp_path_factory.mktemp("handed_in"), repository)
    simulation = {"keep_drives": True, "runs_per_shard": 2}
    project.study(sites=["one"], runs=3, simulation=simulation)
    comfort = [f"results/one/base/comfort/{method}.nc" for method in ("thresholds", "iso2631", "iri")]
    assert project.snakemake("-j2", *comfort).status == 0
    folder = project.folder / "elsewhere"
    folder.mkdir()
    for shard in sorted((project.folder / "results/one/base/drives").glob("*.nc")):
        drives = store.read(shard)
        for run in drives["run"].values:
            drive = drives.sel(run=run, drop=True)[list(DRIVE)].dropna("time").astype(float)
            if run == 0:
                drive.to_dataframe().to_csv(folder / f"{run:04d}.csv")
            else:
                store.write(drive, folder / f"{run:04d}.nc", title="a drive of another simulator")
    project.site("two", simulated="elsewhere")
    project.study(sites=["two"], runs=3, simulation=simulation)
    return project


def test_drives_from_files_give_the_comfort_that_they_gave_before(handed_in):
    answer = handed_in.snakemake("-j2", "two")
    assert answer.status == 0, answer.text
    assert "handed_in" in answer.text and "simulate" not in answer.text.split("handed_in")[0]
    for method, name in (("thresholds", "exceedance_probability"), ("iso2631", "a_v"), ("iri", "iri")):
        ours, theirs = (store.read(handed_in.folder / f"results/{site}/base/comfort/{method}.nc")[name] for site in ("one", "two"))
        np.testing.assert_allclose(theirs, ours, rtol=1e-3)
    tables = handed_in.snakemake("-j2", "results/tables/rid_comf_res.csv")
    assert tables.status == 0, tables.text
    assert "two" in pd.read_csv(handed_in.folder / "results/tables/rid_comf_res.csv").to_string()


def test_one_drive_a_run_is_asked_for(handed_in):
    answer = handed_in.snakemake("--dry-run", "--config", "runs=5")
    (said,) = answer.errors
    assert said == "config/sites/two.yaml: simulated: 3 drives in 'elsewhere', expected one for each of the 5 runs"


def test_a_drive_that_ends_early_is_refused_by_name(handed_in, tmp_path):
    spoilt = handed_in.copied(tmp_path)
    path = spoilt.folder / "elsewhere" / "0000.csv"
    pd.read_csv(path).iloc[:400].to_csv(path, index=False)
    answer = spoilt.snakemake("-j1", "two")
    assert answer.status != 0 and "Traceback" not in answer.text
    assert any("run 0: covers" in line and "expected" in line for line in answer.errors), answer.text
