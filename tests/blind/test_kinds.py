"""What blind trials are drawn from."""

from __future__ import annotations

import pytest

from tests.blind import kinds

ROUND = 8


def test_consecutive_seeds_go_through_the_whole_library():
    drawn = [kinds.draw("clean", seed, number).hidden[0] for seed in range(6) for number in range(ROUND)]
    assert set(drawn[:ROUND]) != set(drawn[ROUND : 2 * ROUND])
    assert len(set(drawn)) > 0.9 * len(kinds.of_the_vehicle())


@pytest.mark.parametrize("kind", kinds.KINDS)
def test_a_draw_depends_on_seed_and_number_alone(kind):
    assert kinds.draw(kind, 3, 1) == kinds.draw(kind, 3, 1)


def test_beside_a_force_outside_of_the_library_the_file_is_wrong_and_no_name_is_right():
    draws = [kinds.draw("outside, beside a wrong file", 1, number) for number in range(5)]
    assert all(draw.wrong and not draw.right and set(draw.hidden) <= set(kinds.MADE_UP) for draw in draws)
