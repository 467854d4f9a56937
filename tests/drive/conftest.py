"""A road, and a drive of another car than the nominal one on it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests import quarter_cars
from tests.quarter_cars import LATERAL


@pytest.fixture(scope="session")
def road():
    return quarter_cars.road(length=560.0)


@pytest.fixture(scope="session")
def drive(road, nominal):
    return quarter_cars.driven(road, quarter_cars.other(nominal))


@pytest.fixture(scope="session")
def truth(nominal):
    return quarter_cars.other(nominal)


@pytest.fixture(scope="session")
def lanes(truth):
    """A road of two lanes without a bend, and a drive in the middle of its left one."""
    road = quarter_cars.road(length=560.0, bend=0.0, width=8.0)
    u = road["u"].values
    speed = xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u")
    run = quarter_cars.run(road, truth, speed=speed, lateral=1.8, end=550.0)
    run = run.isel(time=(run["s"] > 60).values)
    return road, run.assign_coords(time=run["time"] - run["time"][0])


@pytest.fixture(scope="session")
def whole(road, truth):
    """A drive over the whole of the road."""
    u = road["u"].values
    return quarter_cars.run(road, truth, speed=xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u"), lateral=LATERAL)
