"""Effects of how links lead a wheel, against momentum, virtual work and the travel of the plain model."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.vehicle import driver, reference

from tests.effects.whole import drive
from tests.vehicle.roads import road
from tests.vehicle.test_physics import watched

STEP = 0.001


def bump(u, v):
    return np.where((u > 20) & (u < 21.5), 0.01 * np.sin(np.pi * (u - 20) / 1.5) ** 2, 0.0) + 0 * v


def rising(plain, inertia):
    """Sum over the front wheels of ``inertia`` (kg) times how they accelerate upwards against the body, in N."""
    return inertia * np.gradient(np.gradient(plain["travel"][:, :2].sum(axis=1), STEP), STEP)


def recoil(ground, car, share, speed, friction):
    """Force fore and aft in N that front wheels which recede by ``share`` add to a drive, over time: what the car, and wheels that roll, withstand."""
    options = {"speed": speed, "friction": friction, "rate": 1 / STEP, "step": STEP, "start": 4.0}
    receding = drive(ground, car, effects={"wheel_recession": {"front": share, "rear": 0.0}}, **options)
    base = drive(ground, car, **options)
    matrix = reference.Car(car).mass_matrix
    pitching = np.gradient((receding.pitch_rate - base.pitch_rate).values, STEP)
    surging = (receding.a_x - base.a_x).values
    turning = 4.0 * car["wheel_spin_inertia"] / car["tyre_radius"] ** 2 if friction == 1.0 else 0.0
    return matrix[0, 0] * surging + matrix[0, 5] * pitching + turning * (surging - (car["cg_height"] - car["tyre_radius"]) * pitching)


@pytest.mark.parametrize(("friction", "grip"), [(1e-9, 1e4), (1.0, 1.5e6)])
def test_wheels_that_recede_push_by_their_inertia_and_where_they_grip_by_their_spin(car, friction, grip):
    """Momentum: without grip it is m, rolling without slip m + J / R^2, times recession and how they rise."""
    share, speed = 0.02, 10.0
    car = car.replace(longitudinal_slip_stiffness=grip)
    ground = road(60.0, height=bump)
    found = recoil(ground, car, share, speed, friction)
    plain = watched(car, ground, speed, friction=friction, step=STEP)
    inertia = car["unsprung_mass_front"]
    if friction == 1.0:
        inertia += car["wheel_spin_inertia"] / car["tyre_radius"] ** 2
    expected = share * rising(plain, inertia)
    count = min(len(found), len(expected))
    shaken = slice(1400, min(2400, count))
    assert expected[shaken].std() > 3.0
    assert (found[shaken] - expected[shaken]).std() < 0.03 * expected[shaken].std()


def test_driving_lifts_the_body_over_wheels_that_recede(car):
    """Virtual work: at the recession R a wheel pushed by F carries R F less on its spring, so the axle rises by R F / k."""
    acceleration, share, ground = 0.5, 0.2, road(320.0)
    speed = xr.DataArray(np.sqrt(100.0 + 2 * acceleration * ground.u.values), {"u": ground.u.values}, "u")
    receding = drive(ground, car, effects={"wheel_recession": {"front": 0.0, "rear": share}}, speed=speed)
    base = drive(ground, car, speed=speed)
    late = slice(12.0, 16.0)
    gained = float(base.a_x.sel(time=late).mean())
    assert gained == pytest.approx(acceleration, rel=0.05)
    total = car["sprung_mass"] + 2 * car["unsprung_mass_front"] + 2 * car["unsprung_mass_rear"]
    push = gained * (total / 2 - car["unsprung_mass_rear"])
    lift = share * push / car["spring_stiffness_rear"]
    pitched = float((receding.pitch - base.pitch).sel(time=late).mean())
    assert pitched == pytest.approx(lift / car["wheelbase"], rel=0.05)


def test_the_recoil_is_that_of_its_limit_at_half_the_step(car):
    ground = road(60.0, height=bump)
    ends = {}
    for step in (0.001, 0.000125):
        options = {"speed": 15.0, "step": step, "rate": 200.0}
        receding = drive(ground, car, effects={"wheel_recession": {"front": 0.2, "rear": -0.2}}, **options)
        ends[step] = (receding.a_x - drive(ground, car, **options).a_x).values
    coarse, fine = ends.values()
    assert (coarse - fine).std() < 0.02 * fine.std()


def test_wheels_that_are_turned_as_they_rise_steer_as_the_driver_would(car):
    """In a steady bend the driver asks for as much less as the front wheels are turned by the roll; so far aside he drives."""
    radius, speed, toe = 60.0, 10.0, 0.1
    ground = road(300.0, curvature=1.0 / radius)
    turned = drive(ground, car, effects={"bump_steer": {"front": toe, "rear": 0.0}}, speed=speed)
    base = drive(ground, car, speed=speed)
    travel = watched(car, road(160.0, curvature=1.0 / radius), speed)["travel"][-1]
    assert travel[1] == pytest.approx(-travel[0], rel=0.1) and travel[1] > 0.005
    angle = [
        driver.steering.py_func(float(there.e[-50:].mean()), 0.0, speed, 0.0, 1.0 / radius, car["wheelbase"])
        for there in (turned, base)
    ]
    assert angle[0] - angle[1] == pytest.approx(-toe * (travel[0] - travel[1]) / 2, rel=0.05)


def test_links_that_are_inclined_are_a_roll_centre(car):
    """A wheel that moves out by h / (track / 2) per compression has its roll centre h higher, but for the mass of what rolls with it there."""
    height, options = 0.08, {"speed": 20.0, "rate": 200.0}
    car = car.replace(unsprung_mass_front=10.0, unsprung_mass_rear=10.0)

    def rough(u, v):
        return 0.004 * np.sin(2 * np.pi * u / 3.1 + 0.8 * v) + 0.006 * np.sin(2 * np.pi * u / 11.0 - 0.5 * v)

    ground = road(200.0, curvature=1.0 / 150.0, height=rough)
    shares = {axle: 2 * height / car[f"track_{axle}"] for axle in ("front", "rear")}
    base = drive(ground, car, **options)
    raised = drive(ground, car, effects={"roll_centre_height": {"front": height, "rear": height}}, **options)
    inclined = drive(ground, car, effects={"inclined_links": shares}, **options)
    for signal in ("a_y", "a_z", "roll_rate", "yaw_rate"):
        change = (raised[signal] - base[signal]).values
        assert change.std() > 0
        assert ((inclined[signal] - raised[signal]).values).std() < 0.05 * change.std(), signal


def test_links_that_are_inclined_carry_the_mass_of_a_wheel_in_a_bend_as_a_roll_centre_does(car):
    height, options = 0.2, {"speed": 16.0}
    car = car.replace(unsprung_mass_front=100.0, unsprung_mass_rear=100.0)
    ground = road(250.0, curvature=0.02)
    shares = {axle: 2 * height / car[f"track_{axle}"] for axle in ("front", "rear")}
    base, raised, inclined = (
        float(drive(ground, car, effects=effects, **options)["roll"][-50:].mean())
        for effects in ({}, {"roll_centre_height": {"front": height, "rear": height}}, {"inclined_links": shares})
    )
    assert inclined - base == pytest.approx(raised - base, rel=0.01)
