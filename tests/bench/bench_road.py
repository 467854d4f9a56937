"""Speed of the road: heights and points of the reference line a second, against ASAM's library on the same file."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
import pycrg

from ridecomfort.road import crg, surface

LENGTH, WIDTH, SPACING = 1000.0, 4.0, 0.1
EVALUATIONS = 4_000_000


def bench() -> dict:
    """Evaluations per CPU second on one core: ours and ASAM's, positions along a drive and at random.

    Both as they are called, borders and preparation of the road included. For the
    reference line ASAM's library gives x, y, heading and curvature, we slope and bank
    as well.
    """
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "road.crg"
        shape = round(LENGTH / SPACING) + 1, round(WIDTH / SPACING) + 1
        lateral = np.linspace(-WIDTH / 2, WIDTH / 2, shape[1])
        bends = 0.5 * np.sin(np.linspace(0, 20, shape[0]))
        pycrg.write(path, rng.normal(0, 0.01, shape), SPACING, lateral, bends, mods={})
        road = crg.read(path)
        drive = np.linspace(1.0, LENGTH - 1.0, EVALUATIONS), 0.5 * np.sin(np.linspace(0, 60, EVALUATIONS))
        anywhere = rng.uniform(0, LENGTH, EVALUATIONS), rng.uniform(-WIDTH / 2, WIDTH / 2, EVALUATIONS)
        figures = {}
        with pycrg.RoadSurface.open(path) as asam:
            for place, (u, v) in {"drive": drive, "random": anywhere}.items():
                for name, call in {
                    "linear": lambda: surface.height(road, u, v),
                    "cubic": lambda: surface.height(road, u, v, interpolation="cubic"),
                    "asam": lambda: asam.uv_to_z_many(u, v),
                }.items():
                    figures[f"road_{name}_{place}_heights_per_cpu_s"] = EVALUATIONS / _best(call)
                for name, call in {
                    "linear": lambda: surface.reference_line(road, u),
                    "cubic": lambda: surface.reference_line(road, u, interpolation="cubic"),
                    "asam": lambda: (asam.uv_to_xy_many(u, 0.0), asam.uv_to_pk_many(u, 0.0)),
                }.items():
                    figures[f"road_{name}_{place}_line_points_per_cpu_s"] = EVALUATIONS / _best(call)
    return figures


def _best(call, repeats: int = 4) -> float:
    """Least CPU time in s of several runs, the first of which also compiles."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)
