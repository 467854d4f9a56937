"""Whether signals of an instrument have the wrong sign."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from ridecomfort import simulate
from ridecomfort.drive import align, mounting, path, record, signs
from ridecomfort.drive.replay import replay
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars
from tests.blind import trials
from tests.quarter_cars import LATERAL

OPTIONS = {"step": 0.001}

MIRRORED = {
    "right": ("a_y", "pitch_rate", "yaw_rate"),
    "left-handed and right": ("a_y", "roll_rate", "yaw_rate"),
    "backward": ("a_x", "pitch_rate", "yaw_rate"),
    "left-handed": ("roll_rate", "pitch_rate", "yaw_rate"),
    "two rates": ("roll_rate", "pitch_rate"),
    "one": ("roll_rate",),
}
"""Signals that an instrument of another convention, or a mistaken table, tells with the other sign."""


@pytest.fixture(scope="module", params=[1, 2])
def driven(request, repository):
    """A road, a nominal car, and a drive of another one, both whole cars."""
    road = trials.a_road(np.random.default_rng(request.param))
    course, car, u = simulate.prepare(road), quarter_cars.vehicle(repository), road["u"].values
    speed, lateral = 20.0 + 2.0 * np.sin(2 * np.pi * u / 250), 0.13 + 0.05 * np.sin(2 * np.pi * u / 170)
    asked = {name: xr.DataArray(values, {"u": u}, "u") for name, values in (("speed", speed), ("lateral", lateral))}
    run = simulate.run(course, quarter_cars.other(car), **asked, **OPTIONS)
    run = run.isel(time=(run["time"] >= run["time"][0] + 2.0).values)
    return course, car, run.assign_coords(time=run["time"] - run["time"][0])


def told(run, late=0, known=True, gravity=True, turned=0.0, reversed_signals=()):
    """A record of a run with noise, whose instrument is ``turned`` (deg) in yaw, its place so many samples ``late``."""
    rng, time = np.random.default_rng(3), run["time"].values
    values = np.stack([run[name].values for name in SIGNALS])
    if gravity:
        values[:3] = record.specific_force(values[:3], run["roll"].values, run["pitch"].values)
    back = Rotation.from_rotvec([0.0, 0.0, np.radians(turned)]).inv().as_matrix()
    values = np.concatenate([back @ values[:3], back @ values[3:]])
    values += np.array([0.03] * 3 + [0.001] * 3)[:, None] * rng.standard_normal(values.shape)
    quantities = {name: (time, (-1.0 if name in reversed_signals else 1.0) * row) for name, row in zip(SIGNALS, values)}
    shift = time + 0.01 * late
    quantities |= {name: (shift, run[name].values) for name in ("s", "v_x", "e")[: 3 if known else 2]}
    return record.from_arrays(quantities, gravity=gravity, name="own")


def found(driven, **spoilt):
    course, car, run = driven
    return signs.against(mounting.level(told(run, **spoilt)), course, car, simulate.run, OPTIONS)


@pytest.mark.parametrize("spoilt", [{}, {"late": 37}, {"late": -150}, {"known": False}, {"gravity": False}, {"turned": 40.0}], ids=str)
def test_signals_of_the_right_sign_are_not_told(driven, spoilt):
    assert found(driven, **spoilt) == {}


@pytest.mark.parametrize("which", MIRRORED)
@pytest.mark.parametrize("spoilt", [{}, {"late": 37}, {"known": False}], ids=str)
def test_signals_of_the_wrong_sign_are_told_whatever_the_clock_and_the_path(driven, which, spoilt):
    wrong = found(driven, reversed_signals=MIRRORED[which], **spoilt)
    assert tuple(wrong) == MIRRORED[which] and max(wrong.values()) < -0.6


def test_axes_that_point_down_and_to_the_right_are_told_where_gravity_does_not(driven):
    names = ("a_y", "a_z", "pitch_rate", "yaw_rate")
    wrong = found(driven, gravity=False, reversed_signals=names)
    assert tuple(wrong) == names and "as where the y axis points to the right and the z axis points down" in signs.words(wrong)


@pytest.mark.parametrize("turned", [90.0, 135.0, 180.0, -150.0])
def test_an_instrument_that_is_turned_is_no_matter_of_signs(driven, turned):
    assert found(driven, turned=turned) == {}
    assert tuple(found(driven, turned=turned, reversed_signals=("yaw_rate",))) == ("yaw_rate",)


def test_a_drive_on_another_road_tells_nothing(driven):
    course, car, run = driven
    other = simulate.prepare(trials.a_road(np.random.default_rng(77)))
    for known in (True, False):
        assert signs.against(mounting.level(told(run, known=known)), other, car, simulate.run, OPTIONS) == {}


@pytest.mark.parametrize("which", ["right", "two rates"])
def test_clock_path_and_mounting_are_those_of_the_right_signs(driven, which):
    course, car, run = driven
    aligned = align.align(told(run, late=12, reversed_signals=MIRRORED[which]), course, car, simulate=simulate.run, options=OPTIONS)
    assert aligned.attrs["clock_offset"] == pytest.approx(-0.12, abs=1e-3)
    assert aligned.attrs["lateral_position"] == pytest.approx(float(run["e"].mean()), abs=0.02)
    assert abs(np.degrees(aligned.attrs["mounting_yaw"])) < 0.3
    (said,) = aligned.attrs["faults"].split("; ")
    assert said.startswith(f"{', '.join(MIRRORED[which])} run against the model (correlation -") and "change the sign of `factor`" in said


def test_the_record_keeps_the_signs_that_it_has(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL)
    right, wrong = (
        align.align(one, road, nominal, simulate=quarter_cars.run) for one in (recorded, recorded.assign(roll_rate=-recorded["roll_rate"]))
    )
    np.testing.assert_allclose(wrong["roll_rate"], -right["roll_rate"], atol=1e-9)
    assert wrong.attrs["roll_rate_bias"] == pytest.approx(-right.attrs["roll_rate_bias"], abs=1e-9)
    assert wrong.attrs["clock_offset"] == pytest.approx(right.attrs["clock_offset"], abs=1e-9)


def test_words_name_signals_and_what_to_change():
    assert signs.words({}) == ""
    said = signs.words({"roll_rate": -0.9})
    assert said == (
        "roll_rate runs against the model (correlation -0.90): is its sign wrong, as where turning is counted the other way round "
        "(if so, change the sign of `factor` under `columns`); if all drives say so, are left and right of the road's file exchanged?"
    )
    assert "road's file" in signs.words({"a_y": -0.9, "yaw_rate": -1.0}) and "road's file" not in signs.words({"pitch_rate": -0.9, "roll_rate": -0.9})


@pytest.mark.parametrize(("banked", "sloping"), [(0.08, 0.0), (0.0, 0.05)], ids=["bank", "grade"])
def test_a_bank_or_a_grade_that_the_road_file_has_not_is_no_wrong_sign(repository, banked, sloping):
    """Of what is slow in a_y or a_x it makes more than the bends and the pedals do; what is fast goes with the model."""
    levelled = trials.a_road(np.random.default_rng(1))
    u, v = levelled["u"], levelled["v"]
    levelled = levelled.assign(curvature=0.0025 * np.sin(2 * np.pi * u / 350))
    bank, grade = (share * np.sin(2 * np.pi * u / length) for share, length in ((banked, 350), (sloping, 400)))
    hills = grade.cumsum() * float(u[1] - u[0])
    road = levelled.assign(elevation=(levelled["elevation"] + hills - bank * v).transpose("u", "v"))
    car = quarter_cars.vehicle(repository)
    speed = np.sqrt((11.0 if banked else 20.0) ** 2 - 1.2 * 9.81 * (hills - hills.mean()))
    run = simulate.run(simulate.prepare(road), quarter_cars.other(car), speed=speed, lateral=xr.full_like(u, 0.13), **OPTIONS)
    run = run.isel(time=(run["time"] >= run["time"][0] + 2.0).values)
    record_of_it, course = mounting.level(told(run.assign_coords(time=run["time"] - run["time"][0]))), simulate.prepare(levelled)
    again = replay(path.part(record_of_it), course, simulate.run, options=OPTIONS)
    lags, each, _ = signs._correlations(again, again(car))
    assert each[SIGNALS.index("a_y" if banked else "a_x"), np.abs(lags).argmin()] < -signs.AGAINST  # what is slow alone would tell a sign
    assert signs.against(record_of_it, course, car, simulate.run, OPTIONS) == {}


def test_an_acceleration_alone_may_as_well_be_told_of_another_place():
    assert signs.words({"a_x": -0.8}).endswith(", or is the place of the sensor wrong?")
    assert "place" not in signs.words({"a_x": -0.8, "pitch_rate": -0.9, "yaw_rate": -0.9})
