"""The verdict and the score: every kind of verdict is said, with what was found."""

from dataclasses import replace

import pytest

from ridecomfort.discrepancy.form import in_words, plausibility
from ridecomfort.discrepancy.places import scale
from ridecomfort.discrepancy.score import score
from ridecomfort.discrepancy.verdict import SAID
from ridecomfort.report import catalogue, diagnosed, table
from tests.report import differing as made_up
from tests.report.differing import PROPOSAL, rows, words

HIDDEN = {"suspension_friction": {"front": 75.0, "rear": 60.0}, "damper_asymmetry": {"front": 0.3}}


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


@pytest.mark.parametrize("kind, is_told", [("named", True), ("cluster", True), ("outside", False)])
def test_of_each_effect_that_is_named_its_sizes_are_told(kind, is_told):
    told = {row["what"]: row["in_words"] for row in rows(diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "verdict": kind}))["verdict"])}
    expected = "Front 80 N (70 to 90). It takes 80 % of the explainable error, 75 % on drives held out."
    assert told.get("suspension friction") == (expected if is_told else None)


def test_a_size_that_is_known_well_is_told_with_the_digits_of_its_interval():
    size = {"parameter": "frequency", "unit": "Hz", "size": 21.0133, "interval": [20.9981, 21.0285], "plausible": [12.0, 40.0], "is_plausible": True}
    effect = {**made_up.VERDICT["effects"][0], "sizes": [size]}
    told = rows(diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "effects": [effect]}))["verdict"])
    assert told[1]["in_words"].startswith("Frequency 21.01 Hz (21 to 21.03).")


@pytest.mark.parametrize("is_of_measurement, first", [(False, "."), (True, ": suspension friction.")])
def test_of_suspect_data_only_errors_of_the_measurement_are_named(is_of_measurement, first):
    (effect,) = made_up.VERDICT["effects"]
    suspect = {**made_up.VERDICT, "verdict": "suspect", "effects": [{**effect, "is_of_measurement": is_of_measurement}]}
    told = {row["what"]: row["in_words"] for row in rows(diagnosed.tables(made_up.diagnosis(suspect))["verdict"])}
    assert told["verdict"].startswith(f"The data are suspect{first}")
    assert ("suspension friction" in told) == is_of_measurement
    assert not is_of_measurement or told["suspension friction"].startswith("Friction of the struts. Front 80 N")
    assert ("effects: [suspension_friction]" in told["next"]) == is_of_measurement


def test_a_proposed_form_is_shown():
    verdict = {**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | {"name": "discovered_2"}}
    found = replace(made_up.diagnosis(verdict), model="discovered", switched_on=("discovered",))
    said = words(diagnosed.tables(found)["verdict"])
    assert "At the strut: 80 N tanh(velocity / 0.005)." in said and "positive in compression" in said and "Friction of seals." in said
    assert "84 % of the explainable error on the fitted drives, 92 % on drives held out (p = 0.0015)" in said
    told = [row["what"] for row in rows(diagnosed.tables(found)["verdict"])]
    assert told.index("its sizes") < told.index("reason"), "what it is stands before why"
    assert "N (78 to " in said
    row = rows(diagnosed.tables(found)["missing_effects"])[-1]
    assert row["effect"] == "discovered 2 (proposed form)" and float(row["interval_lower"]) == 78.0 and float(row["p_value"]) == 0.0015
    assert (row["fitted_pct"], row["held_out_pct"], row["absorbed_pct"]) == (84.0, 92.0, None)
    held = [*PROPOSAL["sizes"], {"parameter": "velocity_linear", "unit": "1", "size": 0.0, "interval": None}]
    with_nil = {**verdict, "proposal": verdict["proposal"] | {"sizes": held}}
    assert rows(diagnosed.tables(replace(found, verdict=with_nil))["missing_effects"])[-1]["parameter"] == row["parameter"]
    assert "discovered_2.py into a folder" in said and "effects: [discovered, discovered_2]" in said


def test_what_shapes_a_form_has_no_interval_beyond_what_is_plausible_and_every_size_says_what_that_is():
    own = lambda part, size, interval: {"parameter": f"velocity_saturating_{part}", "unit": "m/s", "size": size, "interval": interval} | plausibility(
        "strut", "velocity_saturating", part, size
    )
    sizes = [own("front", 12.3, [-143.0, 167.0]), own("rear", -3511.0, [-4232.0, -2790.0]), own("knee", 0.08, [-0.0154, 0.176]), own("linear", 0.0, [-4.0, 3.5])]
    terms = {"velocity_saturating": {"front": 12.3, "rear": -3511.0}}
    verdict = {**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | {"sizes": sizes, "terms": terms}}
    tables = diagnosed.tables(made_up.diagnosis(verdict))
    (told,) = [row["in_words"] for row in rows(tables["verdict"]) if row["what"] == "its sizes"]
    assert "knee 0.08 m/s (0.02 to 0.176), velocity saturating linear left open by these drives" in told
    front, rear, knee, linear = rows(tables["missing_effects"])[-4:]
    most = 1500.0 / scale("strut", "velocity_saturating")
    assert front["plausible"] == f"yes, may be nil ({-most:.4g} to {most:.4g})" and rear["plausible"] == f"yes ({-most:.4g} to {most:.4g})"
    assert (knee["interval_lower"], knee["plausible"]) == (0.02, "yes (0.02 to 0.5)") and linear["plausible"] == "left open (-3 to 3)"
    assert linear["size"] is None and knee["interval_upper"] == 0.176
    heard = own("knee", 0.08, [0.0, 1.0]) | plausibility("body", "humming_up", "period", 0.08)
    assert "knee 0.08 m/s (0 to 1)" in words(diagnosed.tables(made_up.diagnosis(verdict | {"proposal": PROPOSAL | {"sizes": [heard]}}))["verdict"])


def test_a_verdict_says_of_which_calibration_it_is():
    found = made_up.diagnosis()
    notes = diagnosed.tables(found)["verdict"].notes
    assert "Diagnosed: the model base on Ts1, Ts2." in notes and not any("Calibrated" in note for note in notes)
    found.ranking.attrs["calibrated"] = "tyre_friction, roll_inertia"
    assert "Calibrated in it: tyre_friction, roll_inertia." in diagnosed.tables(found)["verdict"].notes


def test_how_large_each_effect_may_be_that_was_not_found_is_told_by_name():
    found = made_up.diagnosis()
    asymmetry, payload = rows(diagnosed.tables(found)["excluded"])
    assert (payload["effect"], payload["size"], payload["unit"]) == ("payload", "mass", "kg")
    assert [payload[key] for key in ("estimate", "lower", "upper", "least", "most")] == [12.0, -3.0, 27.0, 0.0, 500.0]
    assert asymmetry["effect"] == "damper asymmetry" and asymmetry["lower"] is None and asymmetry["upper"] is None
    bare = replace(found, ranking=found.ranking.drop_dims("other"))
    assert [row["effect"] for row in rows(diagnosed.tables(bare)["excluded"])] == ["none"]


def test_a_form_is_written_in_usual_notation_and_says_what_a_side_is():
    terms = {"slip_of_load": {"front": -2.4e-06}, "side_slip_of_sides": {"front": 0.0076}}
    form = in_words("contact", terms, {"slip_of_load": {"linear": 0.14}})
    verdict = {**made_up.nothing(), "verdict": "outside", "proposal": PROPOSAL | {"form": form, "place": "contact", "port": "tyre_planar", "terms": terms}}
    (row,) = [row for row in rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"]) if row["what"] == "proposed form"]
    assert row["in_words"] == (
        "At the contact: slip_x → slip_x + (−2.4e−06 1/N front) (load + 1.867e+05 · slip_x); "
        "slip_y → slip_y + (0.0076 front) side; side is +1 on the left, −1 on the right."
    )


def test_effects_beside_a_proposed_form_are_switched_on_together_with_it():
    names = [effect["name"] for effect in made_up.VERDICT["effects"]]
    own = 0.84 - sum(effect["share"] for effect in made_up.VERDICT["effects"])
    verdict = {**made_up.VERDICT, "verdict": "outside", "proposal": PROPOSAL | {"beside": names, "own_share": own}, "is_beside_form": True}
    said = rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"])
    by_name = {row["what"]: row["in_words"] for row in said}
    assert by_name["in the library"].endswith(", beside the proposed form.") and "second choice" not in said[-1]["in_words"]
    assert f"effects: [{', '.join(names)}, discovered]" in said[-1]["in_words"]  # as they stand in the table of sizes
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
    verdict = alone | {"proposal": PROPOSAL | {"beside": ["payload"], "share": 0.58, "held_out_share": 0.5, "own_share": 0.4}}
    assert rows(diagnosed.tables(made_up.diagnosis(verdict))["missing_effects"])[-1]["fitted_pct"] == pytest.approx(40.0)
    said = rows(diagnosed.tables(made_up.diagnosis(verdict))["verdict"])
    by_name = {row["what"]: row["in_words"] for row in said}
    assert by_name["in the library"].endswith(", and may stand in for what is missing.")
    assert said[-1]["in_words"].startswith("Go on from what the library has") and "The second choice: look at the proposed form" in said[-1]["in_words"]


def test_nothing_beyond_the_noise_is_not_said_of_an_error_that_has_no_name():
    for left, first, last in ((0.004, "Nothing is missing beyond the noise", "may end here."), (0.4, "Nothing is missing that would have a name", "explains it.")):
        told = rows(diagnosed.tables(made_up.diagnosis({**made_up.nothing(), "remainder": {"a_x": 0.001, "yaw_rate": left}}))["verdict"])
        assert told[0]["in_words"].startswith(first)
        assert told[-1]["in_words"].startswith("Nothing is to be switched on. What is left") and told[-1]["in_words"].endswith(last)


def test_where_nothing_more_is_found_the_table_says_beside_what():
    found = replace(made_up.diagnosis(made_up.nothing()), model="damper_knee+suspension_friction")
    assert rows(diagnosed.tables(found)["missing_effects"])[0]["effect"] == "none beside damper knee, suspension friction"


def test_a_place_that_may_be_nil_is_said_like_any_other():
    ahead = {"parameter": "ahead", "size": 0.05, "unit": "m", "interval": [-0.2, 0.3], "plausible": [-1.0, 2.5], "is_plausible": True}
    effect = {**made_up.VERDICT["effects"][0], "sizes": [ahead | {"is_shaping": True}, ahead]}
    found = rows(diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "effects": [effect]}))["missing_effects"])
    assert [row["plausible"] for row in found[:2]] == ["yes (-1 to 2.5)", "yes, may be nil (-1 to 2.5)"]


def test_a_size_that_no_drive_meets_has_no_value():
    """The stops of an axle that never reaches them: the middle of what is plausible is no finding."""
    known = {"parameter": "front", "size": 4e5, "unit": "N/m", "interval": [3.7e5, 4.3e5], "plausible": [0.0, 8e5], "is_plausible": True}
    effect = {**made_up.VERDICT["effects"][0], "sizes": [known, known | {"parameter": "rear", "interval": [0.0, 8e5]}]}
    found = diagnosed.tables(made_up.diagnosis({**made_up.VERDICT, "effects": [effect]}))
    front, rear = rows(found["missing_effects"])[:2]
    assert (front["size"], front["plausible"]) == (4e5, "yes (0 to 8e+05)")
    assert (rear["size"], rear["interval_lower"], rear["interval_upper"], rear["plausible"]) == (None, None, None, "left open (0 to 8e+05)")
    assert "front 4e+05 N/m (3.7e+05 to 4.3e+05), rear left open by these drives." in words(found["verdict"]).lower().replace(" n/m", " N/m")


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
    assert "Found with knee velocity 0.1 m/s held: with another value these sizes and intervals may be others." in words(diagnosed.tables(found)["verdict"])
    assert "Found with" not in words(diagnosed.tables(made_up.diagnosis())["verdict"])


def test_the_score_is_marked_as_that_of_stand_ins():
    found = diagnosed.scores(made_up.diagnosis(score=score(made_up.VERDICT, HIDDEN)))["standin_score"]
    assert any("sealed" in note for note in found.notes) and any("Stand-in data" in note for note in found.notes)
    assert not diagnosed.scores(made_up.diagnosis())


def test_the_score_tells_which_model_it_is_of():
    """It may lie beside the verdict on another: `diagnose` alone makes none."""
    found = replace(made_up.diagnosis(score=score(made_up.VERDICT, HIDDEN)), model="damper_knee")
    assert diagnosed.scores(found)["standin_score"].notes[0].startswith("Diagnosed: the model damper_knee on ")
