"""One round of the search: who is refitted, and what is told of candidates that were not judged."""

from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy import contest, select

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
