"""What is judged of a series: nothing slower than the vehicle answers for, everything else as it was."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy.judged import band, judged

TIME = np.arange(2000) / 100.0
SLOW, MIDDLE, FAST = (np.sin(2 * np.pi * frequency * TIME) for frequency in (0.2, 1.0, 11.0))

INSIDE = slice(300, -300)
"""Samples 3 s from the ends: series are cut as if they went on mirrored there."""


def test_slow_parts_go_and_fast_ones_stay():
    (found,) = judged((SLOW + FAST)[None], 100.0, ["a_z"])
    np.testing.assert_allclose(found[INSIDE], FAST[INSIDE], atol=0.01)


def test_what_the_driver_makes_reaches_higher_in_some_signals():
    speed, heave = judged(np.stack([MIDDLE, MIDDLE]), 100.0, ["a_x", "a_z"])
    assert np.abs(speed[INSIDE]).max() < 0.03 and heave[INSIDE] == pytest.approx(MIDDLE[INSIDE], abs=0.1)


def test_bands_add_up_to_the_series():
    parts = [band(SLOW + MIDDLE + FAST, 100.0, edges) for edges in ((0.0, 0.5), (0.5, 5.0), (5.0, 60.0))]
    np.testing.assert_allclose(parts[1][INSIDE], MIDDLE[INSIDE], atol=0.03)
    np.testing.assert_allclose(sum(parts), SLOW + MIDDLE + FAST, atol=1e-9)


def test_a_drive_that_ends_slower_than_it_begins_does_not_jump():
    """Half a metre per second squared less of deceleration at the end, of which nothing is fast."""
    braking = judged(np.linspace(-0.5, 0.0, 2000)[None], 100.0, ["a_x"])
    assert np.abs(braking).max() < 2e-3
