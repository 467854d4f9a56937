"""A raw laser scan in place of a road file: from profiles and trajectory to the road that is driven."""

import shutil

import numpy as np
import pytest
import yaml

from ridecomfort import store
from ridecomfort.comfort import iri
from ridecomfort.road import crg, wheeltracks
from ridecomfort.steps import standin_scan

from .conftest import new_project

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def scan(tmp_path_factory, repository):
    """A project whose site has a scan of the test road, its trajectory as CSV."""
    project = new_project(tmp_path_factory.mktemp("scan"), repository)
    folder = project.folder
    config = {"seed": 3, "scanner": {"points": 150, "leaves": 1, "gaps_per_km": 4.0}}
    standin_scan.main(folder / "road.crg", config, folder / "scan.nc", folder / "trajectory.nc")
    path = store.read(folder / "trajectory.nc").to_dataframe().reset_index()
    path.to_csv(folder / "trajectory.csv", index=False)
    project.site("scanned", road={"scan": {"profiles": "scan.nc", "trajectory": "trajectory.csv", "width": 3.6}})
    return project


@pytest.fixture
def scanned(scan, tmp_path):
    """Such a project in which nothing has run yet."""
    return scan.copied(tmp_path)


def test_a_scan_becomes_the_road_that_is_driven(scanned):
    targets = [f"results/scanned/{name}.nc" for name in ("road", "inspection")]
    answer = scanned.snakemake("-j2", "--config", "sites=[scanned]", "--", *targets)
    assert answer.status == 0, answer.text
    road, inspection, before = (
        store.read(scanned.folder / "results" / "scanned" / f"{name}.nc") for name in ("road", "inspection", "scan")
    )
    true = crg.read(scanned.folder / "road.crg")
    assert float(road.u[-1]) == pytest.approx(float(true.u[-1]) - 4.0, abs=0.5)
    roughness = [iri.iri(wheeltracks.tracks(each.isel(u=slice(20, -20))), 0.1).mean() for each in (road, true)]
    assert roughness[0] == pytest.approx(roughness[1], rel=0.03)
    assert inspection.attrs["cells_filled"] + inspection.attrs["cells_repaired"] == int((before.treated > 0).sum()) > 0
    assert np.isfinite(inspection["unevenness"].sel(stage="repaired")).all()


def test_a_scan_that_is_cut_off_is_refused_in_one_line(scanned):
    whole = (scanned.folder / "scan.nc").read_bytes()
    (scanned.folder / "scan.nc").write_bytes(whole[: len(whole) // 2])
    answer = scanned.snakemake("-j1", "--config", "sites=[scanned]", "--", "results/scanned/road.nc")
    assert answer.status != 0 and any("scan.nc: not a readable NetCDF file" in said for said in answer.errors), answer.text
    assert not any(file.startswith("results/scanned/") for file in scanned.files())


def test_a_stand_in_may_be_scanned_too(repository, project):
    shutil.rmtree(project.folder / "config")
    shutil.copytree(repository / "config", project.folder / "config")
    file = project.folder / "config" / "sites" / "ts1.yaml"
    site = yaml.safe_load(file.read_text())
    site["road"] = {"scan": {"profiles": "data/ts1/scan.nc", "trajectory": "data/ts1/trajectory.nc"}}
    file.write_text(yaml.safe_dump(site))
    answer = project.snakemake("--dry-run", "--config", "sites=[ts1]")
    assert answer.status == 0, answer.text
    jobs = [line.split(": ")[0] for line in answer.text.splitlines()]
    assert {"standin_road_ts1", "standin_scan_ts1", "survey ts1", "road ts1", "inspect ts1"} <= set(jobs)
