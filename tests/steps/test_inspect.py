"""What the step inspect says of a road: what was planted is found, and smoothing costs what it must."""

from __future__ import annotations

import numpy as np
import pycrg
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.road import clean, crg
from ridecomfort.steps import inspect
from ridecomfort.vehicle import driver
from tests.described import undescribed

LENGTH = 260.0
SETTINGS = {
    "site": "own",
    "speed": {"limit_km_h": 60, "lateral_acceleration": 3.0, "acceleration": 1.0, "deceleration": 1.5},
    "simulation": {"step": 0.001, "rate": 100},
    "wheel_tracks": [-0.75, 0.75],
    "lateral_position": 0.0,
}


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A file of a rough road with noise, a pothole under the left wheels and two outliers."""
    rng = np.random.default_rng(1)
    u = np.arange(round(LENGTH / 0.1) + 1) * 0.1
    lengths, phases = np.geomspace(0.8, 30, 30), rng.uniform(0, 6, 30)
    rough = (3e-4 * lengths * np.sin(2 * np.pi * u[:, None] / lengths + phases)).sum(axis=1)
    z = rough[:, None] + rng.normal(0, 5e-4, (u.size, 41))
    z[1500:1504, 26:30] -= 0.04
    z[500, 12], z[700, 30] = z[500, 12] + 0.1, z[700, 30] - 0.25
    path = tmp_path_factory.mktemp("inspect") / "road.crg"
    pycrg.write(path, z, 0.1, np.linspace(-2, 2, 41), mods={})
    return path


@pytest.fixture(scope="module")
def found(road, repository):
    settings = {**SETTINGS, "options": {"outliers": "repair"}}
    inspect.main(road, repository / "config/vehicles/midsize.yaml", None, settings, road.parent / "inspection.nc")
    return store.read(road.parent / "inspection.nc")


def test_what_was_planted_is_found_and_counted(found):
    kinds = found["kind"].values.tolist()
    assert kinds.count("outlier repaired") == 2 and kinds.count("dip") == 1
    dip = found.isel(defect=kinds.index("dip"))
    assert dip["u_middle"].item() == pytest.approx(150.15, abs=0.2) and dip["height"].item() == pytest.approx(-0.04, abs=0.01)
    assert undescribed(found) == []
    assert found.attrs["cells_repaired"] == 2 and found.attrs["cells_filled"] == 0
    assert found.attrs["share_changed"] == pytest.approx(2 / found.attrs["cells"])
    assert found.attrs["largest_change"] == pytest.approx(0.25, abs=0.01)
    assert found.attrs["largest_change_u"] == pytest.approx(70.0) and found.attrs["largest_change_v"] == pytest.approx(1.0)


def test_smoothing_takes_noise_from_the_spectrum_the_iri_and_the_drive(found):
    stages = [found.sel(stage=stage) for stage in ("repaired", "smoothed")]
    short = [float(stage["smoothed_psd"].sel(band=slice(2.0, None)).mean()) for stage in stages]
    long = [float(stage["smoothed_psd"].sel(band=slice(None, 0.2)).mean()) for stage in stages]
    assert short[1] < 0.5 * short[0] and long[1] == pytest.approx(long[0], rel=0.02)
    assert float(stages[1]["iri_track"].mean()) < float(stages[0]["iri_track"].mean())
    assert float(stages[1]["a_z_rms"]) < float(stages[0]["a_z_rms"])
    variance = float(stages[0]["acceleration_psd"].integrate("frequency"))
    assert variance == pytest.approx(float(stages[0]["a_z_rms"]) ** 2, rel=0.3)
    assert found.attrs["used"] == "repaired"


def test_the_speed_that_drives_of_the_site_aim_for_is_told_to_other_simulators(found, road):
    limits = {name: SETTINGS["speed"][name] for name in ("lateral_acceleration", "acceleration", "deceleration")}
    expected = driver.speed_profile(crg.read(road), limit=60 / 3.6, **limits)
    np.testing.assert_allclose(found["speed"].interp(u=expected["u"]), expected)
    assert found["speed"].attrs["units"] == "m/s"


def test_the_cutoff_is_that_of_the_least_error(found):
    for _, one in found.groupby("direction"):
        one = one.squeeze("direction")
        least = one["held_out_error"].values.argmin()
        assert one["cutoff"].item() == one["trial_cutoff"].values[least]


def test_a_road_too_short_for_a_spectrum_says_so_by_nan(tmp_path, repository):
    z = np.random.default_rng(2).normal(0, 1e-3, (150, 41))
    pycrg.write(tmp_path / "road.crg", z, 0.1, np.linspace(-2, 2, 41), mods={})
    settings = {**SETTINGS, "options": {}}
    inspect.main(tmp_path / "road.crg", repository / "config/vehicles/midsize.yaml", None, settings, tmp_path / "i.nc")
    short = store.read(tmp_path / "i.nc")
    assert short["unevenness"].isnull().all() and short["iri_track"].notnull().all()
    assert short["acceleration_psd"].sel(stage="smoothed").notnull().all()


def test_a_scan_brings_what_was_done_before_the_file_was_written(road, repository, tmp_path, found):
    """The same heights as they came from a scan, and the file of them cleaned: the same report as from the file alone."""
    measured = crg.read(road, interpolation="cubic")
    cleaned, _ = clean.clean(measured, outliers="repair")
    crg.write(tmp_path / "road.crg", cleaned)
    store.write(measured.assign(treated=cleaned.treated), tmp_path / "scan.nc", title="scan")
    settings = {**SETTINGS, "options": {}}
    vehicle = repository / "config/vehicles/midsize.yaml"
    inspect.main(tmp_path / "road.crg", vehicle, tmp_path / "scan.nc", settings, tmp_path / "i.nc")
    again = store.read(tmp_path / "i.nc")
    assert again.attrs["cells_repaired"] == 2
    assert again.attrs["largest_change"] == pytest.approx(found.attrs["largest_change"], abs=1e-4)
    xr.testing.assert_allclose(again["unevenness"], found["unevenness"], rtol=0.01)


@pytest.fixture
def lane(tmp_path):
    """A file of a lane whose reference line is its right edge, smooth but for waves of 2 m and 3 cm around the middle of its right half."""
    u, v = np.arange(round(LENGTH / 0.1) + 1) * 0.1, np.linspace(0, 3.5, 36)
    waves = 0.03 * np.sin(np.pi * u[:, None]) * np.exp(-((v - 1.0) ** 2) / 0.1)
    pycrg.write(tmp_path / "road.crg", waves + np.random.default_rng(3).normal(0, 3e-4, (u.size, v.size)), 0.1, v, mods={})
    return tmp_path / "road.crg"


def test_the_road_is_inspected_in_the_configured_wheel_tracks_and_driven_where_the_runs_are(lane, repository):
    found = {}
    for lateral in (1.75, 2.5):
        settings = {**SETTINGS, "options": {}, "wheel_tracks": [1.0, 2.5], "lateral_position": lateral}
        inspect.main(lane, repository / "config/vehicles/midsize.yaml", None, settings, lane.parent / f"{lateral}.nc")
        found[lateral] = store.read(lane.parent / f"{lateral}.nc")
    rough, smooth = found[1.75].sel(stage="repaired")["iri_track"].values
    assert found[1.75]["track"].values.tolist() == [1.0, 2.5] and rough > 5.0 * smooth > 0.0
    assert found[1.75]["displacement_psd"].notnull().all()
    # The waves lie under the right wheels of the car in the middle of the lane, and beside those of one that keeps to the left.
    shaken, still = (float(found[lateral]["a_z_rms"].sel(stage="repaired")) for lateral in (1.75, 2.5))
    assert shaken > 2.0 * still


def test_of_a_wheel_track_beside_the_road_nothing_is_said(lane, repository):
    settings = {**SETTINGS, "options": {}, "wheel_tracks": [-0.75, 0.75, 1.5], "lateral_position": 1.75}
    inspect.main(lane, repository / "config/vehicles/midsize.yaml", None, settings, lane.parent / "i.nc")
    found = store.read(lane.parent / "i.nc")
    assert found["track"].values.tolist() == [-0.75, 0.75, 1.5] and set(found["class"].values.ravel()) == {""}
    assert all(found[name].isnull().all() for name in ("unevenness", "waviness", "iri_track"))
