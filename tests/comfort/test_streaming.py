"""Causal weightings: the analogue magnitude, also in pieces; and the paper's bilinear ones."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.comfort import streaming, weighting

RATES = (100, 200, 500, 1000)


@pytest.mark.parametrize("rate", [*RATES, 104.26])
@pytest.mark.parametrize("name", weighting.WEIGHTINGS)
def test_fitted_sections_keep_0_01_dB(rate, name):
    cascade = streaming.fitted(name, rate)
    frequency = np.linspace(0.5, min(80.0, 0.45 * rate), 5000)
    assert np.max(np.abs(cascade.deviation(frequency))) <= 0.01
    roots = np.concatenate([np.roots(section[3:]) for section in cascade.sos])
    assert np.max(np.abs(roots)) < 1.0


@pytest.mark.parametrize("name", ["Wd", "Wk"])
def test_phase_follows_the_analogue_filter_up_to_a_fifth_of_the_rate(name):
    frequency = np.linspace(0.5, 20.0, 500)
    assert np.max(np.abs(streaming.fitted(name, 100.0).lag(frequency))) < np.radians(1.0)


def test_stream_in_pieces_is_the_stream_whole():
    values = np.random.default_rng(5).standard_normal((3, 1000))
    whole = streaming.Stream("Wk", 200.0, channels=(3,)).feed(values)
    stream = streaming.Stream("Wk", 200.0, channels=(3,))
    pieces = np.concatenate([stream.feed(values[:, a:b]) for a, b in ((0, 1), (1, 450), (450, 1000))], axis=1)
    assert np.array_equal(whole, pieces)


def test_stream_is_close_to_the_exact_weighting():
    """Up to a fifth of the rate magnitude and phase are those of the analogue filter."""
    time = np.arange(4000) / 100.0
    smooth = np.sin(2 * np.pi * 6 * time) * np.exp(-(((time - 20) / 3) ** 2))
    exact = weighting.weight(smooth, 100.0, "Wk")
    error = np.max(np.abs(streaming.Stream("Wk", 100.0).feed(smooth) - exact))
    assert error < np.radians(1.0) * np.max(np.abs(exact))


@pytest.mark.parametrize("rate, decibel", [(100, 25), (200, 18), (500, 1.3), (1000, 0.3)])
def test_the_papers_bilinear_transform_errs_as_expected(rate, decibel):
    """The warped axis, by closed form: H_a(2 rate tan(pi f / rate))."""
    cascade = streaming.bilinear("Wk", rate)
    frequency = np.linspace(0.5, min(80.0, 0.45 * rate), 2000)
    warped = weighting.WEIGHTINGS["Wk"].factor(rate / np.pi * np.tan(np.pi * frequency / rate))
    assert np.allclose(np.abs(cascade.response(frequency)), warped, rtol=1e-6)
    assert np.max(np.abs(cascade.deviation(frequency))) == pytest.approx(decibel, rel=0.06)
