"""The door to the simulator."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml
from scipy.signal import butter, sosfiltfilt, welch

from ridecomfort import simulate
from ridecomfort.drive import configured, record
from ridecomfort.effects import library
from ridecomfort.errors import InputError
from ridecomfort.road import crg, edges
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import DRIVE, SIGNALS
from tests import quarter_cars
from tests.vehicle.roads import road, rough


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def course():
    return simulate.prepare(road(120.0, height=rough))


def test_a_drive_holds_what_every_drive_holds(course, car):
    drive = simulate.run(course, car, speed=20.0)
    assert set(DRIVE) <= set(drive.data_vars)
    assert all("units" in drive[name].attrs for name in DRIVE)
    assert np.diff(drive.time.values) == pytest.approx(0.01)
    assert (np.diff(drive.s.values) > 0).all()


def test_what_the_driver_aims_for_may_be_an_array_on_the_road(course, car):
    speed, lateral = np.linspace(18.0, 20.0, course.u.size), np.full(course.u.size, 0.2)
    over_u = lambda values: xr.DataArray(values, {"u": course.u}, "u")
    xr.testing.assert_identical(
        simulate.run(course, car, speed=speed, lateral=lateral), simulate.run(course, car, speed=over_u(speed), lateral=over_u(lateral))
    )


def test_a_road_without_what_is_needed_of_it_is_refused(course):
    with pytest.raises(InputError, match="road: no 'bank', expected elevation, bank, curvature"):
        simulate.prepare(course.road.drop_vars("bank"))


def test_runs_do_not_depend_on_their_company(course, car):
    """Bit for bit: a shard is a slice of the runs and nothing else."""
    speed = xr.DataArray(np.full(course.u.size, 18.0), {"u": course.u}, "u")
    samples = dict(
        speed_deviation=[0.1, -0.2, 0.3], lateral_position=[0.0, 0.2, -0.1], road_friction=[0.7, 0.9, 1.0]
    )
    together = simulate.runs(course, car, speed=speed, **samples)
    alone = simulate.runs(course, car, speed=speed, **{k: v[1:2] for k, v in samples.items()})
    length = alone.time.size
    for name in alone.data_vars:
        np.testing.assert_array_equal(together[name].values[1, :length], alone[name].values[0])


def test_a_sensor_off_the_centre_feels_the_rigid_body(course, car):
    """The vertical acceleration ahead of the centre lacks that of pitching: a_z - x dw/dt."""
    centre = simulate.run(course, car, speed=20.0, rate=1000.0)
    ahead = simulate.run(course, car, speed=20.0, rate=1000.0, sensor=(1.2, 0.0, 0.0))
    pitching = np.gradient(centre.pitch_rate.values, 0.001)
    found = (ahead.a_z - centre.a_z).values
    assert (found + 1.2 * pitching).std() < 0.05 * found.std()
    np.testing.assert_array_equal(ahead.pitch_rate, centre.pitch_rate)


def test_a_sensor_above_the_centre_feels_what_accelerometer_and_gyroscope_tell_of_it_in_a_bend(car):
    """Moved by the measured rates, as an instrument elsewhere, in a narrow bend."""
    bent = simulate.prepare(quarter_cars.road(length=160.0, bend=1 / 30.0))
    below, above = (simulate.run(bent, car, speed=9.0, sensor=(0.0, 0.0, z), rate=1000.0) for z in (0.0, 1.0))
    moved = record.transfer(below.assign_attrs(sensor_x=0.0, sensor_y=0.0, sensor_z=0.0), (0.0, 0.0, 1.0))
    inside = slice(2000, -1000)
    for name in ("a_x", "a_y"):
        off = (above[name] - moved[name]).values[inside]
        assert off.std() < {"a_x": 0.0015, "a_y": 0.0025}[name]


def test_a_sensor_stays_on_the_body_where_the_centre_of_gravity_moves(course, car):
    """By the same load as parameters of the vehicle, with the sensor's place told from its centre of gravity."""
    load = {"mass": 300.0, "ahead": -1.0, "height": 0.9}
    entry, sizes = library.choose({"payload": load})[0]
    loaded = entry.act(car, **sizes)
    back, up = loaded["cg_to_front_axle"] - car["cg_to_front_axle"], loaded["cg_height"] - car["cg_height"]
    assert back == pytest.approx(300.0 / loaded["sprung_mass"])
    with_effect = simulate.run(course, car, speed=20.0, effects={"payload": load}, sensor=(0.4, 0.1, 0.7))
    by_hand = simulate.run(course, loaded, speed=20.0, sensor=(0.4 + back, 0.1, 0.7 - up))
    for name in SIGNALS:
        np.testing.assert_allclose(with_effect[name], by_hand[name], atol=1e-9)
    np.testing.assert_allclose(with_effect["s"], by_hand["s"] + back)


def test_wheels_meet_a_bump_where_the_record_says_however_the_car_is_loaded(course, car):
    """The front wheels come to it when ``s``, told of one point of the body, is the way from there to the axle before it."""
    bump = road(150.0, 0.1, height=lambda u, v: 0.01 * (u >= 80.0) + 0 * v)
    for load in ({}, {"payload": {"mass": 500.0, "ahead": -1.5}}, {"payload": {"mass": 500.0, "ahead": 1.5}}):
        drive = simulate.run(bump, car, speed=20.0, rate=500.0, effects=load, start=40.0, end=120.0)
        felt = np.abs(drive.a_z.values - drive.a_z.values[(drive.s > 60.0) & (drive.s < 75.0)].mean())
        first = drive.s.values[np.argmax((felt > 0.2 * felt.max()) & (drive.s.values > 60.0))]
        assert first == pytest.approx(80.0 - car["cg_to_front_axle"], abs=0.15)
        assert drive.s.values[0] == pytest.approx(40.0, abs=0.1) and drive.s.values[-1] == pytest.approx(120.0, abs=0.1)


def test_records_do_not_alias(car):
    """Unevenness felt at 70 Hz, above half the rate, leaves no false 30 Hz."""
    speed, wave = 21.0, 0.3
    felt = simulate.run(
        road(150.0, 0.02, height=lambda u, v: 2e-4 * np.sin(2 * np.pi * u / wave) + 0 * v), car, speed=speed
    )
    fine = simulate.run(
        road(150.0, 0.02, height=lambda u, v: 2e-4 * np.sin(2 * np.pi * u / wave) + 0 * v),
        car, speed=speed, rate=500.0,
    )  # fmt: skip
    middle = slice(2.0, 5.0)
    assert float(felt.a_z.sel(time=middle).std()) < 0.05 * float(fine.a_z.sel(time=middle).std())


@pytest.mark.parametrize("name", SIGNALS)
def test_records_are_the_drive_low_passed_in_every_band(car, name):
    """At 100 Hz against every step low-passed by scipy: what folds down shows first where little is, at 25 to 40 Hz."""
    course = simulate.prepare(road(400.0, height=rough))
    fine = simulate.run(course, car, speed=25.0, rate=1000.0)[name].values
    coarse = simulate.run(course, car, speed=25.0)[name].values
    expected = sosfiltfilt(butter(12, 46.0, fs=1000.0, output="sos"), fine)[::10]
    error, power = (
        welch(series[100:-100], 100.0, nperseg=256) for series in (coarse - expected[: coarse.size], expected[: coarse.size])
    )
    band = (error[0] > 0.5) & (error[0] < 40)
    assert (error[1][band] < 2e-3 * power[1][band]).all(), (error[1][band] / power[1][band]).max()


@pytest.mark.parametrize(
    ("lateral", "u", "beyond", "said"),
    [
        (1.25, None, 0.0, None),
        (1.3, None, 0.0, "1.30 m, with wheels 0.75 m to either side, expected on the road, -2 to 2 m"),
        ([0.0, -1.28, -1.31], [50.0, 60.0, 70.0], 0.1, None),
        ([0.0, -1.36, -1.31], [50.0, 60.0, 70.0], 0.1, "-1.36 m at u = 60.0 m, with wheels 0.75 m"),
    ],
)
def test_wheels_stay_on_the_road(course, car, lateral, u, beyond, said):
    """Track 1.5 m on 4 m of road: 1.25 m to either side, or a cell more where that is granted."""
    if said is None:
        simulate.check_on_road(course.road, car, lateral, u, beyond=beyond)
        return
    with pytest.raises(InputError) as problem:
        simulate.check_on_road(course.road, car, lateral, u, beyond=beyond, file="road.nc", place="run 7")
    assert str(problem.value).startswith(f"road.nc: run 7: lateral position: {said}")


def test_a_road_ends_where_it_narrows():
    """Not half of a notch's length later, and a single wider cross section widens nothing beside it."""
    u, v = np.arange(0.0, 30.0, 0.1), np.arange(-2.0, 2.01, 0.1)
    elevation = np.zeros((u.size, v.size))
    elevation[150:, v < -1.05] = np.nan
    elevation[:, v > 1.55] = np.nan
    elevation[80] = 0.0
    right, left = edges.sides(elevation, u, v)
    assert right == pytest.approx(np.where(np.arange(u.size) < 150, -2.0, -1.0))
    assert left == pytest.approx(np.where(np.arange(u.size) == 80, 2.0, 1.5))


@pytest.mark.parametrize(("length", "is_refused"), [(0.9, False), (5.0, True)])
def test_wheels_stay_where_the_road_has_heights_but_for_notches_as_short_as_a_hole(car, length, is_refused):
    """The left 0.5 m of 4 m of road hold no height from 60 m on: on 5 m of held heights a drive came out too smooth."""
    narrowed = road(120.0, height=rough)
    narrowed["elevation"] = narrowed.elevation.where((narrowed.v < 1.55) | (narrowed.u < 60.0) | (narrowed.u > 60.0 + length))
    u = np.arange(50.0, 70.0, 0.25)
    simulate.check_on_road(narrowed, car, np.full(u.size, 0.75), u)
    simulate.check_on_road(narrowed, car, 1.25)
    simulate.check_on_road(narrowed, car, np.where((u > 59.0) & (u < 66.0), 0.0, 1.25), u)
    if not is_refused:
        simulate.check_on_road(narrowed, car, np.full(u.size, 1.25), u)
        return
    with pytest.raises(InputError, match=r"1.25 m at u = 6[0-5]\.\d m, with wheels 0.75 m to either side, expected on the road, -2 to 1.5 m"):
        simulate.check_on_road(narrowed, car, np.full(u.size, 1.25), u)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (dict(speed=-3.0), "speed"),
        (dict(speed=float("nan")), "speed"),
        (dict(speed=20.0, friction=0.0), "friction"),
        (dict(speed=20.0, friction=np.ones(3)), "friction: array.*, expected a positive number"),
        (dict(speed=np.full(3, 20.0)), r"speed: has the shape \(3,\), expected a number, a value for each of the \d+ u of the road"),
        (dict(speed=20.0, step=0.003), "step"),
        (dict(speed=20.0, start=500.0), "start"),
        (dict(speed=20.0, start=50.0, end=50.0), "nothing of the road lies between 50 m and 50 m"),
        (dict(speed=20.0, effects=["warp_drive"]), "warp_drive"),
        (dict(speed=20.0, effects={"suspension_friction": {"middle": 3.0}}), "middle"),
    ],
)
def test_what_cannot_be_simulated_is_said_in_a_line(course, car, given, named):
    with pytest.raises(InputError, match=named):
        simulate.run(course, car, **given)


@pytest.mark.parametrize("vehicle", ["midsize", None, "config/vehicles/midsize.yaml"])
def test_what_is_no_vehicle_is_said_in_a_line(course, vehicle):
    with pytest.raises(InputError) as refused:
        simulate.run(course, vehicle, speed=20.0)
    assert str(refused.value) == f"vehicle: {vehicle!r}, expected a Vehicle, as `vehicle.parameters.read` gives it from its file"


def test_a_road_with_holes_is_said_in_a_line(car):
    torn = road(60.0, height=rough)
    torn["elevation"] = torn.elevation.where((torn.u < 30.05) | (torn.u > 30.15) | (abs(torn.v - 0.5) > 0.05))
    with pytest.raises(InputError) as refused:
        simulate.run(torn, car, speed=10.0)
    assert str(refused.value).startswith("road: no height at u = 30.1 m, v = 0.5 m, expected a road without holes") and "\n" not in str(refused.value)
    with pytest.raises(InputError, match="road: holds no height at all"):
        simulate.run(torn.assign(elevation=torn.elevation * np.nan), car, speed=10.0)


def test_a_road_may_hold_its_heights_across_before_along(car):
    ground = road(60.0, height=rough)
    there, here = (simulate.run(each, car, speed=10.0) for each in (ground.assign(elevation=ground.elevation.transpose("v", "u")), ground))
    xr.testing.assert_identical(there, here)


def test_the_golden_car_on_four_corners_is_the_quarter_car(repository):
    """Sayers (1995): acceleration of the body above a wheel against the quarter-car solved by scipy."""
    from scipy.signal import StateSpace, lsim

    golden = parameters.read(repository / "config" / "vehicles" / "golden_car.yaml")
    ground = road(260.0, height=lambda u, v: rough(u, v)[:, :1] + 0 * v)
    place = (golden["cg_to_front_axle"], golden["track_front"] / 2, 0.0)
    drive = simulate.run(ground, golden, speed=80 / 3.6, friction=1e-9, sensor=place)
    k1, k2, c, mu = 653.0, 63.3, 6.0, 0.15
    a = [[0, 1, 0, 0], [-k2, -c, k2, c], [0, 0, 0, 1], [k2 / mu, c / mu, -(k1 + k2) / mu, -c / mu]]
    quarter = StateSpace(a, [[0], [0], [0], [k1 / mu]], [a[1]], [[0]])
    time = np.arange(0, drive.time.values[-1], 0.001)
    s = np.interp(time, drive.time, drive.s) + golden["cg_to_front_axle"]
    height = np.interp(s, ground.u, ground.elevation[:, 20])
    _, acceleration, _ = lsim(quarter, height - height[0], time)
    expected = np.interp(drive.time, time, acceleration)
    settled = slice(300, -30)
    difference = drive.a_z.values[settled] - expected[settled]
    assert difference.std() < 0.05 * expected[settled].std()


@pytest.mark.parametrize("radius", [2.0, 8.7])
def test_a_drive_that_does_not_stay_finite_is_told_with_the_place_and_the_bend_there(car, radius):
    """8.7 m: one of 500 m whose headings are in degrees."""
    bent = road(240.0, height=rough)
    bent["curvature"] = bent["curvature"].copy(data=np.where(bent["u"] > 60.0, 1.0 / radius, 0.0))
    said = rf"did not stay finite at u = \d+ m, where the road bends with a radius of {radius:g} m: are its headings in rad; is a parameter"
    with pytest.raises(InputError, match=said):
        simulate.run(bent, car, speed=25.0)


def test_the_lines_of_the_docs_make_drives_with_an_effect_that_is_hidden(repository, tmp_path, monkeypatch):
    (tmp_path / "data" / "known").mkdir(parents=True)
    (tmp_path / "config").symlink_to(repository / "config")
    straight = quarter_cars.road(length=120.0, bend=0.0)
    crg.write(tmp_path / "data" / "known" / "road.crg", straight.assign(x=straight["u"], y=0.0 * straight["u"]))
    monkeypatch.chdir(tmp_path)
    section = (repository / "docs" / "reading.md").read_text(encoding="utf-8").partition("## A car whose answer you know")[2]
    exec(re.search(r"```python\n(.*?)```", section, re.DOTALL)[1], {})
    site = yaml.safe_load(re.search(r"```yaml\n(.*?)```", section, re.DOTALL)[1])
    assert [Path(drive["file"]).is_file() for drive in site["drives"]] == [True] * 4
    first = configured.read(site["drives"][0]["file"], site["drives"][0], parameters.read("config/vehicles/midsize.yaml"))
    assert first.attrs["place_measured"] and not first.attrs["gravity"] and first["e"].std() < 0.02
