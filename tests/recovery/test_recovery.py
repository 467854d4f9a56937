"""Trials of recovery, and how they are counted."""

from __future__ import annotations

import pytest
import yaml

from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import CALIBRATED
from tests.recovery import __main__ as recovery


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def measurement(repository):
    return yaml.safe_load((repository / "config" / "standin.yaml").read_text())["measurement"]


@pytest.mark.parametrize(("foot", "most"), [(0.0, 0.01), (0.3, 0.04)])
def test_a_trial_comes_within_a_few_percent_of_the_truth_however_briskly_it_is_driven(car, measurement, foot, most):
    rows = recovery.one(1, car, measurement, foot)
    assert [row["parameter"] for row in rows] == list(CALIBRATED)
    for row in rows:  # three to nine times the rms error of docs/recovery.md; of the friction, of which a road says little, seven to twelve
        assert abs(row["error"]) < (0.4 if row["parameter"] == "tyre_friction" else most), row


@pytest.mark.long
def test_most_intervals_hold_the_truth(car, measurement):
    """Of forty at 90 % fewer than 31 do once in two hundred times."""
    rows = [row for seed in range(1, 9) for row in recovery.one(seed, car, measurement)]
    assert sum(row["held"] for row in rows) >= 31, "\n".join(recovery.summary(rows))


def test_shares_are_counted_for_each_parameter():
    row = {"held": True, "error": 0.01, "half_width": 0.02, "verdict": "identified", "cpu_seconds": 1.0}
    rows = [row | {"parameter": name, "held": name != "tyre_friction" or seed < 3} for name in CALIBRATED for seed in range(4)]
    lines = recovery.summary(rows)
    assert lines[2].startswith("| spring_stiffness_front | 100 % (51-100 %) | 4 | +1.00 %")
    assert lines[4].startswith("| tyre_friction | 75 % (30-95 %) | 4 |")
