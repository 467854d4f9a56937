"""The steps behind the error ladder and the score, from files to files."""

from __future__ import annotations

import json

import pytest

from ridecomfort import store
from ridecomfort.steps import critical, ladder, standin_score
from ridecomfort.steps.command import NOTE
from tests.described import undescribed
from tests.report import differing as made_up

MODELS = {"base": (0.5, 0.4), "suspension_friction": (0.5, 0.1)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Comparisons of two models on a site."""
    folder = tmp_path_factory.mktemp("loop")
    for model, errors in MODELS.items():
        store.write(made_up.comparison(errors), folder / model / "comparison.nc", title="comparison")
    return folder


def test_comparisons_become_graded_sections_and_these_a_ladder(folder, capsys):
    config = {"site": "home", "spacing": 0.5, "critical_length": 5, "thresholds": None, "iso2631": {"time_constant": 1}}
    for model in MODELS:
        critical.main(folder / model / "comparison.nc", config, folder / model / "critical.nc")
    files = [[folder / model / name for model in MODELS] for name in ("comparison.nc", "critical.nc")]
    config = {"sites": {"home": True}, "models": list(MODELS), "titles": ["+ suspension_friction"]}
    ladder.main(*files, config, folder / "ladder.nc")
    found = store.read(folder / "ladder.nc")
    left = found["left_overall"].sel(site="home", group="fitted").values
    assert left[1] == pytest.approx(1.0) and left[0] > 1.0 > left[2]
    assert found["agreeing"].attrs["units"] == "1" and found.attrs["configuration_hash"]
    assert undescribed(found) == undescribed(store.read(folder / "base" / "critical.nc")) == []
    # The other way round the error rises, which is for the person who waits, too.
    assert NOTE not in capsys.readouterr().err
    ladder.main(*(each[::-1] for each in files), config | {"models": list(MODELS)[::-1]}, folder / "turned.nc")
    assert f"{NOTE}home: + suspension_friction leaves " in capsys.readouterr().err


def test_the_score_is_written_as_data_and_as_a_table(folder):
    diagnosis = made_up.diagnosis()
    (folder / "truth.json").write_text(json.dumps({"effects": {"suspension_friction": {"front": 75.0}}}))
    (folder / "verdict.json").write_text(json.dumps(diagnosis.verdict))
    store.write(diagnosis.ranking, folder / "ranking.nc", title="ranking")
    config = {"model": "base", "sites": ["ts1"], "effects": [], "effects_folder": None}
    files = (folder / name for name in ("verdict.json", "ranking.nc"))
    standin_score.main([folder / "truth.json"], *files, config, folder / "score.json", folder / "tables")
    assert json.loads((folder / "score.json").read_text())["rows"][0]["covered"] is True
    assert "suspension friction,yes,named,front,N,75,80,70,90,yes" in (folder / "tables" / "standin_score.csv").read_text()
