"""The step of the diagnosis from files to files."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from ridecomfort import store
from ridecomfort.drive import record
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import trials


@pytest.mark.study
def test_a_hidden_effect_stands_in_the_verdict_file(repository, tmp_path):
    vehicle = repository / "config" / "vehicles" / "midsize.yaml"
    effects = {"damper_asymmetry": library.find()["damper_asymmetry"].effect.values()}
    trial = trials.make(7, parameters.read(vehicle), effects, 1.0)
    road, drives = trial.measured["trial"]
    store.write(road, tmp_path / "road.nc", title="road")
    store.write(record.stack(drives), tmp_path / "measured.nc", title="drives")
    config = {
        "sites": ["trial"], "fitted_on": ["trial"], "effects": {}, "effects_folder": None, "bounds": {}, "seed": 1,
        "workers": 1, "among": ["damper_asymmetry", "spring_progression"], "simulation": {"step": 0.001, "rate": 100},
    }  # fmt: skip
    subprocess.run(
        [sys.executable, "-m", "ridecomfort.steps.diagnose", "--roads", tmp_path / "road.nc", "--measured", tmp_path / "measured.nc",
         "--vehicle", vehicle, "--calibration", "--config", json.dumps(config),
         "--ranking", tmp_path / "ranking.nc", "--verdict", tmp_path / "verdict.json"],
        check=True,
    )  # fmt: skip
    verdict = json.loads((tmp_path / "verdict.json").read_text())
    assert verdict["verdict"] == "named" and verdict["effects"][0]["name"] == "damper_asymmetry"
    assert verdict["reasons"] and verdict["effects"][0]["sizes"][0]["unit"] == "1"
    ranking = store.read(tmp_path / "ranking.nc")
    assert ranking["winner"].values[0] == "damper_asymmetry"
