"""One trial of recovery, and how trials are counted."""

from __future__ import annotations

import pytest
import yaml

from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import CALIBRATED
from tests.recovery import __main__ as recovery


@pytest.mark.parametrize("foot", [0.0, 0.3])
def test_a_trial_comes_within_a_few_percent_of_the_truth_however_briskly_it_is_driven(repository, foot):
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    measurement = yaml.safe_load((repository / "config" / "standin.yaml").read_text())["measurement"]
    rows = recovery.one(1, car, measurement, foot)
    assert [row["parameter"] for row in rows] == list(CALIBRATED)
    for row in rows:  # ten times the rms error of docs/recovery.md, but for the friction, of which a road says little
        assert abs(row["error"]) < (0.4 if row["parameter"] == "tyre_friction" else 0.04), row


def test_shares_are_counted_for_each_parameter():
    row = {"held": True, "error": 0.01, "half_width": 0.02, "verdict": "identified", "cpu_seconds": 1.0}
    rows = [row | {"parameter": name, "held": name != "tyre_friction" or seed < 3} for name in CALIBRATED for seed in range(4)]
    lines = recovery.summary(rows)
    assert lines[2].startswith("| spring_stiffness_front | 100 % (51-100 %) | 4 | +1.00 %")
    assert lines[4].startswith("| tyre_friction | 75 % (30-95 %) | 4 |")
