"""The verdict, the evidence and the score: every kind of verdict is said, and says what to do."""

import inspect
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
import yaml
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from ridecomfort import config as configuration
from ridecomfort.discrepancy import confirm, select, tries
from ridecomfort.discrepancy.form import in_words
from ridecomfort.discrepancy.ranking import FORMS
from ridecomfort.discrepancy.score import score
from ridecomfort.discrepancy.verdict import SAID
from ridecomfort.report import catalogue, diagnosed, style, table
from ridecomfort.report.figures import evidence
from ridecomfort.report.study import Diagnosis
from ridecomfort.report.tables import advice, diagnosis
from tests.report import differing as made_up

PROPOSAL = {
    "name": "discovered", "form": "80 N tanh(velocity / 0.005)", "place": "strut", "port": "suspension", "such_as": "friction of seals",
    "share": 0.84, "held_out_share": 0.92, "p_value": 0.0015,
    "sizes": [{"parameter": "velocity_direction", "unit": "N", "size": 80.0, "interval": [78.0, 82.0]}],
}  # fmt: skip


def rows(made):
    return [dict(zip([column.key for column in made.columns], row)) for row in made.rows]


def words(made):
    return " ".join(str(cell) for row in made.rows for cell in row)


@pytest.mark.parametrize("kind", SAID)
def test_every_verdict_is_said_with_its_reasons_and_what_to_do_next(kind):
    verdict = {**(made_up.VERDICT if kind in ("named", "cluster") else made_up.nothing()), "verdict": kind}
    tables = diagnosed.tables(made_up.diagnosis(verdict))
    assert list(tables) == list(catalogue.DIAGNOSIS_TABLES)
    said = words(tables["verdict"])
    assert kind in said and all(reason[1:] in said for reason in verdict["reasons"])
    assert rows(tables["verdict"])[-1]["what"] == "next"
    assert all(form(each) for each in tables.values() for form in table.WRITERS.values())


def test_what_is_to_be_switched_on_is_said_as_it_is_written_in_the_configuration():
    assert "effects: [suspension_friction] in config/study.yaml" in words(diagnosed.tables(made_up.diagnosis())["verdict"])


def test_of_suspect_data_only_errors_of_the_measurement_are_named():
    (effect,) = made_up.VERDICT["effects"]
    for is_of_measurement, said in ((False, "The data are suspect: no effect is named."), (True, "The data are suspect: suspension friction")):
        suspect = {**made_up.VERDICT, "verdict": "suspect", "effects": [{**effect, "is_of_measurement": is_of_measurement}]}
        assert said in words(diagnosed.tables(made_up.diagnosis(suspect))["verdict"])


def test_a_proposed_form_is_shown():
    verdict = {**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | {"name": "discovered_2"}}
    found = replace(made_up.diagnosis(verdict), model="discovered", switched_on=("discovered",))
    said = words(diagnosed.tables(found)["verdict"])
    assert "At the strut: 80 N tanh(velocity / 0.005)." in said and "positive in compression" in said and "Friction of seals." in said
    assert "84 % of the explainable error on the fitted drives, 92 % on drives held out (p = 0.0015)" in said
    row = rows(diagnosed.tables(found)["missing_effects"])[-1]
    assert row["effect"] == "discovered 2 (proposed form)" and float(row["interval_lower"]) == 78.0 and float(row["p_value"]) == 0.0015
    assert (row["fitted_pct"], row["held_out_pct"], row["absorbed_pct"]) == (84.0, 92.0, None)
    assert "discovered_2.py into a folder" in said and "effects: [discovered, discovered_2]" in said


def test_a_form_is_written_in_usual_notation_and_says_what_a_side_is():
    form = in_words("contact", {"slip_of_load": {"front": -2.4e-06}, "side_slip_of_sides": {"front": 0.0076}}, {"slip_of_load": {"linear": 0.14}})
    verdict = {**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | {"form": form, "place": "contact", "port": "tyre_planar"}}
    (row,) = [row for row in rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"]) if row["what"] == "proposed form"]
    assert row["in_words"] == (
        "At the contact: slip_x → slip_x + (−2.4e−06 1/N front) (load + 1.867e+05 · slip_x); "
        "slip_y → slip_y + (0.0076 front) side; side is +1 on the left, −1 on the right."
    )


def test_effects_beside_a_proposed_form_are_switched_on_together_with_it():
    names = [effect["name"] for effect in made_up.VERDICT["effects"]]
    verdict = {**made_up.VERDICT, "verdict": "outside", "proposal": PROPOSAL | {"beside": names}, "is_beside_form": True}
    said = rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"])
    by_name = {row["what"]: row["in_words"] for row in said}
    assert by_name["in the library"].endswith(", beside the proposed form.") and "second choice" not in said[-1]["in_words"]
    assert f"effects: [discovered, {', '.join(names)}]" in said[-1]["in_words"]
    assert any(what.startswith("with ") and what.endswith(" it removes") for what in by_name)
    *effects, form = rows(diagnosed.tables(made_up.diagnosis(verdict))["missing_effects"])
    assert sum(row["fitted_pct"] or 0.0 for row in effects) + form["fitted_pct"] == pytest.approx(84.0)


def test_what_the_signs_of_a_form_mean_is_told_where_they_mean_something():
    verdict = lambda **more: made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | more})
    told = {row["what"]: row["in_words"] for row in rows(diagnosed.tables(verdict(here="more friction (front)"))["verdict"])}
    assert told["here it is"] == "More friction (front)."
    assert "here it is" not in {row["what"] for row in rows(diagnosed.tables(verdict(here=""))["verdict"])}


def test_what_the_library_does_alone_is_no_share_beside_the_form_though_the_names_are_the_same():
    names = [effect["name"] for effect in made_up.VERDICT["effects"]]
    alone = {**made_up.VERDICT, "verdict": "outside", "share": 0.6, "held_out_share": 0.6}
    verdict = alone | {"proposal": PROPOSAL | {"beside": names, "share": 0.58, "held_out_share": 0.5}}
    said = rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"])
    by_name = {row["what"]: row["in_words"] for row in said}
    assert by_name["in the library"].endswith(", and may stand in for what is missing.")
    assert said[-1]["in_words"].startswith("Go on from what the library has") and "The second choice: look at the proposed form" in said[-1]["in_words"]


@pytest.mark.parametrize(("held_out", "first", "second"), [(0.72, "Go on from", "look at the form"), (0.7499, "Go on from", "look at the form"), (0.78, "Look at", "go on from")])
def test_the_better_of_library_and_proposed_form_comes_first(held_out, first, second):
    proposal = PROPOSAL | {"share": 0.70, "held_out_share": held_out}
    tables = diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "verdict": "outside", "proposal": proposal}))
    said = rows(tables["verdict"])[-1]["in_words"]
    assert said.startswith(first) and f"The second choice: {second[:7]}" in said


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


def test_where_no_form_is_found_either_it_is_said_whether_what_is_left_matters():
    for left, end in ((0.004, "the loop may end here"), (0.08, "is worth a look at where it lies")):
        found = {**made_up.nothing(), "verdict": "outside", "remainder": {"a_z": 0.002, "a_x": left}}
        said = rows(diagnosed.tables(made_up.diagnosis(found))["verdict"])[-1]["in_words"]
        assert said.startswith("No form was found") and end in said


def test_nothing_beyond_the_noise_is_not_said_of_an_error_that_has_no_name():
    for left, first, last in ((0.004, "Nothing is missing beyond the noise", "may end here."), (0.4, "Nothing is missing that would have a name", "explains it.")):
        told = rows(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "remainder": {"a_x": 0.001, "yaw_rate": left}}))["verdict"])
        assert told[0]["in_words"].startswith(first)
        assert told[-1]["in_words"].startswith("Nothing is to be switched on. What is left") and told[-1]["in_words"].endswith(last)


def test_where_nothing_more_is_found_the_table_says_beside_what():
    found = replace(made_up.diagnosis(made_up.nothing()), model="damper_knee+suspension_friction")
    assert rows(diagnosed.tables(found)["missing_effects"])[0]["effect"] == "none beside damper knee, suspension friction"


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


def test_what_comes_next_keeps_the_order_of_what_is_switched_on():
    """In another order the models of the error ladder would be others, and calibrated anew."""
    on = ("tyre_relaxation", "damper_knee")
    found = replace(made_up.diagnosis(), model="damper_knee+tyre_relaxation", switched_on=on)
    assert "effects: [tyre_relaxation, damper_knee, suspension_friction]" in words(diagnosed.tables(found)["verdict"])


def test_names_beside_a_form_of_ones_own_are_said_with_a_caution():
    own = replace(made_up.diagnosis(), model="discovered", switched_on=("discovered",))
    assert "take out again what does not lower the error ladder" in words(diagnosed.tables(own)["verdict"])
    assert "take out again" not in words(diagnosed.tables(made_up.diagnosis())["verdict"])


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
    # Beside an error that nothing explains, a few percent that go with the file are not all that is missing.
    little = beyond | {"share": 0.06, "held_out_share": 0.06, "is_first": False}
    said = words(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": little}))["verdict"])
    assert said.startswith("verdict Something is missing that is not in the library. (outside)") and "Nothing is to be switched on" not in said


def test_parameters_that_are_another_explanation_come_last():
    bar = {"parameter": "anti_roll_stiffness_rear", "unit": "N m/rad", "given": 10000.0, "bounds": [8500.0, 11500.0],
           "wider": [2833.3, 34500.0], "value": 19900.0, "interval": [19000.0, 20800.0]}  # fmt: skip
    beyond = {"parameters": [bar], "share": 0.27, "held_out_share": 0.16, "is_first": False, "is_instead": True}
    told = rows(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "verdict": "outside", "beyond_bounds": beyond}))["verdict"])
    assert [row["what"] for row in told][-2:] == ["next", "or, the vehicle"]
    assert told[-1]["in_words"].startswith("In place of that: if the vehicle's file may be that wrong")
    assert told[0]["in_words"].startswith("Something is missing that is not in the library.")


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


def test_a_place_that_may_be_nil_is_said_like_any_other():
    ahead = {"parameter": "ahead", "size": 0.05, "unit": "m", "interval": [-0.2, 0.3], "plausible": [-1.0, 2.5], "is_plausible": True}
    effect = {**made_up.VERDICT["effects"][0], "sizes": [ahead | {"is_shaping": True}, ahead]}
    found = rows(diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "effects": [effect]}))["missing_effects"])
    assert [row["plausible"] for row in found[:2]] == ["yes (-1 to 2.5)", "yes, may be nil (-1 to 2.5)"]


def test_evidence_is_in_the_order_of_the_gain_with_the_outcome_of_refits():
    found = rows(diagnosed.tables(made_up.diagnosis())["evidence"])
    assert [(row["round"], row["effect"]) for row in found[:3]] == [
        (1, "suspension friction"), (1, "damper asymmetry"), (1, "payload"),
    ]  # fmt: skip
    assert found[0]["outcome"] == "accepted" and found[0]["held_out_pct"] == pytest.approx(75.0)
    assert found[1]["outcome"] == "makes the drives held out worse" and found[2]["outcome"] == ""
    # What was accepted is not tested again.
    assert [row["effect"] for row in found[3:]] == ["damper asymmetry", "payload"]
    assert "gains less than the accepted one" in words(diagnosed.tables(replace(made_up.diagnosis(), ranking=unobjected()))["evidence"])
    # What is significant and was not judged is said why.
    assert [row["outcome"] for row in found[3:]] == ["its refit gains less than 5 % of the best", ""]


def test_a_form_that_the_library_goes_before_gains_no_less_but_is_no_better():
    sure = {"strut:velocity_direction": True, "suspension_friction": True}
    assert diagnosis._less("strut:velocity_direction", "suspension_friction", sure) == "no better than the accepted one"
    assert diagnosis._less("suspension_friction", "strut:velocity_direction", sure) == "gains less than the accepted one"
    assert diagnosis._less("strut:velocity_direction", "suspension_friction", sure | {"strut:velocity_direction": False}) == "less sure on drives held out"


def unobjected():
    """The ranking without anything that speaks against the second refit."""
    found = made_up.ranking()
    found["trial_objection"] = ("trial", ["", ""])
    found["trial_held_out_z"] = ("trial", [5.0, 4.0])
    return found


def test_a_refit_that_drives_held_out_confirm_less_surely_is_said_so():
    found = unobjected()
    found["trial_held_out_z"] = ("trial", [5.0, 1.0])
    assert "less sure on drives held out" in words(diagnosed.tables(replace(made_up.diagnosis(), ranking=found))["evidence"])


def test_a_size_whose_interval_includes_none_is_marked():
    found = made_up.diagnosis({**made_up.VERDICT, "effects": [{**made_up.VERDICT["effects"][0], "sizes": [
        {**made_up.VERDICT["effects"][0]["sizes"][0], "interval": [-5.0, 90.0]}]}]})  # fmt: skip
    assert "yes, may be nil" in words(diagnosed.tables(found)["missing_effects"])
    assert "may be nil" not in words(diagnosed.tables(made_up.diagnosis())["missing_effects"])


def test_what_shapes_an_effect_and_was_held_is_told_with_its_value():
    held = {"parameter": "knee_velocity", "size": 0.1, "unit": "m/s", "is_typical": True}
    found = made_up.diagnosis({**made_up.VERDICT, "effects": [{**made_up.VERDICT["effects"][0], "held": [held]}]})
    (row,) = [row for row in rows(diagnosed.tables(found)["missing_effects"]) if row["parameter"] == "knee velocity"]
    assert (row["size"], row["unit"], row["plausible"], row["interval_lower"]) == (0.1, "m/s", "typical: the drives ask for no other", None)


def looked_for_any_form() -> Diagnosis:
    """A diagnosis whose search went on with forces of any form: that of made_up.ranking as terms at two places, a third term beside."""
    found, terms = made_up.ranking(), ["strut:velocity_direction", "body:lift", "strut:side_force_size_times_direction"]
    own = found.assign_coords(effect=terms)
    own["trial_effect"], own["winner"] = ("trial", terms[:2]), ("round", [terms[0], ""])
    return replace(made_up.diagnosis(), ranking=found.merge(own.rename({name: f"{FORMS}{name}" for name in (*own.variables, *own.dims)})))


def test_forces_of_any_form_are_told_by_place_with_what_became_of_them(monkeypatch):
    monkeypatch.setattr(diagnosis, "STRONGEST", 1)
    found = rows(diagnosed.tables(looked_for_any_form())["forms"])
    first = [row for row in found if row["round"] == 1]
    # The strongest, and the best of every other place: the third term is neither.
    assert [(row["place"], row["form"]) for row in first] == [("strut", "velocity direction"), ("body", "lift")]
    assert first[0]["outcome"] == "accepted" and first[0]["sizes"] == "front 80 N"
    assert first[0]["expression"] == "tanh(velocity / 0.005)"


def test_where_none_was_looked_for_the_table_says_so():
    only, = rows(diagnosed.tables(made_up.diagnosis())["forms"])
    assert only["place"].startswith("No force of any form was looked for")


@pytest.mark.parametrize(("name", "winner"), [("evidence", "suspension friction"), ("forms", "strut: velocity direction")])
def test_the_figure_shows_every_round_and_nothing_is_cut_off_or_lies_over_another(name, winner):
    with style.styled():
        each = diagnosed.figures(looked_for_any_form())[name]()
        FigureCanvasAgg(each).draw()
        box = each.get_tightbbox(FigureCanvasAgg(each).get_renderer())
    width, height = each.get_size_inches()
    assert box.x0 > -0.02 and box.x1 < width + 0.02 and box.y0 > -0.02 and box.y1 < height + 0.02
    said = [text.get_text() for text in each.findobj(Text)]
    for line in zip(*[(axes.title, axes.xaxis.label) for axes in each.axes]):
        shown = [text.get_window_extent() for text in line if text.get_text()]
        assert not any(one.overlaps(other) for k, one in enumerate(shown) for other in shown[:k])
    assert winner in said and "round 1" in said and "round 2: nothing accepted" in said
    assert any("Stand-in data" in text for text in said)
    assert any("Diagnosed: the model base" in text for text in said)


def test_the_figure_says_what_came_of_every_refit():
    with style.styled():
        each = diagnosed.figures(made_up.diagnosis())["evidence"]()
    said = " ".join(text.get_text() for text in each.findobj(Text))
    assert re.search(r"\d+ / 75 %  accepted", said) and "makes the drives held out worse" in said
    assert "refit gains too little" in said


@pytest.mark.parametrize(
    ("why", "said"),
    [
        ("not refitted: the drives ask for the opposite sign, which is not plausible", "not refitted: opposite sign"),
        ("not refitted: the 5 that gain most were", "not refitted"),
    ],
)
def test_the_figure_says_why_an_effect_was_not_refitted(why, said):
    found = made_up.ranking()
    found["passed_over"] = found["passed_over"].astype(object)
    found["passed_over"].values[0, 2] = why
    with style.styled():
        each = diagnosed.figures(replace(made_up.diagnosis(), ranking=found))["evidence"]()
    assert said in [text.get_text() for text in each.findobj(Text)]


def test_a_round_with_nothing_left_to_test_is_drawn_and_told():
    found = made_up.ranking()
    for name in ("p_value", "gain", "absorbed"):
        found[name].loc[dict(round=2)] = np.nan
    last = replace(made_up.diagnosis(), ranking=found)
    with style.styled():
        each = diagnosed.figures(last)["evidence"]()
        FigureCanvasAgg(each).draw()
    assert "round 2: nothing accepted" in [text.get_text() for text in each.findobj(Text)]
    assert {row["round"] for row in rows(diagnosed.tables(last)["evidence"])} == {1}


def test_what_the_figure_shortens_is_what_the_search_says():
    source = "".join(inspect.getsource(module) for module in (confirm, select, tries))
    assert all(part in source for part in evidence.OBJECTIONS)


HIDDEN = {"suspension_friction": {"front": 75.0, "rear": 60.0}, "damper_asymmetry": {"front": 0.3}}


def test_the_score_is_marked_as_that_of_stand_ins():
    found = diagnosed.scores(made_up.diagnosis(score=score(made_up.VERDICT, HIDDEN)))["standin_score"]
    assert any("sealed" in note for note in found.notes) and any("Stand-in data" in note for note in found.notes)
    assert not diagnosed.scores(made_up.diagnosis())


def test_the_missing_force_is_drawn_beside_what_the_named_effect_would_show():
    found = made_up.diagnosis()
    found.ranking.update(made_up.curves())
    with style.styled():
        each = diagnosed.figures(found)["signature"]()
        FigureCanvasAgg(each).draw()
    said = " ".join(text.get_text() for text in each.findobj(Text))
    assert "rear strut velocity; both: 60 % of the error" in said and "suspension friction" in said and "[mm]" in said
    drawn = [line for axes in each.axes for line in axes.lines if line.get_linestyle() == "--"]
    assert len(drawn) == 4  # in every panel: nothing is shown as nothing
    assert len({axes.get_ylim() for axes in each.axes}) == 1  # both places are of the strut: sizes compare by eye


def test_what_the_named_effects_would_show_is_not_cut_off():
    found = made_up.diagnosis()
    found.ranking.update(made_up.curves())
    found.ranking["named_missing"] = 5.0 * found.ranking["named_missing"]
    with style.styled():
        each = diagnosed.figures(found)["signature"]()
    for axes in each.axes:
        for line in axes.lines:
            assert np.nanmax(np.abs(line.get_ydata())) < axes.get_ylim()[1]


def test_the_names_of_five_effects_fit_beside_their_curves():
    effects = [{**made_up.VERDICT["effects"][0], "name": name} for name in ("damper_asymmetry", "damper_knee", "wheel_recession", "roll_centre_height", "bump_steer")]
    found = made_up.diagnosis({**made_up.VERDICT, "effects": effects})
    found.ranking.update(made_up.curves())
    with style.styled():
        each = diagnosed.figures(found)["signature"]()
        canvas = FigureCanvasAgg(each)
        canvas.draw()
    (legend,) = each.legends
    box = legend.get_window_extent(canvas.get_renderer())
    assert box.x0 >= 0.0 and box.x1 <= each.bbox.x1


def test_a_diagnosis_without_curves_says_so():
    with style.styled():
        each = diagnosed.figures(made_up.diagnosis())["signature"]()
    assert "not estimated" in " ".join(text.get_text() for text in each.findobj(Text))


@pytest.mark.parametrize("rounds", [1, 3, 6])
def test_evidence_of_many_rounds_fits_a_page(rounds):
    found = made_up.diagnosis(made_up.VERDICT)
    of_effects = [name for name, one in found.ranking.variables.items() if "effect" in one.dims]
    one = found.ranking[of_effects].isel(round=[0])
    more = [one.assign_coords(effect=[f"{name}_{number}" for name in one["effect"].values]) for number in range(12)]
    drawn = evidence.evidence(replace(found, ranking=_of_rounds(xr.concat([one, *more], "effect"), found.ranking, rounds)))
    assert drawn.get_size_inches()[1] < 9.6 and len(drawn.axes) == 2 * rounds
    bars = [len(axes.get_yticklabels()) for axes in drawn.axes[::2]]
    assert min(bars) > select.PROPOSED


def _of_rounds(one, ranking, rounds):
    """A ranking whose rounds are all as this ``one``."""
    others = ranking.drop_dims("effect").isel(round=[0])
    both = xr.merge([one, others])
    return both.isel(round=[0] * rounds).assign_coords(round=np.arange(1, rounds + 1))
