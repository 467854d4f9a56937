"""Records of one site share its blocks of road, at whatever speed they were driven."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.ndimage import gaussian_filter1d

from ridecomfort.calibrate import BOUNDS
from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import floor, opening, refit
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.span import taken_apart
from ridecomfort.drive.sampling import low_pass
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters

RATE, ROAD = 50.0, 1500.0
SIZE = Size("effect.size", "N", 0.0, -50.0, 50.0, 1.0)


def records(*speeds, cut_offs=(25.0, 25.0, 25.0, 25.0)):
    """Those of drives of one site at these speeds (m/s), cut off at these frequencies (Hz)."""
    replays = []
    for number, (speed, cut_off) in enumerate(zip(speeds, cut_offs)):
        time = np.arange(int(ROAD / speed * RATE)) / RATE
        drive = xr.Dataset({"e": ("time", np.zeros(time.size))}, {"time": time}, {"name": f"drive {number}", "cut_off": cut_off})
        replays.append(SimpleNamespace(drive=drive, place=speed * time, time=time, compared=np.ones(time.size, bool)))
    site = opening.Site("road", None, [again.drive for again in replays])
    return opening._records([site], ["road"], replays, {})


def told(seed, own):
    """The interval of an effect that is not there, beside an error of another that all drives meet at equal place."""
    random, place = np.random.default_rng(seed), np.arange(0.0, ROAD + 1.0, 0.1)
    error, effect = (gaussian_filter1d(random.standard_normal(place.size), 4) for _ in range(2))
    at = lambda line: {index: np.interp(record.place, place, line)[None] for index, record in enumerate(own)}
    experiment = SimpleNamespace(records=own, channels=("a_z",), each_record=map, inexact={}, free=())
    residuals = {index: part + 0.02 * random.standard_normal(part.shape) for index, part in at(error).items()}
    flat = {index: taken_apart(np.full((1, *part.shape), 1e-3)) for index, part in residuals.items()}
    frame = exp.frame(experiment, residuals, flat)
    column, white = frame.flat(at(effect)), frame.flat(residuals)
    amount = -(column @ white) / (column @ column)
    left = {index: part + amount * at(effect)[index] for index, part in residuals.items()}
    fit = refit.Fit({SIZE.key: amount}, left, (SIZE.key,), column[None], 0.0)
    return refit.intervals(fit, frame, [SIZE])[SIZE.key]


def test_a_place_lies_in_the_same_block_at_any_speed_and_a_block_lasts_a_second_at_the_highest():
    slow, fast = records(16.0, 24.0)
    place = np.arange(12.0, ROAD - 24.0, 24.0)
    number = lambda record: np.interp(place, record.place, record.blocks())
    assert np.array_equal(number(slow), number(fast))
    assert slow.block == fast.block and abs(fast.block - 24.0 * opening.BLOCK) < 0.1


def test_an_error_that_drives_at_several_speeds_share_is_not_evidence_from_each_of_them():
    """Nine in ten intervals of an effect that is not there hold nil; of blocks of each drive's own length, six in ten would."""
    own = [replace(record, lowest=()) for record in records(12.0, 16.0, 20.0, 24.0)]  # of a single signal
    held = [lower <= 0.0 <= upper for lower, upper in (told(seed, own) for seed in range(40))]
    assert np.mean(held) > 0.8


def test_what_one_of_two_repeats_does_not_record_is_not_the_others_noise():
    """An error of a mean square of 0.09 that both share, noise of 0.0025, and an instrument that records up to 10 Hz alone."""
    random = np.random.default_rng(0)
    own = [replace(record, lowest=()) for record in records(20.0, 20.0, cut_offs=(25.0, 10.0))]
    common, noise = 0.3 * random.standard_normal(own[0].place.size), 0.05 * random.standard_normal((2, own[0].place.size))
    residuals = {0: (common + noise[0])[None], 1: low_pass((common + noise[1])[:, None], 1.0 / RATE, 10.0).T}
    (found,) = floor.floor(SimpleNamespace(records=own), residuals).values()
    for record in own:
        width = record.band[1] - record.band[0]
        assert found.power(record.band, RATE)[0] == pytest.approx(0.0025 * width / (0.5 * RATE), rel=0.2)


def test_a_drive_beside_repeats_is_judged_as_far_as_some_of_these_tell():
    """Beyond that nobody knows its floor: what repeats differ by there is half of what only one of them records."""
    bands = lambda *speeds, cut_offs: [record.band[1] for record in records(*speeds, cut_offs=cut_offs)]
    assert bands(20.0, 20.0, 12.0, cut_offs=(25.0, 10.0, 25.0)) == pytest.approx(3 * [8.5])
    assert bands(20.0, 20.0, 12.0, 12.0, cut_offs=(25.0, 10.0, 20.0, 20.0)) == pytest.approx([8.5, 8.5, 17.0, 17.0])
    assert bands(20.0, 12.0, cut_offs=(25.0, 10.0)) == pytest.approx([21.25, 8.5])


@pytest.mark.parametrize(("lengths", "kept"), [((300.0, 3000.0, 3000.0), 3000.0), ((2900.0, 3000.0), 2900.0)])
def test_of_drives_that_repeat_one_another_elsewhere_one_that_was_ended_early_is_not_asked(lengths, kept):
    drives = []
    for length in lengths:
        time = np.arange(0.0, length / 20.0, 0.02)
        drives.append(xr.Dataset({"s": ("time", 20.0 * time), "e": ("time", np.zeros(time.size))}, {"time": time}))
    (one,) = opening._not_repeated(drives)
    assert float(one["s"][-1]) == pytest.approx(kept, abs=1.0)


def long_enough(*seconds, role="fit"):
    """What stays of drives of a site that are judged for these times (s), by number, and what is said of the others."""
    replays, drives = [], [xr.Dataset(attrs={"name": f"drive {number}", "role": role}) for number in range(len(seconds))]
    for number, own in enumerate(seconds):
        time = np.arange(int(RATE * (own + 2.0)) + 1) / RATE
        replays.append(SimpleNamespace(number=number, time=time, compared=(time >= 2.0) & (own > 0.0)))
    sites, kept, said = opening._long_enough([opening.Site("road", None, drives)], replays, ["road"])
    assert [drive.attrs["name"] for drive in sites[0].drives] == [f"drive {again.number}" for again in kept]
    return [again.number for again in kept], said


def test_a_stub_is_no_fitted_drive_where_all_are_short_either():
    """Behind the run-in nothing may be left of it, and no spectrum be longer than it."""
    kept, said = long_enough(6.9, 0.0, 1.0, 3.0)
    assert kept == [0, 3] and said[0].startswith("road drive 1 is judged for 0.0 s only: too short to be asked (less than 2 s)")
    assert said[1].startswith("road drive 2 ") and "what is found may be chance" in said[-1] and len(said) == 3
    assert long_enough(20.0, 9.98)[1] == ("road drive 1 is judged for 9.9 s only: too short to be asked (less than 10 s)",)
    with pytest.raises(InputError, match="judged for 5.9 s in all .expected 6 s"):
        long_enough(5.98, 1.0)
    with pytest.raises(InputError, match="judged for 0.0 s in all"):
        long_enough(1.5, 1.5, 1.5, 1.5)
    assert long_enough(1.5, role="check")[0] == []


def test_a_search_without_a_calibration_begins_at_the_values_of_the_file_however_far_they_lie_from_the_papers():
    car = parameters.read(Path(__file__).parents[2] / "config" / "vehicles" / "midsize.yaml")
    assert opening.bounds_of(car)["tyre_friction"] == BOUNDS["tyre_friction"]
    other = car.replace(tyre_radial_damping=200.0, tyre_radial_stiffness=212642.0)
    given = {"spring_stiffness_front": (15000.0, 90000.0)}
    free = opening._parameters(other, opening._calibrated_bounds(None, given, other), {})
    started = opening.start_values(SimpleNamespace(free=free))
    assert started == {name: other[name] for name in BOUNDS}
    bounds = {size.key: (size.lower, size.upper) for size in free}
    assert bounds["tyre_radial_damping"] == other.about("tyre_radial_damping") == (100.0, 400.0)
    assert bounds["spring_stiffness_front"] == given["spring_stiffness_front"] and bounds["tyre_friction"] == BOUNDS["tyre_friction"]
    assert "tyre_radial_damping" not in opening.bounds_of(car.replace(tyre_radial_damping=0.0)), "a vehicle has none of it"
    with pytest.raises(InputError, match="bounds: tyre_radial_damping: 4000 to 7000, expected bounds that hold the 200 of the vehicle's file"):
        opening.bounds_of(other, {"tyre_radial_damping": BOUNDS["tyre_radial_damping"]})


def test_a_value_of_nil_that_nobody_calibrated_is_held_whatever_the_bounds():
    car = parameters.read(Path(__file__).parents[2] / "config" / "vehicles" / "midsize.yaml").replace(tyre_radial_damping=0.0)
    bounds = opening.bounds_of(car, BOUNDS)
    assert set(bounds) == set(BOUNDS) - {"tyre_radial_damping"} and bounds["tyre_friction"] == BOUNDS["tyre_friction"]
