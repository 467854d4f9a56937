"""From records to a comparison through the commands that the workflow calls; a mistake leaves nothing behind."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ridecomfort import simulate, store
from ridecomfort.drive import record
from ridecomfort.errors import InputError
from ridecomfort.steps import calibrate, compare, diagnose, measured, realigned
from ridecomfort.steps.command import NOTE
from ridecomfort.vocabulary import CALIBRATED, SIGNALS, STANDARD_GRAVITY
from tests import quarter_cars
from tests.described import undescribed

SIMULATION = {"step": 0.001, "rate": 100}
COLUMNS = {"time": {"column": "t", "unit": "s"}, "v_x": {"column": "v", "unit": "km/h"}, "s": {"column": "s", "unit": "m"}}
COLUMNS |= {name: {"column": name, "unit": "m/s2"} for name in SIGNALS[:3]}
COLUMNS |= {name: {"column": name, "unit": "deg/s"} for name in SIGNALS[3:]}
ENTRY = {"columns": COLUMNS, "lateral_position": 0.0, "sensor": {"behind_front_axle": 1.371, "above_wheel_centres": 0.2}}


@pytest.fixture(scope="module")
def files(tmp_path_factory, repository):
    """A road, and two records made by the study's simulator with a softer front spring."""
    folder = tmp_path_factory.mktemp("site")
    road = quarter_cars.road(length=320.0)
    store.write(road, folder / "road.nc", title="a road")
    car = quarter_cars.vehicle(repository).replace(spring_stiffness_front=22000.0)
    for name, speed in (("fit", 20.0), ("check", 16.0)):
        u = road["u"].values
        run = simulate.run(road, car, speed=xr.DataArray(speed + np.sin(u / 30), {"u": u}, "u"))
        recorded(run).to_csv(folder / f"{name}.csv", index=False)
    return folder


def recorded(run):
    """A run as an instrument records it that feels gravity."""
    table = pd.DataFrame({"t": run["time"], "v": 3.6 * run["v_x"], "s": run["s"], "ahead": run["s"] + 0.9})
    for signal in SIGNALS[:3]:
        table[signal] = run[signal]
    table["a_x"] -= STANDARD_GRAVITY * np.sin(run["pitch"].values)
    table["a_y"] += STANDARD_GRAVITY * np.cos(run["pitch"].values) * np.sin(run["roll"].values)
    table["a_z"] += STANDARD_GRAVITY * np.cos(run["pitch"].values) * np.cos(run["roll"].values)
    for signal in SIGNALS[3:]:
        table[signal] = np.degrees(run[signal])
    return table


@pytest.fixture(scope="module")
def car_file(repository):
    return repository / "config" / "vehicles" / "midsize.yaml"


def test_distances_of_a_point_ahead_are_told_on_the_screen_and_in_the_file(files, car_file, capsys):
    columns = COLUMNS | {"s": {"column": "ahead", "unit": "m"}}
    entries = [ENTRY | {"columns": columns, "name": name, "role": name} for name in ("fit", "check")]
    config = {"site": "here", "drives": entries, "simulation": SIMULATION, "alignment": {"search": 0.5}}
    drives = [files / "fit.csv", files / "check.csv"]
    measured.main(files / "road.nc", car_file, drives, config, files / "ahead.nc", workers=1)
    told = store.read(files / "ahead.nc").attrs["distance_doubt"]
    assert "s looks like the distance of a point 0.9" in told and f"{NOTE}here: {told}" in capsys.readouterr().err


def test_what_was_done_to_a_record_is_told_on_the_screen(files, car_file, tmp_path, capsys):
    table = pd.read_csv(files / "fit.csv")
    table.loc[(table["t"] > 7.0) & (table["t"] < 8.0), "s"] = np.interp(7.0, table["t"], table["s"])
    table.to_csv(tmp_path / "stood.csv", index=False)
    config = {"site": "here", "drives": [ENTRY | {"name": "one"}], "simulation": SIMULATION, "alignment": {"search": 0.5}}
    measured.main(files / "road.nc", car_file, [tmp_path / "stood.csv"], config, tmp_path / "measured.nc", workers=1)
    assert f"{NOTE}here: one: s, which stands still while the vehicle drives on, interpolated there" in capsys.readouterr().err


@pytest.mark.parametrize("rows", [slice(None), slice(300, 1200)], ids=["again", "cut"])
def test_a_record_under_two_names_is_refused_by_its_samples(files, car_file, tmp_path, rows):
    """A second export of one record, with other digits in another column, from its beginning or cut, and a clock of its own."""
    table = pd.read_csv(files / "fit.csv").iloc[rows]
    table.assign(t=table["t"] - table["t"].iloc[0], ahead=0.0).to_csv(tmp_path / "copy.csv", index=False)
    entries = [ENTRY | {"name": "one"}, ENTRY | {"name": "two", "role": "check"}]
    config = {"site": "here", "drives": entries, "simulation": SIMULATION, "alignment": {"search": 0.5}}
    drives = [files / "fit.csv", tmp_path / "copy.csv"]
    with pytest.raises(InputError) as problem:
        measured.main(files / "road.nc", car_file, drives, config, tmp_path / "measured.nc", workers=1)
    assert str(problem.value).startswith(f"{drives[1]}: a_z: is that of {drives[0]}, expected a record once")
    assert not (tmp_path / "measured.nc").exists()


def test_a_fitted_record_is_not_held_out_on_another_site():
    """Another export of it, with a gain and cut at both ends, beside a drive of its own."""
    time, random = np.arange(6000) / 100.0, np.random.default_rng(3)
    driven = lambda signal, name: xr.Dataset({"a_z": ("time", signal)}, {"time": time[: signal.size]}, {"name": name})
    one, other = (np.cumsum(random.standard_normal(6000)) for _ in range(2))
    site = lambda *drives: (None, record.stack(list(drives)))
    sites = {"first": site(driven(one, "fit")), "second": site(driven(other, "own"), driven(1.01 * one[300:5000], "again"))}
    with pytest.raises(InputError, match="^second: drive again: a_z: is the record of first fit, expected one that nothing is fitted to$"):
        diagnose.check_once(sites, ["first"])
    diagnose.check_once({**sites, "second": site(driven(other, "own"))}, ["first"])


def test_records_are_aligned_fitted_and_compared(files, car_file, capsys):
    entries = [ENTRY | {"name": name, "role": name} for name in ("fit", "check")]
    common = {"road": files / "road.nc", "vehicle": car_file}
    config = {"site": "here", "drives": entries, "simulation": SIMULATION, "alignment": {"search": 0.5}}
    measured.main(**common, drives=[files / "fit.csv", files / "check.csv"], config=config, workers=2, output=files / "measured.nc")
    drives = store.read(files / "measured.nc")
    assert list(drives["drive"].values) == ["fit", "check"]
    assert drives["clock_offset"].attrs["units"] == "s" and (abs(drives["clock_offset"]) < 5e-4).all()
    assert drives.attrs["distance_doubt"] == ""

    model = {"site": "here", "effects": {}, "effects_folder": None, "simulation": SIMULATION}
    settings = {"bounds": {}, "signals": list(SIGNALS), "tolerance": 1e-4, "restarts": 0, "seed": 1, "applied": "joint"}
    common["measured"] = files / "measured.nc"
    settings["profiles"] = ["top_mount.stiffness_front"]  # of an effect that this model has not
    calibrate.main(**common, config=model | {"calibration": settings}, workers=2, output=files / "calibration.nc")
    found = store.read(files / "calibration.nc")
    assert "profile" not in found.dims
    assert list(found["parameter"].values) == list(CALIBRATED) and found.attrs["calibrated_on"] == "here"
    assert float(found["value"][0]) == pytest.approx(22000.0, rel=0.03)

    # With an effect more there is a further start, from the calibration without it.
    lag = model | {"effects": {"steering_lag": {}}, "calibration": settings | {"sequence": False, "profiles": [], "bounds": {}}}
    calibrate.main(**common, config=lag, workers=2, output=files / "lag.nc", below=files / "calibration.nc")
    assert store.read(files / "lag.nc").sizes["restart"] == 2
    notes = [line for line in capsys.readouterr().err.splitlines() if NOTE in line]
    assert len(notes) == 1 and "one start only" in notes[0], "of the first, which had no other"

    # Starts that disagree are for the person who waits, too, and for the ladder.
    astray = lag["calibration"] | {"start": [{}, {"spring_stiffness_front": 15000.0}], "tolerance": 0.5}
    calibrate.main(**common, config=lag | {"calibration": astray}, workers=2, output=files / "astray.nc")
    starts = store.read(files / "astray.nc").attrs["starts"]
    assert starts.startswith("starts disagree") and f"{NOTE}{starts}" in capsys.readouterr().err

    model |= {"noise_density": {}}
    compare.main(**common, calibration=files / "calibration.nc", config=model, output=files / "comparison.nc", workers="1")
    compared = store.read(files / "comparison.nc")
    nrmse = compared["nrmse"].sel(signal="pitch_rate")
    assert (nrmse.sel(state="calibrated") < 0.3 * nrmse.sel(state="reference")).all()
    for file in ("measured", "calibration", "lag", "comparison"):
        assert undescribed(store.read(files / f"{file}.nc")) == []
    assert compared.attrs["located_state"] == "calibrated" and "words" in compared.attrs
    assert compared.attrs["starts"] == found.attrs["starts"] and found.attrs["starts"].startswith("one start only")

    # Without a calibration the effects of a model are compared as they are, beside the vehicle without them.
    friction = model | {"effects": {"suspension_friction": {}}}
    compare.main(**common, calibration=None, config=friction, output=files / "comparison.nc", workers="1")
    assert list(store.read(files / "comparison.nc")["state"].values) == ["reference", "with_effects"]
    assert capsys.readouterr().err.count(NOTE) == 1, "that nothing was calibrated"

    # On another site, of drives that were not repeated, the floor is nil where those of the first were not repeated either.
    other = model | {"site": "there"}
    (files / "first.nc").write_bytes((files / "comparison.nc").read_bytes())
    compare.main(**common, calibration=files / "calibration.nc", elsewhere=files / "first.nc", config=other, output=files / "comparison.nc", workers="1")
    assert "nil" in store.read(files / "comparison.nc").attrs["floor"]

    # A wrong sign is for the person who waits, too, and that nothing is held out.
    assert NOTE not in capsys.readouterr().err
    store.write(drives.load().isel(drive=[0]), files / "fitted.nc", title="Without another", configuration={})
    alone = common | {"measured": files / "fitted.nc"}
    compare.main(**alone, calibration=files / "calibration.nc", config=model, output=files / "comparison.nc", workers="1")
    assert f"{NOTE}here: no drive is held out here (role: check)" in capsys.readouterr().err
    compare.main(**alone, calibration=files / "calibration.nc", config=model | {"site": "there"}, output=files / "comparison.nc", workers="1")
    assert NOTE not in capsys.readouterr().err, "nothing is fitted to the drives of a site that is calibrated on another"
    turned = drives.load()
    turned["pitch_rate"] *= -1.0
    store.write(turned, files / "turned.nc", title="Turned", configuration={})
    compare.main(**common | {"measured": files / "turned.nc"}, calibration=None, config=model, output=files / "comparison.nc", workers="1")
    assert f"{NOTE}here: pitch_rate runs against the model" in capsys.readouterr().err


@pytest.fixture(scope="module")
def late(files, repository, tmp_path_factory):
    """The records of a car with soft top mounts, and the configuration of a model that has them."""
    folder, mounts = tmp_path_factory.mktemp("late"), {"top_mount": {"front": 3e-6, "rear": 3e-6}}
    road = store.read(files / "road.nc")
    for name, speed in (("fit", 20.0), ("check", 16.0)):
        u = road["u"].values
        run = simulate.run(road, quarter_cars.vehicle(repository), speed=xr.DataArray(speed + np.sin(u / 30), {"u": u}, "u"), effects=mounts)
        recorded(run).to_csv(folder / f"{name}.csv", index=False)
    entries = [ENTRY | {"name": name, "role": name} for name in ("fit", "check")]
    calibration = {"bounds": {}, "signals": list(SIGNALS), "tolerance": 1e-4, "restarts": 0, "seed": 1, "applied": "sequence", "profiles": ["top_mount.front"]}
    model = {"site": "here", "effects": {"top_mount": {}}, "effects_folder": None, "simulation": SIMULATION, "calibration": calibration}
    return folder, model | {"drives": entries, "alignment": {"search": 0.5}}


def test_what_alignment_for_a_model_finds_anew_is_told():
    drives = lambda *faults: xr.Dataset({"faults": ("drive", list(faults))}, {"drive": ["one", "two"]})
    before, after = drives("a_z: it clips", ""), drives("a_z: it clips; alignment does not settle", "")
    assert realigned.new_faults(before, after) == ["one: alignment does not settle"]
    assert realigned.new_faults(after, before) == []


def test_what_an_effect_does_late_is_no_error_of_a_clock_once_the_model_has_it(files, late, car_file, capsys):
    folder, config = late
    drives = {"road": files / "road.nc", "vehicle": car_file, "drives": [folder / "fit.csv", folder / "check.csv"], "workers": 2}
    base = {key: config[key] for key in ("site", "drives", "simulation", "alignment")}
    measured.main(**drives, config=base, output=folder / "measured.nc")
    fitted = {"road": files / "road.nc", "vehicle": car_file, "workers": 2, "output": folder / "base.nc"}
    calibrate.main(**fitted, measured=folder / "measured.nc", config=config | {"effects": {}})
    own = {**drives, "before": folder / "measured.nc", "below": folder / "base.nc", "config": config, "output": folder / "own.nc"}
    realigned.main(**own)
    before, after = (store.read(folder / f"{name}.nc") for name in ("measured", "own"))
    assert (before["clock_offset"] > 1.5e-3).all(), "recorded without an error of the clock: the delay passes for one"
    assert (abs(after["clock_offset"]) < 0.2 * before["clock_offset"]).all()
    assert undescribed(after) == [] and list(after["drive"].values) == ["fit", "check"]

    # The base model is aligned for as well, from its calibrated vehicle.
    realigned.main(**own | {"below": None, "config": config | {"effects": {}}, "output": folder / "aligned.nc"})
    base = store.read(folder / "aligned.nc")["clock_offset"]
    assert (base > 0.5 * before["clock_offset"]).all() and not np.array_equal(base, before["clock_offset"])

    # A site that is calibrated on another takes the sizes from there.
    calibrate.main(**fitted | {"output": folder / "there.nc"}, measured=folder / "own.nc", config=config | {"calibration": config["calibration"] | {"applied": "joint"}})
    elsewhere = own | {"below": None, "calibration": folder / "there.nc", "config": config | {"calibration": None}}
    realigned.main(**elsewhere)
    assert (abs(store.read(folder / "own.nc")["clock_offset"]) < 0.2 * before["clock_offset"]).all()

    # Where drives cannot be aligned for a model, that is said, and they stay as they are.
    table = pd.read_csv(folder / "fit.csv")
    table["s"] = np.interp(table["t"] + 0.1, table["t"], table["s"])
    table.to_csv(folder / "ahead.csv", index=False)
    capsys.readouterr()
    ahead = {"drives": [folder / "ahead.csv", folder / "check.csv"], "config": elsewhere["config"] | {"alignment": {"search": 0.05}}}
    realigned.main(**elsewhere | ahead)
    assert f"{NOTE}here: drives stay as they were aligned before, since for top_mount" in capsys.readouterr().err
    xr.testing.assert_identical(store.read(folder / "own.nc")["s"], before["s"])
    assert store.read(folder / "own.nc").attrs["alignment_doubt"] and store.read(folder / "aligned.nc").attrs["alignment_doubt"] == ""


def backwards(table):
    table.loc[200:, "t"] -= 1.0
    return table


def mislabelled(table):
    """Speeds in m/s that the site file calls km/h."""
    table["v"] /= 3.6
    return table


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (backwards, "line 202, column 't': the clock does not advance"),
        (lambda table: table.iloc[:25], "drive bad: lasts 0.25 s"),
        (mislabelled, "v_x: recorded speed times 3.6"),
    ],
)
def test_a_bad_record_ends_the_step_with_one_line_and_no_file(files, car_file, tmp_path, change, said):
    change(pd.read_csv(files / "fit.csv")).to_csv(tmp_path / "bad.csv", index=False)
    config = {"site": "here", "drives": [ENTRY], "simulation": SIMULATION, "alignment": {"search": 0.5}}
    output = tmp_path / "out" / "measured.nc"
    words = ["--road", files / "road.nc", "--vehicle", car_file, "--drives", tmp_path / "bad.csv", "--output", output]
    command = [sys.executable, "-m", "ridecomfort.steps.measured", *map(str, words), "--config", json.dumps(config), "--workers", "2"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith(f"error: {tmp_path / 'bad.csv'}: {said}")
    assert not output.parent.exists()
