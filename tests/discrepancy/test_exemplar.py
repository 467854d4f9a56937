"""One drive for all that repeat it: who may borrow columns of whom, and that what is found does not depend on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import contest, exemplar, select
from ridecomfort.discrepancy.rung import begin

from .coloured import coloured
from .linear import SAMPLES, Linear

LIBRARY = 20


class Varied(Linear):
    """The same where what effects do on the second and third repeat is like what they do on the first, as far as ``likeness`` says, and
    which counts the drives that are simulated with an effect."""

    def __init__(self, seed, truth, likeness):
        super().__init__(seed, truth, library=LIBRARY)
        rng, first = np.random.default_rng([seed, 5]), self.columns[0]
        other = lambda column: likeness * column + np.sqrt(1.0 - likeness**2) * coloured(rng, SAMPLES)
        for k in (1, 2):
            self.columns[k] = {key: other(column) for key, column in first.items()}
        self.simulated: list[tuple[str, int]] = []

    def residual(self, values, index):
        self.simulated += [(key, index) for key, value in values.items() if key.startswith("effect") and value]
        return super().residual(values, index)


def found(model, alike=()):
    """A search among the effects of a model, of which those ``alike`` may be borrowed, and how many drives with one that is not missing were
    simulated for it."""
    rung = begin(model, {"stiffness": 0.0})
    model.simulated.clear()
    selection = select.search(rung, most=3, alike=alike)
    return selection, sum(key not in model.truth for key, _ in model.simulated)


def lenders(model):
    rung = begin(model, {"stiffness": 0.0})
    return exemplar.exemplars(rung.frame, rung.raw)


def test_repeats_borrow_of_the_longest_and_who_is_not_alike_has_its_own():
    model = Varied(1, {}, 0.95)
    assert lenders(model) == {0: 0, 1: 0, 2: 0}
    model.records[1] = replace(model.records[1], site="another")
    assert lenders(model) == {0: 0, 1: 1, 2: 0}
    assert lenders(Varied(1, {}, 0.5)) == {0: 0, 1: 1, 2: 2}


def test_a_column_is_borrowed_at_equal_place_and_nil_where_its_lender_did_not_drive():
    model = Linear(1, {})
    place = model.records[0].place
    model.records[1] = replace(model.records[1], place=place + 0.5)
    column = np.sin(place)[None]
    raw = exemplar.borrowed(model, {0: 0, 1: 0}, {"size": {0: column}})["size"]
    assert raw[0] is column
    there = place + 0.5 <= place[-1]
    np.testing.assert_allclose(raw[1][0][there], np.sin(place + 0.5)[there], atol=2e-5)
    assert not raw[1][0][~there].any()


@pytest.mark.parametrize("size", [0.1, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_found_is_what_is_found_without_borrowing_and_took_fewer_drives(seed, size):
    truth = {"stiffness": 0.7, "effect_2.size": size, "effect_9.size": 0.7 * size}
    model = Varied(seed, truth, 0.9)
    names = {candidate.name for candidate in model.candidates}
    without, every = found(model)
    sparing, fewer = found(model, names)
    assert without.accepted and sparing.accepted == without.accepted
    for key, value in without.final.values.items():
        assert sparing.final.values[key] == pytest.approx(value, rel=1e-6)
    gains = [[turn.winner.gain for turn in one.rounds if turn.winner] for one in (sparing, without)]
    assert gains[0] == pytest.approx(gains[1], rel=1e-6)
    assert fewer < 0.6 * every


@pytest.mark.parametrize("met", [{1}, {2}, {1, 2}])
def test_what_the_lender_does_not_meet_is_asked_of_every_drive(met):
    """A stop that only faster repeats reach, a place that only longer ones come to."""
    model = Varied(1, {"effect_2.size": 1.0}, 0.95)
    for index in {0, 1, 2} - met:
        model.columns[index] = {**model.columns[index], "effect_2.size": np.zeros(SAMPLES)}
    assert lenders(model) == {0: 0, 1: 0, 2: 0}
    selection, _ = found(model, {candidate.name for candidate in model.candidates})
    assert selection.accepted == ("effect_2",)
    assert ("effect_2", 0) in selection.probed


def test_what_drives_borrowed_is_known_to_no_later_search():
    model = Varied(1, {"effect_2.size": 1.0}, 0.9)
    selection, _ = found(model, {f"effect_{k}" for k in range(1, LIBRARY)})
    assert set(selection.probed) == {("effect_0", 0)}


def test_what_speaks_for_a_candidate_is_asked_of_every_drive(monkeypatch):
    """On the repeats effect_3 does half of the opposite, and is nowhere missing but on the first drive: what is borrowed of that speaks for it,
    what it does itself does not."""
    model = Varied(1, {}, 0.95)
    for k in (1, 2):
        model.columns[k]["effect_3.size"] = -0.5 * model.columns[0]["effect_3.size"]
    one, residual = model.columns[0]["effect_3.size"], model.residual
    monkeypatch.setattr(model, "residual", lambda values, index: residual(values, index) - 0.25 * one * (index < 3))
    tested, seen = contest.Contest._tested, []
    monkeypatch.setattr(contest.Contest, "_tested", lambda self: seen.append(set(self.borrowed)) or tested(self))
    selection, _ = found(model, {candidate.name for candidate in model.candidates})
    assert selection.accepted == ()
    assert ("effect_3", 0) not in seen[-1] and len(seen[-1]) > 0.5 * LIBRARY
