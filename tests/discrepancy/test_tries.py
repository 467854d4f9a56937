"""A candidate tried beside what was accepted before it."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import probe, refit
from ridecomfort.discrepancy.rung import climb
from ridecomfort.discrepancy.tries import Tries

from .linear import Linear

FIRST, SECOND = "effect_1.size", "effect_2.size"


class Driven(Linear):
    """The same where effect_1 is 1, and effect_2, at 2, is what drives it on to where both are without effect; between lies what is worse."""

    def __init__(self, seed):
        super().__init__(seed, {})

    def residual(self, values, index):
        first, second = values.get(FIRST, 0.0), values.get(SECOND, 0.0)
        columns = self.columns[index]
        wall = 8.0 * np.clip((first - 2.0) * (5.5 - first), 0.0, None)
        share = 4.0 * np.exp(-first)
        together = (first - 1.0) * np.exp(-first) * columns[FIRST] + share * (second - 2.0) * columns[SECOND] + wall * columns["effect_5.size"]
        return super().residual({}, index) + together


def tried(model, first):
    """The first refit of effect_2 beside an effect_1 that was accepted with this size."""
    base = climb(model, {"stiffness": 0.0}, model.free)
    values = {"stiffness": 0.0, FIRST: first}
    rung = climb(model, values, model.free, before=base)
    fitted = [*model.free, model.candidates[1].sizes[0]]
    columns = {("effect_2", 0): probe.Probe(model, rung.fit.values, rung.fit.residuals)(("effect_2", 0))}
    raw = probe.secants(model, rung.fit.values, rung.fit.residuals, fitted)
    rung.raw.update(raw)
    candidates = {candidate.name: candidate for candidate in model.candidates}
    return Tries(rung, candidates, fitted, columns, model, refit.information(rung.frame, rung.fit.residuals)).first(("effect_2", 0))


@pytest.mark.parametrize("first", [6.0, 1.2])
def test_what_drove_an_accepted_size_beyond_what_is_plausible_is_fitted_from_where_that_was_plausible(first):
    values = tried(Driven(2), first).fit.values
    assert values[FIRST] == pytest.approx(1.0, abs=0.2) and values[SECOND] == pytest.approx(2.0, abs=0.2)


def test_without_that_it_stays_behind_the_wall(monkeypatch):
    monkeypatch.setattr(Tries, "_from_plausible", lambda self, fit, *given: fit)
    assert tried(Driven(2), 6.0).fit.values[FIRST] > 5.0
