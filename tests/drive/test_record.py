"""What a drive is: gravity, sensor positions, and what is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr
from scipy.signal import welch

from ridecomfort.drive import record, sampling
from ridecomfort.errors import InputError
from ridecomfort.vocabulary import DRIVE, SIGNALS, STANDARD_GRAVITY
from tests.drive.smooth import TIME, alone, quantities, standing


def test_what_samples_show_of_a_fault_before_they_are_filtered_stays_with_the_drive():
    rng = np.random.default_rng(0)
    clock = np.arange(0, 20, 0.005)
    shaken = {name: (clock, rng.standard_normal(clock.size) + STANDARD_GRAVITY * (name == "a_z")) for name in SIGNALS}
    sound = record.from_arrays(quantities(**shaken))
    assert sound.attrs["faults"] == "" and "low-pass" in sound.attrs["treatment"]
    shaken["a_z"] = clock, np.minimum(shaken["a_z"][1], 11.0)
    limited = record.from_arrays(quantities(**shaken))
    assert limited.attrs["faults"].startswith("a_z: ") and "the largest value, 11 m/s2" in limited.attrs["faults"]
    (back,) = record.unstack(record.stack([limited]))
    assert back.attrs["faults"] == limited.attrs["faults"]


def test_level_vehicle_at_rest_reads_one_g_upwards():
    np.testing.assert_allclose(record.specific_force(np.zeros(3), 0.0, 0.0), [0, 0, STANDARD_GRAVITY])


@pytest.mark.parametrize("degrees", [-20, 5, 60])
def test_at_rest_on_a_slope_gravity_splits_into_sine_and_cosine(degrees):
    angle = np.radians(degrees)
    nose_down = record.specific_force(np.zeros(3), 0.0, angle)
    np.testing.assert_allclose(nose_down, STANDARD_GRAVITY * np.array([-np.sin(angle), 0, np.cos(angle)]), atol=1e-12)
    left_up = record.specific_force(np.zeros(3), angle, 0.0)
    np.testing.assert_allclose(left_up, STANDARD_GRAVITY * np.array([0, np.sin(angle), np.cos(angle)]), atol=1e-12)


def test_gravity_is_that_of_the_rotation_matrix_for_any_attitude():
    roll, pitch, yaw = 0.3, -0.2, 1.1
    x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    y = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    z = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    body_from_earth = (z @ y @ x).T
    np.testing.assert_allclose(record.upward(roll, pitch), body_from_earth @ [0, 0, 1], atol=1e-12)


def test_a_coordinated_turn_feels_no_sideways_force():
    lateral = 3.0
    lean = -np.arctan(lateral / STANDARD_GRAVITY)  # into a turn to the left: the left side down
    body = np.array([0, lateral * np.cos(lean), -lateral * np.sin(lean)])
    force = record.specific_force(body, lean, 0.0)
    assert force[1] == pytest.approx(0.0, abs=1e-12)
    assert force[2] == pytest.approx(np.hypot(lateral, STANDARD_GRAVITY))


def test_removing_gravity_undoes_adding_it():
    rng = np.random.default_rng(0)
    body, roll, pitch = rng.normal(size=(3, 50)), rng.normal(0, 0.1, 50), rng.normal(0, 0.1, 50)
    back = record.acceleration(record.specific_force(body, roll, pitch), roll, pitch)
    np.testing.assert_allclose(back, body, atol=1e-12)


def _moving_body(point, time):
    """Acceleration of a point of a body in known motion, by differences of its position, in body axes."""

    def rotation(t):
        roll, pitch, yaw = 0.05 * np.sin(9 * t), 0.03 * np.cos(7 * t), 0.3 * t + 0.02 * np.sin(5 * t)
        cr, sr, cp, sp, cy, sy = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
        return np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )

    def position(t):
        centre = np.array([15 * t + 0.1 * np.sin(2 * t), 0.4 * t**2, 0.02 * np.sin(11 * t)])
        return centre + rotation(t) @ point

    h = 1e-4
    result = np.empty((3, time.size))
    rates = np.empty((3, time.size))
    for i, t in enumerate(time):
        result[:, i] = rotation(t).T @ (position(t + h) - 2 * position(t) + position(t - h)) / h**2
        spin = rotation(t).T @ (rotation(t + h) - rotation(t - h)) / (2 * h)
        rates[:, i] = spin[2, 1], spin[0, 2], spin[1, 0]
    return result, rates


def test_transfer_to_another_place_agrees_with_differences_of_its_position():
    time = np.arange(0, 3, 0.01)
    here, there = np.array([0.2, -0.1, 0.3]), np.array([-0.9, 0.4, 1.2])
    motion, rates = _moving_body(here, time)
    expected, _ = _moving_body(there, time)
    columns = dict(zip(SIGNALS, [*motion, *rates])) | {"v_x": 15 + 0 * time, "s": 15 * time, "e": 0 * time}
    drive = xr.Dataset({name: ("time", columns[name]) for name in DRIVE}, {"time": time})
    drive.attrs.update(sensor_x=here[0], sensor_y=here[1], sensor_z=here[2])
    moved = record.transfer(drive, tuple(there))
    for name, row, before in zip(("a_x", "a_y", "a_z"), expected, motion):
        inside = slice(5, -5)
        np.testing.assert_allclose(moved[name].values[inside], row[inside], atol=2e-3)
        assert np.abs(before - row)[inside].max() > 0.1
    assert (moved.attrs["sensor_x"], moved.attrs["sensor_z"]) == (-0.9, 1.2)


def test_arrays_become_a_drive_and_survive_being_stacked():
    drive = record.from_arrays(quantities(), name="first", lateral_position=0.2)
    short = record.from_arrays({k: (t[:500], v[:500]) for k, (t, v) in quantities().items()}, name="second", role="check")
    back = record.unstack(record.stack([drive, short]))
    assert [one.attrs["name"] for one in back] == ["first", "second"]
    assert back[1].sizes["time"] == 500 and back[1].attrs["role"] == "check"
    xr.testing.assert_identical(back[0]["a_z"].drop_attrs(), drive["a_z"].drop_attrs())
    assert back[0].attrs["lateral_position"] == 0.2


def test_a_drive_that_does_not_say_how_it_was_recorded_has_what_is_usual():
    """As a simulated one, which is told by its number, at its own rate, without gravity."""
    given = record.from_arrays(quantities(), name="mine", role="check", lateral_position=0.2)
    bare = given.copy()
    bare.attrs = {"role": "check", "sensor_z": 0.4}
    told, usual = record.completed([given, bare])
    assert told is given
    assert usual.attrs.keys() == given.attrs.keys() and usual.attrs["cut_off"] == pytest.approx(given.attrs["cut_off"])
    assert {"name": "drive_2", "role": "check", "gravity": 0, "sensor_z": 0.4, "place_measured": 1}.items() <= usual.attrs.items()
    assert [one.attrs["name"] for one in record.completed(record.stack([given]))] == ["mine"]


def test_a_record_on_the_study_clock_passes_unchanged():
    drive = record.from_arrays(quantities())
    np.testing.assert_array_equal(drive["a_z"].values, quantities()["a_z"][1])
    assert drive.attrs["treatment"] == "none"


def test_down_sampling_keeps_what_lies_below_the_new_rate_and_drops_what_would_fold():
    fine = np.arange(0, 20, 0.0025)  # 400 Hz
    slow, fast = np.sin(2 * np.pi * 12 * fine), np.sin(2 * np.pi * 88 * fine)  # 88 Hz would fold to 12 Hz
    given = {name: (fine, np.interp(fine, TIME, row)) for name, (_, row) in quantities().items()}
    drive = record.from_arrays(given | {"a_y": (fine, slow), "a_x": (fine, fast)})
    inside = slice(50, -50)
    np.testing.assert_allclose(drive["a_y"].values[inside], np.sin(2 * np.pi * 12 * drive["time"].values)[inside], atol=0.01)
    assert np.abs(drive["a_x"].values[inside]).max() < 0.01
    assert "400 Hz" in drive.attrs["treatment"]


def test_a_signal_on_the_study_clock_passes_the_filter_of_slower_ones_as_a_simulation_does():
    rng = np.random.default_rng(0)
    white = STANDARD_GRAVITY + rng.standard_normal(TIME.size)
    given = quantities(a_z=(TIME, white)) | {name: (TIME[::2], 0.1 * np.sin(8 * TIME[::2])) for name in ("roll_rate", "pitch_rate", "yaw_rate")}
    drive = record.from_arrays(given)
    cut_off, count = drive.attrs["cut_off"], drive.sizes["time"]
    assert cut_off == pytest.approx(22.5)
    inside = slice(50, -50)
    expected = sampling.low_pass(white[:, None], 0.01, cut_off)[:count, 0]
    np.testing.assert_allclose(drive["a_z"].values[inside], expected[inside], rtol=0, atol=1e-3)
    frequency, density = welch(drive["a_z"].values, 100.0, nperseg=400)
    assert density[frequency > 1.4 * cut_off].max() < 1e-3 * np.median(density[(frequency > 1) & (frequency < 0.7 * cut_off)])
    slower = r"roll_rate, pitch_rate, yaw_rate brought from 50 Hz \(jitter 0.00 intervals, low-pass 22.5 Hz\)"
    assert re.fullmatch(f"a_x, a_y, a_z low-passed at 22.5 Hz, as the slowest; {slower}", drive.attrs["treatment"])


def test_quantities_with_clocks_of_their_own_meet_on_one():
    imu = np.arange(0.3, 19, 1 / 104.26)
    wheel = np.sort(np.arange(0, 20, 1 / 83) + 0.004 * np.random.default_rng(1).uniform(size=1660))
    given = {name: (imu, 0.1 * np.sin(2 * np.pi * 3 * imu)) for name in SIGNALS}
    given["a_z"] = imu, STANDARD_GRAVITY + 0.1 * np.sin(2 * np.pi * 3 * imu)
    drive = record.from_arrays(given | {"v_x": (wheel, 20 + 0.1 * wheel)})
    time = drive["time"].values + drive.attrs["start_time"]
    np.testing.assert_allclose(drive["v_x"], 20 + 0.1 * time, atol=1e-3)
    np.testing.assert_allclose(drive["pitch_rate"][50:-50], 0.1 * np.sin(2 * np.pi * 3 * time)[50:-50], atol=1e-3)
    assert drive.attrs["place_measured"] == 0
    np.testing.assert_allclose(np.gradient(drive["s"], drive["time"]), drive["v_x"], atol=2e-3)


def spoilt(name, row, value):
    time, values = quantities()[name]
    values = values.copy()
    values[row] = value
    return quantities(**{name: (time, values)})


def backwards():
    time = TIME.copy()
    time[700] = time[699] - 0.5
    return quantities(pitch_rate=(time, 0 * TIME))


def test_time_stamps_that_a_computer_gave_a_little_late_are_those_of_the_clock_behind_them():
    """41,000 stamps at 200 Hz that jitter by 0.2 ms (rms), some of them by a sixth of an interval, and one that came 2 ms late."""
    clock = np.arange(41000) / 200.0
    stamps = clock + 2e-4 * np.random.default_rng(1).standard_normal(clock.size)
    assert np.abs(stamps - clock).max() > 0.15 / 200.0
    stamps[20000] += 0.4 / 200.0
    shaken = 0.1 * np.sin(2 * np.pi * 3 * clock)
    given = {name: (stamps, shaken + (STANDARD_GRAVITY if name == "a_z" else 0.0)) for name in SIGNALS}
    drive = record.from_arrays(given | {"v_x": (clock, np.full(clock.size, 20.0))})
    time = drive["time"].values + drive.attrs["start_time"]
    np.testing.assert_allclose(drive["roll_rate"][50:-50], 0.1 * np.sin(2 * np.pi * 3 * time)[50:-50], atol=3e-4)


@pytest.mark.parametrize("lost", [3, 400, 1000, 1997])
def test_a_single_sample_that_is_lost_is_refused_wherever_it_is(lost):
    """All that follow would stand an interval late, or all before it early."""
    given = quantities(a_y=(np.delete(TIME, lost), np.zeros(TIME.size - 1)))
    with pytest.raises(InputError, match=rf"time of a_y: irregular sampling: .* step of 0.02 s follows on {TIME[lost - 1]:.6g} s"):
        record.from_arrays(given)


def irregular():
    time = TIME.copy()
    time[800:] += 0.05
    return quantities(a_y=(time, 0 * TIME))


def since_1970(given):
    return {name: (time + 1.7e9, values) for name, (time, values) in given.items()}


def test_speeds_and_paths_of_receivers_wheels_and_hard_braking_are_not_refused():
    """A speed in whole km/h that flickers, one told once a second in a stop at 8 m/s2, one with noise of 0.2 m/s; a path whose fix moves by 1.5 m."""
    rng = np.random.default_rng(2)
    wheels = np.round(72 + 3 * np.cos(0.8 * TIME) + 0.5 * rng.standard_normal(TIME.size)) / 3.6
    braked = np.interp(np.floor(TIME), [0, 9, 11, 20], [22, 22, 6, 6]) + 0.05 * np.sin(np.floor(TIME))
    aside = 0.2 * np.sin(0.5 * TIME) + 1.5 * (TIME > 7) - 1.5 * (TIME > 8)
    for changed in ({"v_x": wheels}, {"v_x": braked}, {"v_x": 20 + 0.2 * rng.standard_normal(TIME.size)}, {"e": aside}, {"e": np.interp(np.floor(TIME), [8, 11], [0, 3.5])}):
        given = quantities(**{name: (TIME, values) for name, values in changed.items()})
        record.from_arrays({name: pair for name, pair in given.items() if name != "s"})


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (spoilt("a_y", 41, np.nan), ("a_y", "sample 42", "0.41 s", "nan", "expected a number")),
        (spoilt("roll_rate", 9, 45.0), ("roll_rate", "sample 10", "45", "rad/s", "unit")),
        (spoilt("v_x", 0, 120.0), ("v_x", "120", "-5 to 90")),
        (backwards(), ("time of pitch_rate", "sample 701", "6.49 s after 6.99 s", "strictly increasing")),
        (irregular(), ("time of a_y", "irregular", "0.06 s", "7.99 s")),
        ({k: v for k, v in quantities().items() if k != "yaw_rate"}, ("no yaw_rate", "a_x, a_y, a_z")),
        ({k: v for k, v in quantities().items() if k not in ("s", "v_x")}, ("neither v_x nor s",)),
        (quantities(speed=(TIME, TIME)), ("unknown quantity 'speed'",)),
        (quantities(s=(TIME[:-1], TIME)), ("s has shape (2000,)", "(1999,)")),
        (spoilt("s", -1, 394.0), ("s: sample 2000", "19.99 s", "-5.6 m", "v_x drives 0.2 m", "within 3 m")),
        (quantities(s=(TIME, 20 * TIME + 5 * (TIME >= 8))), ("s: sample 801", "8 s", "+5.2 m")),
        (quantities(s=(TIME, (20 * TIME) % 100.0)), ("s: sample 501", "5 s", "-99.8 m", "v_x drives 0.2 m")),
        (quantities(s=(TIME, standing((5.0, 9.0))[0])), ("s: stands at 98.9 m from 5 to 8.99 s", "v_x drives 79.8 m", "2.1 s at most", "leave s out")),
        (alone(standing((5.0, 9.0))[0]), ("s: stands at 98.9 m from 5 to 8.99 s", "it drives", "2.1 s at most; cut the record there)")),
        (spoilt("v_x", slice(700, 705), 0.0), ("v_x: sample 701 (7 s) holds 0 m/s", "after it became 20", "2 m/s and 15 a second", "leave v_x out where s")),
        (spoilt("v_x", 700, 60.0), ("v_x: sample 701 (7 s) holds 60 m/s",)),
        (quantities(e=(TIME, 0.01 * TIME + 3.0 * ((TIME > 8) & (TIME < 8.1)))), ("e: sample 802 (8.01 s) holds 3.08 m", "became 0.08", "2 m and 5 a second", "or leave e out")),
        (since_1970(backwards()), ("sample 701", "1700000006.49 s after 1700000006.99 s")),
        (since_1970(irregular()), ("sample", "a step of 0.06 s follows on 1700000007.99 s")),
        (since_1970(spoilt("a_y", 41, np.nan)), ("sample 42 (1700000000.41 s)",)),
        (since_1970(spoilt("v_x", 41, 120.0)), ("sample 42 (1700000000.41 s)",)),
        (quantities(v_x=(TIME + 100, 20 + 0 * TIME)), ("overlap",)),
        (quantities(v_x=(np.delete(TIME, slice(300, 400)), np.full(1900, 20.0))), ("pause of 1.01 s", "2.99 s")),
    ],
)
def test_what_is_wrong_is_said_in_one_line(given, words):
    with pytest.raises(InputError) as problem:
        record.from_arrays(given, file="drive.csv")
    message = str(problem.value)
    assert "\n" not in message and message.startswith("drive.csv")
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(("scale", "rate"), [(1e3, "0.1"), (1e6, "0.0001"), (1e9, "1e-07"), (86400.0, "0.00116")])
def test_time_in_a_finer_unit_than_it_is_told_in_is_refused_before_it_is_sampled(scale, rate):
    given = {name: (scale * time, values) for name, (time, values) in quantities().items()}
    with pytest.raises(InputError, match=rf"^drive.csv: time of a_x: {rate} samples per second \(expected 2 or more; is the unit of time right\?\)$"):
        record.from_arrays(given, file="drive.csv")


def test_gravity_that_is_not_where_it_is_said_to_be_is_refused():
    with pytest.raises(InputError, match=r"a_z: mean 9.8.* gravity: False"):
        record.from_arrays(quantities(), gravity=False)
    upside_down = quantities(a_z=(TIME, np.full(TIME.size, -STANDARD_GRAVITY)))
    with pytest.raises(InputError, match="does z point up"):
        record.from_arrays(upside_down)


def test_a_drive_with_a_wrong_unit_or_role_is_refused():
    drive = record.from_arrays(quantities())
    drive["yaw_rate"].attrs["units"] = "deg/s"
    with pytest.raises(InputError, match="yaw_rate is in 'deg/s'"):
        record.check(drive)
    with pytest.raises(InputError, match="role 'train'"):
        record.from_arrays(quantities(), role="train")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"v_x": 0.0}, "v_x: holds 0 m/s throughout its 2000 samples (expected more than 0.5 m/s somewhere; leave v_x out, which is then made of s)"),
        ({"v_x": 0.001}, "v_x: holds 0.001 m/s throughout its 2000 samples"),
        ({"v_x": 0.0, "s": None}, "v_x: holds 0 m/s throughout its 2000 samples (expected more than 0.5 m/s somewhere)"),
        ({"s": 100.0}, "s: holds 100 m throughout its 2000 samples (expected a distance that rises; leave s out, which is then made of v_x)"),
        ({"s": 0.0, "v_x": None}, "s: holds 0 m throughout its 2000 samples (expected a distance that rises)"),
    ],
)
def test_a_distance_or_a_speed_that_is_dead_is_refused_by_name(change, said):
    given = {name: (time, np.full(TIME.size, change[name]) if name in change else values) for name, (time, values) in quantities().items()}
    with pytest.raises(InputError, match=f"^{re.escape(said)}"):
        record.from_arrays({name: pair for name, pair in given.items() if change.get(name, 0.0) is not None})


def test_a_speed_that_goes_on_elsewhere_after_it_was_lost_is_refused():
    speed = 20.0 + np.sin(0.5 * TIME)
    held = np.where((TIME > 7.995) & (TIME < 11.995), speed[800], speed - 12.0 * (TIME > 11.995))
    with pytest.raises(InputError, match=r"^v_x: sample 1201 \(12 s\) holds .* m/s, 4 s after it became .*were values lost"):
        record.from_arrays(quantities(v_x=(TIME, held)))
    record.from_arrays(quantities(v_x=(TIME, np.where((TIME > 7.995) & (TIME < 11.995), speed[800], speed))))
    told = np.floor(TIME + 1e-9)  # once a second, and that brakes hard
    record.from_arrays(quantities(v_x=(TIME, np.interp(told, [0, 5, 6, 20], [20.0, 21.0, 12.0, 13.0]))))
