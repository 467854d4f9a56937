"""A force of any form has its say where the library has none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ridecomfort.discrepancy.reconsider import beside_a_force, heard, humming, is_doubtful, named_all_the_same, reconsidered
from ridecomfort.discrepancy.verdict import Verdict
from tests.discrepancy.verdicts import FOUND, KNEE, NOTHING, OUTSIDE, SIZE, SURE


def test_a_sure_force_of_some_form_makes_outside_of_nothing():
    found = reconsidered(NOTHING, SURE)
    assert found.verdict == "outside" and "tyre" in found.reasons[-1]
    assert found.reasons[:-1] == NOTHING.reasons
    assert beside_a_force(found, SURE).reasons == found.reasons, "it is said once, and explains more than nothing"


def test_but_not_where_it_explains_no_more_than_effects_that_were_too_little_to_be_named():
    assert reconsidered(NOTHING, SURE, too_little=0.5 * SURE.share).verdict == "outside"
    assert reconsidered(NOTHING, SURE, too_little=0.95 * SURE.share) is NOTHING


@pytest.mark.parametrize("kind", ["nothing", "named"])
def test_what_hums_without_a_force_that_is_alike_in_all_drives_makes_data_suspect(kind):
    """As 40 Hz of the mains, folded down, where a foot makes drivetrain_lag take 47 % of little."""
    before = replace(NOTHING, verdict=kind, share=0.47)
    outside = heard(before, "an error of a_z comes back every 0.025 s at any speed", False)
    unsure = replace(SURE, held_out_share=-0.5)
    assert outside.verdict == "outside" and humming(before, outside, "s", unsure).verdict == "suspect"
    assert humming(before, outside, "s", unsure).reasons == outside.reasons
    found = humming(before, replace(outside, effects=(FOUND,)), "s", unsure)
    assert found.reasons == (*outside.reasons, "friction takes something, but may stand in for what hums")
    assert humming(before, outside, "m", unsure) is outside and humming(before, outside, "s", SURE) is outside
    assert humming(replace(before, verdict="outside"), outside, "s", unsure) is outside


def test_it_is_sure_too_where_held_out_drives_have_nothing_above_their_floor():
    assert reconsidered(NOTHING, replace(SURE, held_out_share=float("nan"))).verdict == "outside"


@pytest.mark.parametrize("doubt", [{"p_value": 0.03}, {"share": 0.15}, {"held_out_share": 0.1}, {"place": ""}])
def test_a_doubtful_one_changes_nothing(doubt):
    assert reconsidered(NOTHING, replace(SURE, **doubt)) is NOTHING


@pytest.mark.parametrize("kind", ["nothing", "suspect"])
def test_a_large_gain_that_drives_held_out_confirm_is_sure_whatever_its_p_value(kind):
    """As of a damper that gets firm beyond a centimetre, on a few rough stretches: p = 0.018, 93 % on fitted and held-out drives."""
    before, large = replace(NOTHING, verdict=kind), replace(SURE, p_value=0.018, is_large=True)
    assert reconsidered(before, large, kind == "suspect").verdict == "outside"
    for doubt in ({"is_large": False}, {"share": 0.45}, {"held_out_share": 0.45}, {"held_out_share": float("nan")}):
        assert reconsidered(before, replace(large, **doubt), kind == "suspect") is before


@pytest.mark.parametrize("held_out_share", [0.1, float("nan")])
def test_noise_of_the_road_alone_gives_way_to_a_force_that_is_more_than_noise_and_that_no_drive_held_out_refutes(held_out_share):
    suspect = replace(NOTHING, verdict="suspect")
    assert reconsidered(suspect, replace(SURE, share=0.4, held_out_share=held_out_share), True).verdict == "outside"
    assert reconsidered(suspect, replace(SURE, share=0.4, held_out_share=-0.1), True) is suspect


@pytest.mark.parametrize("is_road_open", [False, True])
def test_outside_stays_where_such_a_force_explains_more(is_road_open):
    other = replace(NOTHING, verdict="outside", effects=(FOUND,), share=0.4, held_out_share=0.4)
    assert reconsidered(other, SURE, is_road_open) is other
    no_more = replace(SURE, share=0.42, held_out_share=0.42)
    assert reconsidered(other, no_more, is_road_open).verdict == ("named" if is_road_open else "outside")


def test_what_takes_little_of_drives_held_out_is_sure_where_these_are():
    """On a noisy road most of what could be explained is noise of the road, which drives held out share."""
    little = replace(SURE, share=0.46, held_out_share=0.19)
    assert reconsidered(NOTHING, replace(little, held_out_z=5.0)).verdict == "outside"
    for weaker in ({"held_out_z": 1.0}, {"held_out_z": 5.0, "held_out_share": -0.1}, {"held_out_z": 5.0, "p_value": 0.03}, {"held_out_z": 5.0, "share": 0.15}):
        assert reconsidered(NOTHING, replace(little, **weaker)) is NOTHING


def assert_kept(found: Verdict, before: Verdict) -> None:
    """The verdict of before, and nothing new but that a force explains as much, so that what is named is not told from it."""
    assert replace(found, reasons=before.reasons) == replace(before, verdict="cluster", is_like_force=True)
    assert found.reasons[:-1] == before.reasons and "explains as much, and drives do not tell which it is" in found.reasons[-1]


@pytest.mark.parametrize("kind", ["named", "cluster"])
def test_a_name_gives_way_to_a_force_that_explains_more_and_no_less_of_drives_held_out(kind):
    named = replace(NOTHING, verdict=kind, effects=(FOUND,), share=0.6, held_out_share=0.5)
    found = reconsidered(named, SURE)
    assert found.verdict == "outside" and "90 %" in found.reasons[-1] and found.effects == named.effects
    for weaker in (replace(SURE, share=0.7), replace(SURE, held_out_share=0.45)):
        assert_kept(reconsidered(named, weaker), named)
    assert reconsidered(named, replace(SURE, p_value=0.03)) is named


def test_of_a_doubtful_name_it_is_said_where_a_force_explains_as_much():
    named = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.6, held_out_share=0.5)
    found = reconsidered(named, replace(SURE, share=0.62, held_out_share=0.52))
    assert "drives do not tell which it is: 62 %" in found.reasons[-1]
    assert found.words().startswith("Missing: friction or something else; the data do not tell those apart.")
    for weaker in (replace(SURE, share=0.58, held_out_share=0.48), replace(SURE, share=0.62, held_out_share=0.52, p_value=0.03)):
        assert reconsidered(named, weaker) is named


def test_a_name_that_leaves_an_error_for_certain_gives_way_to_a_force_that_is_a_little_better_but_to_none_that_is_equal():
    left = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.74, held_out_share=0.73, is_left=True)
    better = replace(SURE, share=0.8, held_out_share=0.7)
    assert reconsidered(left, better).verdict == "outside"
    assert reconsidered(replace(left, is_left=False), better).verdict == "cluster"
    for weaker in (replace(better, share=0.75), replace(better, share=0.7), replace(better, held_out_share=0.5)):
        assert reconsidered(left, weaker) is left


def test_a_name_that_leaves_little_but_that_for_certain_gives_way_to_a_force_that_leaves_half_of_it():
    little = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.82, held_out_share=0.77, may_be_shared=True)
    exact = replace(SURE, share=0.96, held_out_share=0.95)
    assert reconsidered(little, exact).verdict == "outside"
    for weaker in (replace(exact, share=0.88), replace(exact, held_out_share=0.8)):
        assert_kept(reconsidered(little, weaker), little)
    assert reconsidered(little, replace(exact, p_value=0.03)) is little
    assert reconsidered(replace(little, may_be_shared=False), exact).verdict == "cluster"
    hardly = replace(little, share=0.98, held_out_share=0.98)
    assert reconsidered(hardly, replace(exact, share=0.995, held_out_share=0.995)) is hardly


def test_a_doubtful_name_gives_way_to_a_force_that_fits_drives_better_beyond_chance_and_leaves_less():
    named = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.77, held_out_share=0.78)
    force = replace(SURE, share=0.81, held_out_share=0.89)
    assert reconsidered(named, force, fits_better=True).verdict == "outside"
    for is_sure_of_it, as_much in ((False, force), (True, replace(force, share=0.79, held_out_share=0.82))):
        assert_kept(reconsidered(named, as_much, fits_better=is_sure_of_it), named)
    firm = replace(named, share=0.83, held_out_share=0.8)
    assert reconsidered(firm, replace(force, share=0.93), fits_better=True) is firm
    on_fitted_drives = replace(named, share=0.84, held_out_share=0.55)
    assert is_doubtful(on_fitted_drives) and reconsidered(on_fitted_drives, force, fits_better=True).verdict == "outside"
    nobody = replace(named, held_out_share=float("nan"))
    assert reconsidered(nobody, replace(force, share=0.85, held_out_share=float("nan")), fits_better=True).verdict == "outside"


def test_a_name_too_large_to_be_plausible_gives_way_as_a_doubtful_one_does():
    large = SIZE | {"size": 4.9e-6, "interval_of_noise": [4.8e-6, 5.0e-6], "is_plausible": False}
    named = replace(NOTHING, verdict="named", effects=(replace(FOUND, sizes=(large,)),), share=0.9, held_out_share=0.89)
    force = replace(SURE, share=0.99, held_out_share=0.99)
    assert reconsidered(named, force, fits_better=True).verdict == "outside"
    within = replace(FOUND, sizes=(large | {"interval_of_noise": [3.9e-6, 5.0e-6]},))
    assert reconsidered(replace(named, effects=(within,)), force, fits_better=True).verdict == "named"


def test_an_error_of_the_measurement_alone_gives_way_to_a_force_that_explains_more_or_as_much_by_fewer_sizes():
    tilted = replace(FOUND, name="road_bank", sizes=(SIZE, SIZE), is_of_measurement=True)
    error = replace(NOTHING, verdict="suspect", effects=(tilted,), share=0.6, held_out_share=0.5)
    assert reconsidered(error, SURE, is_error_alone=True).verdict == "outside"
    as_much = replace(SURE, share=0.59, held_out_share=0.49)
    assert "fewer sizes" in reconsidered(error, as_much, is_error_alone=True).reasons[-1]
    one_size = replace(error, effects=(replace(tilted, sizes=(SIZE,)),))
    assert reconsidered(one_size, as_much, is_error_alone=True) is one_size
    assert reconsidered(error, replace(as_much, held_out_share=0.4), is_error_alone=True) is error
    fitted = replace(as_much, place="strut", terms={"slow_velocity": {"front": 900.0}}, settings={"slow_velocity": {"frequency": 7.0, "linear": 0.2}})
    assert reconsidered(error, fitted, is_error_alone=True) is error
    assert reconsidered(error, replace(SURE, p_value=0.03), is_error_alone=True) is error


def test_an_error_of_the_measurement_that_gave_way_is_not_named_after_all():
    """Its share would be enough, were it an effect; those of the vehicle beside it stay."""
    error = replace(FOUND, name="road_grade", sizes=(SIZE, SIZE), share=0.5, held_out_share=0.5, is_of_measurement=True)
    as_much = replace(SURE, share=0.57, held_out_share=0.52)
    suspect = replace(NOTHING, verdict="suspect", effects=(error,), share=0.5, held_out_share=0.5)
    found = named_all_the_same(reconsidered(suspect, as_much, is_error_alone=True), as_much)
    assert (found.verdict, found.effects, found.share, found.held_out_share) == ("outside", (), 0.0, 0.0)
    beside = replace(suspect, effects=(error, FOUND), share=0.8, held_out_share=0.8)
    found = reconsidered(beside, SURE, is_error_alone=True)
    assert found.effects == (FOUND,) and found.share == FOUND.share


def test_what_explains_most_is_named_though_a_rest_is_shared_that_no_force_explains():
    small = replace(FOUND, name="cornering_degression", share=0.03)
    left = replace(OUTSIDE, effects=(replace(FOUND, share=0.57, held_out_share=0.55), small))
    elsewhere = replace(small, share=0.18, held_out_share=0.04)
    assert named_all_the_same(replace(left, effects=(*left.effects[:1], elsewhere)), replace(SURE, share=0.5, held_out_share=0.5)).effects == left.effects[:1]
    found = named_all_the_same(left, replace(SURE, share=0.57, held_out_share=0.56))
    assert found.verdict == "named" and [effect.name for effect in found.effects] == [FOUND.name]
    assert (found.share, found.held_out_share) == (0.57, 0.55)
    assert "no form of a force that was tried explains much more" in found.reasons[-2] and found.reasons[-1].startswith("cornering_degression, which takes ")


@pytest.mark.parametrize("is_road_open", [True, False])
def test_a_cluster_that_is_named_after_all_says_on_which_drives_it_differs(is_road_open):
    alike = replace(FOUND, share=0.57, held_out_share=0.55, like=("top_mount",), differ_on={"top_mount": "site, passage 2"})
    left, weak = replace(OUTSIDE, effects=(alike,)), replace(SURE, share=0.3, held_out_share=0.3)
    found = reconsidered(left, weak, is_road_open=True) if is_road_open else named_all_the_same(left, weak)
    assert found.verdict == "cluster"
    assert "the data do not tell friction from top_mount; it differs most from top_mount on drives like site, passage 2" in found.reasons


@pytest.mark.parametrize("change", [{"share": 0.45}, {"held_out_share": 0.4}, {"verdict": "suspect"}, {"effects": ()}, {"is_like_error": True}])
def test_less_than_half_is_not_named(change):
    left = replace(OUTSIDE, effects=(FOUND,))
    assert named_all_the_same(replace(left, **change), replace(SURE, share=0.3)).verdict == replace(left, **change).verdict


def test_nor_is_what_may_as_well_be_none_where_repeats_share_an_error_still():
    """As of a trailer that nods: a payload of -254 to 560 kg did 70 and 88 %."""
    weak, is_none = replace(SURE, share=0.3, held_out_share=0.3), replace(FOUND, is_open=True)
    assert named_all_the_same(replace(OUTSIDE, effects=(FOUND,)), weak).verdict == "named"
    assert named_all_the_same(left := replace(OUTSIDE, effects=(is_none,)), weak) is left
    assert named_all_the_same(replace(OUTSIDE, effects=(is_none, KNEE)), weak).verdict == "named"


@pytest.mark.parametrize("better", [{"share": 0.65, "held_out_share": 0.58}, {"share": 0.6, "held_out_share": 0.62}])
def test_nor_is_what_a_force_does_better_than(better):
    left = replace(OUTSIDE, effects=(FOUND,))
    assert named_all_the_same(left, replace(SURE, **better)) is left


@pytest.mark.parametrize(("share", "is_named"), [(0.42, False), (0.52, True)])
def test_nor_is_what_removes_half_only_with_what_has_no_name(share, is_named):
    """Beside an effect that may be a part of what is left."""
    much, small = replace(FOUND, share=share, held_out_share=share), replace(KNEE, share=0.02, held_out_share=0.02)
    left = replace(OUTSIDE, effects=(much, small), share=share + 0.09, held_out_share=share + 0.09)
    found = named_all_the_same(left, replace(SURE, share=0.3, held_out_share=0.3))
    assert (found.effects == (much,) and found.verdict == "named") if is_named else found is left


LITTLE = replace(NOTHING, verdict="outside", effects=(FOUND,), share=0.3, held_out_share=0.3)


def test_noise_of_the_road_does_not_speak_against_what_was_found():
    weak = replace(SURE, share=0.2)
    assert reconsidered(LITTLE, weak, is_road_open=True).verdict == "named"
    assert reconsidered(LITTLE, weak, is_road_open=False).verdict == "outside"
    alike = replace(LITTLE, effects=(replace(FOUND, like=("knee",)),))
    assert reconsidered(alike, weak, is_road_open=True).verdict == "cluster"
    none_too = replace(LITTLE, effects=(replace(FOUND, is_open=True),))
    assert reconsidered(none_too, weak, is_road_open=True).words().startswith("Missing: friction or something else; the data do not tell")


def test_what_makes_drives_held_out_worse_has_no_name_on_such_a_road_either():
    """That they gain little may be the road: an imbalance of 0.3 on a noisy road removed 27 and 6 %."""
    weak = replace(SURE, share=0.2)
    for held_out, kind in ((-0.4, "outside"), (0.0, "outside"), (0.06, "named"), (float("nan"), "named")):
        assert reconsidered(replace(LITTLE, held_out_share=held_out), weak, is_road_open=True).verdict == kind


def test_little_on_such_a_road_may_be_the_road():
    less = replace(LITTLE, share=0.1)
    assert reconsidered(less, replace(SURE, share=0.05), is_road_open=True).verdict == "suspect"


def test_unless_a_force_explains_more_than_the_road_could():
    """As of joints with play, 0.29 and 0.20 beside friction of 0.02 and 0.01: of what is left noise of the road is most."""
    less, force = replace(LITTLE, share=0.02, held_out_share=0.01), replace(SURE, share=0.29, held_out_share=0.2)
    found = reconsidered(less, force, is_road_open=True)
    assert found.verdict == "outside" and "at the tyre that the library does not hold explains more: 29 %" in found.reasons[-1]
    for weaker in ({"share": 0.15}, {"held_out_share": -0.1}, {"p_value": 0.03}, {"place": ""}):
        assert reconsidered(less, replace(force, **weaker), is_road_open=True).verdict == "suspect"


def test_a_force_that_explains_more_does_even_on_a_noisy_road():
    assert reconsidered(LITTLE, SURE, is_road_open=True) is LITTLE


def test_a_road_alone_is_not_suspected_where_a_force_explains_more_than_its_noise_could():
    suspected = replace(NOTHING, verdict="suspect")
    assert reconsidered(suspected, replace(SURE, share=0.4, held_out_share=0.1), is_road_open=True).verdict == "outside"
    for weaker in ({"share": 0.15}, {"held_out_share": -0.1}, {"p_value": 0.03}, {"place": ""}):
        assert reconsidered(suspected, replace(SURE, **weaker), is_road_open=True) is suspected


WITH_FRICTION = replace(SURE, share=0.97, held_out_share=0.96, beside=(FOUND,))


def test_effects_that_are_missing_beside_a_force_take_the_place_of_those_that_stand_in_for_it():
    alone = replace(NOTHING, verdict="outside", effects=(FOUND, KNEE), share=0.5, held_out_share=0.45)
    found = beside_a_force(alone, WITH_FRICTION)
    assert found.effects == (FOUND,) and (found.share, found.held_out_share) == (0.3, 0.3)
    assert found.reasons[0] == "the library alone comes up to friction, damper_knee"
    assert found.reasons[-1].startswith("a force at the tyre that the library does not hold, with friction beside it, explains more: 97 %")
    assert beside_a_force(alone, replace(SURE, beside=())).effects == ()
    for weaker in (replace(WITH_FRICTION, share=0.6, held_out_share=0.55), replace(WITH_FRICTION, held_out_share=0.4), replace(WITH_FRICTION, p_value=0.03)):
        assert beside_a_force(alone, weaker) is alone
    named = replace(alone, verdict="named")
    assert beside_a_force(named, WITH_FRICTION) is named


def test_names_give_way_to_a_force_and_effects_beside_it_that_fit_better_beyond_chance_and_leave_half():
    """With all that the library has beside it, hardly any force would do no better."""
    named = replace(NOTHING, verdict="named", effects=(FOUND, KNEE), share=0.79, held_out_share=0.74)
    found = reconsidered(named, WITH_FRICTION, fits_better=True)
    assert found.verdict == "outside" and beside_a_force(found, WITH_FRICTION).reasons.count(found.reasons[-1]) == 1
    assert reconsidered(named, WITH_FRICTION) is named
    # The mean of fitted drives and of those held out counts, and neither may be hardly better.
    assert reconsidered(named, replace(WITH_FRICTION, held_out_share=0.86), fits_better=True).verdict == "outside"
    weaker = {"share": 0.8}, {"held_out_share": 0.79}, {"share": 0.88, "held_out_share": 0.87}, {"p_value": 0.03}
    for change in weaker:
        assert reconsidered(named, replace(WITH_FRICTION, **change), fits_better=True) is named


def test_what_explains_most_is_named_unless_such_a_force_leaves_half():
    left = replace(OUTSIDE, effects=(FOUND,))
    found = named_all_the_same(left, replace(WITH_FRICTION, share=0.7, held_out_share=0.68))
    assert found.verdict == "named" and "may be missing, too (70 % and 68 % together): beside what is named" in found.reasons[-1]
    assert "no form of a force that was tried" in named_all_the_same(left, replace(WITH_FRICTION, share=0.6, held_out_share=0.58)).reasons[-1]
    assert named_all_the_same(left, WITH_FRICTION) is left


def test_on_a_road_that_may_be_another_such_a_force_counts_where_it_leaves_half():
    assert reconsidered(LITTLE, WITH_FRICTION, is_road_open=True) is LITTLE
    assert reconsidered(LITTLE, replace(WITH_FRICTION, share=0.45), is_road_open=True).verdict == "named"


def test_a_force_is_held_against_all_that_the_library_found_with_what_has_no_name_of_it():
    """Alone an effect removes 55 % and with another, whose size may as well be none, 84 %: a force that removes 85 % is no better."""
    force = replace(SURE, share=0.85, held_out_share=0.8)
    named = replace(NOTHING, verdict="named", effects=(FOUND,), share=0.55, held_out_share=0.5)
    assert reconsidered(named, force).verdict == "outside"
    assert reconsidered(replace(named, of_all=(0.84, 0.82)), force).verdict == "named"
