"""The reference line meets what is asked for exactly and can be driven on."""

import numpy as np
import pytest
from scipy.special import fresnel

from ridecomfort.errors import InputError
from ridecomfort.standin import geometry

SITES = ("ts1", "ts2", "ts3")


def line(settings, name, seed=None):
    target = settings["sites"][name]
    return geometry.reference_line(
        np.random.default_rng(settings["seed"] if seed is None else seed),
        length=target["length"],
        spacing=settings["grid"]["spacing"],
        plan=target["plan"],
        profile=target["profile"],
        bank=settings["bank"],
    )


def test_a_clothoid_is_traced_as_the_fresnel_integrals_have_it():
    rate = 0.02 / 80.0
    u = np.arange(0.0, 80.05, 0.1)
    heading, x, y = geometry.trace(u, np.array([0.0, 80.0]), np.array([0.0, 0.02]))
    sine, cosine = fresnel(u * np.sqrt(rate / np.pi))
    np.testing.assert_allclose(heading, 0.5 * rate * u**2, atol=1e-14)
    np.testing.assert_allclose(x, cosine * np.sqrt(np.pi / rate), atol=1e-10)
    np.testing.assert_allclose(y, sine * np.sqrt(np.pi / rate), atol=1e-10)


def test_a_full_circle_closes():
    radius = 50.0
    u = np.linspace(0.0, 2.0 * np.pi * radius, 3001)
    heading, x, y = geometry.trace(u, np.array([0.0, u[-1]]), np.full(2, 1.0 / radius))
    assert heading[-1] == pytest.approx(2.0 * np.pi)
    assert np.hypot(x[-1], y[-1]) < 1e-9
    assert y.max() == pytest.approx(2.0 * radius, abs=1e-4)


@pytest.mark.parametrize("name", SITES)
@pytest.mark.parametrize("seed", range(5))
def test_every_seed_gives_the_length_turning_and_slope_asked_for(settings, name, seed):
    road, target = line(settings, name, seed), settings["sites"][name]
    turned_gon = np.abs(np.diff(road.heading)).sum() * 200.0 / np.pi
    assert road.u[-1] == pytest.approx(target["length"])
    assert turned_gon / (target["length"] / 1000.0) == pytest.approx(target["plan"]["turning_gon_per_km"], rel=1e-6)
    assert np.abs(road.slope).mean() == pytest.approx(target["profile"]["mean_absolute"], rel=1e-9)


@pytest.mark.parametrize("name", SITES)
@pytest.mark.parametrize("seed", range(5))
def test_every_seed_gives_a_road_that_can_be_driven(settings, name, seed):
    road, target = line(settings, name, seed), settings["sites"][name]
    assert 1.0 / np.abs(road.curvature).max() >= target["plan"]["radius"][0]
    sharpest = 1.0 / (target["plan"]["radius"][0] * target["plan"]["clothoid_minimum"])
    assert np.abs(np.diff(road.curvature)).max() / 0.1 < sharpest
    vertical = np.abs(np.diff(road.slope)).max() / 0.1
    assert vertical * (100 / 3.6) ** 2 < 3.0, "a crest would lift the car off"
    assert np.abs(road.slope).max() < 0.15
    step = np.hypot(np.diff(road.x), np.diff(road.y))
    np.testing.assert_allclose(step, 0.1, rtol=1e-5)
    apart = np.hypot(road.x[::50, None] - road.x[::50], road.y[::50, None] - road.y[::50])
    far = np.abs(road.u[::50, None] - road.u[::50]) > 150.0
    assert apart[far].min() > 14.0, "the road runs into itself"


def test_the_bank_falls_to_the_inside_of_curves_and_to_the_right_between(settings):
    curvature = np.repeat([0.0, 0.01, 0.0, -0.01, 0.0], 2000)
    bank = geometry.cross_slope(curvature, 0.1, **settings["bank"])
    low, high = settings["bank"]["minimum"], settings["bank"]["maximum"]
    np.testing.assert_allclose(bank[[500, 3000, 5000, 7000, 9500]], [low, -high, low, high, low], atol=1e-9)
    assert np.abs(np.diff(bank)).max() / 0.1 < 2.0 * (low + high) / settings["bank"]["twist_length"] * 1.01


def test_height_is_the_integral_of_slope(settings):
    road = line(settings, "ts3")
    assert road.height[-1] == pytest.approx(np.trapezoid(road.slope, road.u))
    assert road.height[-1] / road.u[-1] == pytest.approx(0.071, rel=0.05), "ts3 is a climb"


def test_a_plan_without_room_is_refused(settings):
    target = settings["sites"]["ts3"]
    with pytest.raises(InputError, match="keeps its limits"):
        geometry.reference_line(
            np.random.default_rng(1), length=500.0, spacing=0.1, plan={**target["plan"], "radius": [400, 500]},
            profile=target["profile"], bank=settings["bank"],
        )  # fmt: skip
