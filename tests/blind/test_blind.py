"""A few blind trials with a small library: what is hidden is named with its size, and where nothing is, nothing is named."""

from __future__ import annotations

import pytest

from ridecomfort import discrepancy
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import trials

AMONG = ("suspension_friction", "damper_asymmetry", "spring_progression", "tyre_progression", "top_mount")


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def judged(seed, car, hidden, kappa):
    effects = {hidden: library.find()[hidden].effect.values()} if hidden else {}
    trial = trials.make(seed, car, effects, kappa)
    table, verdict = discrepancy.rank(trial.measured, car, among=AMONG, most=2, workers=1)
    return trial.truth, table, verdict


def test_a_hidden_effect_is_named_with_its_size(car):
    truth, table, verdict = judged(101, car, "damper_asymmetry", 1.0)
    assert verdict.verdict == "named"
    assert [effect.name for effect in verdict.effects] == ["damper_asymmetry"]
    for size in verdict.effects[0].sizes:
        assert size["size"] == pytest.approx(truth["effects"]["damper_asymmetry"][size["parameter"]], rel=0.1)
    assert float(table["held_out_mean_square"].isel(model=1).mean()) < float(table["held_out_mean_square"].isel(model=0).mean())


def test_nothing_is_named_where_nothing_is_missing(car):
    _, _, verdict = judged(102, car, None, 1.0)
    assert verdict.verdict == "nothing" and verdict.effects == ()
