"""The least-squares search of a calibration, where a vehicle may not be driven."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import descent
from ridecomfort.errors import InputError


class Overshooting:
    """A problem of one parameter whose first step leads far beyond its optimum of 0.3, where nothing can be driven."""

    parameters, evaluations = ("one",), 0

    def flat(self, point):
        if point[0] < 0.1:
            raise InputError("cannot be driven")
        return np.arctan(20.0 * (point - 0.3))

    def jacobian(self, point, free):
        return (20.0 / (1.0 + (20.0 * (point - 0.3)) ** 2))[:, None][:, free]

    def nrmse(self, point):
        return np.zeros((1, 1))


def test_a_search_turns_back_where_a_vehicle_cannot_be_driven_but_must_not_start_there():
    found = descent.descend(Overshooting(), np.array([0.5]), [0], 1e-6, exact=True)
    assert found.point[0] == pytest.approx(0.3, abs=1e-3)
    with pytest.raises(InputError, match="cannot be driven"):
        descent.descend(Overshooting(), np.array([0.05]), [0], 1e-6)
