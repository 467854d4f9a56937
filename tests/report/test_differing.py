"""Tables and figures of where model and measurement differ: arithmetic, words, labelled axes, any set of sites."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Text

from ridecomfort.discrepancy import findings
from ridecomfort.report import catalogue, differing, style, table
from ridecomfort.report.figures import conditions, ladder, located
from ridecomfort.report.study import Compared, Difference
from ridecomfort.report.tables import difference
from ridecomfort.study import JOIN
from ridecomfort.vocabulary import SIGNALS
from tests.report import differing as made_up
from tests.report.differing import rows

UNIT = re.compile(r"\[[^\]]+\]$")


def _figures(study):
    of_sites = [differing.figures_of_site(site, study.model) for site in study.sites]
    return {name: draw for own in [*of_sites, differing.figures(study)] for name, draw in own.items()}


@pytest.fixture(scope="module")
def study():
    return made_up.difference()


@pytest.fixture(scope="module")
def tables(study):
    return differing.tables(study)


@pytest.fixture(scope="module")
def drawn(study):
    found = {}
    for name, draw in _figures(study).items():
        with style.styled():
            found[name] = draw()
            found[name].draw_without_rendering()
    return found


def test_names_are_those_of_the_catalogue(study, tables):
    assert list(tables) == list(catalogue.DIFFERENCE_TABLES)
    names = [site.name for site in study.sites]
    assert sorted(_figures(study)) == sorted(catalogue.difference_figures(names))


def test_every_form_can_be_written(tables):
    for each in tables.values():
        assert all(form(each) for form in table.WRITERS.values())


def test_what_calibration_made_of_the_model_is_told_with_what_the_drives_say_of_it(tables):
    spring, friction = rows(tables["calibrated"])
    assert (spring["parameter"], spring["initial"], spring["value"]) == ("spring stiffness front", 28000.0, 20000.0)
    assert friction["parameter"] == "suspension friction: front" and friction["verdict"] == "at its lower bound, may be nil"
    for said in ("the data ask for less than the bounds allow", "is taken for the driver's foot."):
        assert any(said in note for note in tables["calibrated"].notes)


@pytest.mark.parametrize(
    ("place", "interval", "said"),
    [(0, (15000.0, 22000.0), "identified, its interval ends at a bound"), (0, (19000.0, 22000.0), "identified"), (1, (-1.0, 9.0), "identified, may be nil")],
)
def test_an_interval_that_ends_at_a_bound_or_holds_no_effect_at_all_is_said(study, place, interval, said):
    (name, calibration), *_ = study.calibrations.items()
    verdict = np.where(np.arange(2) == place, "identified", calibration["verdict"])
    ends = {f"interval_{end}": ("parameter", np.full(2, value)) for end, value in zip(("lower", "upper"), interval)}
    other = calibration.assign(verdict=("parameter", verdict), **ends)
    row = rows(differing.tables(replace(study, calibrations={name: other}))["calibrated"])[place]
    assert row["verdict"] == said


def test_a_parameter_that_is_hardly_told_from_another_is_not_only_called_identified(study):
    (name, calibration), *_ = study.calibrations.items()
    alike = calibration.assign(correlation=(("parameter", "other"), np.array([[1.0, -0.97], [-0.97, 1.0]])))
    told = rows(differing.tables(replace(study, calibrations={name: alike}))["calibrated"])
    assert told[0]["verdict"] == "identified, hardly told from suspension friction: front (-0.97)"
    assert told[1]["verdict"].endswith("may be nil, hardly told from spring stiffness front (-0.97)")
    unknown = calibration.assign(correlation=(("parameter", "other"), np.full((2, 2), np.nan)))
    assert "told" not in rows(differing.tables(replace(study, calibrations={name: unknown}))["calibrated"])[0]["verdict"]


def test_that_sizes_of_effects_may_differ_from_the_searchs_is_said_where_there_are_any(tables, study):
    said = "may differ from those of the missing effects"
    assert any(said in note for note in tables["calibrated"].notes)
    alone = {name: found.isel(parameter=[0]) for name, found in study.calibrations.items()}
    base = differing.tables(replace(study, calibrations=alone))["calibrated"]
    assert not any(said in note for note in base.notes)


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


def test_what_is_taken_for_the_drivers_foot_is_told_beside_the_errors_and_the_sections_that_agree_by_it(study, tables):
    said = "what the accelerometer tells along the road from 0.2 Hz up to 2.4 Hz is taken for the driver's foot, which the model drives"
    first, *others = study.sites
    heard = replace(first, comparison=first.comparison.assign_attrs(driver=said))
    told = differing.tables(replace(study, sites=(heard, *others)))
    for name in ("findings", "explainable", "error_ladder_sections"):
        assert [said in note for note in told[name].notes].count(True) == 1
        assert not any("foot" in note for note in tables[name].notes)


def test_explainable_is_what_lies_above_the_floor(tables):
    for row in rows(tables["explainable"]):
        total = row["floor_rmse"] ** 2 + row["explainable_rmse"] ** 2
        assert row["explainable_pct"] == pytest.approx(100 * row["explainable_rmse"] ** 2 / total)
        assert row["rmse_model"] < row["rmse_uncalibrated"]


def test_it_is_said_how_the_floor_is_known(tables, study):
    assert any("repeat one another" in note for note in tables["findings"].notes)
    alone = made_up.comparison(repeated=False)
    site = Compared("home", made_up.aligned(("one", "two")), alone, False)
    single = Difference((site,), made_up.rungs({"home": {"base": alone}}, (True,)))
    assert any("taken as nil: no drive was repeated" in note for note in differing.tables(single)["findings"].notes)


def test_what_the_distances_of_a_site_look_like_stands_below_its_clocks(tables, study):
    assert not any("another point" in note for note in tables["alignment"].notes)
    site = replace(study.sites[0], measured=study.sites[0].measured.assign_attrs(distance_doubt="s looks like another point's"))
    notes = differing.tables(replace(study, sites=(site, *study.sites[1:])))["alignment"].notes
    assert "Ts1: s looks like another point's." in notes


def test_what_was_done_to_records_and_speaks_against_them_stands_below_their_clocks(study):
    measured = study.sites[0].measured
    first, second, third = measured["drive"].values
    told = {"treatment": ("drive", ["none", "s integrated from v_x", "none"]), "faults": ("drive", ["", "a_z: clips", "a_x: clips"])}
    site = replace(study.sites[0], measured=measured.assign(told))
    notes = differing.tables(replace(study, sites=(site, *study.sites[1:])))["alignment"].notes
    assert [note for note in notes if "clips" in note or first in note] == [
        f"Ts1, {second}: s integrated from v_x; a_z: clips.", f"Ts1, {third}: a_x: clips."
    ]  # fmt: skip


def test_a_mounting_that_is_not_sought_without_gravity_has_no_number(study):
    site = replace(study.sites[0], measured=study.sites[0].measured.assign(gravity=("drive", [1, 0, 1])))
    table = differing.tables(replace(study, sites=(site, *study.sites[1:])))["alignment"]
    sought = ("mounting_roll_deg", "mounting_pitch_deg", "mounting_yaw_deg", "acceleration_gain")
    assert [[row[key] is None for key in sought] for row in rows(table)[:3]] == [[False] * 4, [True] * 4, [False] * 4]


def test_findings_are_numbered_alike_in_table_and_figure(tables, drawn, study):
    site = study.sites[0]
    words = [" ".join(text.get_text().split()) for text in drawn["located_ts1"].findobj(Text)]
    for number, each in enumerate(findings.findings(site.comparison), start=1):
        row = next(row for row in rows(tables["findings"]) if row["site"] == "Ts1" and row["number"] == number)
        assert row["power_pct"] == pytest.approx(100 * each.power_share)
        assert str(number) in words and any(each.words().removeprefix(each.signal) in text for text in words)


def test_what_is_written_below_the_maps_has_room(study, monkeypatch):
    """Layout does not know of it: as many findings as there may be, each of two lines."""
    site = study.sites[0]
    long = findings.findings(site.comparison)[0]
    monkeypatch.setattr(type(long), "words", lambda self: f"{self.signal}, " + "relatively most at suspension velocities above 0.04 m/s, " * 4)
    monkeypatch.setattr(findings, "findings", lambda found: [long] * 5)
    with style.styled():
        made = located.located(site, study.model)
        made.draw_without_rendering()
    written = next(text for text in made.findobj(Text) if text.get_text().startswith("1  ")).get_window_extent()
    assert made.bbox.x0 <= written.x0 and written.x1 <= made.bbox.x1 and made.bbox.y0 < written.y0


def test_what_may_be_chance_is_not_on_the_map(study):
    own = study.sites[0].comparison.sel(signal="a_z")
    for times, is_seen in ((1.9, False), (2.1, True)):
        noisy = own.assign(error_map=times * own["floor_density"].broadcast_like(own["error_map"]))
        _, above = located._above(noisy)
        assert above.shape[0] == own.sizes["s_map"] and above.any() == is_seen


def test_places_that_no_drive_tells_of_do_not_look_like_places_without_error(study):
    site = study.sites[0]
    between = (site.comparison["s_map"] > 500) & (site.comparison["s_map"] < 700)
    found = site.comparison.assign(error_map=site.comparison["error_map"].where(~between))
    with style.styled():
        made = located.located(replace(site, comparison=found), study.model)
    image = next(axes.collections[0] for axes in made.axes if axes.get_ylabel().startswith("$a_z$"))
    is_grey = (image.to_rgba(image.get_array()) == to_rgba(located.UNCOUNTED)).all(axis=-1)
    assert (is_grey == found["error_map"].sel(signal="a_z").isnull().any("frequency_map").values).all()


def test_maps_of_two_models_compare_by_their_colours(study):
    site = study.sites[0]
    better = Compared(site.name, site.measured, made_up.comparison((0.5, 0.1)))
    perfect = Compared(site.name, site.measured, made_up.comparison((0.5, 0.01)))
    maps, said = [], []
    for each in (site, better, perfect):
        with style.styled():
            made = located.located(each, study.model)
        maps.append(next(axes.collections[0] for axes in made.axes if axes.get_ylabel().startswith("$a_z$")))
        said.append(" ".join(text.get_text() for text in made.findobj(Text)))
    assert len({(image.norm.vmin, image.norm.vmax) for image in maps}) == 1
    brightness = [np.nanmean(image.to_rgba(image.get_array())) for image in maps]
    assert brightness[0] < brightness[1] < brightness[2]
    least = f"{100 * findings.NAMED:g} % of"
    assert f"No error above the floor reaches {least}" in said[2] and "No error above" not in said[0]
    assert least in catalogue.difference_figures(["ts1"])["located_ts1"] and least in differing.tables(study)["findings"].notes[0]


@pytest.mark.parametrize("name", list(catalogue.difference_figures(["ts1", "ts2"])))
def test_axes_are_labelled_with_units_and_nothing_is_cut_off(name, drawn):
    each = drawn[name]
    labels = [label for axes in each.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert labels and all(UNIT.search(label) for label in labels), labels
    with style.styled():
        box = each.get_tightbbox(FigureCanvasAgg(each).get_renderer())
    width, height = each.get_size_inches()
    assert box.x0 > -0.02 and box.y0 > -0.02 and box.x1 < width + 0.02 and box.y1 < height + 0.02


def test_conditions_have_the_same_axis_for_every_model_with_ticks_to_read_it_by(drawn, study):
    better = Compared("ts1", study.sites[0].measured, made_up.comparison((0.5, 0.1)))
    with style.styled():
        other = conditions.conditions(better, "base").axes[0]
    axes = drawn["conditions_ts1"].axes[0]
    assert axes.get_ylim() == other.get_ylim()
    low, high = axes.get_ylim()
    assert sum(low <= tick <= high for tick in axes.get_yticks()) > 6


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


def test_every_line_of_the_ladder_has_a_key(drawn):
    made = drawn["error_ladder"]
    look = lambda line: (line.get_color(), line.get_marker(), line.get_linestyle() != "-")
    legend = next(each for each in [*made.legends, *(axes.get_legend() for axes in made.axes)] if each)
    assert {look(line) for axes in made.axes for line in axes.lines} <= {look(line) for line in legend.get_lines()}


def test_the_floor_of_a_model_is_not_below_the_lowest_of_the_ladder(tables):
    lowest = {(row["site"], row["drives"]): row for row in rows(tables["error_ladder"]) if row["model"] == "lowest floor"}
    for row in rows(tables["explainable"]):
        if row["signal"] == "$a_z$":
            assert lowest[row["site"], row["drives"]]["a_z_rmse_m_per_s2"] <= row["floor_rmse"]
    assert any("lowest of its models" in note for note in tables["explainable"].notes)


@pytest.mark.parametrize("name", ["conditions_ts1", "responses_ts1"])
def test_figures_of_a_comparison_say_of_which_model_they_are(name, study):
    model = JOIN.join(["damper_asymmetry", "suspension_friction"])
    with style.styled():
        made = differing.figures_of_site(study.sites[0], model)[name]()
    assert f"Ts1, model damper_asymmetry {JOIN} suspension_friction, calibrated" in made.legends[0].get_title().get_text()


def test_what_keeps_drives_from_repeating_others_is_said_beside_the_floor(study):
    said = "two is no repeat of one: paths 0.50 m apart (0.30 m at most)"
    site = study.sites[0]
    near = replace(site, comparison=site.comparison.assign_attrs(near_repeats=said))
    assert said in difference.floor_note(near) and said not in difference.floor_note(site)
    assert said in " ".join(differing.tables(replace(study, sites=(near, *study.sites[1:])))["explainable"].notes)


def test_responses_say_who_is_who_and_how_they_are_read(drawn):
    legend = drawn["responses_ts1"].legends[0]
    said = " ".join(text.get_text() for text in legend.get_texts())
    assert "measured drives" in said and "model on the same paths" in said
    assert "not linear" in legend.get_title().get_text()


def test_a_gain_beyond_what_is_drawn_is_marked(study):
    site = study.sites[0]
    comparison = site.comparison.copy(deep=True)
    comparison["model_gain"].loc[{"signal": "a_z"}] = conditions.HIGHEST + 0.5
    comparison["model_gain"].loc[{"signal": "a_x"}] = conditions.HIGHEST - 0.5
    with style.styled():
        titles = [axes.get_title(loc="left") for axes in conditions.responses(replace(site, comparison=comparison), "base").axes]
    marked = {signal: titles[3 * place + 1] for place, signal in enumerate(SIGNALS)}
    assert marked["a_z"] == "drives over model (▲: above 2)" and marked["a_x"] == "drives over model"


@pytest.mark.parametrize("least", [0.5, 1e-2, 1e-4, 1e-7])
def test_gains_from_the_road_have_numbers_however_many_decades_they_span(study, least):
    """A yaw rate that fell by five decades had an axis without any."""
    site = study.sites[0]
    comparison = site.comparison.copy(deep=True)
    comparison["road_gain"] = xr.full_like(comparison["road_gain"], 30.0)
    comparison["road_gain"].loc[{"frequency": comparison["frequency"][-40:]}] = least
    with style.styled():
        drawn = conditions.responses(replace(site, comparison=comparison), "base")
        drawn.canvas.draw()
    for axes in drawn.axes[::3]:
        low, high = axes.get_ylim()
        numbers = [tick for tick in axes.get_yticks() if low <= tick <= high]
        assert 2 <= len(numbers) <= 12, axes.get_title(loc="left")


@pytest.mark.parametrize("name", list(catalogue.difference_figures(["ts1"])))
def test_rates_are_said_in_words(name, drawn):
    said = " ".join(text.get_text() for text in drawn[name].findobj(Text))
    assert "pitch rate" in said and "-rate" not in said


def test_stand_in_is_said(tables, study):
    assert all(any(note.startswith("Stand-in data") for note in made.notes) for made in tables.values())
    own = Difference(tuple(Compared(s.name, s.measured, s.comparison) for s in study.sites), study.ladder)
    assert not any("tand-in" in note for made in differing.tables(own).values() for note in made.notes)
    elsewhere = replace(own, standin_calibrations=["ts3"])
    assert all(any("drives of Ts3 are" in note for note in made.notes) for made in differing.tables(elsewhere).values())
    assert elsewhere.standin_mark() == replace(own.sites[0], standin_calibrations=["ts3"]).standin_mark() == "Stand-in data: Ts3"


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
