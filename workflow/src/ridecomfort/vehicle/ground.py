"""The ground as the compiled vehicle sees it: a height at any place of the road."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from ..road.surface import cubic, linear


class Surface(NamedTuple):
    """The grid of a road surface: origin in m, cells per m, and whether to interpolate smoothly."""

    u0: float
    per_u: float
    v0: float
    per_v: float
    smooth: bool


@njit(forceinline=True, error_model="numpy", _nrt=False)
def height(surface, elevation, u, v):
    """Height in m of the road at (u, v), by the interpolation that the surface asks for."""
    i, j = (u - surface.u0) * surface.per_u, (v - surface.v0) * surface.per_v
    if surface.smooth:
        return cubic(elevation, 0.0, 1.0, 0.0, 1.0, i, j)
    return linear(elevation, 0.0, 1.0, 0.0, 1.0, i, j)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def plane_slopes(car, ground):
    """Slopes, forward and to the left, of the plane through the heights under the wheels."""
    front, rear = ground[0] + ground[1], ground[2] + ground[3]
    across = (ground[0] - ground[1]) * car.per_track_front + (ground[2] - ground[3]) * car.per_track_rear
    return 0.5 * (front - rear) * car.per_wheelbase, 0.5 * across
