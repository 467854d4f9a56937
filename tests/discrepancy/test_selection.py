"""What of the explainable error goes with each of the effects that a selection accepted."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ridecomfort.discrepancy import select
from ridecomfort.discrepancy.balance import total_shares
from ridecomfort.discrepancy.selection import shares_of

from .linear import Linear


@pytest.mark.parametrize("needless", [(), (0,), (1,), (2,), (0, 1), (1, 2)])
def test_shares_of_what_is_kept_add_up_to_what_the_last_model_removes(needless):
    """What stood in for others lends them its share, wherever it came."""
    selection = select.select(Linear(1, {f"effect_{k}.size": 2.0 for k in (1, 2, 4)}), {"stiffness": 0.0}, most=3)
    first, _, _ = steps = [shares_of(selection, name) for name in selection.accepted]
    found = replace(selection, needless=frozenset(selection.accepted[k] for k in needless))
    assert found.kept == tuple(name for k, name in enumerate(selection.accepted) if k not in needless)
    assert [sum(own) for own in zip(*(shares_of(found, name) for name in found.kept))] == pytest.approx(total_shares(found))
    for k in needless:  # which has its own of when it was found
        assert shares_of(found, selection.accepted[k]) == steps[k]
    if needless == (1,):
        assert shares_of(found, selection.accepted[0]) == first
