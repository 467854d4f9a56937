"""From a recorded scan to an OpenCRG file, as a command."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pycrg
import pytest

from ridecomfort.errors import InputError
from ridecomfort.road import crg
from ridecomfort.steps import standin_scan, survey


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A scan of 40 m of a straight, gently waved road and its trajectory, made by the step that makes stand-ins."""
    folder = tmp_path_factory.mktemp("scan")
    waves = 0.002 * np.sin(np.arange(401) * 0.1)[:, None] * np.cos(np.linspace(-2.5, 2.5, 51))
    pycrg.write(folder / "road.crg", waves, 0.1, np.linspace(-2.5, 2.5, 51), mods={})
    config = {"seed": 3, "scanner": {"points": 200, "leaves": 0, "gaps_per_km": 0.0}}
    standin_scan.main(folder / "road.crg", config, folder / "scan.nc", folder / "trajectory.nc")
    return folder


def test_a_scan_becomes_an_opencrg_file(recorded, tmp_path):
    command = [sys.executable, "-m", "ridecomfort.steps.survey", "--scan", recorded / "scan.nc"]
    command += ["--trajectory", recorded / "trajectory.nc", "--output", tmp_path / "road.crg"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "trajectory smoothed" in done.stderr and "points of" in done.stderr
    road = crg.read(tmp_path / "road.crg")
    assert float(road.u[-1]) == pytest.approx(36, abs=0.5)
    inner = road.elevation.sel(u=slice(3, 33), v=slice(-1.5, 1.5))
    assert np.isfinite(inner).all()
    known = 0.002 * np.sin(inner.u + 2.0) * np.cos(inner.v)
    detrended = (inner - known) - (inner - known).rolling(u=100, center=True, min_periods=1).mean()
    assert float(detrended.std()) < 5e-4


def test_a_file_that_is_no_scan_is_refused_in_one_line(recorded, tmp_path):
    for scan, said in ((recorded / "trajectory.nc", "has no variable"), (tmp_path / "none.nc", "not a readable")):
        with pytest.raises(InputError, match=said) as refusal:
            survey.main(scan, recorded / "trajectory.nc", {}, tmp_path / "road.crg")
        assert "\n" not in str(refusal.value) and scan.name in str(refusal.value)
        assert not (tmp_path / "road.crg").exists()


def test_an_unknown_setting_of_the_scanner_is_named(recorded, tmp_path):
    with pytest.raises(InputError, match="scanner: got an unexpected keyword argument 'laser'"):
        standin_scan.main(
            recorded / "road.crg", {"seed": 3, "scanner": {"laser": 1}}, tmp_path / "s.nc", tmp_path / "t.nc"
        )
