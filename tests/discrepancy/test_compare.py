"""Errors between model and measurement: by closed forms, and over drives that another simulator made."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import calibrated, simulate
from ridecomfort.discrepancy import compare
from ridecomfort.drive import readers, record
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import braked, quarter_cars


def test_rmse_and_nrmse_of_a_sine_against_zero():
    wave = 3.0 * np.sin(2 * np.pi * np.arange(1000) / 100)
    assert compare.rmse(wave) == pytest.approx(3.0 / np.sqrt(2))
    assert compare.nrmse(wave, wave) == pytest.approx(1 / (2 * np.sqrt(2)))


def test_samples_that_are_not_compared_count_in_neither():
    residual, measured = np.full(100, np.nan), np.linspace(0, 10, 100)
    residual[50:] = 2.0
    assert compare.rmse(residual) == 2.0
    assert compare.nrmse(residual, measured) == pytest.approx(2.0 / np.ptp(measured[50:]))


def test_a_signal_that_is_constant_has_no_range_to_be_compared_with():
    assert np.isnan(compare.nrmse(np.ones((1, 10)), np.full((1, 10), 3.0))).all()


@pytest.fixture(scope="module")
def road():
    return quarter_cars.road(length=400.0)


def measured(road, vehicle, folder, *, role="fit", lateral=0.0, clock=0.0):
    """A drive as another simulator hands it over: a NetCDF file of the drive schema."""
    speed = xr.DataArray(18 + np.sin(road["u"].values / 20), {"u": road["u"]}, "u")
    run = quarter_cars.run(road, vehicle, speed=speed, lateral=lateral, end=390.0)
    late = np.interp(run["time"] - clock, run["time"], run["s"])
    run = run.assign(s=("time", late)).isel(time=(run["s"] > 40).values)
    run = run.assign_coords(time=run["time"] - run["time"][0])
    run.assign_attrs(role=role, name=f"{role}ted").to_netcdf(folder / f"{role}.nc")
    return readers.read(folder / f"{role}.nc")


@pytest.fixture(scope="module")
def result(road, nominal, tmp_path_factory):
    folder = tmp_path_factory.mktemp("drives")
    true = nominal.replace(damping_front=1500.0)
    drives = [measured(road, true, folder), measured(road, true, folder, role="check", lateral=0.2)]
    states = {"reference": (nominal, {}), "calibrated": (true, {})}
    return compare.compare(record.stack(drives), road, states, simulate=quarter_cars.run)


def test_the_right_vehicle_leaves_less_than_the_nominal_one(result):
    shaken = result["nrmse"].sel(signal=["a_z", "pitch_rate"])
    assert (shaken.sel(state="calibrated") < 0.15 * shaken.sel(state="reference")).all()


def test_every_error_follows_from_the_residual_beside_it(result):
    again = np.sqrt((result["residual"] ** 2).mean("time"))
    xr.testing.assert_allclose(again.drop_attrs(), result["rmse"].drop_attrs())
    shown = result["residual"].isel(state=0).notnull()
    span = result["measured"].where(shown).max("time") - result["measured"].where(shown).min("time")
    expected = result["rmse"] / span
    np.testing.assert_allclose(result["nrmse"], expected.transpose(*result["nrmse"].dims))
    np.testing.assert_allclose(result["simulated"], (result["measured"] + result["residual"]).transpose(*result["simulated"].dims))


def test_both_drives_are_compared_and_keep_their_roles(result):
    assert list(result["signal"].values) == list(SIGNALS)
    assert list(result["role"].values) == ["fit", "check"]
    assert result["nrmse"].notnull().all()


def test_each_state_is_compared_at_its_own_best_clock(road, nominal, tmp_path):
    drive = measured(road, nominal, tmp_path, clock=-0.0008)
    found = compare.compare([drive], road, {"reference": (nominal, {})}, simulate=quarter_cars.run)
    assert found["clock_correction"].item() == pytest.approx(0.0008, abs=1e-4)
    assert found["nrmse"].sel(signal="a_z").item() < 0.01


def test_no_state_is_forgiven_more_than_alignment_may_be_off_by(road, nominal, tmp_path):
    drive = measured(road, nominal, tmp_path, clock=-0.004)
    found = compare.compare([drive], road, {"reference": (nominal, {})}, simulate=quarter_cars.run)
    assert found["clock_correction"].item() == pytest.approx(0.001)


def test_a_distance_that_jitters_is_no_noise_of_the_signals(road, nominal, tmp_path):
    """What a wrong vehicle gets wrong is the same in both repeats, though their places jitter by 0.1 m from sample to sample."""
    drive, random = measured(road, nominal.replace(damping_front=1500.0), tmp_path), np.random.default_rng(5)
    repeats = [drive.assign(s=drive["s"] + 0.1 * random.standard_normal(drive.sizes["time"])).assign_attrs(name=name) for name in ("one", "two")]
    found = compare.compare(repeats, road, {"reference": (nominal, {})}, simulate=quarter_cars.run)
    assert (np.diff(found["s"].values) > 0).all()
    share = found["floor_rmse"] / found["rmse"].isel(state=0)
    assert (share.sel(signal=["roll_rate", "pitch_rate"]) < 0.15).all() and (share.drop_sel(signal="a_x") < 0.4).all()
    assert (found["rmse"].sel(signal="a_x") < 0.005).all()  # of which dampers change nothing


@pytest.mark.parametrize("place", [190.0, 340.0, 500.0, 690.0])
def test_a_record_that_ends_while_its_speed_changes_is_no_worse_there_than_one_that_goes_on(repository, place):
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    drive, _ = braked.drive(course := braked.course(), car)
    cut = drive.isel(time=slice(0, int(np.searchsorted(drive["s"], place))))
    ended, whole = (
        compare.compare([one], course, {"reference": (car, {})}, simulate=simulate.run)["residual"].sel(signal="a_x").squeeze() for one in (cut, drive)
    )
    kept = np.flatnonzero(ended.notnull())
    assert ended[kept[-25:]].std() < 2.0 * max(whole[kept[-25:]].std(), whole.std())


def test_of_a_drive_that_has_less_than_its_last_second_half_is_compared(repository):
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    drive, _ = braked.drive(course := braked.course(), car)
    short = drive.isel(time=slice(0, int(np.searchsorted(drive["s"], drive["s"][0] + 69.0))))
    found = compare.compare([short], course, {"reference": (car, {})}, simulate=simulate.run)
    assert 0.2 < 0.01 * found["residual"].sel(signal="a_x").notnull().sum() < 0.6 and found["rmse"].notnull().all()


def test_without_a_calibration_nothing_is_changed(nominal):
    assert calibrated.apply(None, nominal, {"payload": {"mass": 100.0}}) == (nominal, {"payload": {"mass": 100.0}})
