"""Trials of recovery: drives of the model itself, recorded with a real instrument's errors, aligned as a study's are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ridecomfort import calibrate, calibrated, simulate
from ridecomfort.drive import align, record
from ridecomfort.standin import drives as standin
from ridecomfort.standin import instrument
from ridecomfort.steps import realigned
from tests.blind.trials import SENSOR, a_road, by_foot

SPEED = 22.0
"""m/s of the repeats; the slower drive of a study is not fitted and is left out here."""

REPEATS = 1

FINE_RATE, RATE = 1000.0, 100.0
"""Hz of the drive that the instrument sees, which is every step of the model, and of what it records."""


@dataclass(frozen=True)
class Trial:
    """``drives``, aligned, on ``road``: what calibration is given. ``truth``: calibrated parameters of the car that drove."""

    road: object
    drives: Sequence[xr.Dataset]
    truth: Mapping[str, float]
    errors: Sequence[Mapping]


def make(seed: int, vehicle, measurement: Mapping, foot: float = 0.0) -> Trial:
    """Repeats on a bent, rough road of 700 m by a car whose calibrated parameters are drawn.

    ``measurement`` is that block of config/standin.yaml: intervals of the parameters, the driver, the instrument. ``foot`` (m/s2 rms): how
    briskly he moves the pedals beside that (``by_foot``).
    """
    rng = np.random.default_rng(seed)
    road = a_road(rng)
    course = simulate.prepare(road)
    truth = {name: float(rng.uniform(*interval)) for name, interval in measurement["calibrated"].items()}
    car = vehicle.replace(**truth)
    mounting = np.radians(measurement["mounting_deg"]) * rng.standard_normal(3)
    drives, errors = [], []
    for number in range(REPEATS):
        usual = np.full(road["u"].size, SPEED)
        speed, path, driver = standin.how_driven(rng, road["u"].values, usual, {"role": "fit"}, measurement)
        speed = speed + by_foot(np.random.default_rng([seed, number, 1]), road["u"].values, speed, foot)
        drive = simulate.run(course, car, speed=speed, lateral=path, sensor=SENSOR, rate=FINE_RATE)
        quantities, drawn = instrument.record(rng, drive, RATE, measurement["instrument"], mounting)
        time = quantities.pop("time")
        measured = record.from_arrays(
            {name: (time, values) for name, values in quantities.items()}, name=f"repeat_{number + 1}", sensor=SENSOR
        )
        drives.append(measured)
        errors.append({**driver, **drawn})
    return Trial(course, _aligned(drives, course, vehicle), truth, errors)


def _aligned(drives: Sequence[xr.Dataset], course, vehicle) -> list[xr.Dataset]:
    """Drives aligned as those of a study: first for the nominal vehicle, then for that of a rough fit."""
    first = [align.align(drive, course, vehicle, simulate=simulate.run) for drive in drives]
    rough = calibrate.calibrate(first, course, vehicle, **realigned.ROUGH)
    own, _ = calibrated.apply(rough, vehicle)
    return [align.align(drive, course, own, simulate=simulate.run) for drive in drives]
