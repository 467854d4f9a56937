"""The cross slope of surfaces whose cross slope is known."""

import numpy as np
import xarray as xr

from ridecomfort.road.crossslope import cross_slope

U, V = 0.1 * np.arange(1000), np.linspace(-2.0, 2.0, 41)


def road(elevation, bank):
    return xr.Dataset({"elevation": (("u", "v"), elevation), "bank": ("u", np.broadcast_to(bank, U.shape))}, {"u": U, "v": V})


def test_is_that_of_the_surface_whatever_the_bank_of_the_file():
    """A scanner that rolls about a plane of 2.5 %: the bank of its reference line is its roll."""
    rng = np.random.default_rng(3)
    plane = 0.03 * U[:, None] - 0.025 * V + rng.normal(0.0, 1e-3, (U.size, V.size))
    found = cross_slope(road(plane, 0.02 * np.sin(U)))
    np.testing.assert_allclose(found, -0.025, atol=2e-4)


def test_ruts_holes_and_a_frayed_edge_leave_it_as_it_is():
    slope = 0.03 * np.sin(2 * np.pi * U / 200.0)
    surface = slope[:, None] * V
    surface[:, 30:35] -= 0.03
    surface[200:400, :4] = np.nan
    np.testing.assert_allclose(cross_slope(road(surface, 0.0))[25:-25], slope[25:-25], atol=1e-4)


def test_is_unknown_where_no_height_is():
    surface = 0.02 * V + 0.0 * U[:, None]
    surface[300:500] = np.nan
    found = cross_slope(road(surface, 0.0))
    assert np.isnan(found[330:470]).all() and np.isfinite(found[:300]).all()
