"""The steps tables, figures and report from files to files."""

import csv
import json

import pytest

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.report import catalogue, style, table
from ridecomfort.steps import figures, report, results, tables
from tests.report import synthetic


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder of results of two sites, one of them with drives, and the configuration of the steps."""
    folder = tmp_path_factory.mktemp("results")
    study = synthetic.study(("ts1", "home"))
    config = json.loads(json.dumps(study.settings))
    config["sites"]["home"] |= {"has_drives": False, "calibrated_on": None}
    for site in study.sites:
        for key, file in site.files.items():
            if key != "comparison" or site.name == "ts1":
                title = f"{key} of {site.name}"
                store.write(getattr(site, key), folder / file, title=title, configuration=config, seed=1)
    store.write(study.assessment, folder / study.assessment_file, title="agreement", configuration=config, seed=1)
    store.write(study.calibrations["ts1"], folder / "ts1" / "base" / "calibration.nc", title="calibration", seed=1)
    return folder, config


def test_files_are_those_of_the_catalogue(written, monkeypatch):
    monkeypatch.setattr(style, "RESOLUTION", 30)
    folder, config = written
    tables.main(folder, config, folder / "tables")
    figures.main(folder, config, folder / "figures")
    report.main(folder, config, folder / "report.html")
    expected = {f"{name}{suffix}" for name in catalogue.tables(config["sites"]) for suffix in table.WRITERS}
    assert {file.name for file in (folder / "tables").iterdir()} == expected
    expected = {f"{name}{suffix}" for name in catalogue.figures(config["sites"]) for suffix in (".png", ".pdf")}
    assert {file.name for file in (folder / "figures").iterdir()} == expected
    assert (folder / "report.html").read_text(encoding="utf-8").rstrip().endswith("</html>")


def test_traces_name_files_that_exist(written):
    folder, config = written
    tables.main(folder, config, folder / "tables")
    elsewhere = ("configuration", "this table", "report/published.yaml")
    for name in catalogue.tables(config["sites"]):
        with open(folder / "tables" / f"{name}.trace.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                known = row["file"] in elsewhere or row["file"].startswith(("tables ", "ridecomfort/"))
                assert known or (folder / row["file"]).is_file(), row


def test_traced_variables_are_in_the_files(written):
    folder, config = written
    study = results.load(folder, config)
    for site in study.sites:
        for key, file in site.files.items():
            assert store.read(file).equals(getattr(site, key))


def test_a_missing_result_is_named(written):
    folder, config = written
    sites = {**config["sites"], "nowhere": config["sites"]["home"]}
    with pytest.raises(InputError, match="nowhere.*no such file"):
        results.load(folder, {**config, "sites": sites})


def test_versions_of_what_computed():
    found = report.software()
    assert {"ridecomfort", "Python", "numpy", "xarray", "matplotlib"} <= set(found)
