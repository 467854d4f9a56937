"""Profiles of the wheel tracks of a road."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.errors import InputError
from ridecomfort.road import wheeltracks


def test_tracks_interpolate_across_the_road_and_name_holes():
    u, v = np.arange(0, 50, 0.5), np.array([-1.0, 0.0, 1.0])
    heights = 0.01 * u[:, None] + 0.1 * v
    road = xr.Dataset({"elevation": (("u", "v"), heights)}, {"u": u, "v": v})
    assert np.allclose(wheeltracks.tracks(road, (-0.75, 1.0)), 0.01 * u + [[-0.075], [0.1]])
    with pytest.raises(InputError, match="outside the road"):
        wheeltracks.tracks(road, (-2.0,))
    heights[20, 0] = np.nan
    with pytest.raises(InputError, match="u = 10 m"):
        wheeltracks.tracks(road, (-0.5,))


@pytest.mark.parametrize("offset", [-0.75, 0.75])
def test_a_track_on_the_first_or_last_line_of_a_road_needs_none_beside_it(offset):
    road = xr.Dataset({"elevation": (("u", "v"), np.tile([1.0, np.nan, 2.0], (5, 1)))}, {"u": np.arange(5.0), "v": [-0.75, 0.0, 0.75]})
    assert (wheeltracks.tracks(road, [offset]) == (1.0 if offset < 0 else 2.0)).all()
