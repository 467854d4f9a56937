"""What changes slowly in a record, and up to where a recorded speed is more than its own noise."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.signal import butter, sosfiltfilt, welch

DRIVER_BANDWIDTH = 1.0
"""Hz; a driver changes speed and lane more slowly, road and wheels show in the record above it."""

LEAST = 0.4
"""Hz up to which a driver is taken to change speed whatever its noise."""

SPEED_WINDOW, SPEED_NOISE = 10.0, (2.0, 0.1)
"""s of the spectra of a recorded speed, and from which Hz to which share of its rate, or to 1 Hz more, it holds nothing of the driver."""


def smooth(values: np.ndarray, rate: float, bandwidth: float = DRIVER_BANDWIDTH, order: int = 2) -> np.ndarray:
    """Low-passed along the last axis without delay (Butterworth, forwards and backwards)."""
    return sosfiltfilt(_low_pass(bandwidth, rate, order), values, padlen=min(np.shape(values)[-1] - 1, int(3 * rate / bandwidth)))


@lru_cache(maxsize=256)  # asked for after every simulated drive
def _low_pass(bandwidth: float, rate: float, order: int) -> np.ndarray:
    return butter(order, min(bandwidth, 0.4 * rate), fs=rate, output="sos")


def speed_bandwidth(speed: np.ndarray, rate: float) -> float:
    """Hz up to which a recorded speed tells more of the driver than of its own noise, LEAST to DRIVER_BANDWIDTH.

    The model drives whatever it is asked for and shakes by it: what its springs and tyres make of noise that the vehicle
    never drove is a difference that stiffer ones would make smaller (at 1 Hz and 14 mm/s, by 0.2 percent). Noise is taken
    for white, with the density that the speed has above the driver.
    """
    frequency, density = _spectrum(speed, rate)
    drowned = frequency[(density < 2 * _noise(frequency, density, rate)) & (frequency > LEAST)]
    return float(min(drowned[0], DRIVER_BANDWIDTH)) if drowned.size else DRIVER_BANDWIDTH


def speed_noise(speed: np.ndarray, rate: float) -> float:
    """Density of the noise of a recorded speed in (m/s)^2/Hz, one-sided, taken for white: that which it has above the driver."""
    return _noise(*_spectrum(speed, rate), rate)


def _noise(frequency: np.ndarray, density: np.ndarray, rate: float) -> float:
    highest = max(SPEED_NOISE[1] * rate, SPEED_NOISE[0] + 1.0)
    return float(np.median(density[(frequency >= SPEED_NOISE[0]) & (frequency <= highest)]))


def _spectrum(speed: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz) and one-sided density ((m/s)^2/Hz) of a speed, by its slope: so slow changes do not leak."""
    length = min(len(speed) - 1, int(SPEED_WINDOW * rate))
    frequency, density = welch(np.diff(speed) * rate, rate, nperseg=length)
    return frequency[1:], density[1:] / (2 * rate * np.sin(np.pi * frequency[1:] / rate)) ** 2
