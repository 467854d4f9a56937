"""One round of the search: who is refitted, and what is told of candidates that were not judged."""

from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import allowance, contest, select
from ridecomfort.discrepancy.experiment import Size

from .linear import Linear


def test_what_was_refitted_for_one_that_was_taken_back_is_told_for_its_gain():
    """Of six that are significant the first was taken back: the sixth was refitted, and gained little."""
    names, found = tuple("abcdef"), SimpleNamespace(opposite=frozenset())
    found.names, found.significant = names, lambda most: list(names)[:most]
    trials = [SimpleNamespace(name=name) for name in "bcde"]
    assert contest.passed_over(found, {"f"}, trials, {"a"}) == {"f": "its refit gains less than 5 % of the best"}
    assert contest.passed_over(found, set(), trials) == {"a": "could not be simulated", "f": "not refitted: the 5 that gain most were"}


class Bent(Linear):
    """The same where what effect_2 does in small sizes is another thing than what it does in that which is missing, 1, beside five smaller effects."""

    def __init__(self, seed):
        super().__init__(seed, {f"effect_{k}.size": 2.0 for k in (0, 1, 3, 4, 5)}, library=7)
        for own in {id(own): own for own in self.columns}.values():
            own["at large"] = own.pop("effect_6.size")
        self.candidates = self.candidates[:6]

    def residual(self, values, index):
        size = values.get("effect_2.size", 0.0)
        return super().residual(values, index) + 9.0 * (size**3 - 1.0) * self.columns[index]["at large"]


@pytest.mark.parametrize("asked", [contest.ASKED, 0])
def test_what_small_sizes_hardly_show_is_refitted_by_what_typical_ones_would_do(asked, monkeypatch):
    monkeypatch.setattr(contest, "ASKED", asked)
    found = select.select(Bent(1), {"stiffness": 0.0}, most=1)
    assert ("effect_2" in {trial.name for trial in found.rounds[0].trials}) == bool(asked)
    if asked:
        assert found.accepted == ("effect_2",)
        assert found.final.values["effect_2.size"] == pytest.approx(1.0, abs=0.02)
    else:
        assert found.rounds[0].passed_over["effect_2"] == "not refitted: the 5 that gain most were"


class Changed(Linear):
    """The same where effect_2, at the size of 2 that is missing, changes what effect_4 and effect_5 do: of effect_4 to half of it and as much of
    something else, of effect_5 to what the stiffness does. Beside effect_2 is missing what effect_4 does then, and what effect_5 did before."""

    def __init__(self, seed):
        super().__init__(seed, {"effect_2.size": 2.0}, library=7)
        for own in {id(own): own for own in self.columns}.values():
            own["something else"] = own.pop("effect_6.size")
        self.candidates = self.candidates[:6]

    def residual(self, values, index):
        own, there = self.columns[index], values.get("effect_2.size", 0.0) / 2.0
        fourth, fifth = (values.get(f"effect_{k}.size", 0.0) for k in (4, 5))
        changed = -0.5 * own["effect_4.size"] + own["something else"], own["stiffness"] - own["effect_5.size"]
        missing = 0.3 * (own["effect_4.size"] + changed[0]) + 0.1 * own["effect_5.size"]
        return super().residual(values, index) + there * (fourth * changed[0] + fifth * changed[1]) - missing


def test_above_the_first_rung_the_evidence_is_that_of_columns_as_they_are_there():
    found = select.select(Changed(1), {"stiffness": 0.0}, most=2)
    assert found.accepted == ("effect_2", "effect_4")
    first, second = found.rounds
    gain = dict(zip(second.names, second.gain))["effect_4"]
    assert gain > 0.6 * second.winner.gain  # by the column of the first rung 0.13
    at_first, beside = (dict(zip(turn.names, turn.p_value))["effect_5"] for turn in (first, second))
    assert at_first < 0.01 and beside > 0.05
    assert "effect_5" not in {trial.name for trial in second.trials}


class Rounded(Changed):
    """The same where longer steps give the same but for rounding, and effect_4 has a size that does nothing."""

    rounding = 0.0

    def __init__(self, seed):
        super().__init__(seed)
        idle = Size("effect_4.idle", "N", 0.0, 0.0, 5.0, 0.1)
        self.candidates = tuple(replace(one, sizes=(*one.sizes, idle)) if one.name == "effect_4" else one for one in self.candidates)

    def residual(self, values, index):
        return super().residual(values, index) + self.rounding

    def coarser(self, values, residuals):
        longer = copy(self)
        longer.rounding = 1e-12
        return longer, {index: longer.residual(values, index) for index in residuals}


def test_columns_are_made_anew_in_longer_steps_too_beside_a_size_that_does_nothing():
    first, second = select.select(Rounded(1), {"stiffness": 0.0}, most=2).rounds
    assert first.winner.name == "effect_2" and second.winner.name == "effect_4"
    assert dict(zip(second.names, second.gain))["effect_4"] > 0.6 * second.winner.gain


def test_intervals_allow_for_what_a_candidate_does_beside_the_effects_that_were_found(monkeypatch):
    """What effect_5 does there is what the stiffness does, which is fitted: it moves nothing, whatever it did before."""
    allowances, asked = allowance.allowances, {}

    def told(fit, frame, sizes, raw, *others):
        asked.update(raw)
        return allowances(fit, frame, sizes, raw, *others)

    monkeypatch.setattr(allowance, "allowances", told)
    model = Changed(1)
    found = select.select(model, {"stiffness": 0.0}, most=3)
    assert found.accepted == ("effect_2", "effect_4") and found.rounds[-1].winner is None
    column, own = asked["effect_5", 0]["effect_5.size"][0], model.columns[0]
    alike = lambda key: np.corrcoef(column.ravel(), own[key].ravel())[0, 1]
    assert alike("stiffness") > 0.999 and abs(alike("effect_5.size")) < 0.1
