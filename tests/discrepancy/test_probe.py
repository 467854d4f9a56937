"""Columns of a fit: chords over a probe, or over as little as a fit may still move."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import probe

from .linear import Linear

KEY = "effect_2.size"


class Bent(Linear):
    """The same where effect_2 grows with the square of its size."""

    def residual(self, values, index):
        return super().residual({**values, KEY: values.get(KEY, 0.0) ** 2}, index)


def column(value, steps=None):
    """Column of effect_2 from ``value`` in units of what it is for a size of one."""
    model = Bent(3, {})
    values = {"stiffness": 0.0, KEY: value}
    size = model.candidates[2].sizes[0]
    found = probe.secants(model, values, {0: model.residual(values, 0)}, [size], steps=steps)[KEY][0]
    own = model.columns[0][KEY]
    return float(np.sum(found * own) / np.sum(own**2)) / size.probe


@pytest.mark.parametrize("steps, chord", [(None, 0.1), ({KEY: 1.0}, 0.1), ({KEY: 0.05}, 0.005)])
def test_a_column_is_the_chord_over_a_probe_or_over_what_is_asked_for(steps, chord):
    assert column(2.0, steps) == pytest.approx(2 * 2.0 + chord, rel=1e-5)


def test_a_column_at_a_bound_is_taken_into_the_bounds():
    assert column(5.0, {KEY: 0.5}) == pytest.approx(2 * 5.0 - 0.05, rel=1e-5)
