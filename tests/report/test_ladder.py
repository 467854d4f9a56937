"""The error ladder, as tables and as a figure: what its rungs leave, what is said of them, and that it can be read."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from ridecomfort.report import differing, style
from ridecomfort.report.figures import ladder
from ridecomfort.report.study import Compared, Difference
from tests.report import differing as made_up
from tests.report.differing import rows


@pytest.fixture(scope="module")
def study():
    return made_up.difference()


@pytest.fixture(scope="module")
def tables(study):
    return differing.tables(study)


def test_the_ladder_begins_with_everything_and_ends_at_the_floor(tables, study):
    found = [row for row in rows(tables["error_ladder"]) if row["site"] == "Ts1" and row["drives"] == "fitted"]
    assert [row["model"] for row in found] == ["uncalibrated", "calibrated", "+ suspension friction", "lowest floor"]
    assert found[1]["all_left_pct"] == pytest.approx(100.0) and found[1]["a_z_left_pct"] == pytest.approx(100.0)
    # The error falls from 0.4 to 0.1 of the signal, its square to a sixteenth.
    assert found[2]["all_left_pct"] == pytest.approx(100 / 16, abs=2.0)
    assert found[0]["all_left_pct"] == pytest.approx(100 * (0.5 / 0.4) ** 2, abs=6.0)
    assert found[2]["all_fall_pct"] == pytest.approx(found[1]["all_left_pct"] - found[2]["all_left_pct"])
    assert found[2]["all_falling_pct"] > 50 and np.isnan(found[0]["all_fall_pct"]) and np.isnan(found[0]["all_falling_pct"])
    assert [row["all_helps"] for row in found] == ["", "yes", "yes", ""]
    assert found[3]["a_z_left_pct"] == 0 < found[3]["a_z_rmse_m_per_s2"] < found[2]["a_z_rmse_m_per_s2"]


def test_below_the_ladder_stands_what_its_100_percent_are_made_of_what_rises_and_whose_starts_disagree(tables, study):
    notes = tables["error_ladder"].notes
    assert any(note.startswith("100 % are what the base model leaves with spring_stiffness_front calibrated.") for note in notes)
    assert not any("without it" in note or "disagree" in note for note in notes)
    found = study.ladder.copy(deep=True)
    found["left_overall"][2] = 1.5
    found["starts"] = found["starts"].astype(object)
    found["starts"][2, 0] = "starts disagree: so far"
    notes = differing.tables(replace(study, ladder=found))["error_ladder"].notes
    assert "Ts1: + suspension friction leaves 150 % on the fitted drives, more than the 100 % without it." in notes
    assert "Ts1: + suspension friction: starts disagree: so far." in notes


def test_fitted_and_held_out_drives_stand_apart(tables):
    groups = {(row["site"], row["drives"]) for row in rows(tables["error_ladder"])}
    assert groups == {("Ts1", "fitted"), ("Ts1", "held out"), ("Ts2", "held out")}


def test_a_better_model_agrees_with_more_sections(tables):
    found = [row for row in rows(tables["error_ladder_sections"]) if row["site"] == "Ts1" and row["drives"] == "fitted"]
    calibrated, better, repeats = found[1:]
    assert better["thresholds_agreeing_pct"] > calibrated["thresholds_agreeing_pct"]
    assert better["thresholds_changed"] > 0 and repeats["model"].startswith("repeats")


def test_a_ladder_on_which_nothing_was_above_the_floor_says_so(study):
    found = study.ladder.copy(deep=True)
    found["left"][:], found["left_overall"][:] = np.nan, np.nan
    drawn = ladder.error_ladder(replace(study, ladder=found))
    assert np.isfinite(drawn.axes[0].get_ylim()).all()
    said = lambda figure: [text.get_text() for text in figure.findobj(Text)]
    assert ladder.NONE_LEFT in said(drawn) and ladder.NONE_LEFT not in said(ladder.error_ladder(study))


def test_what_lies_beyond_the_axis_of_the_ladder_is_said_with_its_signal(study):
    far = study.ladder.copy(deep=True)
    far["left"].loc[dict(rung=far["rung"].values[0], signal="roll_rate")] = 90.0
    far["left"].loc[dict(rung=far["rung"].values[0], signal="a_x")] = 30.0
    far["left_overall"].loc[dict(rung=far["rung"].values[0])] = 40.0
    with style.styled():
        made = differing.figures(replace(study, ladder=far))["error_ladder"]()
    said = [text.get_text() for text in made.findobj(Text)]
    assert "above the axis (at its top), up to:\nroll rate 9,000 %\n$a_x$ 3,000 %" in said and "4000" in said
    at_top = [line for line in made.axes[0].lines if list(line.get_ydata()) == [1.0] and not line.get_clip_on()]
    assert {(line.get_color(), line.get_marker()) for line in at_top} == {style.SIGNAL_LINES[name] for name in ("a_x", "roll_rate")}
    assert [line.get_xdata()[0] for line in at_top] == [0, 0]
    left, right = sorted(line.get_transform().transform((0.0, 1.0))[0] for line in at_top)
    assert right - left > 0.5 * at_top[0].get_markersize()


def test_repeats_of_both_methods_that_coincide_are_a_dashed_line_still():
    """A fifth of the way, at least, neither line covers."""
    way, covered = np.linspace(0.0, 1000.0, 20001), False
    for offset, (dash, gap) in ladder.DASHES.values():
        covered = covered | ((way + offset) % (dash + gap) < dash)
    assert 0.2 < 1.0 - covered.mean() < 0.6


def test_every_line_of_the_ladder_has_a_key(study):
    with style.styled():
        made = differing.figures(study)["error_ladder"]()
        made.draw_without_rendering()
    look = lambda line: (line.get_color(), line.get_marker(), line.get_linestyle() != "-")
    legend = next(each for each in [*made.legends, *(axes.get_legend() for axes in made.axes)] if each)
    assert {look(line) for axes in made.axes for line in axes.lines} <= {look(line) for line in legend.get_lines()}


def test_the_floor_of_a_model_is_not_below_the_lowest_of_the_ladder(tables):
    lowest = {(row["site"], row["drives"]): row for row in rows(tables["error_ladder"]) if row["model"] == "lowest floor"}
    for row in rows(tables["explainable"]):
        if row["signal"] == "$a_z$":
            assert lowest[row["site"], row["drives"]]["a_z_rmse_m_per_s2"] <= row["floor_rmse"]
    assert any("lowest of its models" in note for note in tables["explainable"].notes)


def test_a_site_that_nothing_is_calibrated_on_has_its_first_rung_only():
    alone = made_up.comparison((0.5,))
    found = made_up.rungs({"home": {"base": alone}}, (False,))
    assert found.attrs["reference"] == "uncalibrated"
    left = found["left_overall"].sel(site="home", group="held out").values
    assert left[0] == pytest.approx(1.0) and np.isnan(left[1])


def test_what_the_100_percent_of_a_site_are_is_said_where_sites_differ_in_it(study):
    rmse = study.ladder["rmse"].copy()
    rmse.loc[{"rung": "calibrated", "site": "ts2"}] = np.nan
    mixed = differing.tables(replace(study, ladder=study.ladder.assign(rmse=rmse)))
    of_none = differing.tables(replace(study, ladder=study.ladder.assign_attrs(reference="uncalibrated")))
    for name, start in (("error_ladder", "as a share of what "), ("error_ladder_sections", "in all: than with ")):
        assert any(f"{start}the calibrated base model (on Ts2 the uncalibrated one)" in note for note in mixed[name].notes)
        assert any(f"{start}the uncalibrated base model" in note for note in of_none[name].notes)


def test_where_nothing_is_calibrated_the_ladder_says_so_and_not_that_models_are(study):
    """Effects are compared at the sizes that they are configured with then; that one does not help may mean a wrong size only."""
    start, none = "Every model is calibrated anew on the fitted drives", "Nothing is calibrated{}: effects have the sizes that they are configured with"
    rmse = study.ladder["rmse"].copy()
    rmse.loc[{"rung": "calibrated", "site": "ts2"}] = np.nan
    mixed = " ".join(notes_of_ladder(study, rmse))
    rmse.loc[{"rung": "calibrated"}] = np.nan
    of_none = " ".join(notes_of_ladder(study, rmse, reference="uncalibrated"))
    of_all = " ".join(notes_of_ladder(study, study.ladder["rmse"]))
    assert start in of_all and "Nothing is calibrated" not in of_all
    assert f"{start} ({none.format(' on Ts2')}" in mixed
    assert none.format("") in of_none and "calibrated anew" not in of_none and "fitted to the others" not in of_none


def notes_of_ladder(study, rmse, **attributes):
    """Notes below the error ladder with these errors."""
    return differing.tables(replace(study, ladder=study.ladder.assign(rmse=rmse).assign_attrs(attributes)))["error_ladder"].notes


def test_repeats_of_all_drives_count_by_their_sections(study):
    """1800 sections of which 5 % differ and 60 of which half do are 6.5 % of all, not 27.5 %."""
    found = study.ladder.sel(site="ts1").copy(deep=True)
    for group, sections, alike in (("fitted", 1800.0, 0.95), ("held out", 60.0, 0.5)):
        found["compared"].loc[{"group": group}] = sections
        found["repeats_agreeing"].loc[{"group": group}] = alike
    axes = Figure().subplots()
    ladder._sections(axes, found, ["fitted", "held out"], np.arange(found.sizes["rung"]))
    level = [line.get_ydata()[0] for line in axes.lines if line.get_linestyle() != "-" and len(line.get_ydata()) == 2]
    assert level == pytest.approx([100 * (1 - (1800 * 0.95 + 60 * 0.5) / 1860)] * 2)


@pytest.mark.parametrize("sites, effects", [(2, 8), (3, 4), (3, 8)])
def test_names_and_numbers_of_many_rungs_do_not_overlap(sites, effects):
    switched = ["suspension_friction", "damper_asymmetry", "cornering_degression", "tyre_local_slope",
                "roll_centre_height", "steering_compliance", "powertrain_mounts", "wheel_compliance"][:effects]  # fmt: skip
    errors = [made_up.comparison((0.5, 0.4 * 0.7**k)) for k in range(effects + 1)]
    models = {"+".join(switched[:k]) or "base": each for k, each in enumerate(errors)}
    names = [f"ts{k}" for k in range(1, sites + 1)]
    aligned = made_up.aligned()
    study = Difference(
        tuple(Compared(name, aligned, errors[0]) for name in names),
        made_up.rungs({name: models for name in names}, (True,) + (False,) * (sites - 1)),
    )
    with style.styled():
        figure = differing.figures(study)["error_ladder"]()
        renderer = FigureCanvasAgg(figure).get_renderer()
        figure.draw_without_rendering()
        for axes in figure.axes:
            names = [label for label in axes.get_xticklabels() if label.get_text()]
            numbers = [text for text in axes.texts if text.get_fontweight() == "bold"]
            for printed in (names, numbers):
                boxes = [text.get_window_extent(renderer) for text in printed]
                assert all(one.x1 < other.x0 for one, other in zip(boxes, boxes[1:]))
