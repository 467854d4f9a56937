"""The floor is the noise of one drive, whatever all repeats have in common."""

from __future__ import annotations

from types import SimpleNamespace

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


def test_a_short_repeat_tells_nothing_of_the_rest_of_the_way():
    """Noise three times as large, and what is shared five times, behind the 2,400 samples that the third of three repeats drove."""
    rng = np.random.default_rng(2)
    place, rough = np.arange(6000) * 0.2, np.arange(6000) >= 2400
    lengths = (6000, 6000, 2400)
    records = [Record(str(k), "fit", "a", "a", 100.0, (0.3, 40.0), place[:n], 20.0) for k, n in enumerate(lengths)]
    series = lambda: judged.band(rng.standard_normal((2, 6000)), 100.0, (0.3, 40.0))
    common = 2.0 * series() * np.where(rough, 5.0, 1.0)
    noise = [(series() * np.where(rough, 3.0, 1.0))[:, :n] for n in lengths]
    residuals = [common[:, :n] + own for n, own in zip(lengths, noise)]
    found = floor.apart(records, residuals)
    assert [own.inside.sum() for own in found] == list(lengths)
    for own, known, n in zip(found, noise, lengths):
        np.testing.assert_allclose(np.mean(own.noise**2, axis=1), np.mean(known**2, axis=1), rtol=0.1)
        np.testing.assert_allclose(own.common, np.mean(common[:, :n] ** 2, axis=1), rtol=0.1)
    # Errors are averaged over drives, and so is what they are held against.
    experiment = SimpleNamespace(records=records)
    (spectrum,) = floor.floor(experiment, dict(enumerate(residuals))).values()
    expected = floor.squares(experiment, dict(enumerate(noise))).mean(axis=0)
    np.testing.assert_allclose(spectrum.power((0.3, 40.0), 100.0), expected, rtol=0.1)


def test_what_no_other_repeat_reaches_is_left_out():
    rng = np.random.default_rng(3)
    place = np.arange(2000) * 0.2
    records = [Record(str(k), "fit", "a", "a", 100.0, (0.3, 40.0), place + first, 20.0) for k, first in enumerate((0.0, 50.0, 80.0))]
    inside = [own.inside for own in floor.apart(records, [coloured(rng, 2000) for _ in records])]
    assert [record.place[own][[0, -1]].tolist() for record, own in zip(records, inside)] == [
        pytest.approx(ends) for ends in ([50.0, 399.8], [50.0, 449.8], [80.0, 449.8])
    ]
