"""A verdict says what is left, and what is told of the parameters of the vehicle."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ridecomfort.discrepancy.amended import with_bounds, with_parameters, with_remainder
from ridecomfort.discrepancy.beyond import AtBound, Beyond, BeyondBounds
from ridecomfort.discrepancy.reconsider import heard
from tests.discrepancy.verdicts import FOUND, NOTHING, OUTSIDE


def beyond(share=0.3, held_out_share=0.2, is_first=False):
    inertia = Beyond("roll_inertia", "kg m2", 572.0, (515.0, 629.0), (257.0, 1258.0), 390.0, (380.0, 400.0))
    return BeyondBounds((inertia,), share, held_out_share, is_first)


def test_what_is_left_is_said_in_percent_of_the_power_of_each_signal():
    left = {"a_x": 0.004, "a_y": 0.012, "a_z": 0.0004, "yaw_rate": 0.25, "roll_rate": 0.002}
    found = with_remainder(OUTSIDE, left, left)
    assert found.reasons[-1] == "left above the floor: 25.0 % of the power of yaw_rate, 1.2 % of the power of a_y and 0.4 % of the power of a_x"
    assert found.json()["remainder"]["roll_rate"] == 0.002
    dropped = with_remainder(replace(OUTSIDE, effects=(FOUND,)), left, left, [FOUND.name, "crosswind"])
    assert dropped.reasons[-1].startswith(f"left above the floor with {FOUND.name}, crosswind: 25.0 %"), "not those of the verdict alone"
    assert "less than 0.1 % of the power of any signal" in with_remainder(OUTSIDE, {"a_x": 0.0}, {}).reasons[-1]


@pytest.mark.parametrize(("at_first", "is_little"), [(0.004, True), (0.4, False)])
def test_where_there_was_little_to_explain_the_first_sentence_says_how_little(at_first, is_little):
    found = with_remainder(replace(NOTHING, verdict="named", effects=(FOUND,)), {"a_x": 0.001}, {"a_x": 0.001, "a_z": at_first})
    assert ("It is little: no signal has more than 0.4 % of its power above the floor." in found.words()) == is_little
    assert "It is little" not in with_remainder(NOTHING, {}, {"a_z": at_first}).words()


def test_a_limit_that_would_be_rounded_to_nothing_is_the_least_that_is_said():
    found = with_remainder(replace(NOTHING, verdict="named", effects=(FOUND,)), {"a_x": 0.0}, {"a_x": 0.0001, "a_z": 0.0004})
    assert "no signal has more than 0.1 % of its power above the floor" in found.words()


def test_parameters_beyond_their_bounds_are_a_reason_more():
    named = replace(NOTHING, verdict="named", effects=(FOUND,))
    said = with_parameters(named, beyond())
    assert said.verdict == "named" and said.reasons[:-1] == named.reasons
    assert said.reasons[-1].startswith("another 30 % of the explainable error, 20 % on drives held out,")
    assert "roll_inertia 390 kg m2 (380 to 400) for 572" in said.reasons[-1]
    assert said.json()["beyond_bounds"]["parameters"][0]["interval"] == [380.0, 400.0]
    assert with_parameters(named, None) is named


def test_parameters_are_told_beside_effects_only_where_there_are_any_and_for_the_values_of_the_file():
    named = replace(NOTHING, verdict="named", effects=(FOUND,))
    assert with_parameters(named, beyond()).reasons[-1].startswith("another 30 % of the explainable error")
    assert with_parameters(LITTLE_ALONE, beyond()).reasons[-1].startswith("30 % of the explainable error")
    assert "roll_inertia 390 kg m2 (380 to 400) for 600" in beyond().of({"roll_inertia": 600.0}).words(is_more=False)


def test_where_they_are_all_that_is_missing_it_is_no_effect_of_the_library():
    alone = with_parameters(NOTHING, beyond(is_first=True))
    assert alone.verdict == "outside"
    assert alone.words().startswith("No effect of the library is missing: parameters of the vehicle lie far from its file.")
    remaining = lambda share: with_parameters(with_remainder(NOTHING, {"a_x": 0.01, "a_z": share}, {}), beyond(is_first=True)).words()
    assert remaining(0.019).startswith("No effect of the library is missing")
    unnamed = lambda at_first: with_parameters(with_remainder(NOTHING, {"a_z": 0.001}, {"a_z": at_first}), beyond(is_first=True)).words()
    assert unnamed(0.019).startswith("No effect of the library is missing")
    assert unnamed(0.08).startswith("Something is missing"), "it went with effects that have no name"
    stands_in = with_parameters(replace(OUTSIDE, is_like_error=True), beyond(is_first=True)).words()
    assert stands_in.startswith("Something is missing"), "an error of the measurement would help"
    turning = with_parameters(heard(NOTHING, "an error of a_z comes back every 1.95 m of way", False), beyond(is_first=True))
    for other in (alone.words("force = ..."), replace(alone, is_left=True).words(), remaining(0.021), turning.words()):
        assert other.startswith("Something is missing that is not in the library.")
    first = with_parameters(replace(NOTHING, verdict="named", effects=(FOUND,), held_out_share=0.6), beyond(is_first=True))
    assert first.verdict == "named" and first.reasons[-1].endswith("other shares are of what they leave")


def test_an_effect_beside_them_that_drives_held_out_hardly_confirm_may_be_what_they_leave():
    named = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.49, held_out_share=0.09)
    said = with_parameters(named, beyond(is_first=True))
    assert said.verdict == "outside" and not said.effects and said.reasons[-1].startswith("friction may be what these leave")
    assert said.words().startswith("Something is missing that is not in the library.")
    unknown = replace(named, held_out_share=float("nan"))
    for other in (with_parameters(named, beyond()), with_parameters(unknown, beyond(is_first=True))):
        assert other.verdict == "named" and other.effects == (FOUND,)


def test_a_spring_that_ends_at_its_bound_is_a_reason_more_with_what_to_do():
    spring = AtBound("spring_stiffness_rear", "N/m", 15000.0, 15000.0, "lower")
    grip = AtBound("tyre_friction", "1", 1.4, 1.4, "upper")
    said = with_bounds(NOTHING, (spring, grip))
    assert said.verdict == "nothing" and said.reasons[:-1] == NOTHING.reasons
    assert said.reasons[-1].startswith("spring_stiffness_rear at 15000 N/m, its lower bound; tyre_friction at 1.4, its upper bound: ")
    assert "calibration: parameters, bounds" in said.reasons[-1]
    of_spring = {"parameter": "spring_stiffness_rear", "unit": "N/m", "value": 15000.0, "bound": 15000.0, "end": "lower", "is_wider": False}
    assert said.json()["at_bounds"][0] == of_spring
    tried = AtBound("anti_roll_stiffness_front", "N m/rad", 7083.333, 7083.333, "lower", True)
    assert with_bounds(NOTHING, (tried,)).reasons[-1].startswith("anti_roll_stiffness_front at 7080 N m/rad, the least that was tried beyond ")
    assert with_bounds(NOTHING, ()).reasons == NOTHING.reasons
    none = AtBound("anti_roll_stiffness_rear", "N m/rad", 0.0, 0.0, "lower")
    assert with_bounds(NOTHING, (none,)).reasons[-1] == (
        "anti_roll_stiffness_rear at 0 N m/rad, the least that there can be: something that is missing may drive it there"
    )


def test_one_that_lies_beyond_its_bounds_is_not_told_twice_and_suspect_data_come_first():
    inertia, spring = AtBound("roll_inertia", "kg m2", 257.0, 257.0, "lower"), AtBound("spring_stiffness_rear", "N/m", 15000.0, 15000.0, "lower")
    put_right = with_parameters(replace(NOTHING, verdict="outside"), beyond(is_first=True))
    said = with_bounds(put_right, (inertia, spring))
    assert said.at_bounds == (spring,) and "roll_inertia" not in said.reasons[-1]
    assert with_bounds(replace(NOTHING, verdict="suspect"), (spring,)).reasons == NOTHING.reasons


LITTLE_ALONE = replace(NOTHING, verdict="outside")
