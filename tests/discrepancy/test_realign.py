"""Drives aligned for a model: the frame knows what a path does where they are driven now."""

from __future__ import annotations

from copy import copy

import numpy as np
import pytest

from ridecomfort.discrepancy import realign

from .coloured import coloured
from .linear import SAMPLES, Linear


class Wayward(Linear):
    """The same, driven on paths that are off by ``off``, each on a rough road: what a path changes is another on another path."""

    def __init__(self, seed, off):
        super().__init__(seed, {}, noise=0.1)
        rng = np.random.default_rng(seed + 1)
        self.slope, self.bend = coloured(rng, SAMPLES), coloured(rng, SAMPLES)
        self.off = [off] * len(self.records)

    def residual(self, values, index):
        off = self.off[index]
        return super().residual(values, index) + off * self.slope + 0.5 * off**2 * self.bend

    def nuisances(self, values, index):
        return (self.slope + self.off[index] * self.bend)[None]

    def retuned(self, values, indices, exactly=False):
        return self, {index: self.residual(values, index) for index in indices}

    def realigned(self, amounts):
        moved = copy(self)
        moved.off = [own - float(amounts[i][0]) if i in amounts else own for i, own in enumerate(self.off)]
        return moved

    def taking(self, other, indices):
        mixed = copy(self)
        mixed.off = [other.off[i] if i in indices else own for i, own in enumerate(self.off)]
        return mixed


@pytest.fixture(scope="module")
def made():
    return realign.aligned(Wayward(4, 1.5), {"stiffness": 0.0}, [0, 1, 2])


def test_drives_are_brought_onto_their_paths(made):
    _, _, experiment = made
    np.testing.assert_allclose(experiment.off[:3], 0.0, atol=0.1)
    assert experiment.off[3] == 1.5


def test_what_a_path_does_is_that_of_the_paths_they_are_brought_onto(made):
    """Frames that kept what it did before would hold sizes back."""
    _, frame, experiment = made
    left = [np.sum(frame.flat(dict.fromkeys(range(3), experiment.slope + off * experiment.bend)) ** 2) for off in (0.0, 1.5)]
    assert left[0] < 0.1 * left[1]
