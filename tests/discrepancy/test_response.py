"""Transfer functions of signals that were made by known ones."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.signal import lfilter

from ridecomfort.discrepancy.response import responses

RATE = 100.0


@dataclass
class Driven:
    measured: np.ndarray
    simulated: np.ndarray
    rate: float = RATE
    series: dict = field(default_factory=dict)

    @property
    def residual(self):
        return self.simulated - self.measured


def drive(seed, gain=1.5, noise=0.0, road=False):
    rng = np.random.default_rng(seed)
    wave = rng.standard_normal(12000)
    simulated = lfilter([1.0], [1.0, -0.5], wave)[None]
    measured = gain * simulated + noise * rng.standard_normal(simulated.shape)
    series = {}
    if road:
        series = {"road_heave": np.cumsum(simulated[0]) / RATE, "road_tilt": wave}
    return Driven(measured, simulated, series=series)


def test_a_measured_signal_that_is_larger_has_that_gain_and_full_coherence():
    found = responses([drive(0), drive(1)], ["a_z"])
    np.testing.assert_allclose(found["model_gain"], 1.5, rtol=1e-6)
    np.testing.assert_allclose(found["model_phase"], 0.0, atol=1e-6)
    np.testing.assert_allclose(found["model_coherence"], 1.0, rtol=1e-6)


def test_noise_takes_coherence_and_leaves_the_gain():
    found = responses([drive(seed, noise=1.5) for seed in range(6)], ["a_z"]).sel(frequency=slice(1, 40))
    power = found["simulated_density"] * 1.5**2
    expected = power / (power + 1.5**2 / 50.0)
    assert float(abs(found["model_coherence"] - expected).mean()) < 0.03
    assert float(found["model_gain"].mean()) == pytest.approx(1.5, rel=0.03)


def test_densities_integrate_to_the_variance():
    one = drive(0)
    found = responses([one], ["a_z"])
    step = float(found["frequency"][1])
    assert float(found["error_density"].sum() * step) == pytest.approx(one.residual.var(), rel=0.05)


def test_the_gain_from_the_road_is_per_speed_at_which_it_moves():
    """The simulated signal is what the road moves at, so its gain is one; the measured one's that of the signals."""
    found = responses([drive(seed, road=True) for seed in range(3)], ["a_z"]).sel(frequency=slice(1, 10))
    assert float(found["road_gain"].sel(source="simulated").mean()) == pytest.approx(1.0, rel=0.05)
    assert float(found["road_gain"].sel(source="measured").mean()) == pytest.approx(1.5, rel=0.05)
    assert float(found["road_coherence"].min()) > 0.95


def test_without_a_road_there_is_no_gain_from_it():
    assert "road_gain" not in responses([drive(0)], ["a_z"])
