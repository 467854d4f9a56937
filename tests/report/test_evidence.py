"""The evidence behind a verdict, in tables and figures, and the curves of what is missing."""

import inspect
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from ridecomfort.discrepancy import confirm, contest, select, tries
from ridecomfort.discrepancy.ranking import FORMS
from ridecomfort.report import diagnosed, style
from ridecomfort.report.figures import evidence, signature
from ridecomfort.report.study import Diagnosis
from ridecomfort.report.tables import diagnosis
from tests.report import differing as made_up
from tests.report.differing import rows, words


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
    assert winner in said and "round 1" in said and "round 2: none of 2 accepted" in said
    assert any("Stand-in data" in text for text in said)
    assert any("Diagnosed: the model base" in text for text in said)


def test_the_figure_says_what_came_of_every_refit():
    with style.styled():
        each = diagnosed.figures(made_up.diagnosis())["evidence"]()
    said = " ".join(text.get_text() for text in each.findobj(Text))
    assert re.search(r"\d+ / 75 %  accepted", said) and "makes the drives held out worse" in said
    assert "refit gains too little" in said


def test_shares_on_drives_held_out_are_open_marks_in_the_colour_of_those_on_fitted_ones():
    with style.styled():
        each = diagnosed.figures(made_up.diagnosis())["evidence"]()
    marks = {line.get_marker(): line for axes in each.axes for line in axes.lines if line.get_marker() in ("o", "D")}
    fitted, held_out = marks["o"], marks["D"]
    assert fitted.get_color() == held_out.get_color() == fitted.get_markerfacecolor() != style.REFERENCE
    assert held_out.get_markerfacecolor() == "none"


def test_what_was_refitted_is_drawn_though_many_others_gain_more():
    one = made_up.ranking().sel(round=1)
    others = [f"effect_{number}" for number in range(20)]
    wider = one.reindex(effect=[*one["effect"].values, *others])
    wider["gain"] = ("effect", np.concatenate([one["gain"].values, one["gain"].values.max() + np.arange(1.0, 21.0)]))
    drawn = evidence._shown(wider, 12)
    tried = {str(name) for name in one["trial_effect"].values[one["trial_round"].values == 1]}
    assert len(drawn) == 12 and tried and tried <= set(drawn)
    assert drawn[0] == "effect_19" and drawn == sorted(drawn, key=lambda name: -float(wider["gain"].sel(effect=name)))


def test_a_share_of_next_to_nothing_does_not_press_all_others_together():
    ranking = made_up.ranking()
    ranking["trial_held_out_share"][0] = -3.71
    drawn = evidence.evidence(replace(made_up.diagnosis(), ranking=ranking))
    right = drawn.axes[1]
    assert right.get_xlim()[0] > -1.2 * evidence.MOST
    beyond = [line for line in right.lines if line.get_marker() == "<"]
    assert [line.get_xdata()[0] for line in beyond] == [-evidence.MOST]
    assert any("−371 %" in text.get_text() for text in right.texts)


@pytest.mark.parametrize(("fitted", "held_out", "said"), [(np.nan, 0.75, "– / 75 %  accepted"), (0.75, np.nan, "75 / – %  accepted"), (np.nan, np.nan, "accepted")])
def test_a_share_that_is_missing_does_not_make_the_other_read_as_its_own(fitted, held_out, said):
    ranking = made_up.ranking()
    ranking["trial_share"][0], ranking["trial_held_out_share"][0] = fitted, held_out
    right = evidence.evidence(replace(made_up.diagnosis(), ranking=ranking)).axes[1]
    assert said in [text.get_text() for text in right.texts]


def test_where_no_drive_held_out_has_anything_to_explain_no_mark_of_one_is_promised():
    ranking = made_up.ranking()
    ranking["trial_held_out_share"] = ranking["trial_held_out_share"] * np.nan
    drawn = evidence.evidence(replace(made_up.diagnosis(), ranking=ranking))
    said = [text.get_text() for text in drawn.findobj(Text)]
    assert "on drives held out" not in said and "refits: on fitted drives" in said
    assert "on drives held out" in [text.get_text() for text in evidence.evidence(made_up.diagnosis()).findobj(Text)]


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


@pytest.mark.parametrize("why", ["could not be simulated: came to a stand", contest.UNSIZED])
def test_what_could_not_be_tested_is_told_with_the_reason_below_what_was(why):
    found = made_up.ranking()
    found["passed_over"] = found["passed_over"].astype(object)
    for name in ("p_value", "gain", "absorbed"):
        found[name].values[0, 2] = np.nan
    found["passed_over"].values[0, 2] = why
    told = [row for row in rows(diagnosed.tables(replace(made_up.diagnosis(), ranking=found))["evidence"]) if row["round"] == 1]
    assert told[-1]["outcome"] == why and told[-1]["p_value"] is None and told[-1]["effect"]
    with style.styled():
        FigureCanvasAgg(diagnosed.figures(replace(made_up.diagnosis(), ranking=found))["evidence"]()).draw()


def test_a_round_with_nothing_left_to_test_is_drawn_and_told():
    found = made_up.ranking()
    for name in ("p_value", "gain", "absorbed"):
        found[name].loc[dict(round=2)] = np.nan
    last = replace(made_up.diagnosis(), ranking=found)
    with style.styled():
        each = diagnosed.figures(last)["evidence"]()
        FigureCanvasAgg(each).draw()
    assert "round 2: nothing left to test" in [text.get_text() for text in each.findobj(Text)]
    assert {row["round"] for row in rows(diagnosed.tables(last)["evidence"])} == {1}


def test_what_the_figure_shortens_is_what_the_search_says():
    source = "".join(inspect.getsource(module) for module in (confirm, contest, select, tries))
    assert all(part in source for part in evidence.OBJECTIONS)


def test_what_was_taken_back_is_told_in_a_few_words_that_fit_beside_its_bar():
    found = made_up.diagnosis()
    objections = found.ranking["trial_objection"].values.astype(object)
    objections[objections != ""] = select.VAIN
    found.ranking["trial_objection"] = "trial", objections.astype(str)
    with style.styled():
        each = diagnosed.figures(found)["evidence"]()
        FigureCanvasAgg(each).draw()
        box = each.get_tightbbox(FigureCanvasAgg(each).get_renderer())
    assert box.x1 < each.get_size_inches()[0] + 0.02
    assert any("taken back: error grows" in text.get_text() for text in each.findobj(Text))


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


def test_what_no_curve_explains_looks_small_and_pale():
    found = made_up.diagnosis()
    found.ranking.update(made_up.curves())
    for one in ("missing", "missing_error", "named_missing"):
        found.ranking[one] = 0.01 * found.ranking[one]
    found.ranking["seen_share"] = 0.001 + 0.0 * found.ranking["seen_share"]
    with style.styled():
        each = diagnosed.figures(found)["signature"]()
    assert signature.NONE_EXPLAINS in each.legends[0].get_title().get_text()
    curves = [line for axes in each.axes for line in axes.lines if line.get_marker() in ("o", "s")]
    assert curves and all(line.get_alpha() < 1.0 for line in curves)
    for axes in each.axes:
        assert axes.get_ylim()[1] == signature.LEAST_REACH["N"] > 5 * max(np.nanmax(np.abs(line.get_ydata())) for line in axes.lines)


def test_a_large_and_sure_curve_is_not_pale_however_little_of_noise_and_error_it_explains():
    """A force of some ten newtons explains less than a hundredth of the power of noisy drives."""
    found = made_up.diagnosis()
    found.ranking.update(made_up.curves())
    share, error = 0.0 * found.ranking["seen_share"] + 0.005, np.abs(found.ranking["missing"])
    for times, is_pale in ((0.1, False), (0.5, True)):
        found.ranking["seen_share"], found.ranking["missing_error"] = share, times * error.max() + 0.0 * error
        with style.styled():
            each = diagnosed.figures(found)["signature"]()
        assert all((line.get_alpha() < 1.0) is is_pale for line in each.axes[0].lines if line.get_marker() in ("o", "s"))
        assert (signature.NONE_EXPLAINS in each.legends[0].get_title().get_text()) is is_pale


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
    assert min(bars) > contest.PROPOSED


def _of_rounds(one, ranking, rounds):
    """A ranking whose rounds are all as this ``one``."""
    others = ranking.drop_dims("effect").isel(round=[0])
    both = xr.merge([one, others])
    return both.isel(round=[0] * rounds).assign_coords(round=np.arange(1, rounds + 1))


def test_a_round_in_which_nothing_was_refitted_says_so_and_has_no_axis_without_a_mark():
    ranking = made_up.ranking()
    ranking["passed_over"] = ranking["passed_over"].where(ranking["round"] < 2, "")
    drawn = evidence.evidence(replace(made_up.diagnosis(), ranking=ranking))
    first, last = drawn.axes[1], drawn.axes[3]
    assert [text.get_text() for text in last.texts if text.get_text()] == [evidence.NONE_REFITTED]
    assert not last.lines and not last.get_xlabel() and first.get_xlabel() == "error removed [%]"
    assert evidence.NONE_REFITTED not in [text.get_text() for text in first.texts]
