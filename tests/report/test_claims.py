"""Claims: each rule holds on the paper's own tables, and each verdict can be reached."""

import copy
from dataclasses import replace

import pytest

from ridecomfort.report import claims, published, tables
from ridecomfort.report.claims import FAILS, HOLDS, UNKNOWN, Answer, Evidence
from ridecomfort.report.tables.agreement import pair_title


@pytest.fixture
def paper() -> Evidence:
    """The paper's figures; with values of a_v along the sites, which it does not print."""
    found = copy.deepcopy(claims.from_paper())
    return Evidence(found.sections, found.improvement, {"ts1": 0.05, "ts2": 0.06, "ts3": 0.04}, found.calibrated_on)


def changed(evidence: Evidence, key, site, count) -> Evidence:
    sections = {name: dict(row) for name, row in evidence.sections.items()}
    sections[key][site] = (count, 100.0 * count / published.windows(site))
    return Evidence(sections, evidence.improvement, evidence.lowest, evidence.calibrated_on)


def without(evidence: Evidence, site) -> Evidence:
    def rest(mapping):
        return {key: value for key, value in mapping.items() if key != site}

    sections = {name: rest(row) for name, row in evidence.sections.items()}
    return Evidence(sections, rest(evidence.improvement), rest(evidence.lowest), rest(evidence.calibrated_on))


def verdict(rule, evidence) -> str:
    return claims.combine(rule(evidence)).verdict


@pytest.mark.parametrize("rule", claims.CLAIMS, ids=lambda rule: rule.__name__)
def test_the_paper_supports_its_claims(rule, paper):
    assert verdict(rule, paper) == HOLDS


@pytest.mark.parametrize("rule", claims.CLAIMS, ids=lambda rule: rule.__name__)
def test_nothing_is_said_without_the_sites(rule):
    assert verdict(rule, Evidence({})) == UNKNOWN


@pytest.mark.parametrize("rule", claims.CLAIMS, ids=lambda rule: rule.__name__)
def test_nothing_is_said_without_one_of_the_sites(rule, paper):
    assert verdict(rule, without(paper, "ts3")) == UNKNOWN


@pytest.mark.parametrize(
    "rule, key, site, count",
    [
        (claims.longitudinal, ("a_x", "PT"), "ts3", 30),  # ts3 leads
        (claims.longitudinal, ("a_x", "ND"), "ts2", 1),  # something on ts2
        (claims.longitudinal, ("a_x", "AG"), "ts1", 1),  # something for AG
        (claims.lateral, ("a_y", "PT"), "ts3", 20),  # 4.7 % is not a large share
        (claims.lateral, ("a_y", "ND"), "ts1", 60),  # ts1 leads
        (claims.lateral, ("a_y", "AG"), "ts2", 10),  # ts2 leads
        (claims.vertical, ("a_z", "ND"), "ts3", 52),  # ts3 before ts2
        (claims.vertical, ("a_z", "AG"), "ts2", 50),  # ts2 before ts1
        (claims.iso2631, ("iso2631", "LU"), "ts2", 55),  # ts2 leads
        (claims.iso2631, ("iso2631", "VU"), "ts1", 1),
        (claims.iri, ("iri", "M"), "ts1", 40),
        (claims.iri, ("iri", "P"), "ts3", 2),
    ],
)
def test_one_figure_undoes_a_claim(rule, key, site, count, paper):
    assert verdict(rule, changed(paper, key, site, count)) == FAILS


@pytest.mark.parametrize(
    "rule, key, site, count",
    [(claims.vertical, ("a_z", "ND"), "ts3", 51), (claims.iso2631, ("iso2631", "LU"), "ts2", 54)],
)
def test_a_tie_decides_nothing(rule, key, site, count, paper):
    answer = claims.combine(rule(changed(paper, key, site, count)))
    assert answer.verdict == UNKNOWN and "a tie" in answer.reason


def test_no_leader_where_nothing_is_critical(paper):
    for site in claims.SITES:
        paper = changed(paper, ("iso2631", "U"), site, 0)
    assert verdict(claims.iso2631, paper) == UNKNOWN


def test_agreement_compares_how_often_methods_name_the_site_of_the_iri(paper):
    """Paper: IRI 3 of 3 on ts2; ISO 2631 FU and U of LU, FU, U; thresholds a_y PT and ND of 7."""
    reason = claims.combine(claims.agreement(paper)).reason
    assert "Ts2 is the most critical site in 3 of 3 classes" in reason
    assert "2 of 3 bands of ISO 2631 and 2 of 7 thresholds" in reason
    for key in (("iso2631", "FU"), ("iso2631", "U")):
        paper = changed(paper, key, "ts1", 100)
    assert verdict(claims.agreement, paper) == FAILS


def test_agreement_fails_where_the_iri_names_another_site(paper):
    for quality in ("G", "F", "M"):
        paper = changed(paper, ("iri", quality), "ts1", 600)
    assert verdict(claims.agreement, paper) == FAILS


@pytest.mark.parametrize("lowest, expected", [(0.021, HOLDS), (0.015, UNKNOWN), (0.009, FAILS)])
def test_perception_between_its_thresholds_is_open(lowest, expected, paper):
    paper.lowest["ts2"] = lowest
    assert verdict(claims.perception, paper) == expected


def test_transfer_needs_lower_errors_a_z_the_most_and_parameters_of_ts1(paper):
    worse = copy.deepcopy(paper)
    worse.improvement["ts3"]["a_y"] = -0.1
    assert verdict(claims.transfer, worse) == FAILS
    less = copy.deepcopy(paper)
    less.improvement["ts2"]["a_x"] = 20.0
    assert verdict(claims.transfer, less) == FAILS
    elsewhere = Evidence(paper.sections, paper.improvement, paper.lowest, {**paper.calibrated_on, "ts3": "ts3"})
    assert verdict(claims.transfer, elsewhere) == UNKNOWN


def test_a_part_that_fails_outweighs_an_open_one():
    answer = claims.combine([Answer(HOLDS, "a"), Answer(UNKNOWN, "b"), Answer(FAILS, "c")])
    assert answer == Answer(FAILS, "a; b; c.")


def test_the_table_answers_every_claim_with_figures(made):
    found = made["claims"]
    assert [row[1] for row in found.rows] == published.figures()["claims"]
    assert len(claims.CLAIMS) == len(published.figures()["claims"])
    for row in found.rows:
        assert row[2] in (HOLDS, FAILS, UNKNOWN)
        assert any(letter.isdigit() for letter in row[3])


def test_what_the_iri_says_of_roads_that_are_matched_to_its_classes_is_told_to_be_so_by_construction(made, paper_like):
    matched = [row[3].endswith(claims.MATCHED) for row in made["claims"].rows]
    assert matched == [rule in (claims.iri, claims.agreement) for rule in claims.CLAIMS]
    scanned = replace(paper_like, sites=tuple(replace(site, standin=False) for site in paper_like.sites))
    assert not any(claims.MATCHED in row[3] for row in claims.table(scanned, made).rows)


def test_evidence_of_this_study_is_read_from_its_tables(made, paper_like):
    found = claims.from_tables(made, {})
    chosen = paper_like.sites[2].thresholds.sel(axis="a_y", style="PT")
    assert found.sections["a_y", "PT"]["ts3"] == (int(chosen["critical_count"]), float(chosen["critical_share"]))
    assert found.lowest["ts1"] == pytest.approx(float(paper_like.sites[0].iso2631["a_v"].min()))
    assert set(found.improvement["ts2"]) == {"a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate"}


@pytest.mark.parametrize("interval, said", [((0.1, 0.3), HOLDS), ((-0.3, -0.1), FAILS), ((-0.1, 0.3), UNKNOWN)])
def test_what_is_closer_to_the_iri_is_decided_by_kappas_where_there_are_some(paper, interval, said):
    closer = {"ISO 2631": (0.6, 0.5, 0.7), "thresholding": (0.4, 0.3, 0.5), "difference": (sum(interval) / 2, *interval)}
    found = Evidence(paper.sections, paper.improvement, paper.lowest, paper.calibrated_on, closer)
    answer = claims.combine(claims.agreement(found))
    assert answer.verdict == said and "weighted kappa with the IRI 0.60" in answer.reason


def test_kappas_without_an_interval_decide_nothing(paper):
    nan = float("nan")
    closer = {"ISO 2631": (0.6, nan, nan), "thresholding": (0.4, nan, nan), "difference": (0.2, nan, nan)}
    answer = claims.combine(claims.agreement(Evidence(paper.sections, paper.improvement, paper.lowest, paper.calibrated_on, closer)))
    assert answer.verdict == UNKNOWN and answer.reason.endswith("difference 0.20 (no interval).")


def test_a_method_of_one_grade_has_no_kappa_and_classes_are_compared(made):
    table = made["agreement"]
    title = pair_title("thresholds - iri")
    rows = tuple((*row[:2], *[float("nan")] * 3, *row[5:]) if row[0] == title else row for row in table.rows)
    assert claims.from_tables(made, {}).closer and claims.from_tables({**made, "agreement": replace(table, rows=rows)}, {}).closer == {}


def test_kappas_are_those_of_the_table_of_agreement(made, paper_like):
    told = claims.from_tables(made, {}).closer
    found = paper_like.assessment.sel(site="pooled")
    assert told["ISO 2631"] == tuple(found["kappa"].sel(pair="iso2631 - iri").values)
    assert told["thresholding"] == tuple(found["kappa"].sel(pair="thresholds - iri").values)
    assert told["difference"] == tuple(found["kappa_difference"].values)


def test_kappas_of_other_sites_answer_nothing(own_site):
    assert claims.from_tables(tables.make(own_site), {}).closer == {}
