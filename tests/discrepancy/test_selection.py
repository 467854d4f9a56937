"""What of the explainable error goes with each of the effects that a selection accepted."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ridecomfort.discrepancy import select
from ridecomfort.discrepancy.balance import total_shares
from ridecomfort.discrepancy.selection import RESOLUTION, shares_of

from .linear import Linear


def test_no_interval_is_told_that_is_narrower_than_what_all_drives_have_in_common():
    """Of a size of 2, 90 % of a normal distribution lie within 1.645 standard deviations."""
    selection = select.select(Linear(1, {"effect_1.size": 2.0}), {"stiffness": 0.0})
    key = "effect_1.size"
    value, own = selection.final.values[key], selection.intervals[key]
    for interval, half in ((own, (own[1] - own[0]) / 2), ((value, value), 0.0)):
        lower, upper = replace(selection, intervals={key: interval}, allowed={}).told(key)
        assert (upper - lower) / 2 == pytest.approx((half**2 + (1.645 * RESOLUTION * value) ** 2) ** 0.5, rel=1e-3)


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
