"""Figures: labelled axes with units, nothing cut off, equal bytes for equal data, any set of sites."""

import dataclasses
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from ridecomfort.comfort import weighting
from ridecomfort.report import catalogue, figures, style, tables
from ridecomfort.report.figures.weighting import response_of_weight, sample_signal
from tests.report import synthetic

DIAGRAMS = ("framework", "leastsquare", "optichain")
BY_BLOCK = ("convergence",)
ALL = list(catalogue.figures({name: {"has_drives": True, "calibrated_on": "ts1"} for name in ("ts1", "ts2", "ts3")}))


@pytest.fixture(scope="module")
def drawn(paper_like):
    """Every figure of the paper-like study, laid out."""
    found = {}
    for name in ALL:
        each = figures.draw(paper_like, name)
        with style.styled():
            each.draw_without_rendering()
        found[name] = each
    return found


def test_names_are_those_of_the_catalogue(paper_like):
    assert list(catalogue.figures(paper_like.settings["sites"])) == ALL
    assert {name for name in ALL if name.split("_")[0] not in figures.OF_SITE} == set(figures.BUILDERS)


@pytest.mark.parametrize("name", [name for name in ALL if name not in DIAGRAMS])
def test_axes_are_labelled_with_units(name, drawn):
    axes = drawn[name].axes
    unit = re.compile(r"\[[^\]]+\]$")
    for each in axes:
        numbers = [label.get_text() for label in each.get_yticklabels() if label.get_visible()]
        if any(text[-1:].isdigit() and not text[:1].isalpha() for text in numbers) and each.yaxis.get_tick_params().get("labelleft", True):
            row = [other for other in axes if np.isclose(other.get_position().y0, each.get_position().y0)]
            labels = [other.get_ylabel() for other in row]
            assert any(unit.search(label) for label in labels), f"{name}: {numbers}"
        for label in (each.get_xlabel(), each.get_ylabel()):
            assert not label or unit.search(label), label
    assert name in BY_BLOCK or any(unit.search(each.get_xlabel()) for each in axes)


@pytest.mark.parametrize("name", ALL)
def test_nothing_is_cut_off(name, drawn):
    each = drawn[name]
    with style.styled():
        box = each.get_tightbbox(FigureCanvasAgg(each).get_renderer())
    width, height = each.get_size_inches()
    margin = 0.02
    assert box.x0 > -margin and box.y0 > -margin
    assert box.x1 < width + margin and box.y1 < height + margin


@pytest.mark.parametrize("suffix", list(style.METADATA))
def test_equal_data_give_equal_bytes(suffix, paper_like, tmp_path):
    for copy in ("one", "two"):
        style.save(figures.draw(paper_like, "ride_comfors"), tmp_path / f"{copy}{suffix}")
    one, two = ((tmp_path / f"{copy}{suffix}").read_bytes() for copy in ("one", "two"))
    assert one == two
    assert b"CreationDate" not in one and b"Matplotlib" not in one


def words_of(figure):
    return " ".join(text.get_text() for text in figure.findobj(Text))


def test_figures_of_stand_in_sites_say_so_and_others_do_not(drawn, own_site):
    """A figure is shown without its caption sooner or later."""
    for name, each in drawn.items():
        shows_data = name not in ("framework", "leastsquare")
        assert ("Stand-in data: Ts" in words_of(each)) == shows_data, name
    assert "Stand-in data: Ts2" in words_of(drawn["views_ts2"]) and "Ts1" not in words_of(drawn["views_ts2"])
    assert "Stand-in data: Ts1" in words_of(drawn["validation_iso"]) and "Ts2" not in words_of(drawn["validation_iso"])
    for name in ("optichain", "convergence"):  # calibrated on the first
        assert "Stand-in data: Ts1" in words_of(drawn[name]) and "Ts2" not in words_of(drawn[name])
    assert "Stand-in data: Ts3" in words_of(drawn["opti_plots"])
    for name in ("critical_shares", "validation_iso"):
        assert "Stand-in" not in words_of(figures.draw(own_site, name))


def test_what_a_stand_in_elsewhere_calibrated_says_so(own_site):
    """A study of a site of one's own whose vehicle is calibrated on a stand-in that is not in the call."""
    both = synthetic.study(("ts1", "home"))
    site = dataclasses.replace(both.sites[1], standin=False)
    study = dataclasses.replace(both, sites=(site,), assessment=own_site.assessment, standin_calibrations=("ts1",))
    for name in ("optichain", "convergence", "opti_plots", "validation_iso", "critical_shares"):
        assert figures.standin_mark(study, name) == "Stand-in data: Ts1", name
    for name in ("views_home", "testsection_figs", "smoothing", "framework"):
        assert figures.standin_mark(study, name) is None, name
    for found in (tables.calibration.constraints(study), tables.calibration.opti_res(study, site)):
        assert any("measured drives of Ts1 are made from seeds" in note for note in found.notes)


def test_a_site_without_a_width_leaves_the_axes_to_the_others(paper_like):
    found = paper_like.assessment.copy(deep=True)
    found["designs"].loc[{"place": "ts2"}] = 0
    full, some = (figures.draw(dataclasses.replace(paper_like, assessment=each), "number_of_runs").axes[0] for each in (paper_like.assessment, found))
    assert some.get_xlim() == pytest.approx(full.get_xlim(), rel=0.05) and some.get_ylim()[0] > 0.01
    found["designs"][:] = 0
    empty = figures.draw(dataclasses.replace(paper_like, assessment=found), "number_of_runs").axes
    assert all(axes.get_xlim() == (10, 1000) and axes.get_ylim() == (0.01, 1) for axes in empty)


def test_no_two_of_many_parameters_look_alike(paper_like):
    base = synthetic.calibration()
    many = xr.concat([base.assign_coords(parameter=[f"{name}_{k}" for name in base["parameter"].values]) for k in range(4)], "parameter", data_vars="minimal")
    drawn = figures.draw(dataclasses.replace(paper_like, calibrations={"ts1": many}), "convergence")
    looks = [(line.get_color(), line.get_marker()) for line in drawn.axes[1].lines if not line.get_label().startswith("_")]
    assert len(set(looks)) == len(looks) == 20
    with style.styled():
        drawn.draw_without_rendering()
    test_nothing_is_cut_off("convergence", {"convergence": drawn})


def test_drawing_leaves_the_settings_of_others_alone(own_site):
    import matplotlib

    before = dict(matplotlib.rcParams)
    figures.draw(own_site, "critical_shares")
    assert dict(matplotlib.rcParams) == before


def test_own_site_without_drives(own_site):
    for name in catalogue.figures(own_site.settings["sites"]):
        canvas = FigureCanvasAgg(figures.draw(own_site, name))
        with style.styled():
            canvas.draw()
        assert np.asarray(canvas.buffer_rgba()).std() > 1.0


def test_calibration_of_effects_goes_on_below(paper_like):
    study = dataclasses.replace(paper_like, calibrations={"ts1": synthetic.calibration_with_effect()})
    for name in ("optichain", "convergence"):
        each = figures.draw(study, name)
        with style.styled():
            box = each.get_tightbbox(FigureCanvasAgg(each).get_renderer())
        assert box.x0 > -0.02 and box.x1 < each.get_size_inches()[0] + 0.02
        words = " ".join(text.get_text() for text in each.findobj(Text))
        assert "friction" in words


def test_every_error_in_a_title_has_its_curve():
    study = synthetic.study(("ts3",))
    comparison = study.sites[0].comparison.assign_coords(state=["reference", "with_effects"])
    study = dataclasses.replace(study, sites=(dataclasses.replace(study.sites[0], comparison=comparison),))
    first = figures.draw(study, "opti_plots").axes[0]
    assert first.get_title(loc="left").count("→") == 1 and "(paper, not calibrated: " in first.get_title(loc="left")
    assert [line.get_label() for line in first.lines][1:] == ["simulated, not calibrated", "simulated with the model's effects, not calibrated"]


def test_an_a_x_that_is_the_drivers_by_the_accelerometer_is_told_above_it():
    study = synthetic.study(("ts3",))
    heard = study.sites[0].comparison.assign_attrs(driver="heard")
    told = words_of(figures.draw(dataclasses.replace(study, sites=(dataclasses.replace(study.sites[0], comparison=heard),)), "opti_plots"))
    assert "Ts3: heard: slower than that, a_x is no test of the model." in told
    assert "no test" not in words_of(figures.draw(study, "opti_plots"))


def test_the_axis_of_the_iri_reaches_its_largest_value(own_site):
    iri = own_site.sites[0].iri.copy(deep=True)
    iri["iri_full"][100] = 3.0 * float(iri["iri_full"].max())
    study = dataclasses.replace(own_site, sites=(dataclasses.replace(own_site.sites[0], iri=iri),))
    assert figures.draw(study, "IRI_thresholds").axes[0].get_ylim()[1] > float(iri["iri_full"].max())


def test_severity_darkens_from_class_to_class():
    """So that it reads in grey, too: luminance (ITU-R BT.709) falls within each method."""
    for classes in (("PT", "ND", "AG"), ("NU", "LU", "FU", "U", "VU", "EU"), ("VG", "G", "F", "M", "P")):
        codes = [style.SEVERITY[name] for name in classes]
        colours = [[int(code[i : i + 2], 16) for i in (1, 3, 5)] for code in codes]
        luminance = [np.dot((0.2126, 0.7152, 0.0722), colour) for colour in colours]
        assert all(np.diff(luminance) < 0)


def test_sines_are_measured_with_their_weighting_factor():
    frequency, amplitude = response_of_weight("Wk", 100.0, count=3)
    assert amplitude == pytest.approx(weighting.named("Wk").factor(frequency), rel=1e-4)


def test_sample_is_measured_where_drives_are_and_the_mean_of_the_runs_elsewhere(paper_like, own_site):
    measured, origin = sample_signal(paper_like)
    assert origin == "measured on Ts1" and np.isfinite(measured).all()
    mean, origin = sample_signal(own_site)
    assert origin == "mean of the runs on home" and mean.size == measured.size == 2200


def test_a_sample_is_no_longer_than_its_drive(own_site):
    """200 m at some 22 m/s: no second is made up behind them, and the margins shrink with it."""
    site = own_site.sites[0]
    short = {name: getattr(site, name).sel(s=slice(None, 250.0)) for name in ("thresholds", "iri")}
    study = dataclasses.replace(own_site, sites=(dataclasses.replace(site, **short),))
    seconds = np.sum(0.25 / short["iri"]["v_x"].values)
    sample, _ = sample_signal(study)
    assert sample.size / 100.0 == pytest.approx(seconds, abs=0.05) and seconds < 10.0
    raw = figures.draw(study, "validation_iso").axes[0]
    assert raw.get_xlim()[1] == pytest.approx(0.5 * sample.size / 100.0, abs=0.02) == len(raw.lines[0].get_xdata()) / 100.0


@pytest.mark.parametrize("count, columns", [(320, 320), (2400, 600), (2399, 600)])
def test_every_critical_section_of_a_long_road_is_in_its_strip(own_site, count, columns):
    site = own_site.sites[0]
    start, critical = 5.0 * np.arange(count), np.arange(count) % 97 == 3
    probability = xr.DataArray(np.zeros((3, 3, count)), dims=("axis", "style", "window"))
    found = site.thresholds.drop_dims("window").assign(
        window_start=("window", start), exceedance_probability=probability, critical=probability + critical
    )
    study = dataclasses.replace(own_site, sites=(dataclasses.replace(site, thresholds=found),))
    image = figures.draw(study, "thresholding_results_2").axes[1].images[0]
    marked = image.get_array()[0].min(axis=-1) < 0.9
    assert marked.size == columns and marked.sum() == critical.sum()
    left, right = image.get_extent()[:2]
    middles = left + (np.flatnonzero(marked) + 0.5) * (right - left) / columns
    assert np.abs(middles - start[critical] - 2.5).max() <= 0.5 * (right - left) / columns


@pytest.mark.parametrize("names", [[f"motorway_A2_northbound_{k}" for k in range(3)], [f"s{k}" for k in range(7)], [f"landesstrasse_L1023_abschnitt_{k}" for k in range(10)]])
@pytest.mark.parametrize("figure", ["influence", "number_of_runs", "critical_shares"])
def test_figures_of_long_names_and_of_many_sites_hold_their_words_and_panels_that_can_be_read(paper_like, figure, names):
    sites = tuple(dataclasses.replace(paper_like.sites[k % 3], name=name) for k, name in enumerate(names))
    places = {"place": np.arange(len(names)) % 3}
    assessment = paper_like.assessment.isel(places).assign_coords(place=names)
    study = dataclasses.replace(paper_like, sites=sites, assessment=assessment)
    with style.styled():
        each = figures.draw(study, figure)
        each.draw_without_rendering()
        renderer = FigureCanvasAgg(each).get_renderer()
        legend = each.legends[0].get_window_extent(renderer)
        shown = [axes for axes in each.axes if axes.axison]
        titles = [axes._left_title.get_window_extent(renderer) for axes in shown]
    assert legend.x0 >= 0 and legend.x1 <= each.bbox.x1 and legend.y1 <= each.bbox.y1
    assert min(axes.bbox.width for axes in shown) / each.dpi > 1.0
    assert all(one.x1 <= other.x0 for one, other in zip(titles, titles[1:]) if one.x0 < other.x0)
    assert len(shown) == (3 if figure == "influence" else len(names))
