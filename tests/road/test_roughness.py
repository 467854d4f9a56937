"""Spectra, classes and coherence, on profiles whose spectrum is known because each harmonic was put in."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.road import roughness
from ridecomfort.standin import texture

SPACING = 0.1


def profile(unevenness, waviness, length, rng):
    """A profile in m of random phases: amplitude sqrt(2 Gd(n) dn) at every wavenumber n of its length."""
    samples = round(length / SPACING)
    n = np.fft.rfftfreq(samples, SPACING)
    density = np.zeros(n.size)
    density[1:] = unevenness * (n[1:] / 0.1) ** -waviness
    phase = np.exp(2j * np.pi * rng.random(n.size))
    return np.fft.irfft(np.sqrt(2 * density * n[1]) * phase, samples) * samples / 2


def test_the_spectrum_of_a_sine_holds_its_variance():
    u = np.arange(20000) * SPACING
    wavenumber, density = roughness.spectrum(0.01 * np.sin(2 * np.pi * 0.25 * u), SPACING)
    assert np.trapezoid(density, wavenumber) == pytest.approx(0.01**2 / 2, rel=1e-3)
    assert wavenumber[density.argmax()] == pytest.approx(0.25)


def test_the_spectrum_of_white_noise_is_flat_at_its_variance():
    noise = np.random.default_rng(1).normal(0, 0.002, 400_000)
    wavenumber, density = roughness.spectrum(noise, SPACING)
    assert density[5:-5].mean() == pytest.approx(0.002**2 / (0.5 / SPACING), rel=0.01)


@pytest.mark.parametrize("name, geometric_mean", list(zip("ABCDE", (16e-6, 64e-6, 256e-6, 1024e-6, 4096e-6))))
def test_a_generated_road_is_analysed_as_its_class(name, geometric_mean):
    """Geometric means of the classes: ISO 8608, table C.1."""
    made = profile(geometric_mean, 2.0, 5000.0, np.random.default_rng(2))
    unevenness, waviness = roughness.fit(*roughness.smooth(*roughness.spectrum(made, SPACING)))
    assert unevenness == pytest.approx(geometric_mean, rel=0.1)
    assert waviness == pytest.approx(2.0, abs=0.05)
    assert roughness.road_class(unevenness) == name


@pytest.mark.parametrize("waviness", [1.6, 2.0, 2.4, 3.0])
def test_waviness_is_found(waviness):
    made = profile(50e-6, waviness, 5000.0, np.random.default_rng(3))
    _, found = roughness.fit(*roughness.smooth(*roughness.spectrum(made, SPACING)))
    assert found == pytest.approx(waviness, abs=0.06)


@pytest.mark.parametrize("limit, below, above", [(32e-6, "A", "B"), (128e-6, "B", "C"), (131072e-6, "G", "H")])
def test_limits_of_the_classes(limit, below, above):
    """ISO 8608, table C.1."""
    assert (roughness.road_class(limit * 0.999), roughness.road_class(limit * 1.001)) == (below, above)
    assert roughness.road_class(1e-12) == "A" and roughness.road_class(100.0) == "H"


def test_bands_follow_one_another_without_gaps():
    """ISO 8608, table 2: octaves to 0.0312, third octaves to 0.25, twelfth octaves above."""
    limits = roughness.bands(0.005, 5.0)
    np.testing.assert_allclose(limits[1:, 0], limits[:-1, 1], rtol=1e-12)
    ratio = np.log2(limits[:, 1] / limits[:, 0])
    centre = np.sqrt(limits.prod(axis=1))
    np.testing.assert_allclose(ratio[centre < 0.032], 1)
    np.testing.assert_allclose(ratio[(centre > 0.032) & (centre < 0.26)], 1 / 3)
    np.testing.assert_allclose(ratio[centre > 0.26], 1 / 12)


def test_smoothing_keeps_a_power_law_and_the_power():
    wavenumber = np.arange(1001) * 0.005
    flat = np.full(1001, 3.0)
    np.testing.assert_allclose(roughness.smooth(wavenumber, flat)[1], 3.0)
    density = np.random.default_rng(4).random(1001)
    centre, smoothed = roughness.smooth(wavenumber, density)
    widths = np.diff(roughness.bands(0.0075, 4.995)).ravel()
    assert (smoothed * widths).sum() == pytest.approx(density.mean() * widths.sum(), rel=0.05)


@pytest.mark.parametrize("shared_part", [0.0, 0.5, 0.9])
def test_coherence_of_tracks_that_share_a_part(shared_part):
    rng = np.random.default_rng(5)
    one, other = (profile(64e-6, 2.0, 40_000.0, rng) for _ in range(2))
    right = np.sqrt(shared_part) * one + np.sqrt(1 - shared_part) * other
    wavenumber, found = roughness.coherence(one, right, SPACING)
    assert found[10:400].mean() == pytest.approx(shared_part, abs=0.01)


def test_a_road_is_analysed_in_its_wheel_tracks():
    rng = np.random.default_rng(6)
    u, v = np.arange(20_000) * SPACING, np.linspace(-2, 2, 41)
    rough, smooth = profile(256e-6, 2.2, 2000.0, rng), profile(16e-6, 2.0, 2000.0, rng)
    elevation = np.where(v < 0, rough[:, None], smooth[:, None]) + 0.05 * u[:, None]
    road = xr.Dataset(
        {"elevation": (("u", "v"), elevation), "bank": ("u", np.zeros(u.size))}, coords={"u": u, "v": v}
    )
    found = roughness.analyse(road)
    assert found["class"].values.tolist() == ["C", "A"]
    np.testing.assert_allclose(found.waviness, [2.2, 2.0], atol=0.1)
    assert float(found.coherence[10:].mean()) < 0.15
    assert found.unevenness.units == "m3"


@pytest.mark.parametrize("beside", [-0.75, 3.75])
def test_a_wheel_track_beside_the_road_is_refused_and_not_analysed_as_the_edge_that_is_held_there(beside):
    u, v = np.arange(4000) * SPACING, np.linspace(0, 3.5, 8)
    elevation = np.repeat(profile(64e-6, 2.0, 400.0, np.random.default_rng(8))[:, None], v.size, axis=1)
    road = xr.Dataset(
        {"elevation": (("u", "v"), elevation), "bank": ("u", np.zeros(u.size))}, coords={"u": u, "v": v}
    )
    with pytest.raises(ValueError, match=f"wheel track at {beside} m lies outside the road, 0 to 3.5 m"):
        roughness.analyse(road, tracks=sorted([beside, 0.75]))
    assert roughness.analyse(road, tracks=[0.0, 3.5])["v"].values.tolist() == [0.0, 3.5]


def test_a_wheel_track_beside_the_edge_of_the_road_is_refused_with_its_place():
    u, v = np.arange(4000) * SPACING, np.linspace(-2, 2, 41)
    elevation = np.repeat(profile(64e-6, 2.0, 400.0, np.random.default_rng(8))[:, None], v.size, axis=1)
    elevation[1000:2000, v < -0.01] = np.nan
    road = xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", np.zeros(u.size))}, coords={"u": u, "v": v})
    with pytest.raises(ValueError, match="wheel track at -0.75 m leaves the road at u = 100 m"):
        roughness.analyse(road, tracks=[-0.75, 0.75])
    assert roughness.analyse(road, tracks=[0.0, 0.75])["v"].values.tolist() == [0.0, 0.75]


def test_a_profile_too_short_for_a_fit_is_refused():
    with pytest.raises(ValueError, match="too short"):
        roughness.fit(*roughness.smooth(*roughness.spectrum(np.zeros(100), SPACING)))


@pytest.mark.parametrize("waviness", [1.8, 2.4])
def test_the_stand_in_generator_and_the_analysis_agree(waviness):
    v = np.array([-0.75, 0.75])
    made = texture.fields(
        np.random.default_rng(7), 60_000, SPACING, v,
        wavinesses=[waviness], wavenumber_minimum=0.005, wavenumber_maximum=5.0,
    )[0]  # fmt: skip
    left, right = 8e-3 * made.T / np.sqrt(texture.UNIT_DENSITY)
    unevenness, found = roughness.fit(*roughness.smooth(*roughness.spectrum(np.stack([left, right]), SPACING)))
    np.testing.assert_allclose(unevenness, 64e-6, rtol=0.15)
    np.testing.assert_allclose(found, waviness, atol=0.06)
    wavenumber, common = roughness.coherence(left, right, SPACING)
    low = (wavenumber > 0.02) & (wavenumber < 0.3)
    expected = texture.coherence(wavenumber[low], 1.5, waviness) ** 2
    assert np.abs(common[low] - expected).mean() < 0.07
