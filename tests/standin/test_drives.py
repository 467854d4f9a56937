"""The measured drives: what is in the files, what is hidden, and that each error has its size."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from scipy.signal import welch

from ridecomfort.effects import library
from ridecomfort.standin import drives, instrument
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import CALIBRATED, SIGNALS, STANDARD_GRAVITY


@pytest.fixture(scope="module")
def vehicle(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def entries(repository):
    site = yaml.safe_load((repository / "config" / "sites" / "ts2.yaml").read_text())
    return [{"role": "fit", **entry} for entry in site["drives"]]


@pytest.fixture(scope="module")
def driven(short, entries, vehicle):
    """A quarter of a kilometre of smooth, even, straight road, driven as ts2 is: records and truth."""
    u, v = np.arange(0.0, 400.05, 0.1), np.linspace(-2.0, 2.0, 41)
    rough = 2e-4 * np.cumsum(np.random.default_rng(1).standard_normal((len(u), len(v))), axis=0)
    along = {name: ("u", np.zeros(len(u))) for name in ("y", "heading", "curvature", "slope", "bank")}
    road = xr.Dataset({"elevation": (("u", "v"), rough), "x": ("u", u), **along}, {"u": u, "v": v})
    return drives.make_drives("ts2", short, road, vehicle, entries)


def test_three_repeats_and_a_slower_one_at_100_hz(driven, entries):
    records, truth = driven
    assert [entry["role"] for entry in entries] == ["fit", "fit", "fit", "check"]
    speeds = [record["speed [m/s]"].mean() for record in records]
    assert max(speeds[:3]) - min(speeds[:3]) < 2.0
    assert speeds[3] == pytest.approx(0.8 * np.mean(speeds[:3]), rel=0.06)
    for record in records:
        np.testing.assert_allclose(np.diff(record["time [s]"]), 0.01, atol=1e-9)


def test_columns_are_those_of_the_site_file_with_units_in_their_headers(driven, entries):
    for record, entry in zip(driven[0], entries, strict=True):
        assert list(record) == [column["column"] for column in entry["columns"].values()]
        assert all(f"[{column['unit']}]" in column["column"] for column in entry["columns"].values())
        assert all(np.isfinite(values).all() for values in record.values())


def test_accelerations_hold_gravity(driven):
    for record in driven[0]:
        assert record["acceleration_z [m/s2]"].mean() == pytest.approx(STANDARD_GRAVITY, abs=0.1)


def test_distance_and_speed_belong_together(driven):
    for record in driven[0]:
        travelled = np.trapezoid(record["speed [m/s]"], record["time [s]"])
        assert np.ptp(record["distance [m]"]) == pytest.approx(travelled, rel=0.005)


def test_repeats_differ_in_path_speed_and_clock(driven):
    truth = driven[1]["drives"]
    for name in ("lateral_position", "speed_deviation", "clock_offset", "speed_scale"):
        assert len({drive[name] for drive in truth}) == len(truth)


def test_the_hidden_car_is_inside_the_bounds_of_the_paper_and_not_the_nominal_one(settings, vehicle, published):
    unit = {"spring_stiffness_front": "_N_per_m", "spring_stiffness_rear": "_N_per_m", "tyre_friction": "",
            "tyre_radial_stiffness": "_N_per_m", "tyre_radial_damping": "_Ns_per_m"}  # fmt: skip
    bounds = published["calibration_bounds"]
    for seed in range(20):
        car, effects = drives.hidden_car(seed, settings["measurement"], vehicle)
        for name in CALIBRATED:
            lower, upper = bounds[name + unit[name]]
            assert lower + 0.1 * (upper - lower) <= car[name] <= upper - 0.1 * (upper - lower)
            assert car[name] != vehicle[name]
        assert len(effects) == len(settings["measurement"]["effects"])
        for weighed in ("sprung_mass", "wheelbase", "track_front", "cg_to_front_axle", "tyre_radius"):
            assert car[weighed] == vehicle[weighed]


def test_what_is_hidden_has_the_size_that_is_asked_for(settings, vehicle):
    """Effects a share of what is typical within its interval, what nobody is sure of its spread about the nominal value."""
    block = settings["measurement"]
    cars = [drives.hidden_car(seed, block, vehicle) for seed in range(40)]
    off = [np.log(car[name] / vehicle[name]) for car, _ in cars for name in block["unsure"]["parameters"]]
    assert np.std(off) == pytest.approx(block["unsure"]["spread"], rel=0.15)
    for number, entry in enumerate(block["effects"]):
        shares = []
        for _, effects in cars:
            name, sizes = list(effects.items())[number]
            assert name in entry["among"]
            own = [one for one in library.find()[name].effect.parameters if one.typical != one.neutral]
            shares.append([(sizes[one.name] - one.neutral) / (one.typical - one.neutral) for one in own])
        low, high = entry["size"]
        assert low <= np.min(shares) < low + 0.2 * (high - low) and high - 0.2 * (high - low) < np.max(shares) <= high


def test_the_same_car_drives_on_every_site(settings, vehicle):
    one = drives.hidden_car(settings["seed"], settings["measurement"], vehicle)
    assert one == drives.hidden_car(settings["seed"], settings["measurement"], vehicle)
    assert one != drives.hidden_car(settings["seed"] + 1, settings["measurement"], vehicle)


def test_drives_follow_from_the_seed(driven, short, entries, vehicle):
    u, v = np.arange(0.0, 100.05, 0.1), np.linspace(-2.0, 2.0, 5)
    along = {name: ("u", np.zeros(len(u))) for name in ("y", "heading", "curvature", "slope", "bank")}
    road = xr.Dataset({"elevation": (("u", "v"), np.zeros((len(u), 5))), "x": ("u", u), **along}, {"u": u, "v": v})
    once, twice = (drives.make_drives("ts2", short, road, vehicle, entries[:1])[0][0] for _ in range(2))
    pd.testing.assert_frame_equal(pd.DataFrame(once), pd.DataFrame(twice), check_exact=True)


def test_the_files_do_not_tell_the_truth(driven):
    records, truth = driven
    text = "".join(pd.DataFrame(record).to_csv(index=False) for record in records)
    words = [*truth["effects"], *truth["vehicle"], "offset", "bias", "seed", "lateral", "mounting"]
    assert not [word for word in words if word in text]
    assert json.loads(json.dumps(truth)) == truth


def at_rest(seconds, **motion):
    """A finely sampled drive of a car that stands still, or moves as told (name: function of time)."""
    time = np.arange(0.0, seconds, 0.001)
    names = ("v_x", "s", "roll", "pitch", *SIGNALS)
    still = np.zeros(len(time))
    columns = {name: ("time", motion[name](time) if name in motion else still) for name in names}
    return xr.Dataset(columns, {"time": time})


QUIET = {
    "clock_offset": 0.0,
    "accelerometer": {"density": 0, "bias": 0, "instability": 0, "time": 100},
    "gyroscope": {"density": 0, "bias": 0, "instability": 0, "time": 100},
    "distance": {"drift": 0, "time": 20},
    "speed": {"noise": 0, "scale": 0},
}


def test_noise_has_the_density_of_the_data_sheet(settings):
    sensors = settings["measurement"]["instrument"]
    quantities, _ = instrument.record(np.random.default_rng(1), at_rest(600.0), 100.0, sensors, np.zeros(3))
    for name, unit, sensor in (("a_x", 9.80665e-6, "accelerometer"), ("yaw_rate", np.pi / 180, "gyroscope")):
        wavenumber, density = welch(quantities[name], fs=100.0, nperseg=4096)
        floor = np.sqrt(np.mean(density[(wavenumber > 5.0) & (wavenumber < 45.0)]))
        assert floor == pytest.approx(sensors[sensor]["density"] * unit, rel=0.03)


def test_no_error_of_driver_and_instrument_is_nil(settings):
    def numbers(block):
        return [one for value in block.values() for one in (numbers(value) if isinstance(value, dict) else [value])]

    block = settings["measurement"]
    names = ("speed_deviation", "speed_wander", "lateral_deviation", "lateral_wander", "mounting_deg", "instrument")
    assert min(numbers({name: block[name] for name in names})) > 0 and block["unsure"]["spread"] > 0


def test_records_differ_in_bias_scale_and_clock_by_what_is_asked(settings):
    """A hundred short records of a car at 10 m/s without noise."""
    asked = settings["measurement"]["instrument"]
    biased = {kind: QUIET[kind] | {"bias": asked[kind]["bias"]} for kind in ("accelerometer", "gyroscope")}
    all_of_them = {**QUIET, **biased, "clock_offset": asked["clock_offset"], "speed": {"noise": 0, "scale": asked["speed"]["scale"]}}
    drive, rng, rows = at_rest(1.0, v_x=lambda t: 10.0 + 0.0 * t), np.random.default_rng(5), []
    for _ in range(100):
        quantities, errors = instrument.record(rng, drive, 100.0, all_of_them, np.zeros(3))
        rows.append([quantities[name].mean() for name in (*SIGNALS, "v_x")] + [errors["clock_offset"]])
    spread = np.std(rows, axis=0)
    assert spread[:3] == pytest.approx(asked["accelerometer"]["bias"] * 9.80665e-6, rel=0.2)
    assert spread[3:6] == pytest.approx(np.radians(asked["gyroscope"]["bias"]), rel=0.2)
    assert spread[6] == pytest.approx(10.0 * asked["speed"]["scale"], rel=0.2)
    assert spread[7] == pytest.approx(asked["clock_offset"], rel=0.2)


def test_a_bias_wanders_by_its_instability_over_its_time(settings):
    asked = settings["measurement"]["instrument"]
    wandering = {kind: QUIET[kind] | {"instability": asked[kind]["instability"], "time": 1.0} for kind in ("accelerometer", "gyroscope")}
    quantities, _ = instrument.record(np.random.default_rng(6), at_rest(300.0), 100.0, {**QUIET, **wandering}, np.zeros(3))
    for names, size in (
        (SIGNALS[:3], asked["accelerometer"]["instability"] * 9.80665e-6),
        (SIGNALS[3:], np.radians(asked["gyroscope"]["instability"])),
    ):
        drift = np.stack([quantities[name] for name in names])
        drift -= drift.mean(axis=1, keepdims=True)
        assert np.sqrt(np.mean(drift**2)) == pytest.approx(size, rel=0.15)
        assert np.mean(drift[:, 100:] * drift[:, :-100]) / np.mean(drift**2) == pytest.approx(np.exp(-1.0), abs=0.15)


def test_a_recorded_speed_has_the_noise_that_is_asked(settings):
    noise = settings["measurement"]["instrument"]["speed"]["noise"]
    noisy = {**QUIET, "speed": {"noise": noise, "scale": 0}}
    quantities, _ = instrument.record(np.random.default_rng(7), at_rest(60.0), 100.0, noisy, np.zeros(3))
    assert quantities["v_x"].std() == pytest.approx(noise, rel=0.05)
    assert abs(np.corrcoef(quantities["v_x"][1:], quantities["v_x"][:-1])[0, 1]) < 0.05


def test_a_driver_keeps_to_his_speed_and_path_as_closely_as_is_asked(settings):
    block, u = settings["measurement"], np.arange(0.0, 50000.0, 2.0)
    usual = np.full(len(u), 20.0)
    speed, path, drawn = drives.how_driven(np.random.default_rng(8), u, usual, {"role": "fit", "lateral_position": 0.5}, block)
    for found, mean, size in (
        (speed, 20.0 + drawn["speed_deviation"], block["speed_wander"]),
        (path, drawn["lateral_position"], block["lateral_wander"]),
    ):
        wander = found.values - mean
        assert wander.std() == pytest.approx(size, rel=0.15)
        apart = round(block["wander_length"] / 2.0)
        assert np.corrcoef(wander[apart:], wander[:-apart])[0, 1] == pytest.approx(np.exp(-0.5), abs=0.1)
    many = [drives.how_driven(np.random.default_rng(seed), u[:2], usual[:2], {"role": "fit"}, block)[2] for seed in range(200)]
    for name, size in (("speed_deviation", block["speed_deviation"]), ("lateral_position", block["lateral_deviation"])):
        assert np.std([drawn[name] for drawn in many]) == pytest.approx(size, rel=0.15)


def test_the_instrument_of_a_site_is_mounted_as_askew_as_is_asked_and_reads_gravity_so(short, entries, vehicle, monkeypatch):
    monkeypatch.setattr(drives.simulate, "run", lambda *course, **demand: at_rest(0.5))
    monkeypatch.setattr(drives.simulate, "prepare", lambda road, interpolation: road)
    u = np.arange(0.0, 400.0)
    road = xr.Dataset({"curvature": ("u", np.zeros(len(u)))}, {"u": u})
    askew = []
    for seed in range(30):
        alone = {**short, "seed": seed, "measurement": short["measurement"] | {"instrument": QUIET}}
        ((record,), truth) = drives.make_drives("ts2", alone, road, vehicle, entries[:1])
        askew.append(truth["mounting_rad"])
        across = record["acceleration_x [m/s2]"].mean(), record["acceleration_y [m/s2]"].mean()
        roll, pitch, _ = truth["mounting_rad"]
        assert across == pytest.approx((-pitch * STANDARD_GRAVITY, roll * STANDARD_GRAVITY), abs=1e-5)
    assert np.std(askew) == pytest.approx(np.radians(short["measurement"]["mounting_deg"]), rel=0.2)


def test_a_clock_offset_delays_the_inertial_signals_against_the_position():
    drive = at_rest(20.0, a_z=lambda t: np.sin(8.0 * t), s=lambda t: 10.0 * t, v_x=lambda t: 10.0 + 0.0 * t)
    late = {**QUIET, "clock_offset": 0.02}
    quantities, errors = instrument.record(np.random.default_rng(2), drive, 100.0, late, np.zeros(3))
    true_time = quantities["s"] / 10.0
    expected = STANDARD_GRAVITY + np.sin(8.0 * (true_time - errors["clock_offset"]))
    np.testing.assert_allclose(quantities["a_z"][100:-100], expected[100:-100], atol=5e-4)
    assert abs(errors["clock_offset"]) > 1e-3


def test_the_anti_alias_filter_passes_40_hz_stops_60_hz_and_halves_50_hz():
    time = np.arange(0.0, 10.0, 0.001)
    gains = ((1.0, 0.999, 1.001), (40.0, 0.94, 1.0), (50.0, 0.49, 0.51), (60.0, 0.0, 0.06), (150.0, 0.0, 0.01))
    for frequency, least, most in gains:
        passed = instrument.low_pass(np.sin(2 * np.pi * frequency * time)[None], 1000.0, 100.0)[0, 1000:-1000]
        assert least <= np.sqrt(2.0) * passed.std() <= most


def test_a_tilted_instrument_reads_gravity_across():
    quantities, _ = instrument.record(np.random.default_rng(3), at_rest(5.0), 100.0, QUIET, np.array([0.01, 0.0, 0.0]))
    assert quantities["a_y"].mean() == pytest.approx(0.01 * STANDARD_GRAVITY, rel=1e-6)
    assert quantities["a_x"] == pytest.approx(0.0)


def test_distance_drifts_slowly_by_what_is_asked():
    settings = {**QUIET, "distance": {"drift": 0.03, "time": 4.0}}
    quantities, _ = instrument.record(np.random.default_rng(4), at_rest(1000.0), 100.0, settings, np.zeros(3))
    assert quantities["s"].std() == pytest.approx(0.03, rel=0.25)
    assert np.abs(np.diff(quantities["s"])).max() < 4e-4


def test_the_sensor_is_placed_from_the_front_axle_and_the_wheel_centres(vehicle):
    x, y, z = drives.sensor_place(vehicle, {"behind_front_axle": 1.4, "left": 0.1, "above_wheel_centres": 1.15})
    assert x == pytest.approx(vehicle["cg_to_front_axle"] - 1.4)
    assert y == 0.1
    assert z + vehicle["cg_height"] == pytest.approx(1.15 + vehicle["tyre_radius"], abs=0.03), "tyres give a little"


def test_the_hidden_car_is_driven_with_its_effects_and_the_sensor_at_its_place_in_it(short, entries, vehicle, monkeypatch):
    """What is hidden, as where its centre of gravity lies, does not take the instrument along."""
    car, hidden = drives.hidden_car(short["seed"], short["measurement"], vehicle)
    assert abs(car["cg_height"] - vehicle["cg_height"]) > 0.001
    places = []

    def run(course, driven, *, sensor, effects, **demand):
        places.append((driven, sensor, effects))
        raise InterruptedError

    monkeypatch.setattr(drives.simulate, "run", run)
    monkeypatch.setattr(drives.simulate, "prepare", lambda road, interpolation: road)
    u = np.arange(0.0, 400.0)
    road = xr.Dataset({"curvature": ("u", np.zeros(len(u)))}, {"u": u})
    with pytest.raises(InterruptedError):
        drives.make_drives("ts2", short, road, vehicle, entries)
    ((driven, sensor, effects),) = places
    assert driven.values == car.values and sensor == drives.sensor_place(car, entries[0]["sensor"])
    assert effects == hidden and len(hidden) == 2


def test_lever_arm_of_the_truth_is_that_of_the_instrument(driven):
    """On a straight road at even speed, an instrument on the roof feels pitching in a_x."""
    record = driven[0][0]
    pitch = np.radians(record["pitch_rate [deg/s]"])
    expected = np.gradient(pitch, 0.01)
    found = record["acceleration_x [m/s2]"] - record["acceleration_x [m/s2]"].mean()
    assert np.corrcoef(found, expected)[0, 1] > 0.3
