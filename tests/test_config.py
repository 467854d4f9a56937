"""The configuration: the paper's defaults, each described, and numbers as people write them."""

import yaml

from ridecomfort import config, schema
from tests.projects import assert_said, write


def test_the_study_file_states_the_defaults(repository):
    stated = schema.read_yaml(repository / config.STUDY)
    assert stated == schema.defaults("study", sites=stated["sites"])


def test_the_defaults_are_the_papers(shared):
    published = yaml.safe_load((shared / "paper" / "published.yaml").read_text())
    study = schema.defaults("study", sites=["ts1"])
    assert study["runs"] == published["sampling"]["runs_per_site"]
    assert study["comfort"]["critical_length"] == published["critical_length_m"]
    assert study["comfort"]["thresholds"] == published["acceleration_thresholds"]
    bands = {name: [low, None if high == float("inf") else high] for name, (low, high) in published["iso2631_bands"].items()}
    assert study["comfort"]["iso2631"]["bands"] == bands
    iri = dict(published["iri_thresholds"])
    assert study["comfort"]["iri"]["speed_km_h"] == iri.pop("kmh")
    assert study["comfort"]["iri"]["thresholds"] == iri
    bounds = published["calibration_bounds"].values()
    assert list(study["calibration"]["bounds"].values()) == list(bounds)


def test_the_sites_are_sampled_as_published(shared, repository):
    published = yaml.safe_load((shared / "paper" / "published.yaml").read_text())["sampling"]
    study = config.load(schema.read_yaml(repository / config.STUDY), repository)
    for site in ("ts1", "ts2", "ts3"):
        assert study.sites[site]["sampling"] == {
            name: published[name][site] for name in ("speed_deviation", "lateral_position", "road_friction")
        }


def test_every_key_says_what_it_means():
    def silent(part, path):
        for key, entry in part.get("properties", {}).items():
            if "description" not in entry and "$ref" not in entry and entry.get("type") != "object":
                yield f"{path}{key}"
            yield from silent(entry, f"{path}{key}: ")

    assert not list(silent(schema.load("study"), "")) and not list(silent(schema.load("site"), ""))


def test_a_whole_number_may_be_written_with_a_point(project):
    study = config.load({"sites": ["own"], "runs": 4000.0, "seed": 7.0, "calibration": {"restarts": 2.0}}, project)
    found = study.settings["runs"], study.settings["seed"], study.settings["calibration"]["restarts"]
    assert found == (4000, 7, 2) and all(isinstance(value, int) for value in found)
    assert isinstance(study.settings["simulation"]["step"], float)
    assert_said(project, {"sites": ["own"], "runs": "4000"}, "runs: '4000', expected a whole number; YAML reads this as text, write 4000 ", config.STUDY)


def test_a_road_may_be_its_file_alone(project):
    write(project, "short", {"road": "road.crg"})
    long, short = (config.load({"sites": [name]}, project).sites[name]["road"] for name in ("own", "short"))
    assert short == long and short["file"] == "road.crg"


def test_a_number_on_the_command_line_may_stand_in_a_block(project):
    study = config.load({"sites": ["own"], "space": {"spacing": "0.5"}}, project, given=["space"])
    assert study.settings["space"]["spacing"] == 0.5


def test_a_number_is_said_as_a_configuration_takes_it():
    for number in (2e-06, -3.456e-05, 0.00012, 0.64, 75, 1234567.0, 1e22):
        assert yaml.safe_load(schema.as_yaml(number)) == number
        assert yaml.safe_load(schema.as_written(number)) == float(f"{number:.3g}")
