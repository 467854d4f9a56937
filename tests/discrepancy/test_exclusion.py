"""How large what was not found may be."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import exclusion, ranking, select
from ridecomfort.discrepancy.experiment import Candidate, Size

from .linear import Linear

JOB = ("both", 0)


class Blocks:
    """A frame of so many blocks of ten elements."""

    def __init__(self, count):
        self.count = count

    def blocks(self):
        return np.repeat(np.arange(self.count), 10)


def found(residual, *rows, probe=0.5):
    sizes = tuple(Size(f"both.{end}", "N", 1.0, 0.0, 9.0, probe) for end in ("front", "rear")[: len(rows)])
    columns = {(JOB, size.key): row for size, row in zip(sizes, rows)}
    return exclusion.of_all(Blocks(residual.size // 10), residual, columns, {"both": Candidate("both", sizes)}, {"both": JOB})


def test_intervals_hold_nought_of_what_is_not_there_nine_times_in_ten():
    """72 of them: 90 % of a binomial are 60 to 69; fewer than 58 would be once in 200."""
    held = 0
    for seed in range(12):
        selection = select.select(Linear(seed, {}), {"stiffness": 0.0})
        held += sum(one.interval[0] <= 0.0 <= one.interval[1] for one in selection.rounds[-1].excluded)
    assert 58 <= held <= 72


def test_what_was_accepted_is_not_among_them_and_what_is_too_small_is_within():
    made = Linear(1, {"effect_1.size": 3.0, "effect_4.size": 0.004})
    selection = select.select(made, {"stiffness": 0.0})
    others = {one.effect: one for one in selection.rounds[-1].excluded}
    assert selection.accepted == ("effect_1",) and others.keys() == {f"effect_{k}" for k in (0, 2, 3, 4, 5)}
    lower, upper = others["effect_4"].interval
    assert lower < 0.004 < upper < 0.05
    told = ranking.dataset(made, selection)
    assert told["other_effect"].values.tolist() == list(others) and told["other_interval"].values[3] == pytest.approx((lower, upper))


def test_one_step_is_the_least_square_and_its_interval_as_wide_as_in_closed_form():
    """Of white noise of one, one over the root of the column's power."""
    rng = np.random.default_rng(5)
    column, noise = rng.standard_normal((2, 4000))
    (one,) = found(noise - 0.2 * column, column)
    step = 0.2 - noise @ column / (column @ column)
    assert one.size == pytest.approx(1.0 + 0.5 * step) and (one.parameter, one.unit, one.plausible) == ("front", "N", (0.0, 9.0))
    assert (one.interval[1] - one.interval[0]) / 2 == pytest.approx(0.5 * 1.645 / np.sqrt(column @ column), rel=0.15)


@pytest.mark.parametrize(("largest", "shows"), [(0.9, False), (1.1, True)])
def test_what_would_not_show_at_any_plausible_size_is_not_estimated(largest, shows):
    """The largest, 8 above neutral in probes of 0.5, does no more than noise does in one direction."""
    column = np.full(400, largest / 16.0 / 20.0)
    (one,) = found(np.random.default_rng(7).standard_normal(400), column)
    assert np.isfinite([one.size, *one.interval]).all() == shows


def test_sizes_that_are_not_told_from_one_another_have_no_interval():
    column, noise = np.random.default_rng(6).standard_normal((2, 400))
    front, rear = found(noise, column, -2.0 * column)
    assert np.isnan(front.interval).all() and np.isnan(rear.interval).all()
    apart = found(noise, column, np.roll(column, 1))
    assert np.isfinite([one.interval for one in apart]).all()
