"""Noise of a scanner is found in a road that holds it, with its size, and not in one that does not."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import suspect
from tests.vehicle import roads


@pytest.fixture(scope="module")
def rough():
    return roads.road(600.0, height=roads.rough)


def test_a_road_of_iso_8608_holds_no_noise(rough):
    assert suspect.road_noise(rough) == 0.0


def test_the_size_of_white_noise_is_estimated(rough):
    noisy = rough.copy()
    noisy["elevation"] = rough["elevation"] + 1e-3 * np.random.default_rng(2).standard_normal(rough["elevation"].shape)
    assert suspect.road_noise(noisy) == pytest.approx(1e-3, rel=0.15)
