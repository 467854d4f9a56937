"""Offline weighting: exact, causal in effect, without wrap-round, the same for any batch."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy import signal

from ridecomfort.comfort import iso2631, weighting
from ridecomfort.errors import InputError

RATES = (100, 200, 500, 1000)


def analogue(values: np.ndarray, rate: float, name: str, finer: int = 20) -> np.ndarray:
    """The analogue filter integrated in time (scipy.signal.lsim), the input interpolated band-limited."""
    filter_ = weighting.WEIGHTINGS[name]
    zeros, poles = filter_.zeros_poles()
    at = 2j * np.pi * 3.0
    gain = np.real(filter_.response(3.0) / (np.prod(at - zeros) / np.prod(at - poles)))
    fine = signal.resample(values, finer * len(values))
    time = np.arange(len(fine)) / (finer * rate)
    return signal.lsim(signal.ZerosPolesGain(zeros, poles, gain), fine, time)[1][::finer]


@pytest.mark.parametrize("name", ["Wk", "Wd", "Wb", "Wf"])
def test_burst_against_the_analogue_filter_integrated_in_time(name):
    rate = 100.0
    time = np.arange(2000) / rate
    # A tone of 4 Hz under a smooth envelope: nothing near half the rate, nothing at the ends.
    burst = np.sin(2 * np.pi * 4 * time) * np.exp(-(((time - 8) / 0.8) ** 2))
    expected = analogue(burst, rate, name)
    found = iso2631.weight(burst, rate, name)
    assert np.max(np.abs(found - expected)) < 2e-4 * np.max(np.abs(expected))


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", weighting.WEIGHTINGS)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_deviation_below_0_01_dB_to_0_45_of_the_rate(rate, name, dtype):
    """The response to an impulse amid silence, whose spectrum is compared; 0.5 to 80 Hz."""
    count = 150 * rate
    impulse = np.zeros(count, dtype)
    impulse[count // 3] = 1.0
    answer = iso2631.weight(impulse, rate, name)
    assert answer.dtype == dtype
    frequency = np.fft.rfftfreq(count, 1 / rate)
    inside = (frequency >= 0.5) & (frequency <= min(80.0, 0.45 * rate))
    gain = np.abs(np.fft.rfft(answer.astype(float)))[inside]
    exact = weighting.WEIGHTINGS[name].factor(frequency[inside])
    # The answer is cut off after 100 s and, in float32, rounded: what Wf suppresses further drowns in that.
    audible = exact > (1e-6 if dtype == np.float64 else 1e-3)
    assert np.max(np.abs(20 * np.log10(gain[audible] / exact[audible]))) <= 0.01


def test_nothing_wraps_round():
    """What happens at the end must not show at the beginning, nor the other way round."""
    rate = 100.0
    late = np.zeros(1500)
    late[-120:] = np.sin(2 * np.pi * 1.0 * np.arange(120) / rate)
    assert np.max(np.abs(iso2631.weight(late, rate, "Wd")[:1000])) < 1e-6
    early = late[::-1].copy()
    longer = np.concatenate([early, np.zeros(5000)])
    assert np.allclose(iso2631.weight(early, rate, "Wd"), iso2631.weight(longer, rate, "Wd")[:1500], atol=1e-8)


def test_mirror_spares_an_offset_its_transient():
    rate, time = 100.0, np.arange(6000) / 100.0
    wave = np.cos(2 * np.pi * 2 * time)
    steady = weighting.WEIGHTINGS["Wk"].factor(2.0)
    at_rest = iso2631.weight(9.81 + wave, rate, "Wk")
    mirrored = iso2631.weight(9.81 + wave, rate, "Wk", before="mirror")
    assert np.max(np.abs(at_rest[:100])) > 3.0
    assert np.max(np.abs(mirrored[:100])) < 1.05 * steady


def test_padding_with_nan_stays_and_does_not_leak(rng=np.random.default_rng(3)):
    signals = rng.standard_normal((3, 2, 900))
    ends = np.array([[900, 400], [650, 1], [77, 0]])
    for run, axis in np.ndindex(3, 2):
        signals[run, axis, ends[run, axis] :] = np.nan
    found = iso2631.weight(signals, 100.0, "Wk")
    for run, axis in np.ndindex(3, 2):
        end = ends[run, axis]
        assert np.isnan(found[run, axis, end:]).all()
        if end:
            alone = iso2631.weight(signals[run, axis, :end], 100.0, "Wk")
            assert np.array_equal(found[run, axis, :end], alone)


def test_xarray_keeps_dims_wherever_time_stands():
    values = np.random.default_rng(1).standard_normal((500, 4))
    time = np.arange(500) / 100.0
    array = xr.DataArray(values, dims=("time", "run"), coords={"time": time}, attrs={"units": "m s-2"}, name="a_z")
    found = iso2631.weight(array, 100.0, "Wk")
    assert found.dims == ("time", "run") and found.attrs["units"] == "m/s2"
    assert np.array_equal(found.values, iso2631.weight(values.T, 100.0, "Wk").T)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((np.array([0.0, np.nan, 1.0]), 100, "Wk"), "sample 1"),
        ((np.array([0.0, np.inf]), 100, "Wk"), "not finite"),
        ((np.zeros(9), 100, "Wq"), "'Wq' is not a frequency weighting"),
        ((np.zeros(9), 0, "Wk"), "rate"),
        ((np.zeros(0), 100, "Wk"), "no samples"),
        ((xr.DataArray(np.zeros(9), dims="time", attrs={"units": "g"}), 100, "Wk"), "expected m/s2"),
        ((xr.DataArray(np.zeros(9), dims="time", coords={"time": np.arange(9) / 50}), 100, "Wk"), "50 Hz"),
    ],
)
def test_mistakes_are_named(arguments, message):
    with pytest.raises(InputError, match=message):
        iso2631.weight(*arguments)
