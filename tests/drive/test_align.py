"""Alignment finds the errors that were planted in a record, with a nominal vehicle that does not fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from ridecomfort.drive import align, mounting, place, record, replay
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars
from tests.blind import trials
from tests.quarter_cars import LATERAL, aligned, driven, turned


@pytest.mark.parametrize("clock", [0.1234, -0.0317])
def test_clock_is_found_to_better_than_a_millisecond(drive, road, nominal, clock):
    found = aligned(quarter_cars.recorded(drive, clock=clock, noise=1.0, lateral_position=LATERAL), road, nominal)
    assert found.attrs["clock_offset"] == pytest.approx(clock, abs=0.5e-3)


def test_a_distance_that_is_held_until_the_next_is_known_delays_no_clock(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL)
    time = drive["time"].values
    held = np.interp(np.floor(time / 0.1 + 1e-6) * 0.1, time, drive["s"].values)
    quantities = {name: (time, recorded[name].values) for name in (*SIGNALS, "v_x")}
    found = aligned(record.from_arrays(quantities | {"s": (time, held)}, lateral_position=LATERAL), road, nominal)
    assert found.attrs["clock_offset"] == pytest.approx(0.0, abs=2e-3)


def test_all_errors_at_once_are_found(drive, road, nominal):
    recorded = quarter_cars.recorded(
        drive,
        clock=0.0307,
        gain=1.01,
        rotation=(0.02, -0.03, 0.01),
        bias=(0.003, -0.002, 0.004),
        speed_scale=1.007,
        noise=1.0,
        lateral_position=LATERAL - 0.2,
    )
    found = aligned(recorded, road, nominal)
    assert found.attrs["clock_offset"] == pytest.approx(0.0307, abs=1e-3)
    assert found.attrs["speed_scale"] == pytest.approx(1.007, abs=1e-3)
    assert found.attrs["lateral_position"] == pytest.approx(LATERAL, abs=0.02)
    assert found.attrs["acceleration_gain"] == pytest.approx(1.01, abs=2e-3)
    for axis, rotation, bias in zip(("roll", "pitch", "yaw"), (0.02, -0.03, 0.01), (0.003, -0.002, 0.004)):
        assert found.attrs[f"mounting_{axis}"] == pytest.approx(rotation, abs=2e-3)
        assert found.attrs[f"{axis}_rate_bias"] == pytest.approx(bias, abs=3e-4)
    clean = aligned(quarter_cars.recorded(drive, lateral_position=LATERAL), road, nominal)
    count = min(found.sizes["time"], clean.sizes["time"])
    shift = int(round((found.attrs["start_time"] - 0.0307) * 100))  # the record begins when its last clock does
    for name, tolerance in (("a_z", 0.05), ("a_y", 0.05), ("pitch_rate", 2e-3)):
        one, other = found[name].values[: count - 5], clean[name].values[shift : shift + count - 5]
        assert np.sqrt(np.mean((one - other) ** 2)) < tolerance


def test_the_path_is_found_where_none_is_recorded(drive, road, nominal):
    found = aligned(quarter_cars.recorded(drive, noise=1.0), road, nominal)
    assert found.attrs["lateral_position"] == pytest.approx(LATERAL, abs=0.02)


def test_a_path_that_was_recorded_far_from_where_it_was_is_found(drive, road, nominal):
    found = aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL - 0.7), road, nominal)
    assert found.attrs["lateral_position"] == pytest.approx(LATERAL, abs=0.02)


def test_the_path_is_found_in_either_lane_of_a_road_with_two(lanes, nominal):
    road, drive = lanes
    found = aligned(quarter_cars.recorded(drive, clock=0.0307, noise=1.0), road, nominal)
    assert found.attrs["lateral_position"] == pytest.approx(1.8, abs=0.02)
    assert found.attrs["clock_offset"] == pytest.approx(0.0307, abs=1e-3)


def test_a_clock_that_a_wider_search_was_asked_for_is_found(lanes, nominal):
    road, drive = lanes
    recorded = quarter_cars.recorded(drive, clock=0.7, noise=1.0)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run, search=1.0)
    assert found.attrs["clock_offset"] == pytest.approx(0.7, abs=1e-3)


def test_a_road_that_is_even_across_does_not_tell_the_path(road, truth, nominal):
    even = road.assign(elevation=road["elevation"].isel(v=[20] * road.sizes["v"]).assign_coords(v=road["v"]))
    found = aligned(quarter_cars.recorded(driven(even, truth), clock=0.0307, noise=1.0), even, nominal)
    assert found.attrs["clock_offset"] == pytest.approx(0.0307, abs=1e-3)
    assert abs(found.attrs["lateral_correction"]) < 0.3


def test_rounding_of_a_signal_that_the_model_does_not_move_agrees_with_nothing(drive, road, nominal):
    """A roll rate of 1e-9 rad/s for some 1e-2 that was recorded: however its digits lie, they are no reason for a path or a clock."""
    again = replay.replay(mounting.level(quarter_cars.recorded(drive, lateral_position=LATERAL)), road, quarter_cars.run)
    simulated = again(nominal)
    roll = SIGNALS.index("roll_rate")
    still, rounded = simulated.signals.copy(), simulated.signals.copy()
    still[roll] = 0.0
    rounded[roll] = 1e-9 * np.random.default_rng(1).standard_normal(still.shape[1])
    agreement = [place.shaken(again, replace(simulated, signals=signals), 1.0)[1] for signals in (still, rounded)]
    np.testing.assert_array_equal(*agreement)


def test_a_wandering_path_and_place_are_followed(road, truth, nominal):
    drive = driven(road, truth, aside=0.08, along=0.05)
    found = aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL), road, nominal)
    place = found["s"].values
    inside = slice(150, -100)
    assert np.sqrt(np.mean((found["e"].values - drive["e"].values)[inside] ** 2)) < 0.02
    true_place = drive["s"].values - 0.05 * np.sin(2 * np.pi * drive["s"].values / 300)
    before, after = (np.std((row - true_place)[inside]) for row in (drive["s"].values, place))
    assert after < 0.5 * before


def test_a_place_that_wanders_by_more_than_three_rounds_take_out_is_found_all_the_same(road, truth, nominal):
    drive = driven(road, truth, along=0.5)
    found = aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL), road, nominal)
    true_place = drive["s"].values - 0.5 * np.sin(2 * np.pi * drive["s"].values / 300)  # to 3 mm
    assert np.std((found["s"].values - true_place)[150:-100]) < 0.03
    assert found.attrs["faults"] == ""


def test_a_path_that_was_recorded_wrongly_is_found_however_briskly_it_was_driven(repository):
    """What a driver makes who is followed too slowly hid half of an error of 2 cm."""
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    trial = trials.make(1, car, {}, foot=0.3, speed_noise=0.014, path_error=0.02, aligned=True)
    ((_, drives),) = trial.measured.values()
    assert all(drive.attrs["lateral_wander"] > 0.015 for drive in drives)


def test_nothing_is_found_where_nothing_is_wrong(road, nominal):
    drive = driven(road, nominal)
    found = aligned(quarter_cars.recorded(drive, lateral_position=LATERAL), road, nominal)
    for name, tolerance in (("clock_offset", 1e-4), ("lateral_correction", 0.02), ("lateral_wander", 0.01)):
        assert abs(found.attrs[name]) < tolerance, name
    assert found.attrs["speed_scale"] == pytest.approx(1.0, abs=5e-4)
    np.testing.assert_allclose(found["a_z"], drive["a_z"].values[: found.sizes["time"]], atol=0.01)


def test_an_odometer_without_a_fix_is_scaled_and_placed_by_the_road(drive, road, nominal):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(
        drive, place=False, speed_scale=1.013, distance_start=start + 6.0, noise=1.0, lateral_position=LATERAL
    )
    found = aligned(recorded, road, nominal)
    assert found.attrs["speed_scale"] == pytest.approx(1.013, abs=5e-4)
    np.testing.assert_allclose(found["s"], drive["s"], atol=0.06)


def test_an_instrument_that_is_turned_by_more_than_three_rounds_take_out_is_turned_back(drive, road, nominal):
    found = aligned(turned(drive, 40.0), road, nominal)
    assert np.degrees(found.attrs["mounting_yaw"]) == pytest.approx(40.0, abs=0.3)
    (said,) = found.attrs["faults"].split("; ")
    assert said.startswith("the instrument is turned by +40 deg in yaw")


def test_accelerations_that_hold_no_gravity_keep_what_they_are(drive, road, nominal):
    time = drive["time"].values
    given = {name: (time, drive[name].values) for name in (*record.SIGNALS, "s", "v_x")}
    found = aligned(record.from_arrays(given, gravity=False, lateral_position=LATERAL), road, nominal)
    np.testing.assert_array_equal(found["a_z"], drive["a_z"])
    assert not found["roll"].any() and found.attrs["acceleration_gain"] == 1.0


def test_the_residual_compares_specific_force_with_specific_force(road, nominal):
    """Gravity taken out with a wrong attitude changes nothing: the attitude of the simulation replaces it."""
    drive = driven(road, nominal)
    recorded = quarter_cars.recorded(drive, lateral_position=LATERAL)
    level = mounting.level(recorded)
    again = replay.replay(level, road, quarter_cars.run)
    residual = again.residual(again(nominal))[:, again.compared]
    assert np.abs(level["a_x"].values).mean() > 0.1  # g times the slope of the road
    assert np.sqrt(np.mean(residual[:3] ** 2, axis=1)).max() < 0.02


def test_what_lies_where_no_place_was_recorded_is_not_kept(truth, nominal):
    """Inertial signals that come 6 s late: before that, place and speed would be the continuation of a drive that speeds up."""
    road, late = quarter_cars.road(length=900.0), 6.0
    u = road["u"].values
    speed = xr.DataArray(np.sqrt(np.clip(8.0**2 + 1.6 * np.clip(u - 50, 0, None), 0, 24.0**2)), {"u": u}, "u")
    run = quarter_cars.run(road, truth, speed=speed, start=60.0, end=820.0)
    time, behind = run["time"].values - float(run["time"][0]), round(late * 100)
    given = {name: (time[behind:] - late, run[name].values[behind:]) for name in ("s", "v_x")}
    given |= {name: (time[behind:] - late, run[name].values[:-behind]) for name in SIGNALS}
    recorded = record.from_arrays(given, gravity=False, lateral_position=0.0)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run, search=10.0)
    assert found.attrs["clock_offset"] == pytest.approx(late, abs=2e-3)
    assert found.attrs["start_time"] == pytest.approx(late - place.END, abs=0.02) and float(found["time"][0]) == 0.0
    true = np.interp(found.attrs["start_time"] + found["time"].values, time, run["s"].values)
    assert np.abs(found["s"].values - true).max() < 0.3


@pytest.mark.parametrize("clock", [0.0307, -0.0307, 0.3, -0.3])
def test_what_only_the_clock_moves_off_the_road_is_cut(whole, road, nominal, clock):
    found = aligned(quarter_cars.recorded(whole, clock=clock, noise=1.0, lateral_position=LATERAL), road, nominal)
    assert found.attrs["clock_offset"] == pytest.approx(clock, abs=1e-3)
    assert found["s"].values[0] > -0.1 and found["s"].values[-1] < 560.1 and np.ptp(found["s"].values) > 559.0 - 25.0 * abs(clock)
    time = found["time"].values + found.attrs["start_time"] - clock
    np.testing.assert_allclose(found["s"], np.interp(time, whole["time"], whole["s"]), atol=0.2)


def test_what_only_the_place_of_the_axle_that_it_was_told_of_moves_off_the_road_is_cut(whole, road, nominal):
    recorded = quarter_cars.recorded(whole, noise=1.0, lateral_position=LATERAL)
    recorded = recorded.isel(time=slice(0, -20)).assign_attrs(cg_to_front_axle=1.4)
    found = aligned(recorded.assign(s=recorded["s"] - 1.4), road, nominal)
    assert found["s"].values[0] == pytest.approx(1.4, abs=0.3)
    assert found.attrs["clock_offset"] == pytest.approx(-1.4 / 20.0, abs=5e-3)  # the distance of the body was told for that of the axle
    with pytest.raises(InputError, match=r"its centre of gravity runs from s = -3.0 to .* within the road"):
        aligned(recorded.assign(s=recorded["s"] - 3.0), road, nominal)


@pytest.mark.parametrize("scale", [0.97, 1.03])
def test_a_drive_over_the_whole_road_lies_on_it_though_its_speed_is_off(whole, road, nominal, scale):
    recorded = quarter_cars.recorded(whole, place=False, speed_scale=scale, noise=1.0, lateral_position=LATERAL)
    found = aligned(recorded, road, nominal)
    assert found.attrs["speed_scale"] == pytest.approx(scale, abs=1e-3)
    assert found["s"].values[-1] == pytest.approx(560.0, abs=0.5)


def test_a_search_of_less_than_half_a_sample_finds_a_clock_that_is_right(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, lateral_position=LATERAL)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run, search=0.004)
    assert found.attrs["clock_offset"] == pytest.approx(0.0, abs=1e-3)
