"""The driver: a comfortable speed, and a path and speed that are held."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.errors import InputError
from ridecomfort.vehicle import driver

from tests.vehicle.roads import road

LIMITS = dict(limit=27.0, lateral_acceleration=3.0, acceleration=1.0, deceleration=1.5)


def bend(length=900.0, radius=60.0):
    """A straight, a bend of the given radius with transitions, a straight."""
    u = np.arange(0.0, length + 0.05, 0.1)
    return np.interp(u, [0, 400, 440, 520, 560, length], [0, 0, 1 / radius, 1 / radius, 0, 0])


def test_speed_profile_keeps_its_limits():
    ground = road(900.0, curvature=bend())
    speed = driver.speed_profile(ground, **LIMITS)
    gain = np.gradient(speed.values**2 / 2, ground.u.values)
    assert speed.max() <= 27.0 + 1e-9
    assert (speed**2 * np.abs(ground.curvature)).max() < 3.0 * 1.05
    assert gain.max() < 1.0 * 1.05 and gain.min() > -1.5 * 1.05
    assert speed.sel(u=480.0, method="nearest") == pytest.approx(np.sqrt(3.0 * 60.0), rel=0.01)
    assert speed.isel(u=0) == pytest.approx(27.0)


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_that_is_not_positive_is_refused(name):
    with pytest.raises(InputError, match=name):
        driver.speed_profile(road(50.0), **{**LIMITS, name: -1.0})


def test_path_and_speed_are_held_through_a_bend(car):
    ground = road(900.0, curvature=bend())
    drive = simulate.run(ground, car, speed=driver.speed_profile(ground, **LIMITS), lateral=0.3)
    target = driver.speed_profile(ground, **LIMITS).interp(u=drive.s.values)
    assert np.abs(drive.e - 0.3).max() < 0.25
    assert np.abs(drive.v_x.values - target.values).max() < 0.5
    assert np.abs(drive.a_y).max() < 3.6


def test_a_grade_costs_no_lasting_speed(car):
    ground = road(800.0, height=lambda u, v: 0.07 * np.maximum(u - 100, 0) + 0 * v)
    drive = simulate.run(ground, car, speed=15.0)
    progress = np.gradient(drive.s.values, drive.time.values)
    assert progress[-1] == pytest.approx(15.0, abs=0.05)
    assert drive.v_x.values[-1] == pytest.approx(progress[-1] * np.hypot(1.0, 0.07), rel=5e-4)


def test_too_little_friction_for_a_grade_is_said(car):
    ground = road(400.0, height=lambda u, v: 0.3 * np.maximum(u - 50, 0) + 0 * v)
    with pytest.raises(InputError, match="friction"):
        simulate.run(ground, car, speed=10.0, friction=0.1)


def test_a_lateral_profile_is_followed(car):
    ground = road(400.0)
    shift = xr.DataArray(np.interp(ground.u, [150, 250], [0.0, 0.5]), {"u": ground.u}, "u")
    drive = simulate.run(ground, car, speed=15.0, lateral=shift)
    assert drive.e.isel(time=-1) == pytest.approx(0.5, abs=0.02)
    assert float(drive.e.sel(time=slice(0, 5)).max()) < 0.05


def test_a_path_is_driven_when_its_demand_is_asked_for(car):
    ground = road(500.0)
    u, speed, length = ground.u.values, 20.0, 80.0
    path = 0.2 * np.sin(2 * np.pi * u / length)

    def largest_error(asked):
        drive = simulate.run(ground, car, speed=speed, lateral=xr.DataArray(asked, {"u": u}, "u"))
        error = drive.e - 0.2 * np.sin(2 * np.pi * drive.s / length)
        return float(np.abs(error[(drive.s > 150) & (drive.s < 400)]).max())

    demand = driver.path_demand(path, (u[1] - u[0]) / speed, np.full(u.size, speed))
    # What is left is the delay of the vehicle behind its front wheels.
    assert largest_error(demand) < 0.15 * largest_error(path)


@pytest.mark.parametrize("lateral", [1.5, -1.5])
def test_a_lane_is_driven_alike_whichever_reference_line_it_is_seen_from(car, lateral):
    radius, speed = 30.0, 8.0
    aside = simulate.run(road(120.0, curvature=1.0 / radius), car, speed=speed, lateral=lateral)
    within = simulate.run(road(120.0, curvature=1.0 / (radius - lateral)), car, speed=speed)
    assert float(aside.e[-1]) - lateral == pytest.approx(float(within.e[-1]), abs=2e-4)


@pytest.mark.parametrize("frequency", [0.3, 1.0, 2.0])
def test_a_wave_of_speed_that_the_controller_is_asked_for_as_it_answers_is_driven(car, frequency):
    ground, speed = road(500.0), 20.0
    time = np.arange(0.0, 25.0, 0.01)
    wave = 0.01 * np.sin(2 * np.pi * frequency * time) * np.clip((time - 4.0) / 2.0, 0.0, 1.0)
    asked = driver.speed_demand(wave, 0.01)
    demand = xr.DataArray(speed + np.interp(ground.u.values, speed * time, asked), {"u": ground.u}, "u")
    drives = [simulate.run(ground, car, speed=target, step=0.001) for target in (demand, speed)]
    driven = drives[0]["v_x"].values - np.interp(drives[0]["s"], drives[1]["s"], drives[1]["v_x"])
    wanted = np.interp(drives[0]["s"], speed * time, wave)
    settled = (drives[0]["s"].values > 180.0) & (drives[0]["s"].values < 450.0)
    assert np.std((driven - wanted)[settled]) < 0.25 * np.std(wanted[settled])
