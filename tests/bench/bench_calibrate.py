"""Speed of a calibration of five parameters on a site as long as ts1, and what a job that starts warm pays for compiled code."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import xarray as xr

from ridecomfort import calibrate, simulate
from ridecomfort.drive import record
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests.bench.bench_kernel import CAR, EFFECTS
from tests.vehicle.roads import road, rough

LENGTH, SPEED, REPEATS = 3100.0, 25.0, 3

WARM = """
import time
from ridecomfort import simulate
from ridecomfort.vehicle import parameters
from tests.vehicle.roads import road, rough
car, course = parameters.read({car!r}), simulate.prepare(road(60.0, height=rough))
start = time.process_time()
simulate.run(course, car, speed=20.0, effects={effects!r})
first = time.process_time() - start
start = time.process_time()
simulate.run(course, car, speed=20.0, effects={effects!r})
print(first - (time.process_time() - start))
"""


def bench() -> dict:
    """Seconds are of this process on one core, after compilation; ``evaluations`` of all steps together."""
    car = parameters.read(CAR)
    course = simulate.prepare(road(LENGTH, height=rough, curvature=0.004 * np.sin(np.arange(0, LENGTH + 0.05, 0.1) / 50)))
    drives = [_drive(course, car, k) for k in range(REPEATS)]
    calibrate.problem(drives[:1], course, car)
    start = time.process_time()
    found = calibrate.calibrate(drives, course, car, restarts=0)
    seconds = time.process_time() - start
    return {
        "calibrate_five_parameters_s": seconds,
        "calibrate_evaluations": int(found["evaluations"].sum()),
        "warm_start_s": {"no effects": _warm(()), "five effects": _warm(EFFECTS)},
    }


def _drive(course, car, k: int) -> xr.Dataset:
    truth = car.replace(spring_stiffness_front=24000.0, tyre_radial_stiffness=320000.0)
    speed = xr.DataArray(SPEED + np.sin(course.u / 60 + k), {"u": course.u}, "u")
    run = simulate.run(course, truth, speed=speed, lateral=0.1 * k)
    rng, time_ = np.random.default_rng(k), run["time"].values
    given = {name: (time_, run[name].values) for name in ("v_x", "s", "e")}
    for name in SIGNALS:
        given[name] = time_, run[name].values + (4e-3 if name[0] == "a" else 3e-4) * rng.standard_normal(time_.size)
    return record.from_arrays(given, gravity=False, name=f"repeat_{k + 1}")


def _warm(effects) -> float:
    """CPU seconds that the first drive of a new process takes longer than the second, everything compiled before."""
    call = [sys.executable, "-c", WARM.format(car=str(CAR), effects=tuple(effects))]
    subprocess.run(call, check=True, capture_output=True)
    return float(subprocess.run(call, check=True, capture_output=True, text=True).stdout)
