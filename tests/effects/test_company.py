"""Effects that act together: in the order of what they describe, not of their names."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.effects import library

from tests.effects.whole import drive
from tests.vehicle.roads import road, rough

ROUGH = road(120.0, height=rough)


def test_what_delays_comes_behind_what_it_delays():
    chosen = library.choose(["clock_offset", "gyroscope_delay", "imu_lever_arm", "imu_tilt", "sensor_mount", "sensor_gain"])
    assert [entry.effect.name for entry, _ in chosen] == [
        "imu_lever_arm", "sensor_mount", "imu_tilt", "clock_offset", "gyroscope_delay", "sensor_gain",
    ]  # fmt: skip
    together = [entry.effect.name for entry, _ in library.choose(["tyre_relaxation", "wheel_compliance", "steering_lag", "steering_compliance"])]
    assert together.index("wheel_compliance") < together.index("tyre_relaxation")
    assert together.index("steering_lag") < together.index("steering_compliance")


@pytest.mark.parametrize("speed", [10.0, 20.0])
def test_wheels_on_bushings_whose_tyres_answer_late_do_not_shake_the_car(car, speed):
    alone = [drive(ROUGH, car, effects=[name], speed=speed).a_x.values.std() for name in ("tyre_relaxation", "wheel_compliance")]
    together = drive(ROUGH, car, effects=["tyre_relaxation", "wheel_compliance"], speed=speed).a_x.values.std()
    assert together < 1.5 * max(alone)


def test_the_lever_arm_of_an_instrument_does_not_wait_for_its_gyroscope(car):
    """Only the rates that are shown are late."""
    arm = drive(ROUGH, car, effects=["imu_lever_arm"], speed=20.0)
    both = drive(ROUGH, car, effects=["imu_lever_arm", "gyroscope_delay"], speed=20.0)
    for name in ("a_x", "a_y", "a_z"):
        np.testing.assert_array_equal(both[name], arm[name])
    assert (both.roll_rate - arm.roll_rate).values.std() > 0.01 * arm.roll_rate.values.std()


def test_an_engine_on_its_mounts_answers_to_the_acceleration_of_the_same_step(car):
    """By halving the step: it is a tenth of the body's mass, whose acceleration of the step before would be a first-order error."""
    drives = {
        step: simulate.run(ROUGH, car, effects=["powertrain_mounts"], speed=20.0, step=step) for step in (0.002, 0.001, 0.000125)
    }
    finest = drives[0.000125].a_z.values[100:400]
    error = {step: (drives[step].a_z.values[100:400] - finest).std() / finest.std() for step in (0.002, 0.001)}
    assert error[0.001] < 0.004 and error[0.002] < 0.012


@pytest.mark.parametrize("ahead", [-1.6, 1.6])
@pytest.mark.parametrize("frequency", [5.0, 20.0])
def test_the_heaviest_engine_at_an_end_of_the_car_is_integrated_in_the_steps_of_a_search(car, ahead, frequency):
    """It takes two thirds of the body's inertia away there."""
    sizes = {"mass": 350.0, "ahead": ahead, "frequency": frequency, "damping_ratio": 0.02}
    coarse, fine = (drive(ROUGH, car, effects={"powertrain_mounts": sizes}, speed=20.0, step=step).a_z.values for step in (0.002, 0.0005))
    assert (coarse[100:400] - fine[100:400]).std() < 0.1 * fine[100:400].std()


def test_a_grade_that_the_file_leaves_out_is_driven_like_one_in_the_file(car):
    grade = 0.05
    missing = drive(road(140.0), car, effects={"road_grade": {"grade": grade}}, speed=20.0)
    there = drive(road(140.0, height=lambda u, v: grade * u + 0 * v), car, speed=20.0)
    for name, most in (("v_x", 0.01), ("a_x", 0.01)):
        assert np.abs(missing[name].values[:400] - there[name].values[:400]).max() < most


def test_standing_on_a_bank_is_as_a_bend_to_the_links(car):
    """By equivalence: a bank of 0.05 and a level bend of 0.05 g give the same lean, but for small angles."""
    car = car.replace(roll_centre_height_front=0.3, roll_centre_height_rear=0.3)
    bank, speed = 0.05, 10.0
    banked = drive(road(220.0, height=lambda u, v: bank * v + 0 * u), car, speed=speed)
    bent = drive(road(220.0, curvature=bank * 9.80665 / speed**2), car, speed=speed)
    lean = float(banked["roll"][-50:].mean()) - bank, float(bent["roll"][-50:].mean())
    assert abs(lean[0]) == pytest.approx(abs(lean[1]), rel=0.06)
