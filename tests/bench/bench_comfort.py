"""Speed of the comfort methods: 12,000 drives of three axes on two cores, and profiles of the IRI."""

from __future__ import annotations

import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from ridecomfort.comfort import iri, iso2631

DRIVES, CORES, BATCH = 12_000, 2, 200
RATE, SAMPLES = 100.0, 12_500


def bench() -> dict:
    """Seconds for weighting and total value of 12,000 drives (100 Hz, 125 s); samples of a profile per second."""
    with ProcessPoolExecutor(CORES, get_context("spawn")) as pool:
        list(pool.map(_total_values, [1] * CORES))
        start = time.perf_counter()
        list(pool.map(_total_values, [DRIVES // BATCH // CORES] * CORES))
        seconds = time.perf_counter() - start
    profile = np.random.default_rng(1).standard_normal((2, 100_000)).cumsum(axis=1) * 1e-3
    iri.iri(profile, 0.1, 50.0)
    start = time.perf_counter()
    iri.iri(profile, 0.1, 50.0)
    return {
        "comfort_12000_drives_s": seconds,
        "comfort_iri_samples_per_s": profile.size / (time.perf_counter() - start),
    }


def _total_values(batches: int) -> None:
    axes = np.random.default_rng(1).standard_normal((3, BATCH, SAMPLES)).astype(np.float32)
    for _ in range(batches):
        iso2631.running_total_value(*axes, RATE)
