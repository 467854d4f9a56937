"""A run of trials that is cut short."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blind import __main__ as blind

ROW = {"kind": "clean", "hidden": "payload", "kappa": 1.0, "reached": np.float64(0.9), "first_right": np.True_, "against_oracle": float("nan")}
DONE = {("clean", 1, 0): ROW, ("clean", 1, 1): None}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(blind.score, "summary", lambda rows: ["a table"])
    blind.write(tmp_path, DONE, 3, "as now", "python -m tests.blind --seed 1")
    return tmp_path


def test_it_goes_on_where_it_ended_with_the_rows_that_it_had(folder):
    before = blind.done_before(folder / "done.json", "as now")
    assert list(before) == list(DONE) and before["clean", 1, 1] is None
    np.testing.assert_equal(before["clean", 1, 0], ROW)


def test_the_summary_says_how_it_was_made(folder):
    said = (folder / "summary.md").read_text()
    assert said.startswith("# Blind trials") and "1 trials of 3, cut short, by `python -m tests.blind --seed 1`" in said and said.endswith("a table\n")



def test_the_summary_of_a_whole_run_does_not_call_it_cut_short(folder):
    blind.write(folder, DONE, 2, "as now", "python -m tests.blind --seed 1")
    assert "1 trials by `python" in (folder / "summary.md").read_text()


def test_nothing_is_kept_of_another_version(folder):
    assert blind.done_before(folder / "done.json", "as then") == {}
    assert blind.done_before(folder / "none.json", "as now") == {}


def test_a_version_is_that_of_all_that_a_trial_rests_on(monkeypatch, tmp_path):
    now = blind.version()
    assert now == blind.version()
    for folder in ("workflow", "config/vehicles"):
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.setattr(blind, "REPOSITORY", tmp_path)
    monkeypatch.setattr(blind, "__file__", str(tmp_path / "tests" / "blind" / "__main__.py"))
    (tmp_path / "tests" / "blind").mkdir(parents=True)
    empty = blind.version()
    (tmp_path / "workflow" / "kernel.py").write_text("step = 1e-3\n")
    assert blind.version() not in (empty, now)
