"""Smoothing splines and their cross-validated stiffness."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.interpolate import make_smoothing_spline

from ridecomfort.road import smoothing

U = np.arange(2000) * 0.1


def test_the_cut_off_halves_waves_of_its_length_and_leaves_long_ones():
    for wavelength, gain in ((2.0, 0.5), (20.0, 1 / (1 + 1e-4)), (0.5, 1 / (1 + 4**4))):
        wave = np.sin(2 * np.pi * U / wavelength)
        found = smoothing.smooth(wave[:, None], 0.1, 2.0)[:, 0]
        assert (found @ wave / (wave @ wave))[()] == pytest.approx(gain, abs=0.03)


@pytest.mark.parametrize("spacings", [2, 3, 4, 6, 10, 100])
def test_a_wave_of_the_cut_off_keeps_half_its_height_however_few_points_make_it_up(spacings):
    wave = np.cos(2 * np.pi * np.arange(6000) / spacings)
    found = smoothing.smooth(wave[:, None], 0.1, 0.1 * spacings)[:, 0]
    inside = slice(1200, -1200)
    assert found[inside] @ wave[inside] / (wave[inside] @ wave[inside]) == pytest.approx(0.5, abs=1e-6)


def test_a_cut_off_below_two_spacings_is_one_of_two():
    heights = np.random.default_rng(6).standard_normal((100, 1))
    np.testing.assert_allclose(smoothing.smooth(heights, 0.1, 0.05), smoothing.smooth(heights, 0.1, 0.2))


def test_the_penalty_of_a_choice_is_that_of_its_smoothing():
    """That of waves much longer than the spacing: (wavelength / 2 pi)^4."""
    noisy = np.random.default_rng(7).standard_normal((400, 1))
    choice = smoothing.cross_validate(noisy, 0.1, [0.3, 10.0])
    assert choice.penalty == smoothing.penalty(choice.wavelength, 0.1)
    assert smoothing.penalty(10.0, 0.1) == pytest.approx((10 / (2 * np.pi)) ** 4, rel=1e-3)


def test_straight_lines_pass_unchanged():
    line = 3.0 + 0.07 * U[:, None]
    np.testing.assert_allclose(smoothing.smooth(line, 0.1, 5.0), line, atol=1e-6)


def test_it_is_the_cubic_smoothing_spline():
    """Against scipy's spline through the same points with the same penalty (per point: lambda / spacing)."""
    rng = np.random.default_rng(1)
    noisy = np.sin(U / 5) + rng.normal(0, 0.1, U.size)
    spline = make_smoothing_spline(U, noisy, lam=smoothing.penalty(3.0, 0.1) / 0.1)(U)
    found = smoothing.smooth(noisy[:, None], 0.1, 3.0)[:, 0]
    assert np.sqrt(np.mean((found - spline)[50:-50] ** 2)) < 1e-3


@pytest.mark.parametrize("noise", [0.01, 0.1])
def test_cross_validation_comes_close_to_the_best_that_the_truth_would_choose(noise):
    rng = np.random.default_rng(2)
    truth = np.sin(2 * np.pi * U / 8)
    noisy = (truth + rng.normal(0, noise, U.size))[:, None]
    choice = smoothing.cross_validate(noisy, 0.1)

    def error(wavelength):
        return np.sqrt(np.mean((smoothing.smooth(noisy, 0.1, wavelength)[:, 0] - truth) ** 2))

    best = min(error(wavelength) for wavelength in choice.wavelengths)
    assert error(choice.wavelength) < 1.1 * best < noise / 2
    assert choice.errors.min() == pytest.approx(noise, rel=0.1)


def test_a_surface_is_smoothed_in_both_directions_and_its_edges_stay():
    rng = np.random.default_rng(3)
    v = np.linspace(-2, 2, 41)
    bank = 0.05 * np.sin(U / 20)
    truth = 0.02 * np.sin(2 * np.pi * U / 12)[:, None] * np.cos(v) + bank[:, None] * v + 0.07 * U[:, None]
    noisy = truth + rng.normal(0, 0.002, truth.shape)
    noisy[:300, :2] = np.nan
    road = xr.Dataset({"elevation": (("u", "v"), noisy), "bank": ("u", bank)}, coords={"u": U, "v": v})
    found, choices = smoothing.smooth_surface(road)
    assert set(choices) == {"along", "across"}
    assert np.isnan(found.elevation.values[:300, :2]).all() and int(found.elevation.isnull().sum()) == 600
    assert float(np.sqrt(((found.elevation - truth) ** 2).mean())) < 0.0005
    assert "smoothed along the road" in found.treatment and "cross-validation" in found.treatment


def test_zero_leaves_a_direction_alone():
    road = xr.Dataset(
        {"elevation": (("u", "v"), np.random.default_rng(4).normal(size=(50, 5))), "bank": ("u", np.zeros(50))},
        coords={"u": U[:50], "v": np.arange(5.0)},
    )
    same, choices = smoothing.smooth_surface(road, along=0, across=0)
    np.testing.assert_array_equal(same.elevation, road.elevation)
    assert choices == {}


def test_frayed_edges_with_hardly_a_value_are_smoothed_and_stay_frayed():
    """Of the last column one value is left, of the one before two, and one cross section is empty."""
    rng = np.random.default_rng(5)
    heights = rng.normal(0, 1e-3, (300, 12))
    heights[:, 11], heights[:, 10] = np.nan, np.nan
    heights[40, 10:] = 0.002
    heights[41, 10] = 0.001
    heights[200] = np.nan
    road = xr.Dataset(
        {"elevation": (("u", "v"), heights), "bank": ("u", np.zeros(300))}, coords={"u": U[:300], "v": 0.1 * np.arange(12)}
    )
    found, _ = smoothing.smooth_surface(road)
    np.testing.assert_array_equal(np.isnan(found.elevation), np.isnan(heights))
    assert float(np.abs(found.elevation).max()) < 0.006
    long = smoothing.smooth(heights, 0.1, 100.0)
    assert np.isfinite(long[40, 10:]).all() and np.isnan(long[200, 11])
