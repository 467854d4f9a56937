"""Forces of a tyre in the plane of the road."""

from __future__ import annotations

from math import sqrt

from numba import njit


@njit(forceinline=True, error_model="numpy", _nrt=False)
def brush(slip_x, slip_y, load, friction, stiffness_x, stiffness_y):
    """Forces in N of a brush tyre with parabolic pressure under combined slip, and its give.

    Pacejka (2012), Tire and Vehicle Dynamics, section 3.2; stiffnesses are per unit load. The
    give is the slope of the force over the slip, relative to that at no slip; 0 when it slides.
    """
    per_friction = 1.0 / friction
    x = stiffness_x * slip_x * per_friction
    y = stiffness_y * slip_y * per_friction
    total = sqrt(x * x + y * y)
    if total < 3.0:
        share = 1.0 - total * (1.0 / 3.0 - total * (1.0 / 27.0))
        give = (1.0 - total * (1.0 / 3.0)) ** 2
    else:
        share, give = 1.0 / total, 0.0
    return friction * load * share * x, friction * load * share * y, give
