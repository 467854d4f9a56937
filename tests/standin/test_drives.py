"""The measured drives: what is in the files, what is hidden, and that each error has its size."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from scipy.signal import welch

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


def test_the_sensor_sits_at_its_place_in_the_car_that_is_driven(short, entries, vehicle, monkeypatch):
    """What is hidden, as where its centre of gravity lies, does not take the instrument along."""
    car, _ = drives.hidden_car(short["seed"], short["measurement"], vehicle)
    assert abs(car["cg_height"] - vehicle["cg_height"]) > 0.001
    places = []

    def run(course, driven, *, sensor, **demand):
        places.append((driven, sensor))
        raise InterruptedError

    monkeypatch.setattr(drives.simulate, "run", run)
    monkeypatch.setattr(drives.simulate, "prepare", lambda road, interpolation: road)
    u = np.arange(0.0, 400.0)
    road = xr.Dataset({"curvature": ("u", np.zeros(len(u)))}, {"u": u})
    with pytest.raises(InterruptedError):
        drives.make_drives("ts2", short, road, vehicle, entries)
    ((driven, sensor),) = places
    assert driven.values == car.values and sensor == drives.sensor_place(car, entries[0]["sensor"])


def test_lever_arm_of_the_truth_is_that_of_the_instrument(driven):
    """On a straight road at even speed, an instrument on the roof feels pitching in a_x."""
    record = driven[0][0]
    pitch = np.radians(record["pitch_rate [deg/s]"])
    expected = np.gradient(pitch, 0.01)
    found = record["acceleration_x [m/s2]"] - record["acceleration_x [m/s2]"].mean()
    assert np.corrcoef(found, expected)[0, 1] > 0.3
