"""Alignment finds the errors that were planted in a record, with a nominal vehicle that does not fit."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from ridecomfort.drive import align, mounting, place, record, replay
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars
from tests.blind import trials
from tests.quarter_cars import LATERAL, driven


@pytest.fixture(scope="module")
def truth(nominal):
    return quarter_cars.other(nominal)


def aligned(recorded, road, nominal):
    return align.align(recorded, road, nominal, simulate=quarter_cars.run)


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


@pytest.fixture(scope="module")
def lanes(truth):
    """A road of two lanes without a bend, and a drive in the middle of its left one."""
    road = quarter_cars.road(length=560.0, bend=0.0, width=8.0)
    u = road["u"].values
    speed = xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u")
    run = quarter_cars.run(road, truth, speed=speed, lateral=1.8, end=550.0)
    run = run.isel(time=(run["s"] > 60).values)
    return road, run.assign_coords(time=run["time"] - run["time"][0])


def test_the_path_is_found_in_either_lane_of_a_road_with_two(lanes, nominal):
    road, drive = lanes
    found = aligned(quarter_cars.recorded(drive, clock=0.0307, noise=1.0), road, nominal)
    assert found.attrs["lateral_position"] == pytest.approx(1.8, abs=0.02)
    assert found.attrs["clock_offset"] == pytest.approx(0.0307, abs=1e-3)


@pytest.mark.parametrize("clock", [0.7, -2.0])
@pytest.mark.parametrize("told", [{}, {"lateral_position": 1.8}], ids=["unknown path", "known path"])
def test_a_clock_beyond_the_search_is_refused_with_what_it_is(lanes, nominal, clock, told):
    road, drive = lanes
    with pytest.raises(InputError, match=r"drive own: the inertial signals lag (\S+) s behind s \(expected within 0.5 s") as refused:
        aligned(quarter_cars.recorded(drive, clock=clock, noise=1.0, name="own", **told), road, nominal)
    assert float(str(refused.value).split(" lag ")[1].split()[0]) == pytest.approx(clock, abs=0.02)
    assert "\n" not in str(refused.value) and "alignment: search" in str(refused.value)


def test_a_clock_that_a_wider_search_was_asked_for_is_found(lanes, nominal):
    road, drive = lanes
    recorded = quarter_cars.recorded(drive, clock=0.7, noise=1.0)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run, search=1.0)
    assert found.attrs["clock_offset"] == pytest.approx(0.7, abs=1e-3)


def test_a_path_farther_from_what_is_told_than_is_searched_is_refused(lanes, nominal):
    road, drive = lanes
    words = r"drive own: its path fits the road best \+1.80 m to the left of what is recorded or told.*lateral_position"
    with pytest.raises(InputError, match=words):
        aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=0.0, name="own"), road, nominal)


@pytest.mark.parametrize("told", [-15.0, -3.2, 3.0, 3.2, 15.0])
@pytest.mark.parametrize("is_recorded", [False, True])
def test_a_path_that_lies_off_the_road_is_refused_however_far(drive, road, nominal, told, is_recorded):
    """Half the vehicle keeps on this road from 1.1 m to the right to 1.1 m to the left of its middle."""
    recorded = quarter_cars.recorded(drive, name="own", lateral_position=np.nan if is_recorded else told)
    if is_recorded:
        recorded["e"] = recorded["e"].copy(data=np.where(recorded["time"] < 5.0, 0.0, told))
    with pytest.raises(InputError, match=rf"^drive own: its path, as recorded or told, lies .*[+-]{abs(told):.2f} .*m to the left .*expected -1.10 to \+1.10 m"):
        aligned(recorded, road, nominal)


@pytest.mark.parametrize("scale", [1.0, np.pi / 180.0])
def test_a_drive_that_is_refused_names_signals_in_another_unit(lanes, nominal, scale):
    """A roll rate in rad/s, told as deg/s, shows of its road as little as one on a wrong path."""
    road, drive = lanes
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=0.0, name="own")
    recorded["roll_rate"] = recorded["roll_rate"] * scale
    with pytest.raises(InputError, match="drive own: ") as refused:
        aligned(recorded, road, nominal)
    named = [part.split()[0] for part in str(refused.value).split("; ")[1:] if part.endswith("is its unit right?")]
    assert named == (["roll_rate"] if scale < 1.0 else [])


def test_a_path_at_the_edge_of_the_grid_is_refused(lanes, nominal):
    """A grid on which the path may lie up to 1.7 m to the left."""
    road, drive = lanes
    narrow = road.sel(v=slice(-2.65, 2.65))
    with pytest.raises(InputError, match=r"drive own: its path fits the road best .* at an end of what is searched or beyond"):
        aligned(quarter_cars.recorded(drive, noise=1.0, name="own"), narrow, nominal)


def test_a_drive_on_another_road_is_refused(drive, nominal):
    with pytest.raises(InputError, match=r"drive own: model and record agree nowhere .* \(expected 0.3 or more.*lateral_position"):
        aligned(quarter_cars.recorded(drive, noise=1.0, name="own"), quarter_cars.road(length=560.0, seed=8), nominal)


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


def test_a_place_that_no_round_settles_is_told(road, truth, nominal, monkeypatch):
    recorded = quarter_cars.recorded(driven(road, truth, along=0.5), noise=1.0, lateral_position=LATERAL)
    monkeypatch.setattr(align, "MOST", align.PASSES)
    (said,) = aligned(recorded, road, nominal).attrs["faults"].split("; ")
    assert said.startswith("alignment does not settle: its last round moved the place by 0.") and "is s good to 0.5 m" in said


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


@pytest.mark.parametrize(("longer", "said"), [(1.0, ""), (1.01, "s: runs 1.0 % too far over the road"), (0.985, "s: runs 1.5 % too short over the road")])
def test_an_odometer_that_is_told_for_a_place_on_the_road_is_called_one(drive, road, nominal, longer, said):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive.assign(s=start + longer * (drive["s"] - start)), noise=1.0, lateral_position=LATERAL)
    found = aligned(recorded.assign_attrs(faults="a_z: it clips"), road, nominal)
    before, *after = found.attrs["faults"].split("; ")
    assert before == "a_z: it clips" and len(after) == bool(said)
    for words in after:
        told = float(words.split()[2])
        assert words.startswith(f"s: runs {told} % too {said.split()[5]} over the road") and told == pytest.approx(float(said.split()[2]), abs=0.15)


def test_an_odometer_that_is_refused_for_its_clock_or_place_is_called_one_before(drive, road, nominal):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive.assign(s=start + 0.97 * (drive["s"] - start)), noise=1.0, lateral_position=LATERAL, name="own")
    words = rf"^drive own: s: runs [23].\d % too short over the road.* distance_start: {start:.0f}: .*; if not, (?!drive own)"
    with pytest.raises(InputError, match=words) as refused:
        aligned(recorded, road, nominal)
    assert "\n" not in str(refused.value)


def test_rates_of_the_wrong_sign_are_no_odometer(drive, road, nominal):
    """The distance is exact: scaled, it would agree with the road still less."""
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL)
    found = aligned(recorded.assign({name: -recorded[name] for name in ("roll_rate", "pitch_rate")}), road, nominal)
    assert "odometer" not in found.attrs["faults"]
    np.testing.assert_allclose(found["s"], drive["s"].values[: found.sizes["time"]], atol=0.1)


def odometer(drive, speed=True, late=0):
    """A drive whose distance runs 1.2 % too far, with or without a speed beside it, and comes so many samples late."""
    start, time = float(drive["s"][0]), drive["time"].values
    recorded = quarter_cars.recorded(drive, noise=1.0)
    told = {name: (time, recorded[name].values) for name in (*SIGNALS, "v_x")[: len(SIGNALS) + speed]}
    return record.from_arrays(told | {"s": (time[late:], start + 1.012 * (drive["s"].values[late:] - start))}, lateral_position=LATERAL)


def test_an_odometer_without_a_speed_beside_it_is_not_to_be_left_out_but_to_tell_the_speed(drive, road, nominal):
    said = aligned(odometer(drive, speed=False), road, nominal).attrs["faults"]
    assert "as that of an odometer (give its slope as v_x in its place, with distance_start: 60: " in said


def test_where_to_begin_without_s_is_where_the_record_begins_not_its_distance(drive, road, nominal):
    said = aligned(odometer(drive, late=300), road, nominal).attrs["faults"]
    told = float(said.split("distance_start: ")[1].split(":")[0])
    assert "(leave s out, with distance_start" in said and told == pytest.approx(float(drive["s"][0]), abs=2.5)  # 60 m more after 3 s


def turned(drive, degrees):
    """A record of a drive by an instrument that is turned about the vertical."""
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL, name="own")
    back = Rotation.from_rotvec([0.0, 0.0, np.radians(degrees)]).inv().as_matrix()
    rows = [back @ np.stack([recorded[name].values for name in part]) for part in (SIGNALS[:3], SIGNALS[3:])]
    return recorded.assign({name: ("time", row) for name, row in zip(SIGNALS, np.concatenate(rows))})


def test_an_instrument_that_is_turned_by_more_than_three_rounds_take_out_is_turned_back(drive, road, nominal):
    found = aligned(turned(drive, 40.0), road, nominal)
    assert np.degrees(found.attrs["mounting_yaw"]) == pytest.approx(40.0, abs=0.3)
    (said,) = found.attrs["faults"].split("; ")
    assert said.startswith("the instrument is turned by +40 deg in yaw")


def test_an_instrument_that_no_round_turns_back_is_told(drive, road, nominal, monkeypatch):
    monkeypatch.setattr(align, "MOST", align.PASSES)
    said = aligned(turned(drive, 40.0), road, nominal).attrs["faults"].split("; ")[0]
    assert re.fullmatch(r"alignment does not settle: its last round turned the instrument by 1\d\.\d deg: are the axes .* right\?", said)


@pytest.mark.parametrize(
    ("degrees", "columns"), [(90, "a_x = -a_y, a_y = a_x, "), (-90, "a_x = a_y, a_y = -a_x, "), (180, "a_x = -a_x, a_y = -a_y, ")]
)
def test_axes_that_are_exchanged_are_told_with_what_to_change(drive, road, nominal, degrees, columns):
    (said,) = aligned(turned(drive, degrees), road, nominal).attrs["faults"].split("; ")
    assert said.startswith(f"the instrument looks turned by {degrees:+d} deg in yaw") and columns in said


@pytest.mark.parametrize(("angles", "said"), [((0, 0, 0), ""), ((0, 0, 25), "yaw"), ((0, 0, 40), "yaw"), ((0, 20, 0), "pitch"), ((20, 0, 0), "roll")])
@pytest.mark.parametrize("seed", [1, 2])
def test_an_instrument_that_is_turned_is_told_where_gravity_turns_none_back(truth, nominal, seed, angles, said):
    road = quarter_cars.road(length=560.0, seed=seed)
    drive, rng = driven(road, truth), np.random.default_rng(seed)
    back = Rotation.from_euler("xyz", angles, degrees=True).inv().as_matrix()
    rows = [back @ np.stack([drive[name].values for name in part]) for part in (SIGNALS[:3], SIGNALS[3:])]
    noise = np.array([0.02] * 3 + [0.001] * 3)[:, None] * rng.standard_normal((6, drive.sizes["time"]))
    given = dict(zip(SIGNALS, np.concatenate(rows) + noise)) | {name: drive[name].values for name in ("s", "v_x")}
    quantities = {name: (drive["time"].values, values) for name, values in given.items()}
    faults = aligned(record.from_arrays(quantities, gravity=False, lateral_position=LATERAL), road, nominal).attrs["faults"]
    assert faults.startswith(f"the instrument looks turned in {said} by 8 deg or more") if said else faults == ""


def test_axes_that_are_exchanged_are_told_where_a_drive_is_refused(truth, nominal):
    road = quarter_cars.road(length=560.0, seed=3)
    with pytest.raises(InputError, match=r"agree nowhere .*; the instrument looks turned by \+180 deg in yaw: .*, pitch_rate = -pitch_rate\)$"):
        aligned(turned(driven(road, truth), 180.0), road, nominal)


def test_a_drive_without_a_place_that_begins_elsewhere_is_asked_where_it_begins(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, place=False, noise=1.0, lateral_position=LATERAL)
    with pytest.raises(InputError, match=r"agree nowhere .* are the axes right, and distance_start \(0 m unless given\) to 15 m\?"):
        aligned(recorded, road, nominal)


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


@pytest.fixture(scope="module")
def whole(road, truth):
    """A drive over the whole of the road."""
    u = road["u"].values
    return quarter_cars.run(road, truth, speed=xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u"), lateral=LATERAL)


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


def test_a_drive_that_goes_on_behind_the_road_is_refused_by_its_way(whole, road, nominal):
    recorded = quarter_cars.recorded(whole, place=False, lateral_position=LATERAL)
    with pytest.raises(InputError, match=r"its centre of gravity runs from s = -?0.0 to 5\d\d.\d m by v_x \(expected within the road, 0.0 to 450.0 m\)"):
        aligned(recorded, road.sel(u=slice(0, 450)), nominal)


def test_a_search_of_less_than_half_a_sample_finds_a_clock_that_is_right(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, lateral_position=LATERAL)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run, search=0.004)
    assert found.attrs["clock_offset"] == pytest.approx(0.0, abs=1e-3)


def test_a_drive_against_the_reference_line_is_called_that(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, name="back")
    with pytest.raises(InputError, match="^drive back: s falls from .* driven against the reference line"):
        aligned(recorded.assign(s=600 - recorded["s"]), road, nominal)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.assign(v_x=d["v_x"].where(d["time"] < 10, 0.2)), r"by v_x at (9|10).* \(expected above 1 m/s"),
        (lambda d: d.assign(s=d["s"].where(d["time"] < 10, d["s"].values[1000])), r"by s, \d+\.\d+ m/s by v_x at 1[01].* \(expected above 1 m/s"),
        (lambda d: d.assign(s=d["s"] + 300), "within the road"),
        (lambda d: d.assign(s=600 - d["s"]), "s falls from 5.* to .* m: driven against the reference line, which is not supported"),
    ],
)
def test_a_drive_that_cannot_be_driven_again_is_refused(drive, road, change, words):
    recorded = quarter_cars.recorded(drive, name="morning")
    with pytest.raises(InputError, match=words) as problem:
        replay.replay(change(recorded), road, quarter_cars.run)
    assert "drive morning" in str(problem.value)


@pytest.mark.parametrize(
    ("last", "turned", "asked"),
    [
        ((0.05, 0.0), 0.0, "is s good to 0.5 m (if not, leave s out, with distance_start: it is then integrated from v_x)?"),
        ((0.0, 0.05), 0.0, "was it driven parallel to the reference line (if not, record e)?"),
        ((0.0, 0.0), 0.02, "are the axes of accelerations and rates right?"),
    ],
)
def test_what_does_not_settle_is_asked_for(drive, last, turned, asked):
    recorded = quarter_cars.recorded(drive)
    assert align._unsettled(recorded, last, turned).endswith(f": {asked}")


def test_a_recorded_path_that_does_not_settle_is_asked_for_its_unit(drive):
    said = align._unsettled(quarter_cars.recorded(drive).assign(e=("time", drive["e"].values)), (0.0, 0.05), 0.0)
    assert said.endswith("0.05 m across the road: is e right, its unit, too?")


@pytest.mark.parametrize("scale", [0.001, 0.5, 1.2])
def test_a_distance_in_another_unit_than_the_speed_is_told_as_that(drive, road, nominal, scale):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL, name="own")
    with pytest.raises(InputError, match=r"^v_x: recorded speed times \S+ fits the road .* are the units of v_x and s right") as refused:
        aligned(recorded.assign(s=start + scale * (recorded["s"] - start)), road, nominal)
    assert float(str(refused.value).split("times ")[1].split()[0]) == pytest.approx(scale, rel=0.01)


def test_a_drive_without_a_place_that_is_too_short_to_find_it_is_refused(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, place=False, distance_start=float(drive["s"][0]), noise=1.0, lateral_position=LATERAL, name="own")
    with pytest.raises(InputError, match=r"^drive own: lasts 11\.5 s \(expected at least 12 s where s is left out"):
        aligned(recorded.isel(time=slice(0, 1151)), road, nominal)
    long_enough = aligned(recorded.isel(time=slice(0, 1251)), road, nominal)
    np.testing.assert_allclose(long_enough["s"], drive["s"].values[: long_enough.sizes["time"]], atol=0.1)
