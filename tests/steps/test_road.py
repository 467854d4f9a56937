"""From an OpenCRG file to the road as it is used, as the workflow calls it."""

from __future__ import annotations

import json
import re
import subprocess
import sys

import numpy as np
import pycrg
import pytest

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.steps import road


def run(path, output, **options):
    return subprocess.run(
        [sys.executable, "-m", "ridecomfort.steps.road", "--road", path, "--output", output]
        + ["--config", json.dumps({"site": "own", "options": options})],
        capture_output=True,
        text=True,
    )


@pytest.fixture
def torn(tmp_path):
    """A file without modifier block, with one outlier."""
    z = np.random.default_rng(1).normal(0, 3e-4, (300, 41))
    z[100, 20] = 0.3
    path = tmp_path / "road.crg"
    pycrg.write(path, z, 0.1, np.linspace(-2, 2, 41))
    return path


def test_the_log_says_what_was_done_and_the_file_holds_it(torn, tmp_path):
    done = run(torn, tmp_path / "road.nc", outliers="repair")
    assert done.returncode == 0, done.stderr
    for said in ("no modifier block", "1 outliers repaired", "largest change 0.3"):
        assert said in done.stderr
    used = store.read(tmp_path / "road.nc")
    assert used.treatment in done.stderr
    assert used.attrs["interpolation"] == "cubic" and float(used.elevation.max()) < 0.01
    assert int(used.treated.sum()) == 1


@pytest.mark.parametrize(
    "options, said",
    [
        ({"outliers": "refuse"}, "road.crg: road.outliers: 1 outliers, the first at u = 10 m, v = 0 m"),
        ({"outlier": "repair"}, "unknown option"),
        ({"holes": "sew"}, "'sew', expected one of refuse, fill"),
        ({"smoothing": "much"}, "'much', expected one of none, cross-validation"),
    ],
)
def test_what_is_refused_leaves_no_file(torn, tmp_path, options, said):
    with pytest.raises(InputError, match=re.escape(said)):
        road.main(torn, {"options": options}, tmp_path / "road.nc")
    assert not (tmp_path / "road.nc").exists()


def test_smoothing_says_what_it_does_to_the_iri(tmp_path, capsys):
    noisy = np.random.default_rng(1).normal(0, 3e-4, (300, 41)) + 0.02 * np.sin(np.arange(300) / 20)[:, None]
    pycrg.write(tmp_path / "road.crg", noisy, 0.1, np.linspace(-2, 2, 41))
    road.main(tmp_path / "road.crg", {"options": {"smoothing": "cross-validation"}}, tmp_path / "road.nc")
    said = capsys.readouterr().err
    before, after = re.search(r"IRI of the wheel tracks at -0.75 and 0.75 m from (\S+) to (\S+) m/km", said).groups()
    assert float(after) < float(before) and "found by cross-validation" in said


@pytest.mark.parametrize(("spacing", "told"), [(0.25, False), (0.5, True)])
def test_cross_sections_too_far_apart_for_the_iri_are_told(tmp_path, capsys, spacing, told):
    pycrg.write(tmp_path / "road.crg", np.random.default_rng(1).normal(0, 3e-4, (100, 41)), spacing, np.linspace(-2, 2, 41))
    road.main(tmp_path / "road.crg", {"options": {}}, tmp_path / "road.nc")
    said = "IRI of the wheel tracks: samples up to 0.5 m apart, expected 0.3 m or less"
    assert (said in capsys.readouterr().err) == (said in store.read(tmp_path / "road.nc").treatment) == told


def test_a_lane_beside_the_usual_wheel_tracks_is_smoothed_without_a_word_on_these(tmp_path):
    noisy = np.random.default_rng(1).normal(0, 3e-4, (300, 36)) + 0.02 * np.sin(np.arange(300) / 20)[:, None]
    pycrg.write(tmp_path / "road.crg", noisy, 0.1, np.linspace(0, 3.5, 36))
    road.main(tmp_path / "road.crg", {"options": {"smoothing": "cross-validation"}}, tmp_path / "road.nc")
    said = store.read(tmp_path / "road.nc").treatment
    assert "found by cross-validation" in said and "IRI of the wheel tracks" not in said


def test_warnings_of_the_library_do_not_litter_a_refusal(shared, tmp_path):
    done = run(shared / "data" / "opencrg" / "belgian_block_damaged.crg", tmp_path / "road.nc")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "heights out of reason" in done.stderr
