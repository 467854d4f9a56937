"""Jerk of manoeuvres, over time and along the road."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import jerk

TIME = np.arange(3000) / 100.0


@pytest.mark.parametrize("dtype, error", [(np.float64, 1e-6), (np.float32, 2e-3)])
def test_jerk_of_a_slow_sine(dtype, error):
    """A sin(wt) behind the Gaussian: A w cos(wt) times 2^-(f / cutoff)^2."""
    wave = 2 * np.pi * 0.2
    expected = 1.5 * wave * np.cos(wave * TIME) * 2 ** -((0.2 / jerk.CUTOFF) ** 2)
    found = jerk.of_drive((1.5 * np.sin(wave * TIME)).astype(dtype), 100.0)
    assert found[200:-200] == pytest.approx(expected[200:-200], abs=error)


def test_vibration_hardly_counts():
    vibration = 0.5 * np.sin(2 * np.pi * 12 * TIME)
    assert np.max(np.abs(jerk.of_drive(vibration, 100.0)[200:-200])) < 1e-8


def test_a_ramp_has_its_slope_to_the_ends():
    assert jerk.of_drive(0.7 * TIME + 3.0, 100.0) == pytest.approx(0.7)


def test_padding_stays():
    signal = np.concatenate([0.7 * TIME, np.full(500, np.nan)])
    found = jerk.of_drive(np.stack([signal, np.full(3500, np.nan)]), 100.0)
    assert np.isnan(found[0, 3000:]).all() and np.isnan(found[1]).all()
    assert found[0, :3000] == pytest.approx(0.7)


def test_along_the_road_it_is_the_same_jerk():
    """At constant speed, places are times."""
    speed, spacing = 20.0, 0.25
    s = spacing * np.arange(2400)
    acceleration = np.sin(2 * np.pi * 0.3 * s / speed)[None]
    found = jerk.along(acceleration, np.full_like(acceleration, speed), spacing)
    expected = jerk.of_drive(acceleration, speed / spacing)
    assert found == pytest.approx(expected, abs=1e-9)


def test_sections_of_a_run_that_brakes_harder_and_harder():
    s = 0.25 * np.arange(1200)
    a_x = np.where(s < 150, 0.0, -(s - 150) / 20.0)  # 1 m/s3 at 20 m/s
    shard = xr.Dataset(
        {name: (("run", "s"), values[None]) for name, values in (("v_x", 0 * s + 20.0), ("a_x", a_x), ("a_y", 0 * s))},
        {"run": [0], "s": s},
    )
    found = jerk.evaluate([shard])
    assert found["jerk_critical"].sel(jerk="jerk_x", jerk_style="standing_high").values[32:].all()
    assert not found["jerk_critical"].sel(jerk="jerk_x", jerk_style="standing_high").values[:28].any()
    assert not found["jerk_critical"].sel(jerk_style="seated").any()
    assert not found["jerk_critical"].sel(jerk="jerk_y").any()
