"""The floor is the noise of one drive, whatever all repeats have in common."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import floor, judged
from ridecomfort.discrepancy.experiment import Record

from .coloured import coloured


def test_repeats_give_the_noise_and_not_what_they_share():
    rng = np.random.default_rng(0)
    place = np.arange(6000) * 0.2
    records = [Record(str(k), "fit", "a", "a", 100.0, (0.3, 40.0), place, 20.0) for k in range(3)]
    common, noise = 5.0 * coloured(rng, 6000), [coloured(rng, 6000) for _ in records]
    parts = floor.deviations(records, [common + own for own in noise])
    assert np.mean(np.square(parts)) == pytest.approx(np.mean(np.square(noise)), rel=0.05)


def test_the_share_is_one_at_the_floor_and_nought_where_nothing_changed():
    first, ground = np.array([[4.0, 9.0]]), np.array([[1.0, 1.0]])
    assert floor.explained_share(first, ground, first, ground) == pytest.approx(1.0)
    assert floor.explained_share(first, first, first, ground) == 0.0
    assert np.isnan(floor.explained_share(ground, ground, ground, ground))


def test_repeats_whose_samples_fall_between_one_another_lose_nothing_that_is_fast():
    rng = np.random.default_rng(1)
    fast = lambda: judged.band(rng.standard_normal((2, 40000)), 100.0, (30.0, 42.5))
    records = [Record(str(k), "fit", "a", "a", 100.0, (0.3, 42.5), (np.arange(40000) + k / 3) * 0.2, 20.0) for k in range(3)]
    noise = [fast() for _ in records]
    parts = floor.deviations(records, noise)
    assert np.mean(np.square(np.hstack(parts))) == pytest.approx(np.mean(np.square(noise)), rel=0.02)
