"""Up to where a recorded speed is more than its own noise."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from ridecomfort.drive.slow import smooth, speed_bandwidth, speed_noise

RATE = 100.0


def test_a_speed_is_asked_for_as_far_as_it_stands_out_of_its_noise():
    """A driver who changes speed at 0.2 Hz, and one who does at 0.8 Hz as well, by more than the noise there."""
    time = np.arange(0, 60, 1 / RATE)
    slow, fast = np.sin(2 * np.pi * 0.2 * time), 0.03 * np.sin(2 * np.pi * np.array([[0.6], [0.7], [0.8]]) * time).sum(axis=0)
    noise = 0.03 * np.random.default_rng(4).standard_normal(time.size)
    assert speed_bandwidth(20 + slow + noise, RATE) < 0.7
    assert 0.8 < speed_bandwidth(20 + slow + fast + noise, RATE) <= 1.0
    assert speed_bandwidth(20 + slow + 1e-4 * noise, RATE) > 0.4


def test_what_is_asked_for_beyond_it_would_be_noise():
    """Acceleration that is asked for, against the true one, with the bandwidth that is found and with the full one."""
    time = np.arange(0, 60, 1 / RATE)
    true = 20 + np.sin(2 * np.pi * 0.1 * time)
    noisy = true + 0.03 * np.random.default_rng(5).standard_normal(time.size)
    found, full = (
        np.std((np.gradient(smooth(noisy, RATE, bandwidth) - true, time))[300:-300]) for bandwidth in (speed_bandwidth(noisy, RATE), 1.0)
    )
    assert found < 0.5 * full


@pytest.mark.parametrize("shape", [(2000,), (6, 500), (2, 3, 400), (1,), (40,)])
def test_what_is_slow_is_what_scipy_filters_forwards_and_backwards(shape):
    """Records of many periods of the filter and of fewer than its ends are continued by, of one and of several channels."""
    values = 3.0 + np.random.default_rng(6).standard_normal(shape).cumsum(axis=-1)
    expected = sosfiltfilt(butter(4, 0.4, fs=RATE, output="sos"), values, padlen=min(shape[-1] - 1, 750))
    np.testing.assert_array_equal(smooth(values, RATE, 0.4, order=4), expected)


def test_the_noise_of_a_short_record_of_20_hz_is_known():
    """Between 2 Hz and a tenth of the rate there is nothing."""
    rng = np.random.default_rng(7)
    time = np.arange(0, 9, 1 / 20.0)
    noisy = 20 + 0.5 * np.sin(2 * np.pi * 0.05 * time) + 0.014 * rng.standard_normal(time.size)
    assert 0.5 < speed_noise(noisy, 20.0) / (0.014**2 / 10.0) < 2.0 and speed_bandwidth(noisy, 20.0) < 0.9


def test_the_noise_of_a_speed_is_told_whatever_its_driver_does():
    """White, of 14 mm/s, beside a driver at 0.2 Hz."""
    time = np.arange(0, 120, 1 / RATE)
    noisy = 20 + np.sin(2 * np.pi * 0.2 * time) + 0.014 * np.random.default_rng(6).standard_normal(time.size)
    assert speed_noise(noisy, RATE) == pytest.approx(0.014**2 / (RATE / 2), rel=0.15)
