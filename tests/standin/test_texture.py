"""The random surface has the spectrum of ISO 8608 along and the coherence of an isotropic surface across."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import csd, welch
from scipy.special import k1

from ridecomfort.road import roughness
from ridecomfort.standin import texture

V = np.linspace(-2.0, 2.0, 9)


@pytest.fixture(scope="module")
def surfaces():
    """Surfaces of waviness 1.8 and 2.4, 30 km long."""
    rng = np.random.default_rng(3)
    band = {"wavenumber_minimum": 0.01, "wavenumber_maximum": 5.0}
    return texture.fields(rng, 300_000, 0.1, V, wavinesses=(1.8, 2.4), **band)


@pytest.mark.parametrize(("index", "waviness"), [(0, 1.8), (1, 2.4)])
def test_spectrum_has_the_level_and_exponent_asked_for(surfaces, index, waviness):
    wavenumber, density = welch(surfaces[index], fs=10.0, nperseg=8192, axis=0, window="hann")
    inside = (wavenumber > 0.02) & (wavenumber < 4.0)
    exponent, level = np.polyfit(np.log(wavenumber[inside] / 0.1), np.log(density.mean(axis=1)[inside]), 1)
    assert -exponent == pytest.approx(waviness, abs=0.02)
    assert np.exp(level) == pytest.approx(1e-6, rel=0.03)


def test_variance_is_the_integral_of_the_spectrum(surfaces):
    expected, _ = quad(lambda n: 1e-6 * (n / 0.1) ** -1.8, 0.01, 5.0)
    assert surfaces[0].var() == pytest.approx(expected, rel=0.05)


def test_the_study_sees_the_class_that_is_generated():
    """A gain of 8 makes 64e-6 m3 at 0.1 cycles/m, the middle of class B of ISO 8608."""
    (surface,) = texture.fields(
        np.random.default_rng(5), 50_000, 0.1, V, wavinesses=(2.0,), wavenumber_minimum=0.01, wavenumber_maximum=5.0
    )
    centre, density = roughness.smooth(*roughness.spectrum(8.0 * surface[:, 0], 0.1))
    unevenness, waviness = roughness.fit(centre, density)
    assert roughness.road_class(float(unevenness)) == "B"
    assert float(unevenness) == pytest.approx(64e-6, rel=0.2)
    assert float(waviness) == pytest.approx(2.0, abs=0.1)


def test_coherence_for_waviness_two_is_that_of_kamash_and_robson():
    n, t = np.array([0.05, 0.2, 1.0])[:, None], np.array([0.5, 1.5])
    argument = 2.0 * np.pi * n * t
    np.testing.assert_allclose(texture.coherence(n, t, 2.0), argument * k1(argument), rtol=1e-12)
    assert texture.coherence(0.0, 1.5, 2.0) == 1.0


@pytest.mark.parametrize("waviness", [1.8, 2.4])
def test_coherence_is_that_of_a_two_dimensional_isotropic_spectrum(waviness):
    """The same from scratch: cross spectrum as the integral over transverse wavenumbers of |k|^-(w+1)."""
    n, t = 0.15, 1.5

    def spectrum(m):
        return (n * n + m * m) ** (-0.5 * (waviness + 1.0))

    along, _ = quad(spectrum, 0.0, np.inf)
    across, _ = quad(spectrum, 0.0, np.inf, weight="cos", wvar=2.0 * np.pi * t)
    assert texture.coherence(n, t, waviness) == pytest.approx(across / along, rel=1e-6)


@pytest.mark.parametrize(("index", "waviness"), [(0, 1.8), (1, 2.4)])
def test_left_and_right_track_cohere_as_they_should(surfaces, index, waviness):
    right, left = surfaces[index][:, 2], surfaces[index][:, 5]
    settings = {"fs": 10.0, "nperseg": 4096, "window": "hann"}
    wavenumber, cross = csd(right, left, **settings)
    found = cross.real / np.sqrt(welch(right, **settings)[1] * welch(left, **settings)[1])
    for band in ((0.02, 0.06), (0.06, 0.15), (0.15, 0.4), (0.5, 2.0)):
        inside = (wavenumber > band[0]) & (wavenumber < band[1])
        expected = texture.coherence(wavenumber[inside], V[5] - V[2], waviness).mean()
        assert found[inside].mean() == pytest.approx(expected, abs=0.06)


def test_modulation_scales_slopes_and_leaves_no_step():
    surface = np.cumsum(np.random.default_rng(1).standard_normal((4000, 3)), axis=0)
    gain = np.where(np.arange(4000) < 2000, 1.0, 3.0)
    changed = texture.modulate(surface, gain)
    np.testing.assert_allclose(np.diff(changed, axis=0)[:1999], np.diff(surface, axis=0)[:1999], atol=1e-9)
    np.testing.assert_allclose(np.diff(changed, axis=0)[2000:], 3.0 * np.diff(surface, axis=0)[2000:], atol=1e-9)
    np.testing.assert_allclose(texture.modulate(surface, np.ones(4000)), surface, atol=1e-9)


def test_smooth_noise_has_unit_variance_and_its_correlation_length():
    noise = texture.smooth_noise(np.random.default_rng(2), 200_000, 1.0, 20.0)
    assert noise.std() == pytest.approx(1.0, abs=0.03)
    assert np.mean(noise[20:] * noise[:-20]) == pytest.approx(np.exp(-0.5), abs=0.05)
