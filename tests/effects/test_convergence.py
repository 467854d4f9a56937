"""The error of the step beside every effect, by halving it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

from ridecomfort.effects.contract import COMPILED
from ridecomfort.vocabulary import SIGNALS

from tests.effects.whole import ENTRIES, drive
from tests.vehicle.roads import road, rough

FIRST_ORDER = ("wheel_compliance",)
"""What answers to a force of the step before: with that of the same step, a wheel on bushings would not be stable in the steps of a search."""

NEGLIGIBLE = 0.002
"""Of the standard deviation of a signal."""


@lru_cache
def _bends():
    bends = 0.004 * np.sin(np.arange(0, 200.05, 0.1) / 30)
    return road(200.0, height=rough, curvature=bends)


@pytest.mark.parametrize("name", sorted(name for name, entry in ENTRIES.items() if entry.effect.port in COMPILED and entry.is_of_library))
def test_half_the_step_takes_three_quarters_of_the_error(car, name):
    """Car._missing relies on it: what it makes good is what a second order lacks."""
    steps = (0.001, 0.0005, 0.000125)
    coarse, half, fine = (drive(_bends(), car, effects=[name], speed=18.0, step=step, rate=125.0) for step in steps)
    count = min(seen.time.size for seen in (coarse, half, fine)) - 5
    for signal in SIGNALS:
        known, limit = fine[signal].values[50:count], NEGLIGIBLE * float(fine[signal].std())
        error, left = (np.sqrt(np.mean((seen[signal].values[50:count] - known) ** 2)) for seen in (coarse, half))
        if name in FIRST_ORDER and error > limit:
            assert left < 0.6 * error < 0.03 * known.std(), signal
        else:
            # (1/4 - 1/64) / (1 - 1/64) of it were left if it were of second order to the last digit; 3/7, of first.
            assert error < limit or left < 0.3 * error, signal
