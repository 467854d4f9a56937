"""What to do next after a verdict."""

import re
from dataclasses import replace

import pytest
import yaml

from ridecomfort import config as configuration
from ridecomfort.discrepancy.explain import NIL, REPEATS
from ridecomfort.report import diagnosed
from ridecomfort.report.tables import advice
from tests.report import differing as made_up
from tests.report.differing import PROPOSAL, rows, words


@pytest.mark.parametrize(("held_out", "first", "second"), [(0.72, "Go on from", "look at the form"), (0.7499, "Go on from", "look at the form"), (0.78, "Look at", "go on from")])
def test_the_better_of_library_and_proposed_form_comes_first(held_out, first, second):
    proposal = PROPOSAL | {"share": 0.70, "held_out_share": held_out}
    tables = diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "verdict": "outside", "proposal": proposal}))
    said = rows(tables["verdict"])[-1]["in_words"]
    assert said.startswith(first) and f"The second choice: {second[:7]}" in said


@pytest.mark.parametrize(("verdict", "floor", "is_said"), [("outside", NIL, True), ("outside", REPEATS, False), ("named", NIL, False)])
def test_where_something_is_missing_beside_a_floor_that_is_not_known_noise_comes_first(verdict, floor, is_said):
    found = made_up.diagnosis({**made_up.VERDICT, "verdict": verdict})
    found = replace(found, ranking=found.ranking.assign_attrs(floor=floor))
    said = rows(diagnosed.tables(found)["verdict"])[-1]["in_words"]
    assert said.startswith("First tell the noise of the instruments (noise_density") is is_said


@pytest.mark.parametrize(("library", "said"), [(0.15, "Go on from what the library has"), (0.05, "Nothing that was found explains much")])
def test_a_form_that_explains_little_is_not_to_be_switched_on(library, said):
    proposal = PROPOSAL | {"share": 0.08, "held_out_share": 0.12}
    little = {**made_up.VERDICT, "verdict": "outside", "share": library, "held_out_share": library, "proposal": proposal}
    next_step = rows(diagnosed.tables(made_up.diagnosis(little))["verdict"])[-1]["in_words"]
    assert next_step.startswith(said) and "discovered.py" not in next_step


@pytest.mark.parametrize(("left", "said"), [(0.011, "1.1 % of the power of any signal: the loop may end here"), (0.08, "8.0 % of the power of a_x, is worth a look")])
def test_where_little_is_found_it_is_said_whether_what_is_left_matters(left, said):
    found = {**made_up.VERDICT, "verdict": "outside", "share": 0.05, "held_out_share": 0.05, "remainder": {"a_z": 0.002, "a_x": left}}
    found["proposal"] = PROPOSAL | {"share": 0.08, "held_out_share": 0.12}
    assert said in rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]


@pytest.mark.parametrize(
    ("verdict", "at_first", "is_little"),
    [("named", 0.004, True), ("outside", 0.004, True), ("cluster", 0.004, True), ("named", 0.4, False), ("suspect", 0.004, False)],
)
def test_where_there_was_little_to_explain_the_loop_may_end_unless_what_was_found_is_most_of_it(verdict, at_first, is_little):
    told = lambda share: rows(
        diagnosed.tables(
            made_up.diagnosis({**made_up.VERDICT, "verdict": verdict, "share": share, "held_out_share": share, "at_first": {"a_z": at_first}})
        )["verdict"]
    )
    assert ("no signal has more than 0.4 % of its power above the floor" in told(0.3)[0]["in_words"]) == is_little
    assert told(0.3)[-1]["in_words"].startswith("The loop may end here. Else: ") == is_little
    assert "The loop may end" not in told(0.9)[-1]["in_words"]


def test_before_a_form_that_is_most_of_a_little_error_the_loop_does_not_end():
    little = {**made_up.VERDICT, "verdict": "outside", "share": 0.1, "held_out_share": 0.1, "at_first": {"a_z": 0.015}}
    for share, may_end in ((0.9, False), (0.3, True)):
        found = {**little, "proposal": PROPOSAL | {"share": share, "held_out_share": share}}
        said = rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]
        assert "Look at the proposed form" in said and said.startswith("The loop may end here.") == may_end


def test_a_form_that_removes_little_of_a_little_error_of_fitted_drives_is_not_to_be_tried():
    little = {**made_up.VERDICT, "verdict": "outside", "share": 0.02, "held_out_share": 0.29, "remainder": {"yaw_rate": 0.002}}
    for at_first, is_tried in (({"a_z": 0.015}, False), ({"a_z": 0.4}, True)):
        found = {**little, "at_first": at_first, "proposal": PROPOSAL | {"share": 0.06, "held_out_share": 0.41}}
        said = rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]
        assert ("Look at the proposed form" in said) == is_tried
        assert said.endswith("What is left is no more than 1.5 % of the power of any signal: the loop may end here.") != is_tried


def test_where_no_form_is_found_either_it_is_said_whether_what_is_left_matters():
    for left, end in ((0.004, "the loop may end here"), (0.08, "is worth a look at where it lies")):
        found = {**made_up.nothing(), "verdict": "outside", "remainder": {"a_z": 0.002, "a_x": left}}
        said = rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]
        assert said.startswith("No form was found") and end in said


def test_what_is_not_to_be_switched_on_takes_nothing_of_what_is_left():
    """An effect that a search kept and that got no name."""
    found = {**made_up.nothing(), "verdict": "outside", "remainder": {"a_z": 0.012}, "at_first": {"a_z": 0.045}}
    said = rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]
    assert said.startswith("No form was found") and "4.5 % of the power of a_z, is worth a look" in said


def test_what_of_the_library_helps_an_error_from_outside_of_it_can_be_gone_on_from():
    said = words(diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "verdict": "outside"}))["verdict"])
    assert "suspension friction takes 80 % on the fitted drives, 75 % on drives held out" in said
    assert "effects: [suspension_friction]" in said


def test_what_does_not_help_on_drives_held_out_is_not_to_be_gone_on_from():
    useless = {**made_up.VERDICT, "verdict": "outside", "held_out_share": -0.004}
    assert "in the library" not in [row["what"] for row in rows(diagnosed.tables(made_up.diagnosis(useless))["verdict"])]


def test_a_road_that_fits_better_when_it_is_interpolated_otherwise_comes_before_all_else():
    found = made_up.diagnosis()
    found.ranking.attrs["road"] = "the drives fit the road better with linear interpolation between its points (road: options: interpolation: linear)"
    assert "next First set road: options: interpolation: linear in the site file" in words(diagnosed.tables(found)["verdict"])


def test_the_sizes_that_effects_had_before_they_were_switched_on_are_told_again():
    """The search fits what is uncertain of the vehicle beside them, which calibration holds."""
    before = {"suspension_friction": {**made_up.VERDICT["effects"][0], "model": "base"}}
    found = replace(made_up.diagnosis(made_up.nothing()), model="suspension_friction", switched_on=("suspension_friction",), told_before=before)
    (row,) = (row for row in rows(diagnosed.tables(found)["verdict"]) if row["what"] == "suspension friction, switched on")
    size = made_up.VERDICT["effects"][0]["sizes"][0]
    assert row["in_words"].startswith(f"The verdict on the model base: front {size['size']:.3g} N (") and "prefer this" in row["in_words"]


def test_what_later_verdicts_say_of_what_was_switched_on_ends_the_table():
    again = {"suspension_friction": {**made_up.VERDICT, "share": 0.31, "held_out_share": None}, "payload+suspension_friction": made_up.nothing()}
    again["payload+suspension_friction"]["at_first"] = {"a_x": 0.002}
    last = [(row["what"], row["in_words"]) for row in rows(diagnosed.tables(replace(made_up.diagnosis(), later=again))["verdict"])[-2:]]
    assert [what for what, _ in last] == ["diagnosed again, model suspension_friction", "diagnosed again, model payload + suspension_friction"]
    assert last[0][1].endswith("(named) This takes 31 % of what is explainable then.")
    assert "(nothing) What is left is no more than 0.2 % of the power of any signal: the loop may end here." in last[1][1]


def test_what_comes_next_keeps_the_order_of_what_is_switched_on():
    """In another order the models of the error ladder would be others, and calibrated anew."""
    on = ("tyre_relaxation", "damper_knee")
    found = replace(made_up.diagnosis(), model="damper_knee+tyre_relaxation", switched_on=on)
    assert "effects: [tyre_relaxation, damper_knee, suspension_friction]" in words(diagnosed.tables(found)["verdict"])


def test_what_comes_next_keeps_sizes_that_are_held():
    found = replace(made_up.diagnosis(), model="steering_lag", switched_on=("steering_lag",), held={"steering_lag": {"time": 0.1}})
    assert "effects: [{steering_lag: {time: 0.1}}, suspension_friction]" in words(diagnosed.tables(found)["verdict"])


def test_held_sizes_can_be_pasted_as_they_are_said():
    """A millionth needs its point, and less digits would make another model, which is calibrated and diagnosed anew."""
    held = {"top_mount": {"front": 1e-06, "rear": 2.3456789e-06}, "payload": {"mass": 75}}
    found = replace(made_up.diagnosis(), model="payload+top_mount", switched_on=tuple(held), held=held)
    said = re.search(r"effects: (\[.*?\]) in config", words(diagnosed.tables(found)["verdict"]))[1]
    assert yaml.safe_load(said) == [{name: sizes} for name, sizes in held.items()] + ["suspension_friction"]
    assert "{mass: 75}" in said


def test_names_beside_a_form_of_ones_own_are_said_with_a_caution():
    own = replace(made_up.diagnosis(), model="discovered", switched_on=("discovered",))
    assert "take out again what does not lower the error ladder" in words(diagnosed.tables(own)["verdict"])
    assert "take out again" not in words(diagnosed.tables(made_up.diagnosis())["verdict"])


def test_an_effect_of_the_library_is_no_form_of_ones_own_where_a_size_is_held():
    held = replace(made_up.diagnosis(), model="aerodynamic_drag", switched_on=("aerodynamic_drag",), held={"aerodynamic_drag": {"area": 0.64}})
    assert "a form of its own" not in words(diagnosed.tables(held)["verdict"])


def test_parameters_beyond_their_bounds_are_said_as_they_are_written_in_the_configuration():
    bar = {"parameter": "anti_roll_stiffness_rear", "unit": "N m/rad", "given": 10000.0, "bounds": [8500.0, 11500.0],
           "wider": [2833.3, 34500.0], "value": 34500.0, "interval": [20000.0, 49000.0]}  # fmt: skip
    inertia = {**bar, "parameter": "roll_inertia", "wider": [257.4, 1258.4], "value": 406.2}
    beyond = {"parameters": [inertia, bar], "share": 0.27, "held_out_share": 0.16, "is_first": True}
    said = words(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": beyond}))["verdict"])
    assert "Add roll_inertia, anti_roll_stiffness_rear to calibration: parameters in config/study.yaml, unless they are there" in said
    # Half to twice what was found is within the bounds, too: a bar that ends where it was allowed to wants to go on.
    assert "put roll_inertia: [203, 1260], anti_roll_stiffness_rear: [2830, 69000] into calibration: bounds" in said
    assert said.startswith("verdict No effect of the library is missing: parameters of the vehicle lie far from its file. (outside)")
    less_sure = beyond | {"parameters": [inertia], "less_sure": [bar]}
    assert words(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": less_sure}))["verdict"]) == said
    named = diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "beyond_bounds": beyond}))["verdict"]
    assert [row["what"] for row in rows(named)][-2:] == ["the vehicle", "next, after the vehicle"]
    assert rows(named)[-1]["in_words"].startswith("This was found with the vehicle put right as above, so that both may be done in one go. ")
    small = {**made_up.nothing(), "verdict": "outside", "beyond_bounds": beyond, "remainder": {"a_z": 0.01}}
    last = rows(diagnosed.tables(made_up.diagnosis(small))["verdict"])[-1]["in_words"]
    assert last == "Nothing is to be switched on. What is left is no more than 1.0 % of the power of any signal: the loop may end here."
    suspect = diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "suspect", "beyond_bounds": beyond}))["verdict"]
    assert not any("the vehicle" in row["what"] for row in rows(suspect)) and rows(suspect)[-1]["in_words"].startswith("Put the data right first")
    friction = beyond | {"parameters": [{**bar, "parameter": "tyre_friction", "value": 0.9, "wider": [0.5, 1.5]}]}
    said = words(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": friction}))["verdict"])
    assert "unless they are there (and take tyre_friction out of diagnosis: uncertain, if it stands there)" in said
    # Beside an error that nothing explains, a few percent that go with the file are not all that is missing.
    little = beyond | {"share": 0.06, "held_out_share": 0.06}
    for is_first, more in ((False, {}), (True, {"is_left": True}), (True, {"may_be_more": True}), (True, {"remainder": {"a_z": 0.3}})):
        beside = {**made_up.nothing(), "verdict": "outside", "beyond_bounds": {**little, "is_first": is_first}, **more}
        said = words(diagnosed.tables(made_up.diagnosis(beside))["verdict"])
        assert said.startswith("verdict Something is missing that is not in the library. (outside)") and "Nothing is to be switched on" not in said


def test_effects_each_of_which_may_as_well_be_none_are_not_told_from_something_else():
    effects = [{**effect, "like": [], "is_open": True} for effect in made_up.VERDICT["effects"]]
    said = {**made_up.VERDICT, "verdict": "cluster", "effects": effects}
    told = rows(diagnosed.tables(made_up.diagnosis(said))["verdict"])
    first = told[0]["in_words"]
    assert first.endswith(" or something else; the data do not tell those apart. (cluster)"), first
    assert told[-1]["in_words"].startswith("Switch on what may be missing, effects: [suspension_friction]"), "there is no other to try"
    like = {**said, "effects": [{**effects[0], "like": ["top_mount"]}, *effects[1:]]}
    for other in (like, {**said, "beyond_bounds": {"is_as_good": True, "is_instead": True, "parameters": []}}):
        assert advice.next_step(made_up.diagnosis(other)).startswith("Switch one of each cluster on")
    for other in ({**said, "verdict": "suspect"}, {**said, "effects": [{**effects[0], "is_open": False}, *effects[1:]]}):
        assert "something else" not in rows(diagnosed.tables(made_up.diagnosis(other))["verdict"])[0]["in_words"]


def test_a_form_that_explains_as_much_as_the_names_of_a_cluster_is_to_be_tried_in_their_place():
    found = {**made_up.VERDICT, "verdict": "cluster", "is_like_force": True, "proposal": PROPOSAL}
    told = {row["what"]: row["in_words"] for row in rows(diagnosed.tables(replace(made_up.diagnosis(found), switched_on=("damper_knee",)))["verdict"])}
    assert "or something else; the data do not tell those apart. (cluster)" in told["verdict"] and "proposed form" in told
    assert "Switch one of each cluster on, effects: [damper_knee, suspension_friction]" in told["next"]
    assert "Something else is the proposed form in the rows above: to try that in their place, put " in told["next"]
    assert "discovered.py into a folder of your own" in told["next"] and "switch it on, effects: [damper_knee, discovered]." in told["next"]
    assert "discovered" not in rows(diagnosed.tables(made_up.diagnosis({**found, "proposal": None}))["verdict"])[-1]["in_words"]


def test_parameters_that_calibration_holds_beside_the_drives_are_to_be_calibrated_too():
    inertia = {"parameter": "roll_inertia", "unit": "kg m2", "given": 572.0, "value": 589.0, "interval": [588.0, 590.0]}
    off = {"parameters": [inertia, {**inertia, "parameter": "damping_front"}], "left": {"roll_rate": 0.002}}
    for said in (made_up.VERDICT, made_up.nothing()):
        told = rows(diagnosed.tables(made_up.diagnosis({**said, "off_file": off}))["verdict"])
        assert [row["what"] for row in told][-2:] == ["the vehicle's file", "next"]
        assert told[-1]["in_words"].startswith("First, or in the same go, put the vehicle's file right, as the row above says. Then: ")
        assert told[-2]["in_words"].startswith("Add roll_inertia, damping_front to calibration: parameters in config/study.yaml")
    assert "the vehicle's file" not in [row["what"] for row in rows(diagnosed.tables(made_up.diagnosis())["verdict"])]


def test_what_is_to_be_calibrated_too_is_told_ready_to_copy_with_all_that_stands_there(project):
    off = {"parameters": [{"parameter": "damping_front"}, {"parameter": "tyre_friction"}]}
    bar = {"parameter": "anti_roll_stiffness_rear", "unit": "N m/rad", "given": 10000.0, "bounds": [8500.0, 11500.0],
           "wider": [2833.3, 34500.0], "value": 19900.0, "interval": [19000.0, 20800.0]}  # fmt: skip
    beyond = {"parameters": [bar], "share": 0.27, "held_out_share": 0.16, "is_first": True}
    for more, first in (({}, []), ({"beyond_bounds": beyond}, ["anti_roll_stiffness_rear"])):
        found = made_up.diagnosis({**made_up.VERDICT, "off_file": off, **more})
        found.ranking.attrs["calibrated"] = "tyre_friction, roll_inertia, damper_knee.front"
        (said,) = [row["in_words"] for row in rows(diagnosed.tables(found)["verdict"]) if row["what"] == "the vehicle's file"]
        written = yaml.safe_load(said.partition("study.yaml, ")[2].partition(" with those")[0])
        names = ["tyre_friction", "roll_inertia", *first, "damping_front"]
        assert written == {"calibration": {"parameters": names}}
        assert configuration.load({"sites": ["own"], **written}, project).settings["calibration"]["parameters"] == names


def test_parameters_that_are_another_explanation_come_last():
    bar = {"parameter": "anti_roll_stiffness_rear", "unit": "N m/rad", "given": 10000.0, "bounds": [8500.0, 11500.0],
           "wider": [2833.3, 34500.0], "value": 19900.0, "interval": [19000.0, 20800.0]}  # fmt: skip
    beyond = {"parameters": [bar], "share": 0.27, "held_out_share": 0.16, "is_first": False, "is_instead": True}
    told = rows(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": beyond}))["verdict"])
    assert [row["what"] for row in told][-2:] == ["next", "or, the vehicle"]
    assert told[-1]["in_words"].startswith("In place of that: if the vehicle's file may be that wrong")
    assert told[0]["in_words"].startswith("Something is missing that is not in the library.")
    fewer = advice.farther(beyond | {"effects": ["damper_knee"]})
    assert fewer.startswith("In place of that, with damper_knee alone of the effects above: if the vehicle's file may be that wrong")


def test_bounds_that_are_proposed_are_those_of_a_vehicle_and_read_as_numbers(project):
    """What the verdict says, put into config/study.yaml as it stands, is taken."""
    tyre = {"parameter": "tyre_radial_stiffness", "unit": "N/m", "given": 320e3, "bounds": [250e3, 400e3], "wider": [83333.3, 1.2e6],
            "value": 155e3, "interval": [150e3, 160e3]}  # fmt: skip
    damper = {**tyre, "parameter": "damping_front", "unit": "N s/m", "wider": [700.0, 20000.0], "value": 18e3}
    said = advice.farther({"parameters": [tyre, damper]})
    bounds = said.partition(" put ")[2].partition(" into ")[0]
    assert bounds == "tyre_radial_stiffness: [80000, 1200000], damping_front: [700, 30000]"
    given = yaml.safe_load("{" + bounds + "}")
    names = ["tyre_radial_stiffness", "damping_front"]
    study = configuration.load({"sites": ["own"], "calibration": {"parameters": names, "bounds": given}}, project)
    assert study.settings["calibration"]["bounds"]["damping_front"] == [700, 30000]


@pytest.mark.parametrize("verdict", ["named", "outside"])
@pytest.mark.parametrize("form", [{}, PROPOSAL | {"share": None, "held_out_share": None}])
def test_shares_of_an_error_that_none_was_explainable_of_are_unknown_and_no_reason_to_fail(verdict, form):
    unknown = {"share": None, "held_out_share": None}
    effects = [{**effect, **unknown} for effect in made_up.VERDICT["effects"]]
    found = made_up.diagnosis({**made_up.VERDICT, **unknown, "verdict": verdict, "effects": effects, "proposal": form, "at_first": {"a_z": 0.002}})
    said = " ".join(row["in_words"] for row in rows(diagnosed.tables(found)["verdict"]))
    assert "an unknown share" in said


def test_a_form_with_which_most_goes_is_switched_on_before_what_stands_beside_it():
    """On the ladder the smaller of two, first, may seem to make drives held out worse: a lag of the steering beside an undamped nose."""
    for own, keys in ((0.8, "[discovered, steering_lag]"), (0.2, "[steering_lag, discovered]")):
        proposal = PROPOSAL | {"name": "discovered", "beside": ["steering_lag"], "share": 0.84, "own_share": own}
        found = {**made_up.VERDICT, "verdict": "outside", "proposal": proposal, "is_beside_form": True}
        assert f"effects: {keys}" in words(diagnosed.tables(made_up.diagnosis(found))["verdict"])
