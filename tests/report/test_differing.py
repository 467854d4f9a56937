"""Tables and figures of where model and measurement differ: arithmetic, words, labelled axes, any set of sites."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.text import Text

from ridecomfort.discrepancy import findings
from ridecomfort.report import catalogue, differing, style, table
from ridecomfort.report.figures import conditions, located
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
    marked = {signal: titles[4 * place + 1] for place, signal in enumerate(SIGNALS)}
    assert marked["a_z"] == "drives over model (▲: above 2)" and marked["a_x"] == "drives over model"


def test_drives_that_come_late_have_a_phase_below_nil_where_they_are_coherent_with_the_model(study):
    site = study.sites[0]
    comparison = site.comparison.copy(deep=True)
    comparison["model_phase"] = (-2.0 * np.pi * 0.004 * comparison["frequency"]).broadcast_like(comparison["model_phase"])
    comparison["model_coherence"] = xr.where(comparison["frequency"] < 20.0, 0.9, 0.1).broadcast_like(comparison["model_coherence"])
    with style.styled():
        axes = conditions.responses(replace(site, comparison=comparison), "base").axes[2]
    frequency, phase = next(line.get_data() for line in axes.lines if line.get_color() == style.ERROR)
    told = np.isfinite(phase)
    assert frequency[told].max() < 20.0 and phase[told] == pytest.approx(-360.0 * 0.004 * frequency[told])


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
    for axes in drawn.axes[::4]:
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
