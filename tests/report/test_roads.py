"""Tables and figures of the road surfaces: their numbers are those of the inspection."""

import dataclasses

import numpy as np
import pytest

from ridecomfort.report import figures, style, tables


@pytest.fixture(scope="module")
def site(paper_like):
    return paper_like.sites[1]


def rows(table, label):
    keys = [column.key for column in table.columns]
    return [dict(zip(keys, row)) for row in table.rows if row[0] == label]


def test_roughness_is_that_of_the_stage_in_use(made, paper_like, site):
    for used in ("repaired", "smoothed"):
        inspection = site.inspection.assign_attrs(used=used)
        study = dataclasses.replace(paper_like, sites=(dataclasses.replace(site, inspection=inspection),))
        for row in rows(tables.roads.roughness(study), site.label):
            one = inspection.sel(stage=used, track=row["track_m"])
            assert row["unevenness_cm3"] == pytest.approx(1e6 * one["unevenness"].item())
            assert (row["class"], row["waviness"]) == (one["class"].item(), one["waviness"].item())


def test_repair_tells_before_from_after_and_where(made, site):
    (row,) = rows(made["repair"], site.label)
    assert row["outliers_repaired"] == 1 and row["changed_pct"] == pytest.approx(100 / row["cells"])
    assert (row["largest_change_mm"], row["largest_change_u_m"]) == (40.0, 400.0)
    before, after = (site.inspection["unevenness"].sel(stage=stage).mean().item() for stage in ("measured", "repaired"))
    assert row["unevenness_before_cm3"] == pytest.approx(1e6 * before)
    assert row["unevenness_after_cm3"] == pytest.approx(1e6 * after)
    assert row["dips"] == int((site.inspection["kind"] == "dip").sum()) >= 1


def test_smoothing_shows_its_cost(made, site):
    without, smoothed = rows(made["smoothing"], site.label)
    assert without["road"] == "repaired, used" and without["cutoff_along_m"] is None
    assert smoothed["cutoff_along_m"] == site.inspection["cutoff"].sel(direction="along").item()
    spacing = 0.1  # m; the second differences of its points halve a wave of the cut-off
    assert smoothed["lambda_along_m4"] == pytest.approx((spacing / 2 / np.sin(np.pi * spacing / smoothed["cutoff_along_m"])) ** 4)
    assert (without["a_z_rms"], smoothed["a_z_rms"]) == (0.31, 0.30)


def test_every_found_place_is_on_the_map(paper_like, site):
    with style.styled():
        drawn = figures.draw(paper_like, f"views_{site.name}")
    marks = sum(len(part.get_offsets()) for axes in drawn.axes for part in axes.collections if hasattr(part, "get_offsets")
                and part.get_label() in figures.roads.MARKS)  # fmt: skip
    assert marks == site.inspection.sizes["defect"]


def test_a_road_too_short_for_a_spectrum_is_drawn_all_the_same(paper_like, site):
    names = [name for name in site.inspection if "psd" in name and "acceleration" not in name] + ["coherence"]
    short = site.inspection.drop_vars(names)
    for name in ("unevenness", "waviness"):
        short[name] = np.nan * short[name]
    study = dataclasses.replace(paper_like, sites=(dataclasses.replace(site, inspection=short),))
    drawn = figures.draw(study, f"spectrum_{site.name}")
    assert any("too short" in text.get_text() for axes in drawn.axes for text in axes.texts)
    figures.draw(study, "smoothing")
    assert tables.roads.roughness(study).printed(0, 3) == "–"


@pytest.mark.parametrize("tracks, said", [((1.0, 2.5), ["right: ", "left: "]), ((0.5,), ["0.5 m: "]), ((-1.5, -0.75, 0.75), ["-1.5 m: ", "-0.75 m: ", "0.75 m: "])])
def test_every_wheel_track_has_its_spectrum_wherever_the_reference_line_lies(paper_like, site, tracks, said):
    inspection = site.inspection.isel(track=np.arange(len(tracks)) % 2).assign_coords(track=list(tracks))
    study = dataclasses.replace(paper_like, sites=(dataclasses.replace(site, inspection=inspection),))
    density, common = figures.draw(study, f"spectrum_{site.name}").axes
    labels = [text.get_text() for text in density.get_legend().get_texts() if "class" in text.get_text()]
    assert [label[: label.index("class")] for label in labels] == said
    assert bool(common.lines) == (len(tracks) > 1)
