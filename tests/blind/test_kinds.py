"""What blind trials are drawn from."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blind import kinds

ROUND = 8

MANY = range(24)

SPOILT = {
    "path error": {"path_error": 0.06, "aligned": True}, "clock error, aligned": {"clock": 0.008, "aligned": True},
    "clock error, left": {"clock": 0.008}, "gain error": {"gain": 0.03}, "scanner noise": {"scanner": 0.001},
    "another interpolation": {"interpolation": "linear"}, "brisk foot": {"foot": 0.2, "speed_noise": 0.014},
    "brisk foot, clean speed": {"foot": 0.2}, "nothing": {},
}  # fmt: skip


def draws(kind: str, seed: int = 1) -> list[kinds.Draw]:
    return [kinds.draw(kind, seed, number) for number in MANY]


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


@pytest.mark.parametrize(("one", "other"), [("messy", "three"), ("outside", "outside, beside a wrong file"), ("messy", "outside, messy")])
def test_kinds_are_drawn_apart(one, other):
    pairs = [(a, b) for a, b in zip(draws(one), draws(other)) if not a.missing]
    assert sum(a.hidden[0] == b.hidden[0] for a, b in pairs) < 0.2 * len(pairs)
    assert sum(a.kappa == b.kappa for a, b in pairs) < 0.75 * len(pairs)


@pytest.mark.parametrize(("kind", "spoilt"), SPOILT.items())
def test_where_nothing_is_hidden_the_data_are_spoilt_one_way(kind, spoilt):
    assert all(draw == kinds.Draw((), 0.0, frozenset(), spoilt=spoilt) for draw in draws(kind))


def test_clean_cars_have_one_effect_of_any_size_and_nothing_else():
    found = draws("clean")
    assert all(draw == kinds.Draw(draw.hidden, draw.kappa, frozenset(draw.hidden)) and len(draw.hidden) == 1 for draw in found)
    assert {draw.kappa for draw in found} == set(kinds.KAPPAS)


def test_a_messy_car_is_spoilt_in_every_way():
    found = draws("messy")
    ways = {"background", "clock", "gain", "scanner", "aligned", "foot", "speed_noise"}
    assert all(set(draw.spoilt) == ways and draw.spoilt["aligned"] and draw.right == {*draw.hidden} for draw in found)
    assert all(len({*draw.hidden, *draw.spoilt["background"]} - {*kinds.FAINT}) == 3 for draw in found)
    assert all(draw.there == {*draw.hidden, *draw.spoilt["background"]} for draw in found)
    spread = {way: np.array([draw.spoilt[way] for draw in found]) for way in ways - {"background", "aligned"}}
    assert 0.002 < spread["clock"].std() < 0.01 and 0.001 < spread["gain"].std() < 0.006
    assert spread["scanner"] == pytest.approx(1e-4)
    assert 0.0 < spread["foot"].min() < 0.1 and 0.2 < spread["foot"].max() < 0.3
    assert 0.0 < spread["speed_noise"].min() < 0.006 and 0.014 < spread["speed_noise"].max() < 0.02


def test_sets_hold_as_many_effects_as_their_kind_says():
    for kind, count in (("two", 2), ("three", 3)):
        found = draws(kind)
        assert all(len({*draw.hidden}) == count and draw.right == {*draw.hidden} and not draw.spoilt for draw in found)
        assert not any(set(draw.hidden) & set(kinds.FAINT) for draw in found) and {draw.kappa for draw in found} == {1.0, 3.0}


def test_outside_is_by_turns_a_force_that_the_library_never_had_and_an_effect_that_it_is_left_without():
    found = draws("outside", 2)
    assert all(not draw.right and not draw.spoilt and not draw.wrong and draw.kappa in kinds.STRONG for draw in found)
    assert all(draw.hidden[0] in kinds.MADE_UP and not draw.missing for draw in found[::2])
    assert all(draw.hidden == draw.missing and draw.hidden[0] in kinds.of_the_vehicle() for draw in found[1::2])


def test_on_a_noisy_road_a_force_is_made_up_and_the_data_are_spoilt_but_for_background_and_foot():
    for draw in draws("outside, messy"):
        assert draw.hidden[0] in kinds.MADE_UP and not draw.right and not draw.missing
        assert set(draw.spoilt) == {"clock", "gain", "scanner", "aligned"} and draw.spoilt["scanner"] == 1e-4


def test_beside_a_made_up_force_stands_an_effect_of_the_library_which_is_right():
    for draw in draws("outside, beside the library"):
        made_up, own = draw.hidden
        assert made_up in kinds.MADE_UP and own in kinds.of_the_vehicle() and draw.right == {own} and not draw.missing


def test_a_wrong_file_is_far_off_in_one_or_two_parameters_and_by_turns_hides_an_effect():
    found = draws("wrong file", 2)
    factors = [factor for draw in found for factor in draw.wrong.values()]
    assert {len(draw.wrong) for draw in found} == {1, 2}
    assert all(0.5 <= factor <= 0.75 or 1.4 <= factor <= 2.2 for factor in factors) and min(factors) < 1.0 < max(factors)
    assert all(len(draw.hidden) == 1 and draw.right == {*draw.hidden} and draw.kappa in kinds.STRONG for draw in found[::2])
    assert all(not draw.hidden and not draw.right for draw in found[1::2])


def test_what_the_library_has_of_another_shape_or_of_an_instrument_is_right():
    for kind, names in (("another shape", kinds.SHAPED), ("measurement", kinds.OF_MEASUREMENT)):
        found = draws(kind)
        assert all(draw.right == {names[draw.hidden[0]]} for draw in found) and {draw.hidden[0] for draw in found} == set(names)
    assert all(draw.spoilt == {"aligned": True} for draw in draws("measurement"))


def test_an_effect_is_set_otherwise_by_what_shapes_it_and_a_bump_stop_is_among_them():
    found = draws("another setting")
    assert all(set(draw.settings) == set(draw.hidden) and all(draw.settings.values()) for draw in found)
    assert "bump_stop" in {draw.hidden[0] for draw in found} and len({str(draw.settings) for draw in found}) == len(found)


def test_what_is_faint_is_in_the_library():
    assert set(kinds.FAINT) < set(kinds.of_the_vehicle())
