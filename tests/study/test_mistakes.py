"""A user's mistakes: one clear line, a status that is not zero, nothing half-written left."""

import pytest

from ridecomfort.vocabulary import SIGNALS

pytestmark = pytest.mark.slow


def assert_refused(answer, *said):
    assert answer.status != 0, answer.text
    assert "Traceback" not in answer.text, answer.text
    assert len(answer.errors) == 1, answer.text
    for words in said:
        assert words in answer.errors[0]


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("runs=0", "runs: 0, expected at least 1"),
        ("rums=40", "unknown key 'rums'; did you mean 'runs'"),
        ("sites=[nowhere]", "unknown site 'nowhere'; known sites: one, two"),
        ("comfort={critical_length: -5}", "critical_length: -5, expected at least 1"),
    ],
)
def test_on_the_command_line(project, setting, said):
    assert_refused(project.snakemake("--dry-run", "--config", setting), "--config: ", said)


def test_a_bracket_that_is_not_closed(project):
    settings = project.folder / "config" / "study.yaml"
    settings.write_text("runs: 40\neffects: [suspension_friction\nsites: [one]\n")
    assert_refused(project.snakemake("--dry-run"), "config/study.yaml: line 3: is not valid YAML")


@pytest.mark.parametrize(("asked", "hint"), [("onee", "did you mean 'one'"), ("reprt", "did you mean 'report'"), ("xyz", "see README")])
def test_a_target_that_is_not_there(project, asked, hint):
    assert_refused(project.snakemake("--dry-run", asked), f"{asked}: no site of the study and no target", hint)


def test_a_missing_road(project):
    project.site("one", road={"file": "data/one/road.crg"})
    assert_refused(project.snakemake("--dry-run"), "config/sites/one.yaml: road: file: no such file 'data/one/road.crg'")


def test_a_road_with_heights_out_of_reason(project, shared):
    damaged = shared / "data" / "opencrg" / "belgian_block_damaged.crg"
    if not damaged.is_file():
        pytest.skip("the damaged road is not in ../shared")
    project.site("one", road={"file": str(damaged)})
    assert_refused(project.snakemake("-j1", "results/one/road.nc"), damaged.name, "heights out of reason")
    assert project.files() == set()


def test_a_road_cut_off(project):
    road = project.folder / "road.crg"
    road.write_bytes(road.read_bytes()[:-5000])
    assert_refused(project.snakemake("-j1", "results/one/road.nc"), "road.crg")
    assert project.files() == set()


def test_a_truncated_result(project):
    assert project.snakemake("-j1", "results/one/samples.nc", "results/one/road.nc").status == 0
    road = project.folder / "results" / "one" / "road.nc"
    road.write_bytes(road.read_bytes()[:20000])
    before = project.files()
    answer = project.snakemake("-j1", "results/one/base/drives/0000-0003.nc", "--rerun-triggers", "mtime")
    assert_refused(answer, "results/one/road.nc: not a readable NetCDF file")
    assert project.files() == before


def test_a_diagnosis_that_fails_says_that_the_verdict_there_is_of_an_earlier_one(project):
    verdict = project.folder / "results" / "tables" / "verdict.md"
    verdict.parent.mkdir(parents=True)
    verdict.write_text("| verdict | Missing: suspension friction. |")
    units = {"time": "s", "v_x": "m/s", **dict.fromkeys(SIGNALS[:3], "m/s2"), **dict.fromkeys(SIGNALS[3:], "rad/s")}
    (project.folder / "drive.csv").write_text(f"{','.join(units)}\n0.0{',none' * (len(units) - 1)}\n")
    columns = {name: {"column": name, "unit": unit} for name, unit in units.items()}
    project.site("one", drives=[{"file": "drive.csv", "columns": columns, "sensor": {"behind_front_axle": 1.4, "left": 0.0, "above_wheel_centres": 0.4}}])
    told = "results/tables/verdict.md and what stands beside it are of an earlier diagnosis"
    answer = project.snakemake("-j1", "diagnose", "--config", "sites=[one]")
    assert_refused(answer, "drive.csv")
    assert answer.text.count(told) == 1 and verdict.is_file()
    assert told not in project.snakemake("-j1", "compare", "--config", "sites=[one]").text
