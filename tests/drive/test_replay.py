"""A record driven again by the vehicle that made it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.drive.replay import fused_place, replay
from ridecomfort.drive.sensor import TOLD_OF
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import DRIVE, SIGNALS
from tests.blind import trials

RATE = 100.0


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def driven(car):
    """A bent, rough road and a drive on it that wanders in speed and path, recorded without noise."""
    rng = np.random.default_rng(5)
    road = trials.a_road(rng)
    course = simulate.prepare(road)
    record = simulate.run(course, car, sensor=trials.SENSOR, **trials._demand(rng, road.u.values, 22.0))
    x, y, z = trials.SENSOR
    record = record[list(DRIVE)].isel(time=slice(200, None)).assign_attrs(
        name="drive", role="fit", gravity=0, cut_off=50.0, place_measured=1, lateral_position=0.0,
        sensor_x=x, sensor_y=y, sensor_z=z,
    )  # fmt: skip
    return course, record


@pytest.mark.parametrize(("treatment", "told"), [("none", "0.20 m/s by v_x at 0.00 s"), ("v_x differentiated from s", "0.20 m/s by s at 0.00 s")])
def test_a_drive_that_stands_is_refused_by_what_was_recorded_of_its_speed(driven, treatment, told):
    course, record = driven
    standing = record.assign(v_x=0.0 * record["v_x"] + 0.2).assign_attrs(treatment=treatment, start_time=-1e-9 - float(record["time"][0]))
    with pytest.raises(InputError, match=f"^drive drive: {told} \\(expected above 1 m/s"):
        replay(standing, course, simulate.run)


def test_the_same_vehicle_repeats_its_own_record(driven, car):
    course, record = driven
    again = replay(record, course, simulate.run).tuned(car)
    residual, measured = again.residual(again(car)), again.measured()
    share = {
        name: np.sqrt(np.mean(_band(part[again.compared]) ** 2) / np.mean(_band(whole[again.compared]) ** 2))
        for name, part, whole in zip(SIGNALS, residual, measured)
    }
    assert share["a_z"] < 0.005 and share["roll_rate"] < 0.01 and share["pitch_rate"] < 0.01


@pytest.mark.parametrize(("back", "higher"), [(0.12, 0.0), (0.0, 0.1), (-0.1, -0.05)])
def test_a_centre_of_gravity_that_lies_elsewhere_than_the_drive_is_told_of_moves_neither_sensor_nor_axles(driven, car, back, higher):
    """What is calibrated is where the centre of gravity lies, not where the instrument sits or the wheels are."""
    course, told = driven
    told_of = {name: car[name] for name in TOLD_OF}
    other = car.replace(cg_to_front_axle=car["cg_to_front_axle"] + back, cg_height=car["cg_height"] + higher)
    x, y, z = trials.SENSOR
    demand = trials._demand(np.random.default_rng(5), course.u, 22.0)
    truth = simulate.run(course, other, sensor=(x + back, y, z - higher), **demand)
    record = truth[list(DRIVE)].isel(time=slice(200, None)).assign_attrs(told.attrs)
    record = record.assign(s=record["s"] + back).assign_attrs(told_of)
    again = replay(record, course, simulate.run).tuned(other)
    left = again.residual(again(other))[:, again.compared]
    share = dict(zip(SIGNALS, left.std(axis=1) / again.measured()[:, again.compared].std(axis=1)))
    assert max(share[name] for name in ("a_x", "a_z", "roll_rate", "pitch_rate")) < 0.02


def test_a_drive_is_compared_as_far_as_its_front_axle_may_come(driven):
    """2 m of road stay free beyond it, 4 m beyond the centre of gravity at least."""
    course, record = driven
    longer = record.assign(s=record["s"] + float(course.u[-1] - record["s"][-1]))
    ends = [replay(longer.assign_attrs(cg_to_front_axle=front), course, simulate.run) for front in (1.4, 3.5)]
    assert [course.u[-1] - again.place[again.compared][-1] for again in ends] == pytest.approx([4.0, 5.5], abs=0.3)


def test_a_drive_that_begins_as_slowly_as_may_be_is_not_asked_to_be_slower_before(driven):
    course, record = driven
    time = record["time"].values
    speed = 1.05 + 0.6 * np.maximum(time - 1.0, 0.0)
    place = float(course.u[0]) + 60.0 + np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time))])
    slow = record.assign(v_x=record["v_x"].copy(data=speed), s=record["s"].copy(data=place)).isel(time=slice(0, 2000))
    assert float(replay(slow, course, simulate.run).demand["speed"].min()) >= 1.0


def test_it_drives_the_recorded_path_at_the_recorded_speed(driven, car):
    course, record = driven
    again = replay(record, course, simulate.run).tuned(car)
    run = again.run(car)
    for name, largest in (("e", 0.002), ("v_x", 0.001)):
        difference = np.interp(again.place, run["s"], run[name]) - record[name].values
        assert np.sqrt(np.mean(difference[again.compared] ** 2)) < largest


def test_place_is_fused_from_speed_and_place_in_bends_as_well(driven):
    course, record = driven
    noisy = record.assign(s=record["s"] + xr.DataArray(np.random.default_rng(1).normal(0, 0.03, record.sizes["time"]), dims="time"))
    error = fused_place(noisy, RATE, course.road) - record["s"].values
    assert error.std() < 0.006
    assert (fused_place(record, RATE, course.road) - record["s"].values).std() < 0.0005


def _band(values, lower=0.8, upper=20.0):
    bins = np.fft.rfft(values - values.mean())
    frequency = np.fft.rfftfreq(values.size, 1 / RATE)
    return np.fft.irfft(np.where((frequency > lower) & (frequency < upper), bins, 0.0), values.size)
