"""The steps tables, figures and report from files to files."""

import csv
import json

import pytest

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.report import catalogue, style, table
from ridecomfort.steps import compared, diagnosed, figures, located, report, results, tables
from tests.report import differing, synthetic


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder of results of two sites, one of them with drives, and the configuration of the steps."""
    folder = tmp_path_factory.mktemp("results")
    study = synthetic.study(("ts1", "home"))
    config = json.loads(json.dumps(study.settings))
    config["sites"]["home"] |= {"has_drives": False, "calibrated_on": None}
    for site in study.sites:
        for key, file in site.files.items():
            if key != "comparison":
                title = f"{key} of {site.name}"
                store.write(getattr(site, key), folder / file, title=title, configuration=config, seed=1)
    store.write(study.assessment, folder / study.assessment_file, title="agreement", configuration=config, seed=1)
    difference, diagnosis = differing.difference(("ts1",)), differing.diagnosis()
    store.write(difference.sites[0].comparison, folder / "ts1" / "base" / "comparison.nc", title="comparison of ts1")
    store.write(difference.sites[0].measured, folder / "ts1" / "base" / "measured.nc", title="measured on ts1")
    store.write(difference.ladder, folder / "ladder" / "base.nc", title="ladder")
    store.write(diagnosis.ranking, folder / "diagnosis" / "base" / "ranking.nc", title="ranking")
    (folder / "diagnosis" / "base" / "verdict.json").write_text(json.dumps(differing.VERDICT))
    store.write(study.calibrations["ts1"], folder / "ts1" / "base" / "calibration.nc", title="calibration", seed=1)
    return folder, config


def test_files_are_those_of_the_catalogue(written, monkeypatch):
    monkeypatch.setattr(style, "RESOLUTION", 30)
    monkeypatch.setitem(style.SETTINGS, "pdf.fonttype", 3)  # embeds the letters in a third of the time
    folder, config = written
    tables.main(folder, config, folder / "tables")
    figures.main(folder, config, folder / "figures", "2")
    looped = {**config, "diagnosed": {"ts1": True}, "scored": False, "switched_on": [], "held": {}}
    measured = {**config, "sites": {"ts1": config["sites"]["ts1"]}}
    located.main(folder, measured, folder / "figures")
    compared.main(folder, measured, folder)
    later = folder / "diagnosis" / "suspension_friction" / "verdict.json"
    later.parent.mkdir()
    later.write_text(json.dumps(differing.nothing()))
    diagnosed.main(folder, [later], looped, folder, "1")
    report.main(folder, [later], looped, folder / "report.html")
    names = [*catalogue.tables(config["sites"]), *catalogue.DIFFERENCE_TABLES, *catalogue.DIAGNOSIS_TABLES]
    expected = {f"{name}{suffix}" for name in names for suffix in table.WRITERS}
    assert {file.name for file in (folder / "tables").iterdir()} == expected
    names = [*catalogue.figures(config["sites"]), *catalogue.difference_figures(["ts1"]), *catalogue.DIAGNOSIS_FIGURES]
    expected = {f"{name}{suffix}" for name in names for suffix in (".png", ".pdf")}
    assert {file.name for file in (folder / "figures").iterdir()} == expected
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.rstrip().endswith("</html>")
    again = "diagnosed again, model suspension_friction"
    assert again in page and again in (folder / "tables" / "verdict.md").read_text(encoding="utf-8")
    assert all(f'id="{place}"' in page for place in ("fig-located_ts1", "tab-verdict", "fig-error_ladder", "tab-error_ladder"))


@pytest.mark.parametrize(
    ("drives", "kept"),
    [
        (True, {"sites.csv", "mine.csv", "views_home.png", "opti_res_home.csv", "located_home.png", "error_ladder.csv"}),
        (False, {"sites.csv", "mine.csv", "views_home.png"}),
    ],
)
def test_tables_of_sites_that_are_not_in_the_study_go(tmp_path, drives, kept):
    others = ["opti_res_gone.csv", "opti_res_gone.trace.csv", "views_gone.png", "located_gone.png", "claims.csv"]
    own = ["sites.csv", "mine.csv", "views_home.png", "opti_res_home.csv", "located_home.png", "error_ladder.csv"]
    for name in others + own:
        (tmp_path / name).touch()
    results.drop_others(tmp_path, {"home": {"has_drives": drives}})
    assert {file.name for file in tmp_path.iterdir()} == kept


def test_a_diagnosis_elsewhere_stays_where_the_vehicle_of_a_site_is_calibrated_there(tmp_path):
    for name in ("verdict.csv", "standin_score.csv", "evidence.png", "error_ladder.csv"):
        (tmp_path / name).touch()
    results.drop_others(tmp_path, {"home": {"has_drives": False, "calibrated_on": "ts1"}})
    assert {file.name for file in tmp_path.iterdir()} == {"verdict.csv", "standin_score.csv", "evidence.png"}


@pytest.mark.parametrize("standin", [True, False])
def test_the_score_of_an_earlier_study_does_not_stay_beside_the_verdict_on_real_drives(written, tmp_path, monkeypatch, standin):
    folder, config = written
    monkeypatch.setattr("ridecomfort.report.diagnosed.figures", lambda diagnosis: {})
    (tmp_path / "tables").mkdir()
    for suffix in table.WRITERS:
        (tmp_path / "tables" / f"standin_score{suffix}").touch()
    looped = {**config, "diagnosed": {"ts1": True, "home": standin}, "scored": False, "switched_on": [], "held": {}}
    diagnosed.main(folder, [], looped, tmp_path, "1")
    names = {file.name.split(".")[0] for file in (tmp_path / "tables").iterdir()}
    assert names == {*catalogue.DIAGNOSIS_TABLES, *(["standin_score"] if standin else [])}


def test_a_diagnosis_may_be_of_a_site_that_is_not_in_the_call(written):
    """As of the one that the vehicle is calibrated on, when the study is that of another site alone."""
    folder, config = written
    alone = {**config, "sites": {"home": config["sites"]["home"]}, "scored": False, "switched_on": [], "held": {}}
    found = results.diagnosis(folder, {**alone, "diagnosed": {"ts1": True, "home": False}})
    assert found.sites == ("ts1", "home") and found.standin == ("Ts1",)


def test_the_stand_in_that_a_vehicle_is_calibrated_on_is_known_though_it_is_not_in_the_call(written):
    folder, config = written
    home = {**config["sites"]["home"], "standin": False, "calibrated_on": "ts1"}
    alone = {**config, "sites": {"home": home}, "standin_calibrations": ["ts1"]}
    assert results.load(folder, alone).standin_mark() == results.difference(folder, alone).standin_mark() == "Stand-in data: Ts1"
    drives = {**config, "sites": {"ts1": {**config["sites"]["ts1"], "standin": False}}}
    assert results.compared(folder, drives, "ts1").standin_mark() == "Stand-in data: Ts1"


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
