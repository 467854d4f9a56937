"""Time and memory of a 3 km laser scan at full density on its way to the grid of a road."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import time

import numpy as np
import xarray as xr

from ridecomfort.road import survey
from ridecomfort.standin.scan import Scanner, profiles, trajectory

LENGTH = 3000.0


def bench() -> dict:
    """Points, CPU seconds without making the scan, points a second, and peak memory in MiB of a process of its own."""
    done = subprocess.run([sys.executable, __file__], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def measure(length: float = LENGTH) -> dict:
    """The figures of `bench`, in this process."""
    road = gentle(length)
    true, measured = trajectory(road, 1)
    survey.grid(profiles(road.isel(u=slice(0, 400)), true.isel(time=slice(0, 300)), 1), measured)
    spent = 0.0

    def scan():
        nonlocal spent
        blocks = profiles(road, true, 1, Scanner())
        while True:
            start = time.process_time()
            block = next(blocks, None)
            spent += time.process_time() - start
            if block is None:
                return
            yield block

    start = time.process_time()
    _, report = survey.grid(scan(), measured)
    seconds = time.process_time() - start - spent
    return {
        "survey_points": report.points,
        "survey_cpu_s": seconds,
        "survey_points_per_s": report.points / seconds,
        "survey_peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def gentle(length: float) -> xr.Dataset:
    """A waved, bending road, 5 m wide."""
    u, v = np.arange(round(length / 0.1) + 1) * 0.1, np.linspace(-2.5, 2.5, 51)
    bend = 0.005 * np.sin(2 * np.pi * u / 400)
    heading = np.cumsum(0.1 * bend)
    line = {"x": np.cumsum(0.1 * np.cos(heading)), "y": np.cumsum(0.1 * np.sin(heading)), "heading": heading}
    line |= {"curvature": bend, "slope": np.zeros(u.size), "bank": np.zeros(u.size)}
    relief = np.random.default_rng(1).normal(0, 0.001, (u.size, v.size)) + 0.01 * np.sin(u / 3)[:, None]
    return xr.Dataset(
        {"elevation": (("u", "v"), relief), **{name: ("u", values) for name, values in line.items()}},
        coords={"u": u, "v": v},
    )


if __name__ == "__main__":
    print(json.dumps(measure()))
