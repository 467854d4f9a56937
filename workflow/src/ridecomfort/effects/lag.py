"""A first-order lag that effects share, good for any time constant down to zero."""

from __future__ import annotations

from numba import njit

SHORTEST = 0.005
"""s; five steps of the kernel, two and a half where directions are probed. States that answer faster could not be integrated
explicitly."""


@njit(forceinline=True, error_model="numpy", _nrt=False)
def lag(value, state, time):
    """``value`` behind a lag of ``time`` in s, and the slope of the lag's ``state``.

    A lag shorter than SHORTEST is that share of one of SHORTEST: its phase at low frequency is
    the same, and without any the value passes unchanged.
    """
    span = max(time, SHORTEST)
    slope = (value - state) / span
    return value - time * slope, slope
