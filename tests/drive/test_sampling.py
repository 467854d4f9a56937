"""One filter for records and for simulations, whatever their rate."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.drive import sampling


@pytest.mark.parametrize(("cut_off", "frequency"), [(45.0, 35.0), (45.0, 10.0), (38.0, 30.0)])
def test_a_record_and_a_denser_simulation_pass_the_same_filter(cut_off, frequency):
    """At 100 Hz half of the filter is no whole number of intervals (5.6, 6.6); the simulation has 1 kHz. The filter lets 0.5 % (-45 dB) of the
    images of a record pass, so that gains may differ by some tenths of a percent."""
    wave = lambda time: np.sin(2 * np.pi * frequency * time)
    time = np.arange(1.0, 3.0, 0.01) + 0.0037
    coarse, dense = np.arange(0, 4, 0.01), np.arange(0, 4, 0.001)
    recorded = sampling.band_limited(0.0, 0.01, wave(coarse), time, cut_off)
    simulated = sampling.resampled(wave(dense)[None], 0.001, time / 0.001, cut_off)[0]
    assert recorded.std() == pytest.approx(simulated.std(), rel=3e-3)


def test_a_filtered_record_is_held_beyond_its_ends_however_far():
    values = np.cumsum(np.random.default_rng(3).standard_normal(400))
    time = np.array([-50.0, -1.0, 5.0, 60.0])
    expected = [values[0], values[0], values[-1], values[-1]]
    np.testing.assert_allclose(sampling.band_limited(0.0, 0.01, values, time, 20.0), expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("share", "lowest", "highest"),
    [(0.4, -0.1, 0.1), (0.7, -0.02, 0.02), (0.8, -0.5, -0.4), (1.0, -6.1, -6.0), (1.2, -27.0, -26.0), (1.3, -200.0, -45.0), (1.5, -200.0, -45.0)],
)
def test_the_filter_passes_at_shares_of_its_cut_off_what_is_said_of_it(share, lowest, highest):
    """Cut-off 1 Hz at 100 Hz, decibels."""
    time = np.arange(-20.0, 20.0, 0.01)
    passed = sampling.low_pass(np.cos(2 * np.pi * share * time)[:, None], 0.01, 1.0)[2000, 0]
    assert lowest <= 20 * np.log10(abs(passed)) <= highest


def test_samples_at_any_place_are_those_of_the_filter_and_their_slopes_its_derivative():
    rng = np.random.default_rng(0)
    interval, time = 0.001, np.linspace(0.5, 1.5, 300)
    values = np.cumsum(rng.standard_normal((2, 2000)), axis=1)
    found = sampling.resampled(values, interval, time / interval, 50.0)
    slopes = sampling.resampled_slopes(values, interval, time / interval, 50.0)
    expected = np.stack([sampling.band_limited(0.0, interval, row, time, 50.0) for row in values])
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-3 * values.std())
    ahead, behind = (sampling.resampled(values, interval, (time + shift) / interval, 50.0) for shift in (1e-4, -1e-4))
    np.testing.assert_allclose(slopes, (ahead - behind) / 2e-4, rtol=0, atol=0.02 * slopes.std())
