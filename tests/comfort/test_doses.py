"""Doses of runs over a stretch of road, in the step that weights them."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.comfort import doses, weighting
from ridecomfort.comfort.seat import Seat
from ridecomfort.errors import InputError
from ridecomfort.steps import space

CONFIG = {
    "site": "ts1",
    "space": {"spacing": 0.25, "run_in": 50, "run_out": 25},
    "iso2631": {
        "time_constant": 1, "averaging": "linear", "weightings": ["Wd", "Wd", "Wk"], "factors": [1, 1, 1], "seat": None
    },
}  # fmt: skip
FREQUENCY = 8.0


@pytest.fixture
def files(tmp_path):
    """A road of 390 m and a shard of two runs at 10 and 11 m/s, shaken by sines of 1 m/s2 on every axis."""
    time, speeds = np.arange(4000) / 100.0, np.array([[10.0], [11.0]])
    wave = np.tile(np.sin(2 * np.pi * FREQUENCY * time), (2, 1))
    values = {"s": speeds * time, "v_x": speeds + 0 * time, "a_x": wave, "a_y": wave, "a_z": wave}
    drives = xr.Dataset({name: (("run", "time"), each.astype(np.float32)) for name, each in values.items()})
    drives = drives.where(drives["s"] < 396.0).assign_coords(run=[3, 4], time=time)
    store.write(drives, tmp_path / "both.nc", title="drives")
    store.write(drives.isel(run=[1]), tmp_path / "one.nc", title="drives")
    store.write(xr.Dataset(coords={"u": np.arange(0.0, 390.1, 0.1)}), tmp_path / "road.nc", title="road")
    return tmp_path


def spaced(folder, name, **iso2631) -> xr.Dataset:
    config = {**CONFIG, "iso2631": {**CONFIG["iso2631"], **iso2631}}
    space.main(drives=folder / f"{name}.nc", road=folder / "road.nc", config=config, output=folder / "space.nc")
    return store.read(folder / "space.nc")


def test_sines_have_the_doses_of_their_closed_forms(files):
    """A sine of amplitude A over T: rms A / sqrt(2), VDV (3/8 A^4 T)^1/4."""
    found = spaced(files, "both")
    factors = np.array([weighting.named(name).factor(FREQUENCY) for name in ("Wd", "Wd", "Wk")])
    assert found["weighted_rms"].dims == ("run", "axis") and found["axis"].values.tolist() == list(doses.AXES)
    assert found["weighted_rms"].values == pytest.approx(np.tile(factors, (2, 1)) / np.sqrt(2), rel=2e-3)
    assert found["duration"].values == pytest.approx([315 / 10, 315 / 11], abs=0.02)
    assert found["mtvv"].values == pytest.approx(found["weighted_rms"].values, rel=5e-3)
    assert found["crest_factor"].values == pytest.approx(np.sqrt(2), rel=5e-3)
    assert found["vdv"].values == pytest.approx(factors * (0.375 * found["duration"].values[:, None]) ** 0.25, rel=2e-3)


def test_what_nobody_feels_has_no_crest_factor(files):
    drives = store.read(files / "both.nc")
    flat = drives["a_y"] * 0.0
    flat[:, 2000] = 1e-12
    store.write(drives.assign(a_y=flat), files / "flat.nc", title="drives")
    crest = spaced(files, "flat")["crest_factor"]
    assert np.isnan(crest.sel(axis="a_y")).all() and np.isfinite(crest.sel(axis=["a_x", "a_z"])).all()


@pytest.mark.parametrize("averaging, enough, too_long", [("linear", 4.5, 4.6), ("exponential", 1.5, 4.6 / 3)])
def test_a_run_in_must_let_the_running_rms_settle(files, averaging, enough, too_long):
    """50 m at 11 m/s are 4.55 s; of steady vibration an exponential mean knows 95 % of the power after three time constants."""
    found = spaced(files, "both", averaging=averaging, time_constant=enough)
    assert float(found["a_v"].isel(s=0).min() / found["a_v"].isel(s=-1).min()) == pytest.approx(1.0, abs=0.06)
    with pytest.raises(InputError, match=r"both.nc: a run-in is driven in 4.5\d s, expected 4.6 s or more"):
        spaced(files, "both", averaging=averaging, time_constant=too_long)


def test_a_drive_that_begins_behind_the_run_in_is_told_of_its_place_and_not_of_its_pace(files):
    late = store.read(files / "one.nc")
    store.write(late.assign(s=late["s"] + 60.0).drop_attrs(), files / "late.nc", title="drives")
    with pytest.raises(InputError, match=r"run 4: covers 60.0 to 45\d.\d m, expected 50.0 to"):
        spaced(files, "late")


def test_a_drive_that_never_comes_out_of_the_run_in_is_said_to_have_stopped(files):
    drives = store.read(files / "both.nc").load()
    drives["s"][0] = np.minimum(drives["s"][0], 40.0)
    store.write(drives, files / "stopped.nc", title="drives")
    with pytest.raises(InputError, match="covers 0.0 to 40.0 m, expected 50.0 to"):
        spaced(files, "stopped")


def test_a_run_is_the_same_in_whatever_shard(files):
    both, one = (spaced(files, name).drop_attrs() for name in ("both", "one"))
    assert both.sel(run=[4]).identical(one)


def test_sickness_is_of_slow_vertical_motion():
    """0.2 Hz of 1 m/s2 for 200 s: Wf lets 0.2 Hz through with its factor; MSDV a_w sqrt(T)."""
    time = np.arange(40_000) / 100.0
    counted = doses.Doses(10.0 * time[None], 100.0, 1000.0, 3000.0)
    counted.vertical(np.sin(2 * np.pi * 0.2 * time)[None])
    found = counted.dataset([0])
    factor = float(weighting.named("Wf").factor(0.2))
    assert found["duration"].item() == pytest.approx(200.0, abs=0.02)
    assert found["msdv_z"].item() == pytest.approx(factor / np.sqrt(2) * np.sqrt(200.0), rel=1e-3)


def test_a_seat_isolates_above_its_natural_frequency(files):
    """What comes through is its transmissibility at 8 Hz, along z alone."""
    chair = {"natural_frequency": 4.0, "damping_ratio": 0.3}
    floor, seat = (spaced(files, "both", seat=seat)["weighted_rms"].values for seat in (None, chair))
    assert seat[:, 2] / floor[:, 2] == pytest.approx(abs(Seat(**chair).response(FREQUENCY)), rel=2e-3)
    assert np.array_equal(seat[:, :2], floor[:, :2])
