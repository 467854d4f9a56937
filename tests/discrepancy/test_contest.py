"""One round of the search: what is told of candidates that were not judged."""

from types import SimpleNamespace

from ridecomfort.discrepancy import contest


def test_what_was_refitted_for_one_that_was_taken_back_is_told_for_its_gain():
    """Of six that are significant the first was taken back: the sixth was refitted, and gained little."""
    names, found = tuple("abcdef"), SimpleNamespace(opposite=frozenset())
    found.names, found.significant = names, lambda most: list(names)[:most]
    trials = [SimpleNamespace(name=name) for name in "bcde"]
    assert contest.passed_over(found, {"f"}, trials, {"a"}) == {"f": "its refit gains less than 5 % of the best"}
    assert contest.passed_over(found, set(), trials) == {"a": "could not be simulated", "f": "not refitted: the 5 that gain most were"}
