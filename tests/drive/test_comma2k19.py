"""A real recording with clocks of different rates becomes a drive through ``record.from_arrays``."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d

from ridecomfort.drive import record
from ridecomfort.vocabulary import STANDARD_GRAVITY


@pytest.fixture(scope="module")
def log(shared):
    folder = shared / "data" / "comma2k19" / "processed_log"
    if not folder.is_dir():
        pytest.skip("the comma2k19 recording is not in ../shared")
    return lambda name: (np.load(folder / name / "t.npy"), np.load(folder / name / "value.npy"))


@pytest.fixture(scope="module")
def drive(log):
    """Accelerometer and gyroscope of a device with x forward, y right, z down; speed of four wheels in m/s."""
    clock, force = log("IMU/accelerometer")
    gyro_clock, rates = log("IMU/gyro")
    wheel_clock, wheels = log("CAN/wheel_speed")
    quantities = {
        "a_x": (clock, force[:, 0]),
        "a_y": (clock, -force[:, 1]),
        "a_z": (clock, -force[:, 2]),
        "roll_rate": (gyro_clock, rates[:, 0]),
        "pitch_rate": (gyro_clock, -rates[:, 1]),
        "yaw_rate": (gyro_clock, -rates[:, 2]),
        "v_x": (wheel_clock, wheels.mean(axis=1)),
    }
    return record.from_arrays(quantities, name="comma2k19")


def test_it_is_uniform_at_100_hz_and_says_what_was_done(drive):
    np.testing.assert_allclose(np.diff(drive["time"]), 0.01, atol=1e-9)
    assert drive.sizes["time"] > 5900
    assert "104.3 Hz" in drive.attrs["treatment"] and "s integrated from v_x" in drive.attrs["treatment"]


def test_gravity_is_on_its_z_axis(drive):
    force = np.sqrt(sum(float(drive[name].mean()) ** 2 for name in ("a_x", "a_y", "a_z")))
    assert force == pytest.approx(STANDARD_GRAVITY, rel=0.02)


def test_its_accelerometer_feels_what_its_wheels_do_and_the_grade(drive, shared):
    """Specific force along x is the change of speed plus g times the grade, here from satellite velocities."""
    folder = shared / "data" / "comma2k19" / "global_pose"
    position, velocity = np.load(folder / "frame_positions.npy"), np.load(folder / "frame_velocities.npy")
    up = position / np.array([6378137.0, 6378137.0, 6356752.3]) ** 2  # normal of the WGS 84 ellipsoid
    grade = np.sum(velocity * up, axis=1) / np.linalg.norm(up, axis=1) / np.linalg.norm(velocity, axis=1)
    time = drive["time"].values + drive.attrs["start_time"]
    felt = np.gradient(drive["v_x"].values, 0.01) + STANDARD_GRAVITY * np.interp(time, np.load(folder / "frame_times.npy"), grade)
    slow, recorded = uniform_filter1d(felt, 101)[100:-100], uniform_filter1d(drive["a_x"].values, 101)[100:-100]
    assert np.corrcoef(slow, recorded)[0, 1] > 0.98


def test_its_distance_agrees_with_its_satellite_positions(drive, shared):
    folder = shared / "data" / "comma2k19" / "global_pose"
    times, positions = np.load(folder / "frame_times.npy"), np.load(folder / "frame_positions.npy")
    time = drive["time"].values + drive.attrs["start_time"]
    inside = (times >= time[0]) & (times <= time[-1])
    way = np.linalg.norm(np.diff(positions[inside], axis=0), axis=1).sum()
    travelled = np.diff(np.interp(times[inside][[0, -1]], time, drive["s"].values))[0]
    assert travelled == pytest.approx(way, rel=0.02)
