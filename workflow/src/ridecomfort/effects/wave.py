"""A fast sine for what turns with the wheels."""

from __future__ import annotations

from math import floor, pi

from numba import njit

PHASE = 2.4
"""rad from wheel to wheel; the golden angle, by which no two wheels ever turn in step."""


@njit(forceinline=True, error_model="numpy", _nrt=False)
def wave(angle):
    """Sine of any ``angle`` in rad to 4e-6, by its series over the quarter that the angle falls into."""
    turns = angle * (0.5 / pi) + 0.25
    x = 2.0 * pi * (0.25 - abs(turns - floor(turns) - 0.5))
    y = x * x
    return x * (1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0))))
