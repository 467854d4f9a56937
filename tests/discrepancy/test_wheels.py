"""Wheels between body and road: a slow wave moves nothing against anything, a fast one the tyre, by the closed form."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy.wheels import wheels
from tests import quarter_cars

SPEED, RATE = 20.0, 200.0


@pytest.fixture(scope="module")
def car(repository):
    return quarter_cars.vehicle(repository)


def surface(u, elevation, **attrs):
    v = np.linspace(-2, 2, elevation.shape[1])
    return xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", np.zeros(u.size))}, {"u": u, "v": v}, attrs)


def driven(car, wavelength, amplitude=0.005, tilted=False):
    """The wheels of a car whose body is held still over a sinusoidal road."""
    u, v = np.arange(0.0, 500.0, 0.05), np.linspace(-2, 2, 5)
    wave = amplitude * np.sin(2 * np.pi * u / wavelength)
    across = np.sign(v) if tilted else np.ones_like(v)
    road = surface(u, wave[:, None] * across)
    place = np.arange(50.0, 450.0, SPEED / RATE)
    still = np.zeros(place.size)
    return place, wheels(road, car, place, np.zeros(place.size), RATE, still, still, still, (0.0, 0.0, 0.0))


def test_a_wheel_under_a_still_body_follows_the_closed_form(car):
    frequency = 4.0
    _, found = driven(car, SPEED / frequency)
    omega = 2j * np.pi * frequency
    responses = []
    for axle in ("front", "rear"):
        strut = car[f"spring_stiffness_{axle}"] + omega * car[f"damping_{axle}"]
        contact = car["tyre_radial_stiffness"] + omega * car["tyre_radial_damping"]
        responses.append(contact / (contact + strut + car[f"unsprung_mass_{axle}"] * omega**2))
    velocity = 0.005 * abs(omega)
    inner = slice(400, -400)
    suspension = velocity * np.sqrt(np.mean(np.abs(responses) ** 2) / 2)
    tyre = velocity * np.sqrt(np.mean(np.abs(1 - np.array(responses)) ** 2) / 2)
    assert np.sqrt(np.mean(found.suspension_velocity[inner] ** 2)) == pytest.approx(suspension, rel=0.03)
    assert np.sqrt(np.mean(found.tyre_velocity[inner] ** 2)) == pytest.approx(tyre, rel=0.03)


def test_the_road_under_the_wheels_is_that_of_the_surface(car):
    place, found = driven(car, 10.0)
    expected = 0.005 * np.sin(2 * np.pi * (place + car["cg_to_front_axle"]) / 10.0)
    np.testing.assert_allclose(found.heave(), expected, atol=2e-5)
    np.testing.assert_allclose(found.tilt(), 0.0, atol=1e-12)


def test_tilt_is_left_above_right(car):
    place, found = driven(car, 10.0, tilted=True)
    left = 0.005 * np.sin(2 * np.pi * (place + car["cg_to_front_axle"]) / 10.0)
    assert np.corrcoef(found.tilt(), left)[0, 1] > 0.99 and found.heave().std() < 1e-6


def test_a_moving_body_and_a_moving_road_work_the_suspension_alike(car):
    """At 1 Hz the tyre hardly gives: either moves the suspension by all of its own motion."""
    place, found = driven(car, SPEED / 1.0)
    road = surface(np.arange(0.0, 500.0, 0.05), np.zeros((10000, 5)))
    moving = 0.005 * (2 * np.pi) ** 2 * np.sin(2 * np.pi * np.arange(place.size) / RATE)
    alone = wheels(road, car, place, np.zeros(place.size), RATE, moving, 0 * moving, 0 * moving, (0.0, 0.0, 0.0))
    velocity = 0.005 * 2 * np.pi / np.sqrt(2)
    assert np.sqrt(np.mean(alone.suspension_velocity[400:-400] ** 2)) == pytest.approx(velocity, rel=0.15)
    assert np.sqrt(np.mean(found.suspension_velocity[400:-400] ** 2)) == pytest.approx(velocity, rel=0.15)


def test_places_beyond_the_road_take_the_height_of_its_end(car):
    road = surface(np.arange(0.0, 100.0, 0.1), np.full((1000, 5), 0.3), border_mode_u="none", border_mode_v="none")
    place = np.arange(90.0, 120.0, 0.1)
    still = np.zeros(place.size)
    found = wheels(road, car, place, still, RATE, still, still, still, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(found.road, 0.3)
