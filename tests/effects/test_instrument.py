"""Effects of the instrument and of what it calls the path, on drives whose motion is known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from ridecomfort import simulate
from ridecomfort.vocabulary import SIGNALS, STANDARD_GRAVITY as G

from tests.effects.whole import act, drive
from tests.vehicle.roads import road, rough

RATE = 100.0


@pytest.fixture
def record():
    """A drive with a sine of its own frequency in every signal."""
    time = np.arange(0.0, 10.0, 1 / RATE)
    values = {name: np.sin(2 * np.pi * (1.0 + 0.7 * k) * time + k) for k, name in enumerate(SIGNALS)}
    values.update(roll=0.02 * np.sin(time), pitch=0.01 * np.cos(time), v_x=15 + 0 * time, s=100 + 15 * time, e=0 * time)
    return xr.Dataset({name: ("time", column) for name, column in values.items()}, coords={"time": time})


@pytest.mark.parametrize("rate", [500.0, 100.0])
def test_lever_arm_is_as_if_the_sensor_sat_there(car, rate):
    """Against the model's own sensor, moved to that place; however slowly it is sampled."""
    ground = road(150.0, height=lambda u, v: rough(u, v))
    arm = (-0.3, 0.2, 0.9)
    moved = drive(ground, car, effects={"imu_lever_arm": dict(zip("xyz", arm, strict=True))}, speed=15.0, rate=rate)
    there = simulate.run(ground, car, speed=15.0, sensor=arm, rate=rate)
    here = simulate.run(ground, car, speed=15.0, rate=rate)
    for name in SIGNALS[:3]:
        error = (moved[name] - there[name]).values[50:-50].std()
        assert error < 0.03 * float((here[name] - there[name]).std())


def test_lever_arm_of_a_steady_turn_is_centripetal(record):
    still = record.copy(deep=True)
    for name in SIGNALS:
        still[name][:] = 0.0
    still["yaw_rate"][:] = 0.5
    moved = act("imu_lever_arm")(still, 2.0, -1.0, 0.3)
    assert moved.a_x.values == pytest.approx(-2.0 * 0.25)
    assert moved.a_y.values == pytest.approx(1.0 * 0.25)
    assert moved.a_z.values == pytest.approx(0.0)


def test_tilt_turns_what_the_instrument_feels(record):
    """Against rotations by scipy; gravity included, taken out as if the instrument were straight."""
    tilt = (0.03, -0.02, 0.05)
    moved = act("imu_tilt")(record, *tilt)
    turn = Rotation.from_euler("ZYX", tilt[::-1]).inv()
    level = Rotation.from_euler("YX", np.stack([record["pitch"], record["roll"]], axis=1)).inv()
    gravity = level.apply([0.0, 0.0, G])
    values = np.stack([record[name] for name in SIGNALS], axis=1)
    expected = np.concatenate([turn.apply(values[:, :3] + gravity) - gravity, turn.apply(values[:, 3:])], axis=1)
    assert np.stack([moved[name] for name in SIGNALS], axis=1) == pytest.approx(expected, abs=1e-12)


def test_tilt_at_rest_shows_gravity_in_the_level_axes(record):
    still = xr.zeros_like(record)
    moved = act("imu_tilt")(still, 0.0, 0.02, 0.0)
    assert moved.a_x.values == pytest.approx(-G * np.sin(0.02))


def test_clock_offset_shifts_samples_but_not_place(record):
    late = act("clock_offset")(record, 0.05)
    for name in SIGNALS:
        assert late[name].values[5:] == pytest.approx(record[name].values[:-5], abs=1e-9)
    xr.testing.assert_identical(late.s, record.s)
    xr.testing.assert_identical(late.v_x, record.v_x)


def test_clock_offset_between_samples_is_exact_to_the_spline(record):
    late = act("clock_offset")(record, 0.0034)
    expected = np.sin(2 * np.pi * 1.0 * (record.time.values - 0.0034))
    assert late.a_x.values[20:-20] == pytest.approx(expected[20:-20], abs=1e-5)


def test_clock_drift_is_an_offset_that_grows(record):
    late = act("clock_drift")(record, 1e-3)
    time = record.time.values * (1 - 1e-3)
    assert late.a_x.values == pytest.approx(np.sin(2 * np.pi * time), abs=1e-4)


def test_gyroscope_delay_shifts_rates_against_accelerations(record):
    late = act("gyroscope_delay")(record, 0.0034)
    inner = slice(20, -20)
    for k, name in enumerate(SIGNALS):
        shift = 0.0034 if name.endswith("rate") else 0.0
        expected = np.sin(2 * np.pi * (1.0 + 0.7 * k) * (record.time.values - shift) + k)
        assert late[name].values[inner] == pytest.approx(expected[inner], abs=1e-4)
    assert (late["s"] == record["s"]).all() and (late["roll"] == record["roll"]).all()


@pytest.mark.parametrize("constant", [0.001, 0.004, 0.02])
def test_bandwidth_is_a_first_order_low_pass_without_its_delay(record, constant):
    weak = act("sensor_bandwidth")(record, constant)
    turns = 2 * np.pi * 1.7
    response = np.exp(1j * turns * constant) / (1 + 1j * turns * constant)
    expected = abs(response) * np.sin(turns * record.time.values + 1 + np.angle(response))
    assert weak.a_y.values[100:-5] == pytest.approx(expected[100:-5], abs=2e-3)


def test_bandwidth_leaves_a_constant_alone(record):
    still = xr.ones_like(record)
    assert act("sensor_bandwidth")(still, 0.01).a_x.values == pytest.approx(1.0)


@pytest.mark.parametrize("frequency", [8.0, 20.0])
@pytest.mark.parametrize("name, signal", [("sensor_mount", "a_z"), ("sensor_sway", "a_y")])
def test_mount_shakes_the_instrument_as_a_base_shakes_an_oscillator(name, signal, frequency):
    """Against transmissibility, in closed form: of a participation of 1 that of a mass on spring and damper."""
    time, asked, share, ratio = np.arange(0.0, 12.0, 0.001), np.array([2.0, 7.0, 15.0, 30.0]), 0.4, 0.15
    turns, natural = 2 * np.pi * asked, 2 * np.pi * frequency
    transmitted = (natural**2 + 2j * ratio * natural * turns) / (natural**2 - turns**2 + 2j * ratio * natural * turns)
    level = {other: ("time", np.zeros(time.size)) for other in ("a_x", "a_y", "a_z", "roll", "pitch")}
    shaken = xr.Dataset(level | {signal: ("time", np.sin(np.outer(time, turns)).sum(axis=1))}, coords={"time": time})
    felt = act(name)(shaken, share, frequency, ratio)
    expected = (np.exp(1j * np.outer(time, turns)) @ (1.0 + share * (transmitted - 1.0))).imag
    assert felt[signal].values[8000:] == pytest.approx(expected[8000:], abs=0.02)


@pytest.mark.parametrize("name, signal", [("sensor_mount", "a_z"), ("sensor_sway", "a_y")])
def test_mount_leaves_a_constant_alone_and_other_signals(record, name, signal):
    still = xr.ones_like(record)
    xr.testing.assert_allclose(act(name)(still, 1.0, 12.0, 0.1), still)
    swung = act(name)(record, 0.5, 12.0, 0.1)
    xr.testing.assert_identical(swung.drop_vars(signal), record.drop_vars(signal))
    assert not np.allclose(swung[signal], record[signal])


@pytest.mark.parametrize("name, sizes", [("sensor_sway", (1.0, 12.0, 0.15)), ("sensor_bandwidth", (0.01,))])
def test_what_follows_weakly_follows_gravity_weakly_as_well(record, name, sizes):
    """A body that rolls to and fro at rest: all that the instrument feels aside is gravity."""
    rolling = xr.zeros_like(record)
    rolling["roll"] = 0.1 * np.sin(2 * np.pi * 8.0 * record.time)
    felt = rolling.copy()
    felt["a_y"] = G * rolling["roll"]
    shown = act(name)(rolling, *sizes).a_y + G * rolling["roll"]
    expected = act(name)(felt.assign(roll=0.0 * felt["roll"]), *sizes).a_y
    np.testing.assert_allclose(shown[200:-20], expected[200:-20], atol=0.002)


def test_gain_shows_gravity_too_large_as_well(record):
    still = xr.zeros_like(record)
    assert act("sensor_gain")(still, 0.02, 0.0).a_z.values == pytest.approx(0.02 * G)
    scaled = act("sensor_gain")(record, 0.0, 0.03)
    assert scaled.yaw_rate.values == pytest.approx(1.03 * record.yaw_rate.values)
    assert scaled.a_x.values == pytest.approx(record.a_x.values)


def test_speed_scale_stretches_distance_from_the_start(record):
    scaled = act("speed_scale")(record, 0.01)
    assert scaled.v_x.values == pytest.approx(15.15)
    assert scaled.s.values == pytest.approx(100 + 15.15 * record.time.values)


def test_offset_of_the_path_meets_other_heights_and_is_not_recorded(car):
    """The signals of a drive beside, the place of the drive that was asked for."""
    ground = road(120.0, height=lambda u, v: rough(u, v))
    there = drive(ground, car, effects={"path_offset": {"offset": 0.25}}, speed=15.0, lateral=0.1)
    beside = drive(ground, car, speed=15.0, lateral=0.35)
    for name in (*SIGNALS, "s", "v_x"):
        np.testing.assert_allclose(there[name], beside[name], atol=1e-9)
    np.testing.assert_allclose(there.e, beside.e - 0.25, atol=1e-9)
