"""A drive whose driver brakes and speeds up within half a second, and its record by a noisy instrument on the roof."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort import simulate
from ridecomfort.drive import record
from ridecomfort.vocabulary import SIGNALS
from tests.vehicle.roads import road, rough

ON_ROOF = (0.1, 0.1, 0.9)
"""m from the centre of gravity."""

NOISE = 0.014
"""m/s rms of the recorded speed, at 100 Hz."""


def course() -> simulate.Course:
    """A straight and rough road of 900 m."""
    return simulate.prepare(road(900.0, height=rough))


def drive(course, car, *, gravity=True, noise=NOISE, of_acceleration=0.003, effects=()):
    """A record of the car, whose driver brakes within half a second and speeds up again, three times, and the drive itself."""
    u = course.u
    speed = np.interp(u, [0, 150, 200, 300, 350, 480, 520, 650, 700, 900], [22, 22, 17, 17, 21, 21, 16, 16, 20, 20])
    run = simulate.run(course, car, speed=xr.DataArray(speed, {"u": u}, "u"), sensor=ON_ROOF, effects=effects)
    rng = np.random.default_rng(3)
    felt = record.felt(run) if gravity else np.stack([run[name].values for name in SIGNALS[:3]])
    values = {**dict(zip(SIGNALS[:3], felt)), **{name: run[name].values for name in (*SIGNALS[3:], "v_x", "s", "e")}}
    for name in SIGNALS[:3]:
        values[name] = values[name] + of_acceleration * rng.standard_normal(run.sizes["time"])
    values["v_x"] = values["v_x"] + noise * rng.standard_normal(run.sizes["time"])
    found = record.from_arrays(
        {name: (run["time"].values, part) for name, part in values.items()}, gravity=gravity, sensor=ON_ROOF, name="own"
    )  # fmt: skip
    if gravity:  # as alignment takes it out: with the attitude of a simulation
        attitude = {name: ("time", np.interp(found["time"], run["time"], run[name]) + 1e-3) for name in ("roll", "pitch")}
        found = found.assign(attitude)
        flat = record.acceleration(np.stack([found[name].values for name in SIGNALS[:3]]), found["roll"], found["pitch"])
        found = found.assign({name: ("time", part) for name, part in zip(SIGNALS[:3], flat)})
    return found, run
