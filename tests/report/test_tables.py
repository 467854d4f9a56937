"""Tables: arithmetic, published rows beside ours, the forms they are written in, their origins."""

import csv
import dataclasses
import io
from html.parser import HTMLParser

import numpy as np
import pytest

from ridecomfort.report import catalogue, claims, published, table, tables
from ridecomfort.report.table import Column, Source, Table
from ridecomfort.vocabulary import SIGNALS
from tests.report import synthetic

DETECTIONS = ("thresholding_table", "rid_comf_res", "rid_comf_res2")


def rows(made: Table, source: str) -> list[dict]:
    keys = [column.key for column in made.columns]
    return [dict(zip(keys, row)) for row in made.rows if row[1] == source]


@pytest.mark.parametrize("name", DETECTIONS)
def test_critical_and_other_sections_make_up_the_site(made, paper_like, name):
    for row in rows(made[name], "this study"):
        for site in paper_like.sites:
            count, share, rest, rest_share = (row[f"{site.name}_{key}"] for key in ("C", "R_c", "N", "R_n"))
            assert count + rest == site.thresholds.sizes["window"]
            assert share + rest_share == pytest.approx(100.0)
            assert share == pytest.approx(100.0 * count / (count + rest))


def test_our_counts_are_those_of_the_sections(made, paper_like):
    site = paper_like.sites[1]
    by_class = dict(zip(site.iso2631["band"].values.tolist(), site.iso2631["critical"].values.sum(axis=1)))
    for row in rows(made["rid_comf_res"], "this study"):
        assert row["ts2_C"] == by_class[row["class"]]


def test_published_rows_are_printed_as_they_are_and_misprints_are_marked(made):
    found = made["rid_comf_res"]
    row = next(i for i, row in enumerate(found.rows) if row[:2] == ("LU", "paper"))
    assert [found.value(row, f"ts2_{key}") for key in ("C", "R_c", "N", "R_n")] == [20, 6.27, 319, 93.73]
    columns = [column.key for column in found.columns]
    assert found.marks[row, columns.index("ts2_N")] == found.marks[row, columns.index("ts2_R_n")] == "†"
    assert (row, columns.index("ts1_N")) not in found.marks
    assert len(found.marks) == 2 * 5  # LU ts2 ts3, FU ts2 ts3, U ts3
    assert any("†" in note for note in found.notes)


def test_bold_in_the_paper_is_where_its_tables_print_bold(made):
    """tab:thresholding_table: a_x ts1 ts1; a_y ts2 ts2 ts3; a_z ts1 ts1, by share."""
    found = made["thresholding_table"]
    columns = [column.key for column in found.columns]
    leaders = [
        next((columns[j].split("_")[0] for (i, j) in sorted(found.bold) if i == row), None)
        for row in range(len(found.rows))
        if found.rows[row][1] == "paper"
    ]
    assert leaders == ["ts1", "ts1", None, "ts2", "ts2", "ts3", None, "ts1", "ts1"]


@pytest.mark.parametrize("name", DETECTIONS)
def test_bold_type_is_explained_where_there_is_any(made, own_site, name):
    assert made[name].bold and any(note.startswith("Bold:") for note in made[name].notes)
    alone = tables.make(own_site)[name]
    assert not alone.bold and not any("Bold" in note for note in alone.notes)


def test_improvement_follows_from_the_errors(made, paper_like):
    found = made["opti_res_ts2"]
    ours = rows(found, "this study")
    assert [row["state"] for row in ours[3:]] == ["Ref, check", "Opt, check", r"$\pm$ [%], check"]
    for ref, opt, change in (ours[:3], ours[3:]):
        for signal in SIGNALS:
            before, after = ref[f"nrmse_{signal}"], opt[f"nrmse_{signal}"]
            assert change[f"nrmse_{signal}"] == pytest.approx(100 * (before - after) / before)
    errors = paper_like.sites[1].comparison["nrmse"].sel(state="reference", signal="a_z")
    assert ours[0]["nrmse_a_z"] == pytest.approx(float(errors.sel(drive=["repeat_1", "repeat_2"]).mean()))
    assert ours[3]["nrmse_a_z"] == pytest.approx(float(errors.sel(drive="slower")))


def test_of_a_site_that_is_calibrated_elsewhere_no_row_passes_for_fitted(made, paper_like):
    fitted, elsewhere = made["opti_res_ts1"], made["opti_res_ts2"]
    assert "check: drives that nothing is fitted to." in fitted.notes and "check: drives that nothing is fitted to." not in elsewhere.notes
    assert "Nothing is fitted to any drive of Ts2." in elsewhere.notes and not any("Nothing is fitted" in note for note in fitted.notes)
    assert fitted.sources[0].rule == "mean over the drives of role fit"
    assert elsewhere.sources[0].rule == "mean over the drives of role fit, not fitted"
    nominal = tables.calibration.opti_res(paper_like, dataclasses.replace(paper_like.sites[1], calibrated_on=None))
    assert "Nothing is fitted to any drive of Ts2." in nominal.notes


def test_published_improvements_follow_from_published_errors():
    """tab:opti_res_ts1..3: the printed errors have four digits, the printed changes come from more."""
    for site in ("ts1", "ts2", "ts3"):
        entry = published.figures()["nrmse"][site]
        for signal in SIGNALS:
            before, after = entry["ref"][signal], entry["opt"][signal]
            rounding = 100 * 1.1e-4 / before
            assert entry["improvement_pct"][signal] == pytest.approx(100 * (before - after) / before, abs=rounding)


def test_a_slope_that_is_taken_from_the_heights_is_said_to_be(own_site):
    said = lambda study: next(source for source in tables.inputs.sites(study).sources if source.cells.endswith("mean slope"))
    site = own_site.sites[0]
    level = dataclasses.replace(site, road=site.road.assign(slope=0.0 * site.road["slope"]))
    assert said(own_site).variable == "slope"
    assert said(dataclasses.replace(own_site, sites=(level,))).variable == "elevation"


def test_sites_are_measured_on_the_reference_line():
    rng = np.random.default_rng(1)
    road = synthetic.road(rng).isel(u=slice(0, 1001))
    road["curvature"][:] = np.where(np.arange(1001) % 2, 0.01, -0.01)
    road["slope"][:] = -0.02
    road["u"] = np.arange(1001) * 0.1
    inputs = tables.inputs
    assert inputs.length(road) == pytest.approx(100.0)
    assert inputs.mean_slope(road) == pytest.approx(0.02)
    # A file may hold its climb in the heights instead, on waves that are shorter than a hill.
    climb = 0.06 * road["u"] + 0.01 * np.sin(2 * np.pi * road["u"] / 5.0)
    raised = road.assign(slope=0.0 * road["slope"], elevation=climb + 0.0 * road["elevation"])
    assert inputs.mean_slope(raised) == pytest.approx(0.06, rel=0.02)
    assert inputs.mean_slope(raised.drop_vars("slope")) == inputs.mean_slope(raised)
    # A bend of radius 100 m turns by 1 gon in 1.5708 m: 636.62 gon/km.
    assert 1000 * inputs.GON_PER_RAD * inputs.mean_curvature(road) == pytest.approx(636.62, abs=0.01)


def test_exceedance_counts_sections_of_single_runs(made, paper_like):
    found = made["exceedance"]
    row = next(i for i, row in enumerate(found.rows) if row[1] == "LU")
    probability = paper_like.sites[0].iso2631["exceedance_probability"].sel(band="LU").values
    assert found.value(row, "ts1_runs") == pytest.approx(probability.sum())
    assert found.value(row, "ts1_likely") == (probability > 0.5).sum()


def test_shares_of_a_variance_are_printed_within_0_and_100_percent(own_site):
    assessment = own_site.assessment.copy(deep=True)
    assessment["first_order"][:] = 0.5
    assessment["first_order"][dict(place=0, measure=0, factor=0)] = [-0.02, -0.3, 1.2]
    found = tables.agreement.influence_table(dataclasses.replace(own_site, assessment=assessment))
    assert found.rows[0][2:5] == (0.0, 0.0, 100.0) and found.rows[0][6] == "cannot be said"


def test_a_study_of_few_runs_says_why_it_has_no_number_of_runs(own_site):
    found = tables.agreement.number_of_runs_table(own_site)
    assert "home: no figures, 8 runs are too few, at least 160 are needed." in found.notes


def test_origins_of_the_exceedance_name_the_method(made):
    cells = [source.cells for source in made["exceedance"].sources]
    assert len(set(cells)) == len(cells)


@pytest.mark.parametrize("study", ["paper_like", "own_site"])
def test_names_are_those_of_the_catalogue(study, request):
    study = request.getfixturevalue(study)
    made = tables.make(study)
    made |= claims.tables(study, made)
    assert list(made) == list(catalogue.tables(study.settings["sites"]))


def test_own_site_has_no_published_rows(own_site):
    found = tables.make(own_site)
    assert not any(name.startswith("opti_res") or name in ("baseline_res", "constraints") for name in found)
    for each in found.values():
        assert not any("paper" in column.key or column.key == "source" for column in each.columns)
        assert not any("paper" in row for row in each.rows) and not any("The paper" in note for note in each.notes)
        assert not any("published" in source.file for source in each.sources)
        assert all(0 < row < len(each.rows) for row in each.breaks)
    assert not any("tand-in" in note for each in found.values() for note in each.notes)
    assert any("exact: in the frequency domain" in note for note in found["weighting"].notes)  # what is not about the paper stays
    assert "running rms" in found["perception"].notes[0]  # though it tells that the paper did so, too


def test_a_site_that_is_called_paper_keeps_its_rows_columns_and_origins():
    found, usual = (tables.make(synthetic.study((name,), drives=False, standin=False, runs=8)) for name in ("paper", "home"))
    for name, each in found.items():
        assert (len(each.rows), len(each.columns)) == (len(usual[name].rows), len(usual[name].columns)), name
        assert len(each.sources) == len(usual[name].sources), name


def test_thresholds_of_ones_own_name_their_source_whatever_its_words(own_site):
    thresholds = own_site.sites[0].thresholds.copy(deep=True)
    thresholds["source"] = thresholds["source"].astype(object)
    thresholds["source"][:] = "a white paper of 2024"
    site = dataclasses.replace(own_site.sites[0], thresholds=thresholds)
    found = tables.make(dataclasses.replace(own_site, sites=(site,)))["thresholds_manual"]
    assert any("a white paper of 2024" in note for note in found.notes)


def test_a_distribution_of_another_family_than_the_papers_names_both(paper_like):
    sampling = {**paper_like.sites[0].sampling, "speed_deviation": {"uniform": [-1, 1]}}
    site = dataclasses.replace(paper_like.sites[0], sampling=sampling)
    found = tables.inputs.lhs_input(dataclasses.replace(paper_like, sites=(site, *paper_like.sites[1:])))
    families = [found.value(row, "distribution") for row in range(len(found.rows))]
    assert families == ["uniform; paper: Gaussian", "Gaussian", "uniform"] + ["Gaussian", "Gaussian", "uniform"] * 2


def test_a_title_with_dollars_is_no_mathematics(own_site):
    site = dataclasses.replace(own_site.sites[0], title="A $5 road & 50 % $ more")
    found = tables.inputs.sites(dataclasses.replace(own_site, sites=(site,)))
    assert "A $5 road & 50 % $ more" in table.to_markdown(found)
    assert r"A \$5 road \& 50 \% \$ more" in table.to_latex(found)


def test_effects_have_no_published_bounds(paper_like):
    study = dataclasses.replace(paper_like, calibrations={"ts1": synthetic.calibration_with_effect()})
    last = tables.calibration.constraints(study).rows[-1]
    assert last[1] == "Suspension friction: front" and last[3:5] == (None, None)


def test_site_without_calibration_has_its_reference_only():
    study = synthetic.study(("ts2",))
    site = study.sites[0]
    uncalibrated = dataclasses.replace(site, comparison=site.comparison.sel(state=["reference"]))
    found = tables.calibration.opti_res(study, uncalibrated)
    assert [row[0] for row in found.rows if row[1] == "this study"] == ["Ref", "Ref, check"]


def test_effects_that_nothing_calibrated_have_their_own_rows():
    study = synthetic.study(("ts2",))
    site = study.sites[0]
    site = dataclasses.replace(site, comparison=site.comparison.assign_coords(state=["reference", "with_effects"]), calibrated_on=None)
    study = dataclasses.replace(study, sites=(site,))
    errors = tables.calibration.nrmse(site, "with_effects")
    found = tables.calibration.opti_res(study, site)
    assert [row[0] for row in found.rows if row[1] == "this study"] == ["Ref", "With effects", "Ref, check", "With effects, check"]
    assert list(found.rows[1][2:]) == errors
    before = tables.calibration.baseline_res(study)
    assert [row[0] for row in before.rows] == ["Ts2", "Ts2, with effects", "Ts2"] and list(before.rows[1][2:]) == errors
    assert all(any("not calibrated" in note for note in each.notes) for each in (found, before))


def test_an_a_x_that_is_the_drivers_by_the_accelerometer_is_told_beside_the_papers():
    study = synthetic.study(("ts2",))
    said = "what the accelerometer tells is taken for the driver's foot, which the model drives"
    site = next(site for site in study.sites if site.name == "ts2")
    site = dataclasses.replace(site, comparison=site.comparison.assign_attrs(driver=said))
    heard = dataclasses.replace(study, sites=(site,))
    for found in (tables.calibration.opti_res(heard, site), tables.calibration.baseline_res(heard)):
        assert f"Ts2: {said}: slower than that, a_x is no test of the model." in found.notes
    assert not any("foot" in note for note in tables.calibration.baseline_res(study).notes)


def test_an_axis_that_nobody_feels_has_no_ratios_and_an_rms_that_suffices(paper_like):
    site = paper_like.sites[0]
    found = site.iso2631.copy(deep=True)
    found["weighted_rms"].loc[{"axis": "a_y"}] = found["vdv"].loc[{"axis": "a_y"}] = 1e-16
    found["mtvv"].loc[{"axis": "a_y"}], found["crest_factor"].loc[{"axis": "a_y"}] = 1e-14, np.nan
    study = dataclasses.replace(paper_like, sites=(dataclasses.replace(site, iso2631=found),))
    row = tables.passengers.vibration(study).rows[1]
    assert np.isnan(row[6:9]).all() and row[9] == 0.0


def test_every_table_of_results_says_stand_in_and_names_its_sources(made):
    for name, each in made.items():
        assert each.sources and all(source.file and source.variable and source.rule for source in each.sources)
        if name not in ("quantities", "thresholds_manual", "acc_thresholds", "IRI_thresholds", "weighting"):
            assert any(note.startswith("Stand-in data:") for note in each.notes), name


def test_csv_holds_the_numbers(made):
    for each in made.values():
        header, *lines = csv.reader(io.StringIO(table.to_csv(each)))
        assert header == [column.key for column in each.columns]
        assert len(set(header)) == len(header)
        for line, row in zip(lines, each.rows, strict=True):
            for text, value in zip(line, row, strict=True):
                if isinstance(value, (int, float)):
                    assert float(text) == pytest.approx(value, rel=1e-9)
                elif value is None:
                    assert text == ""


def test_markdown_has_as_many_cells_in_every_row(made):
    for each in made.values():
        lines = [line for line in table.to_markdown(each).splitlines() if line.startswith("|")]
        assert len(lines) == len(each.rows) + 2
        assert {line.replace(r"\|", "").count("|") for line in lines} == {len(each.columns) + 1}


def test_latex_rows_fill_the_columns(made):
    for each in made.values():
        text = table.to_latex(each)
        assert rf"\label{{tab:{each.name}}}" in text
        assert text.count("{") - text.count(r"\{") == text.count("}") - text.count(r"\}")
        body = text.split(r"\midrule")[-1].split(r"\bottomrule")[0]
        for line in filter(None, map(str.strip, body.splitlines())):
            assert line.replace(r"\&", "").count("&") == len(each.columns) - 1
        assert not set("²±†‡−→μσ") & set(text.replace("\\", ""))


def test_html_is_well_formed(made):
    class Balance(HTMLParser):
        open_tags: list = []

        def handle_starttag(self, tag, attrs):
            self.open_tags.append(tag)

        def handle_endtag(self, tag):
            assert self.open_tags.pop() == tag

    for each in made.values():
        parser = Balance()
        parser.feed(table.to_document(each).replace('<meta charset="utf-8">', ""))
        assert not parser.open_tags


def test_heading_spans_neighbours_with_the_same_words():
    columns = (Column("a", ("", "A")), Column("b", ("Site", "x"), "d"), Column("c", ("Site", "y"), ".1f"))
    cells = (("row", 3, None), ("row", 10, 2.25))
    small = Table("small", "A small table", columns, cells, (Source("all", "f", "v", "r"),))
    assert small.heading_lines() == [[("", 1), ("Site", 2)], [("A", 1), ("x", 1), ("y", 1)]]
    assert small.printed(0, 2) == "–"
    assert small.printed(1, 2) == "2.2"
    with pytest.raises(ValueError, match="2 cells under 3 columns"):
        Table("small", "", columns, (("row", 3),), ())


def test_a_number_below_nil_is_printed_with_a_minus_and_one_that_rounds_to_nil_without():
    small = Table("small", "", (Column("a", ("A",), ".1f"),), ((-1.25,), (-0.04,), (0.04,)), ())
    assert [small.printed(row, 0) for row in range(3)] == ["−1.2", "0.0", "0.0"]
