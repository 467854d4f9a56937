"""Effects between the driver and the wheels, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.effects.lag import SHORTEST, lag

from tests.effects.whole import act


@pytest.mark.parametrize("time", [0.0, 0.2 * SHORTEST, SHORTEST, 0.1])
@pytest.mark.parametrize("frequency", [0.2, 2.0])
def test_lag_has_the_phase_of_its_time_constant(time, frequency):
    """1 / (1 + i omega t), for short lags as good as omega is slow against SHORTEST."""
    step, turns = 1e-5, 2 * np.pi * frequency
    count = round(1 / frequency / step)
    instants = np.arange(2 * count) * step
    state, seen = 0.0, np.empty(instants.size)
    for k, value in enumerate(np.cos(turns * instants)):
        seen[k], slope = lag(value, state, time)
        state += step * slope
    response = 2 * np.mean(seen[count:] * np.exp(-1j * turns * instants[count:]))
    assert abs(response - 1 / (1 + 1j * turns * time)) < 1e-3 + (turns * SHORTEST) ** 2


def test_no_lag_is_exactly_none():
    assert lag(0.1, 0.7, 0.0)[0] == 0.1


def test_drive_comes_late_and_brakes_at_once():
    force, slope = act("drivetrain_lag")(3000.0, 20.0, 1000.0, 0.2)
    assert (force, slope) == pytest.approx((1000.0, 10000.0))
    force, slope = act("drivetrain_lag")(-2000.0, 20.0, 500.0, 0.2)
    assert (force, slope) == pytest.approx((-1500.0, -2500.0))


def shifting(speeds, step=0.001, depth=0.8, duration=0.4):
    gear, forces, gears = 3.0, [], []
    for speed in speeds:
        force, slope = act("gear_shift")(1000.0, speed, gear, depth, duration, 5.0, 1.45)
        gear += step * slope
        forces.append(force)
        gears.append(gear)
    return np.array(forces), np.array(gears)


def test_a_box_of_six_gears_shifts_up_five_times():
    forces, gears = shifting(np.linspace(20.0, 60.0, 20000))
    assert gears.max() == pytest.approx(5.0, abs=1e-2)


def test_gears_come_at_speeds_in_geometric_steps_and_interrupt_the_drive_once_each():
    forces, gears = shifting(np.linspace(12.0, 24.0, 20000))
    interrupted = forces < 1000.0 * (1 - 0.8 * 0.5)
    starts = np.flatnonzero(np.diff(interrupted.astype(int)) == 1)
    assert np.linspace(12.0, 24.0, 20000)[starts] == pytest.approx([5 * 1.45**3, 5 * 1.45**4], rel=0.01)
    assert forces.min() == pytest.approx(200.0)
    assert gears[-1] == pytest.approx(5.0, abs=1e-3)
    lost = (1000.0 - forces).sum() * 0.001 / 2
    assert lost == pytest.approx(0.8 * 1000.0 * 0.4 * (np.log(2) + 1) / 3, rel=0.02)


def test_steady_speed_at_a_shift_does_not_shift_to_and_fro():
    edge = 5 * 1.45**3
    forces, gears = shifting(edge * (1 + 0.02 * np.sin(np.linspace(0.0, 60.0, 20000))))
    assert np.abs(np.diff(np.round(gears))).sum() <= 1.0


@pytest.mark.parametrize("asked", [0.3, 0.8])
def test_a_climb_during_which_the_clutch_opens_does_not_hold_the_car_at_the_speed_of_the_shift(asked):
    """On a grade the car slows while the clutch is open; the shift that has begun goes on."""
    mass, grade, step, speed, gear, interrupted = 1500.0, 0.05, 0.001, 10.2, 2.0, 0
    demand = mass * (asked + 9.81 * grade)
    for _ in range(20000):
        force, slope = act("gear_shift")(demand, speed, gear, 0.8, 0.4, 5.0, 1.45)
        gear += step * slope
        speed += step * (force / mass - 9.81 * grade)
        interrupted += force < 0.6 * demand
    assert speed > 10.2 + 0.25 * asked * 20.0
    assert gear > 2.9 and interrupted * step < 2.0


def test_brakes_are_not_shifted():
    assert act("gear_shift")(-1000.0, 20.0, 0.0, 0.8, 0.4, 5.0, 1.45)[0] == -1000.0


def test_steering_gives_way_in_proportion_to_the_side_force():
    angle, state = 0.0, 0.0
    for _ in range(5000):
        angle, slope = act("steering_compliance")(0.05, 20.0, 4000.0, state, 1e-6)
        state += 1e-4 * slope
    assert angle == pytest.approx(0.05 - 4000.0 * 1e-6)


def test_steering_lag_follows_a_step():
    state, angle = 0.0, 0.0
    for _ in range(800):
        angle, slope = act("steering_lag")(0.1, 20.0, 0.0, state, 0.08)
        state += 1e-4 * slope
    assert angle == pytest.approx(0.1 * (1 - np.exp(-1)), rel=1e-3)
