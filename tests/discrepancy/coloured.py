"""Coloured noise over several channels with a known cross-spectrum, for tests of the statistics."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter


def coloured(rng, samples: int, channels: int = 4) -> np.ndarray:
    """Noise (channel, sample): two resonances shared by all channels and a white one of each; louder in places."""
    shared = np.stack(
        [
            lfilter([1.0], [1.0, -2 * 0.97 * np.cos(2 * np.pi * tone / 100.0), 0.97**2], rng.standard_normal(samples))
            for tone in (1.5, 11.0)
        ]
    )
    mixing = np.array([[1.0, 0.3], [0.8, -0.5], [-0.2, 1.0], [0.5, 0.5]])[:channels]
    delayed = np.stack([np.roll(mixing[k] @ shared, 2 * k) for k in range(channels)])
    loud = 1.0 + 0.8 * np.sin(2 * np.pi * np.arange(samples) / 1700.0)
    return loud * (0.2 * delayed + 0.5 * rng.standard_normal((channels, samples)))
