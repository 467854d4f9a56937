"""The page: self-contained, complete, honest about stand-in data."""

import dataclasses
import re
from html.parser import HTMLParser

import pytest

from ridecomfort.report import catalogue, claims, page, tables
from tests.report import differing, synthetic

PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d4944415478da63f8cfc0f01f0005000"
    "1ff5bd6e5cd0000000049454e44ae426082"
)


class Resources(HTMLParser):
    """What a page loads, its elements' ids, and its text."""

    def __init__(self):
        super().__init__()
        self.loaded, self.links, self.ids, self.tags, self.text = [], [], [], [], []
        self.style = ""

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append(tag)
        self.loaded += [attrs[key] for key in ("src", "srcset", "data", "poster") if key in attrs]
        self.links += [attrs["href"]] if "href" in attrs else []
        self.ids += [attrs["id"]] if "id" in attrs else []

    def handle_data(self, data):
        if self.tags[-1:] == ["style"]:
            self.style += data
        self.text.append(data)


def rendered(study):
    made = tables.make(study)
    made |= claims.tables(study, made)
    figures = dict.fromkeys(catalogue.figures(study.settings["sites"]), PIXEL)
    text = page.render(study, made, figures)
    parser = Resources()
    parser.feed(text)
    return text, parser


@pytest.fixture(scope="module", params=["paper_like", "own_site"])
def study(request):
    return request.getfixturevalue(request.param)


def test_nothing_is_loaded_from_elsewhere(study):
    _, found = rendered(study)
    assert found.loaded and all(source.startswith("data:") for source in found.loaded)
    assert all(link.startswith("#") and link[1:] in found.ids for link in found.links)
    assert "script" not in found.tags and "link" not in found.tags
    assert "url(" not in found.style and "@import" not in found.style


def test_every_table_and_figure_is_on_it_once(study):
    _, found = rendered(study)
    sites = study.settings["sites"]
    expected = [f"tab-{name}" for name in catalogue.tables(sites) if name != "claims"]
    expected += [f"fig-{name}" for name in catalogue.figures(sites)]
    assert sorted(name for name in found.ids if name[:4] in ("tab-", "fig-")) == sorted(expected)


def test_claims_and_provenance_are_on_it(study):
    text, found = rendered(study)
    words = " ".join(found.text)
    assert words.count("by the paper's own tables:") == (len(claims.CLAIMS) if study.of_the_paper else 0)
    assert ("claims" in found.ids) == study.of_the_paper
    for site in study.sites:
        assert site.files["iri"] in words
    assert "seed: 2021" in words and "numpy" in words


def test_stand_in_is_said_where_it_is_shown_and_not_elsewhere(study):
    text, _ = rendered(study)
    figures_with_data = set(catalogue.figures(study.settings["sites"])) - {"framework", "leastsquare"}
    if study.standin:
        assert "made from seeds" in text and "of Ts1, Ts2, Ts3 are" in text
        assert {name for name, caption in captions_of(text).items() if "Stand-in data: Ts" in caption} == figures_with_data
    else:
        assert "tand-in" not in text


def captions_of(text):
    """Names of the figures on a page and what stands below them."""
    return dict(re.findall(r'<figure id="fig-(\w+)">.*?<figcaption>(.*?)</figcaption>', text, re.S))


def test_figures_of_a_site_of_ones_own_do_not_say_stand_in_beside_one_that_is():
    study, found = synthetic.study(("ts1", "home")), differing.difference(("ts1", "home"))
    own = [dataclasses.replace(study.sites[1], standin=False, calibrated_on="home"), dataclasses.replace(found.sites[1], standin=False)]
    found = dataclasses.replace(found, sites=(found.sites[0], own[1]))
    study = dataclasses.replace(study, sites=(study.sites[0], own[0]), difference=found, diagnosis=differing.diagnosis(standin=False))
    text = page.render(study, tables.make(study), dict.fromkeys(page.captions(study), PIXEL))
    said = {name for name, caption in captions_of(text).items() if "Stand-in data: Ts1." in caption}
    assert "tand-in" not in " ".join(caption for name, caption in captions_of(text).items() if name not in said)
    kinds = ("views", "spectrum", "located", "conditions", "responses")
    assert {f"{kind}_ts1" for kind in kinds} <= said and not {f"{kind}_home" for kind in kinds} & said
    assert {"optichain", "convergence", "validation_iso", "error_ladder", "critical_shares"} <= said
    assert not {"opti_plots", "leastsquare", "framework", "evidence", "signature"} & said


@pytest.mark.parametrize("score", [None, {"found": []}])
def test_every_file_that_was_read_is_told_once(score):
    study, found, last = synthetic.study(("ts1",)), differing.difference(("ts1",)), differing.diagnosis(score=score)
    if score is None:
        last = dataclasses.replace(last, files={name: file for name, file in last.files.items() if name != "score"})
    told = [file for file, *_ in page._files(dataclasses.replace(study, difference=found, diagnosis=last))]
    read = [*study.sites[0].files.values(), "ts1/base/measured.nc", "ts1/base/calibration.nc", "comfort/base/agreement.nc", "ladder/base.nc"]
    assert sorted(told) == sorted([*read, *last.files.values()])


def test_captions_say_what_is_left_out():
    assert "at most two of a signal" in catalogue.site_figures("ts1")["located_ts1"]
    for name in ("thresholding_results_1", "thresholding_results_2"):
        assert "others are not drawn" in catalogue.COMFORT_FIGURES[name]


def test_one_site_of_ones_own_has_no_empty_sections_and_no_claims(own_site):
    text, found = rendered(own_site)
    assert not {"calibration", "claims"} & {*found.ids, *(link[1:] for link in found.links)}
    assert "<td>all sites" not in text and ">all sites," not in text


def test_names_with_markup_are_shown_not_run(own_site):
    named = dataclasses.replace(own_site.sites[0], title="<script>alert(1)</script>")
    study = dataclasses.replace(own_site, sites=(named,))
    text, found = rendered(study)
    assert "script" not in found.tags and "&lt;script&gt;" in text
