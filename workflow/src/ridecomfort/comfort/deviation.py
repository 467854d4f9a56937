"""How far digital frequency weightings deviate from the analogue ones."""

from __future__ import annotations

import numpy as np

from . import streaming, weighting

LOWEST, HIGHEST = 0.5, 80.0
"""Hz; the range of ISO 2631-1 for health, comfort and perception."""

WAYS = ("exact", "causal", "bilinear")
"""``weighting.weight``; ``streaming.fitted``; the bilinear transform without prewarping, as in the paper."""

SECONDS = 128.0


def largest(name: str, rate: float, way: str) -> float:
    """Largest deviation in dB of a weighting at ``rate`` Hz from 0.5 to 80 Hz, up to 0.45 times the rate.

    The filters answer to a unit impulse in the middle of two minutes; the spectrum of the answer is
    held against the analogue response. Only magnitudes are compared.
    """
    samples = round(SECONDS * rate)
    impulse = np.zeros(samples)
    impulse[samples // 2] = 1.0
    if way == "exact":
        answer = weighting.weight(impulse, rate, name)
    else:
        cascade = streaming.fitted(name, rate) if way == "causal" else streaming.bilinear(name, rate)
        answer = cascade.filter(impulse)
    frequency = np.fft.rfftfreq(samples, 1.0 / rate)
    inside = (frequency >= LOWEST) & (frequency <= min(HIGHEST, weighting.EXACT * rate))
    found = np.abs(np.fft.rfft(answer))[inside]
    return float(np.max(np.abs(20.0 * np.log10(found / weighting.named(name).factor(frequency[inside])))))
