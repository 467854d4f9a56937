"""Cross-spectra of errors, and frames that are white by them."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import spectrum
from ridecomfort.discrepancy.spectrum import cross_spectrum

from .linear import Linear


def related(rng, sizes):
    """Two channels of noise that share half of their power, of these rms."""
    own = rng.standard_normal((2, 6000))
    own[1] = np.sqrt(0.5) * (own[0] + own[1])
    return np.array(sizes)[:, None] * own


def coherence(spectrum):
    return np.abs(spectrum.density[:, 0, 1]) ** 2 / np.abs(spectrum.density[:, 0, 0] * spectrum.density[:, 1, 1])


def test_power_is_brought_down_to_that_of_another_spectrum_and_coherence_stays():
    rng = np.random.default_rng(1)
    own, other = (cross_spectrum([related(rng, sizes)], 100.0) for sizes in ([3.0, 1.0], [1.0, 3.0]))
    limited = own.no_larger(other)
    power = [spectrum.power((1.0, 40.0), 100.0) for spectrum in (own, other, limited)]
    assert power[2] == pytest.approx([power[1][0], power[0][1]])
    assert coherence(limited) == pytest.approx(coherence(own))


def test_nothing_is_brought_down_to_what_is_larger_everywhere():
    rng = np.random.default_rng(2)
    own, other = (cross_spectrum([related(rng, [size, size])], 100.0) for size in (1.0, 3.0))
    assert own.no_larger(other).density == pytest.approx(own.density)


def test_an_error_that_grew_weighs_as_in_the_frame_of_before_and_one_that_fell_more():
    model = Linear(1, {})
    before = exp.simulate(model, {}, range(3))
    after = {index: np.array([5.0, 0.2, 1.0, 1.0])[:, None] * residual for index, residual in before.items()}
    nuisances = exp.nuisances(model, {}, range(3))
    first = exp.frame(model, before, nuisances)
    alone, limited = exp.frame(model, after, nuisances), exp.frame(model, after, nuisances, least=first)
    size = lambda frame, channel: np.linalg.norm(frame.flat({i: np.eye(4)[channel][:, None] * before[i] for i in before}))
    assert size(alone, 0) == pytest.approx(0.2 * size(first, 0), rel=0.1)
    assert size(limited, 0) == pytest.approx(size(first, 0), rel=0.1)
    assert size(limited, 1) == pytest.approx(5.0 * size(first, 1), rel=0.1)


@pytest.mark.parametrize("seconds", [12, 30])
def test_a_drift_is_slow_whatever_its_ends(seconds):
    """Noise of 0.1 beside a drift of 6, of which nothing is left from 1.5 Hz on: taken to come round again it made half of the noise as well."""
    rng = np.random.default_rng(5)
    noise = 0.1 * rng.standard_normal((1, 100 * seconds))
    drifting = noise + 6.0 * np.linspace(-0.5, 0.5, noise.size)
    found, expected = (spectrum._faster(series, 100.0, (1.5,)) for series in (drifting, noise))
    assert np.mean(found**2) == pytest.approx(np.mean(expected**2), rel=0.02)
