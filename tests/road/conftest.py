"""Roads that the tests share."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr


@pytest.fixture
def alpine() -> xr.Dataset:
    """A bending, banked road that climbs 140 m over 2 km, rough by a centimetre, its right edge frayed."""
    rng = np.random.default_rng(20)
    u, v = np.linspace(0.0, 2000.0, 20001), np.linspace(-2.0, 2.0, 41)
    bend = 0.01 * np.sin(2 * np.pi * u / 300.0)
    heading = 0.3 + np.cumsum(0.1 * bend)
    slope = 0.07 + 0.02 * np.sin(2 * np.pi * u / 500.0)
    bank = 0.05 * np.sin(2 * np.pi * u / 300.0)
    climb = np.concatenate([[0.0], np.cumsum(0.1 * slope[1:])])
    elevation = 812.345 + climb[:, None] + bank[:, None] * v + rng.normal(0.0, 0.01, (len(u), len(v)))
    elevation[500:700, :3] = np.nan
    line = {
        "x": 1e5 + np.concatenate([[0.0], np.cumsum(0.1 * np.cos(heading[:-1]))]),
        "y": 2e5 + np.concatenate([[0.0], np.cumsum(0.1 * np.sin(heading[:-1]))]),
        "heading": heading,
        "curvature": bend,
        "slope": slope,
        "bank": bank,
    }
    return xr.Dataset(
        {"elevation": (("u", "v"), elevation), **{name: ("u", values) for name, values in line.items()}},
        coords={"u": u, "v": v},
    )
