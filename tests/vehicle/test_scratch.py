"""Arrays on the stack: they are as numpy's, and those of one call know nothing of those of another."""

from __future__ import annotations

import numpy as np
from numba import njit

from ridecomfort.vehicle.scratch import zeros


@njit(forceinline=True)
def _running(values):
    total = zeros(1)
    for value in values:
        total[0] += value
    return total[0]


@njit
def _products(values):
    table, sums = zeros(3, 4), zeros(2)
    before = table.sum() + sums.sum()
    for i in range(3):
        for k in range(4):
            table[i, k] = values[i] * (k + 1.0)
    sums[0], sums[1] = _running(table[1]), _running(table[2])
    return before, table.copy(), table.shape, sums.copy()


def test_begins_with_zeros_and_holds_what_is_put_where():
    before, table, shape, sums = _products(np.array([2.0, -1.0, 0.5]))
    assert before == 0.0 and shape == (3, 4)
    np.testing.assert_array_equal(table, np.outer([2.0, -1.0, 0.5], [1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_array_equal(sums, [-10.0, 5.0])


def test_begins_with_zeros_anew_in_every_round_of_a_loop_that_it_is_inlined_into():
    @njit
    def sums(rows):
        found = np.empty(len(rows))
        for i in range(len(rows)):
            found[i] = _running(rows[i])
        return found

    np.testing.assert_array_equal(sums(np.ones((5, 3))), np.full(5, 3.0))
