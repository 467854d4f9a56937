"""The simulated drives of a site, as the workflow calls for them."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.steps import simulate
from tests import quarter_cars

CONFIG = {
    "site": "here",
    "effects": {},
    "effects_folder": None,
    "simulation": {"step": 0.001, "rate": 100},
    "space": {"spacing": 0.25, "run_in": 50, "run_out": 25},
    "speed": {"limit_km_h": 60, "lateral_acceleration": 3.0, "acceleration": 1.0, "deceleration": 1.5},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A road 4 m wide with bends of 50 m."""
    folder = tmp_path_factory.mktemp("site")
    store.write(quarter_cars.road(length=160.0, bend=0.02), folder / "road.nc", title="a road")
    return folder


def drive(folder, repository, lateral, friction=1.0):
    runs = len(lateral)
    samples = {"speed_deviation": np.zeros(runs), "lateral_position": np.array(lateral), "road_friction": np.full(runs, friction)}
    drawn = xr.Dataset({name: ("run", values) for name, values in samples.items()}, {"run": np.arange(runs)})
    store.write(drawn, folder / "samples.nc", title="samples")
    vehicle, output = repository / "config" / "vehicles" / "midsize.yaml", folder / "drives.nc"
    simulate.main(folder / "road.nc", folder / "samples.nc", vehicle, None, f"0000-{runs - 1:04d}", CONFIG, output)
    return store.read(output)


def test_drives_keep_to_the_positions_that_were_drawn(folder, repository):
    found = drive(folder, repository, [0.0, 1.24])
    np.testing.assert_allclose(found["e"].isel(time=200), [0.0, 1.24], atol=0.05)


def test_a_drive_beside_the_road_is_refused_before_it_is_simulated(folder, repository):
    """It was simulated on held heights before, as smooth across as they are."""
    with pytest.raises(InputError) as problem:
        drive(folder, repository, [0.0, 3.0, -1.0])
    said = "run 1: lateral position: 3.00 m, with wheels 0.75 m to either side, expected on the road, -2 to 2 m"
    assert str(problem.value) == f"{folder / 'samples.nc'}: {said}"


def test_a_drive_that_slides_off_the_road_is_refused(folder, repository):
    """In a bend that asks for 3 m/s2, with a friction that gives little more; aimed for is the last place that is allowed."""
    with pytest.raises(InputError, match=r"road.nc: run 0: lateral position: 1.\d\d m at u = \d+\.\d m, with wheels 0.75 m"):
        drive(folder, repository, [1.25], friction=0.34)
