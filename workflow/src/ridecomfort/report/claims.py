"""The paper's claims, answered by rules from tables: holds, does not hold, cannot be said.

The same rules read our rows and the paper's rows of the same tables, so that each verdict
stands beside the one that the paper's own figures give.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from . import catalogue, notation, published
from .classes import CRITICAL_BANDS, CRITICAL_QUALITIES, STYLES
from .study import Study
from .table import PUBLISHED, Column, Source, Table
from .tables.agreement import DIFFERENCE, POOLED, pair_title, place_title
from .tables.calibration import CHANGE
from .tables.comfort import OURS, PAPER, PERCEPTION

HOLDS = "holds"
FAILS = "does not hold"
UNKNOWN = "cannot be said"

SITES = catalogue.OF_THE_PAPER
TIE = ": a tie, which a run more or less would break"

MATCHED = " Stand-in roads are matched to the paper's shares of the IRI classes: what these say is so by construction."

LARGE_SHARE = 10.0
"""Percent; what counts as a large share (the smallest that the paper calls so is 11.71 %)."""


@dataclass(frozen=True)
class Evidence:
    """What the claims rest on: the figures of the paper's three sites, as far as they are known.

    ``sections`` maps (method, class) to site to (C, R_c in percent), ``improvement`` maps a site
    to the change of NRMSE in percent by signal, ``lowest`` a site to its lowest a_v in m/s2,
    ``calibrated_on`` a site to the site that its parameters come from. ``closer``: kappa of ISO 2631
    with the IRI, that of thresholding with it, and the difference with its 95 % interval, (estimate, lower, upper) each.
    """

    sections: Mapping[tuple[str, str], Mapping[str, tuple[int, float]]]
    improvement: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    lowest: Mapping[str, float] = field(default_factory=dict)
    calibrated_on: Mapping[str, str] = field(default_factory=dict)
    closer: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)

    def counts(self, method: str, name: str) -> dict[str, int]:
        """Critical sections of the paper's sites; sites that are missing are left out."""
        found = self.sections.get((method, name), {})
        return {site: found[site][0] for site in SITES if site in found}

    def shares(self, method: str, name: str) -> dict[str, float]:
        """Share of critical sections in percent of the paper's sites."""
        found = self.sections.get((method, name), {})
        return {site: found[site][1] for site in SITES if site in found}


@dataclass(frozen=True)
class Answer:
    """A verdict and the sentence that gives its reason, figures included."""

    verdict: str
    reason: str


def from_tables(tables: Mapping[str, Table], calibrated_on: Mapping[str, str]) -> Evidence:
    """The evidence in the rows of this study in its tables."""
    sections: dict = {}
    for name, classes in _CLASSES.items():
        keys = [column.key for column in tables[name].columns]
        rows = [dict(zip(keys, row)) for row in tables[name].rows if row[1] == OURS]
        for key, row in zip(classes, rows):
            sections[key] = {site: (row[f"{site}_C"], row[f"{site}_R_c"]) for site in SITES if f"{site}_C" in row}
    improvement = {}
    for site in SITES:
        table = tables.get(f"opti_res_{site}")
        for row in table.rows if table else ():
            if row[0] == CHANGE and row[1] == OURS:
                keys = [column.key.removeprefix("nrmse_") for column in table.columns]
                improvement[site] = dict(list(zip(keys, row))[2:])
    rows = {row[0]: row[1] for row in tables["perception"].rows}
    lowest = {site: rows[catalogue.label(site)] for site in SITES if catalogue.label(site) in rows}
    return Evidence(sections, improvement, lowest, calibrated_on, _closer(tables.get("agreement")))


def _closer(table: Table | None) -> dict[str, tuple[float, float, float]]:
    """Kappas over the paper's three sites together; empty where the study is of others."""
    if table is None:
        return {}
    rows = {row[:2]: tuple(row[2:5]) for row in table.rows}
    sites = {site for _, site in rows} - {place_title(POOLED)}
    keys = {"ISO 2631": pair_title("iso2631 - iri"), "thresholding": pair_title("thresholds - iri")}
    keys["difference"] = DIFFERENCE
    if sites != {catalogue.label(site) for site in SITES}:
        return {}
    found = {name: rows[title, place_title(POOLED)] for name, title in keys.items()}
    return found if all(math.isfinite(kappa) for kappa, *_ in found.values()) else {}  # of one grade alone there is none


def from_paper() -> Evidence:
    """The evidence in the paper's own tables; it publishes no values of a_v along the sites."""
    sections = {}
    for name, classes in _CLASSES.items():
        for method, key in classes:
            row = (method, key) if name == "thresholding_table" else (key,)
            found = {site: published.detection(name, row, site) for site in SITES}
            sections[method, key] = {site: values[:2] for site, values in found.items() if values}
    improvement = {site: published.figures()["nrmse"][site]["improvement_pct"] for site in SITES}
    return Evidence(sections, improvement, calibrated_on=dict.fromkeys(SITES, "ts1"))


def answers(found: Evidence) -> list[Answer]:
    """The answers to the claims of the paper, in their order."""
    return [combine(claim(found)) for claim in CLAIMS]


def combine(parts: Iterable[Answer]) -> Answer:
    """One answer from those to the parts of a claim: all must hold, one that fails decides."""
    parts = list(parts)
    verdicts = [part.verdict for part in parts]
    verdict = FAILS if FAILS in verdicts else UNKNOWN if UNKNOWN in verdicts else HOLDS
    return Answer(verdict, "; ".join(part.reason for part in parts) + ".")


def tables(study: Study, made: Mapping[str, Table]) -> dict[str, Table]:
    """The table of claims by its name, none for a study without any of the paper's sites: they are about these."""
    return {"claims": table(study, made)} if study.of_the_paper else {}


def table(study: Study, tables: Mapping[str, Table]) -> Table:
    """The claims with the verdict of this study, its reason, and the verdict of the paper's own figures."""
    origin = {site.name: site.calibrated_on for site in study.sites if site.calibrated_on}
    ours, paper = answers(from_tables(tables, origin)), answers(from_paper())
    matched = [MATCHED if study.standin and claim in (iri, agreement) else "" for claim in CLAIMS]
    columns = (
        Column("number", ("No.",), "d"),
        Column("claim", ("Claim of the paper",)),
        Column("verdict", ("In this study",)),
        Column("reason", ("Because",)),
        Column("paper_verdict", ("By the paper's own tables",)),
    )
    rows = tuple(
        (number, claim, our.verdict, our.reason + note, its.verdict)
        for number, (claim, our, its, note) in enumerate(zip(published.figures()["claims"], ours, paper, matched), start=1)
    )
    names = ", ".join(name for name in tables if name in (*_CLASSES, "perception", "agreement") or name.startswith("opti_res_"))
    sources = (
        Source("claim", "report/published.yaml", "claims", "the paper's conclusions"),
        Source("verdict, reason", f"tables {names}", f"rows of {OURS}", "report/claims.py, one rule a claim"),
        Source(PAPER, PUBLISHED, "detections, nrmse", "the same rules on the paper's figures"),
    )
    note = study.standin_note()
    notes = (f"{note} The verdicts are about these sites.",) if note else ()
    return Table("claims", catalogue.CLAIMS_TABLES["claims"], columns, rows, sources, notes)


def longitudinal(found: Evidence) -> list[Answer]:
    """a_x: most critical sections on ts1 (PT and ND); none on ts2; none anywhere for AG."""
    return [
        *(_first(found, "a_x", style, "ts1") for style in ("PT", "ND")),
        *(_none(found, "a_x", style, ("ts2",)) for style in ("PT", "ND")),
        _none(found, "a_x", "AG", SITES),
    ]


def lateral(found: Evidence) -> list[Answer]:
    """a_y: every site exceeds PT on a large share; ts2 leads in share for PT and ND, ts3 for AG."""
    shares = found.shares("a_y", "PT")
    large = _complete(shares, lambda: min(shares.values()) >= LARGE_SHARE)
    return [
        Answer(large, f"a_y PT {_list(shares, '.2f', ' %')} (large: at least {LARGE_SHARE:g} %)"),
        _first(found, "a_y", "PT", "ts2", by="share"),
        _first(found, "a_y", "ND", "ts2", by="share"),
        _first(found, "a_y", "AG", "ts3", by="share"),
    ]


def vertical(found: Evidence) -> list[Answer]:
    """a_z: ts1 has the most critical sections, then ts2, then ts3 (ND and AG)."""
    parts = []
    for style in ("ND", "AG"):
        counts = found.counts("a_z", style)
        rising = _complete(counts, lambda counts=counts: counts["ts1"] >= counts["ts2"] >= counts["ts3"])
        tied = rising == HOLDS and len(set(counts.values())) < len(counts)
        parts.append(Answer(UNKNOWN if tied else rising, f"a_z {style} {_list(counts)}{TIE if tied else ''}"))
    return parts


def iso2631(found: Evidence) -> list[Answer]:
    """ISO 2631: ts1 has the most LU; ts2 the most FU and U; no VU or EU anywhere."""
    return [
        _first(found, "iso2631", "LU", "ts1"),
        _first(found, "iso2631", "FU", "ts2"),
        _first(found, "iso2631", "U", "ts2"),
        _none(found, "iso2631", "VU", SITES),
        _none(found, "iso2631", "EU", SITES),
    ]


def iri(found: Evidence) -> list[Answer]:
    """IRI: ts2 has the most G, F and M; no P anywhere."""
    return [*(_first(found, "iri", name, "ts2") for name in ("G", "F", "M")), _none(found, "iri", "P", SITES)]


def agreement(found: Evidence) -> list[Answer]:
    """ISO 2631 agrees with IRI more closely than thresholding does (ts2 the most critical).

    Each class of a method in which anything is critical names the site with the largest share.
    The IRI's site is the one that most of its classes name; a method agrees as often as its
    classes name that site. Where the methods were held against each other section by section, the difference
    of their weighted kappas with the IRI says which is closer, and its interval whether that can be said.
    """
    leaders = {method: _leaders(found, keys) for method, keys in _METHODS.items()}
    if not all(leaders.values()) or any(set(found.shares(*key)) != set(SITES) for key in _METHODS["IRI"]):
        return [Answer(UNKNOWN, "a method finds nothing critical, or a site is missing")]
    named = leaders["IRI"]
    reference = max(SITES, key=named.count)
    clear = named.count(reference) * 2 > len(named)
    share = {method: (sites.count(reference), len(sites)) for method, sites in leaders.items()}
    iso, thresholding = share["ISO 2631"], share["Thresholding"]
    ahead = iso[0] * thresholding[1] - thresholding[0] * iso[1]
    site = catalogue.label(reference)
    leading = Answer(
        HOLDS if clear and reference == "ts2" else FAILS,
        f"by the IRI {site} is the most critical site in {named.count(reference)} of {len(named)} classes",
    )
    reason = f"so it is in {iso[0]} of {iso[1]} bands of ISO 2631 and {thresholding[0]} of {thresholding[1]} thresholds"
    if found.closer:
        return [leading, _closer_by_kappa(found.closer, reason)]
    return [leading, Answer(HOLDS if ahead > 0 else FAILS if ahead < 0 else UNKNOWN, reason)]


def _closer_by_kappa(kappas: Mapping[str, tuple[float, float, float]], reason: str) -> Answer:
    difference, lower, upper = kappas["difference"]
    verdict = HOLDS if lower > 0 else FAILS if upper < 0 else UNKNOWN
    figures = f"{kappas['ISO 2631'][0]:.2f} of ISO 2631, {kappas['thresholding'][0]:.2f} of thresholding"
    interval = f"{difference:.2f} ({lower:.2f} to {upper:.2f})" if math.isfinite(upper - lower) else f"{difference:.2f} (no interval)"
    return Answer(verdict, f"{reason}; section by section weighted kappa with the IRI {figures}, difference {interval}")


def perception(found: Evidence) -> list[Answer]:
    """The vibration perception threshold (0.01-0.02 m/s^2) is exceeded everywhere."""
    if not found.lowest:
        return [Answer(UNKNOWN, "no values of a_v along the sites of the paper")]
    exceeded = _complete(found.lowest, lambda: min(found.lowest.values()) > PERCEPTION[1])
    if exceeded == FAILS and min(found.lowest.values()) > PERCEPTION[0]:
        exceeded = UNKNOWN
    return [Answer(exceeded, f"lowest a_v {_list(found.lowest, '.4f')} m/s²")]


def transfer(found: Evidence) -> list[Answer]:
    """Parameters calibrated on ts1 lower a_x, a_y and a_z errors on ts2 and ts3 too, a_z the most."""
    parts = []
    for site in ("ts2", "ts3"):
        change = found.improvement.get(site)
        if not change or found.calibrated_on.get(site) != "ts1":
            parts.append(Answer(UNKNOWN, f"{catalogue.label(site)}: no comparison with parameters of Ts1"))
            continue
        change = {signal: change[signal] for signal in ("a_x", "a_y", "a_z")}
        lower = min(change.values()) > 0 and max(change, key=change.get) == "a_z"
        figures = ", ".join(f"{signal} {value:.2f} %" for signal, value in change.items())
        parts.append(Answer(HOLDS if lower else FAILS, f"{catalogue.label(site)} errors lower by {figures}"))
    return parts


CLAIMS: tuple[Callable[[Evidence], list[Answer]], ...] = (
    longitudinal,
    lateral,
    vertical,
    iso2631,
    iri,
    agreement,
    perception,
    transfer,
)
"""One rule a claim, in the order of ``published.figures()["claims"]``."""

_CLASSES = {
    "thresholding_table": [(axis, style) for axis in ("a_x", "a_y", "a_z") for style in STYLES],
    "rid_comf_res": [("iso2631", band) for band in CRITICAL_BANDS],
    "rid_comf_res2": [("iri", quality) for quality in CRITICAL_QUALITIES],
}
_METHODS = {
    "Thresholding": [key for key in _CLASSES["thresholding_table"] if key != ("a_z", "PT")],
    "ISO 2631": _CLASSES["rid_comf_res"],
    "IRI": _CLASSES["rid_comf_res2"],
}


def _first(found: Evidence, method: str, name: str, site: str, by: str = "count") -> Answer:
    """Whether a site leads alone in a class; with nothing critical on any site, or in a tie, nobody can tell."""
    values = found.counts(method, name) if by == "count" else found.shares(method, name)
    reason = f"{_title(method)} {name} {_list(values) if by == 'count' else _list(values, '.2f', ' %')}"
    if set(values) == set(SITES) and not any(values.values()):
        return Answer(UNKNOWN, f"{reason}: nothing to compare")
    leads = _complete(values, lambda: values[site] == max(values.values()))
    if leads == HOLDS and list(values.values()).count(values[site]) > 1:
        return Answer(UNKNOWN, f"{reason}{TIE}")
    most = "most" if by == "count" else "largest"
    return Answer(leads, f"{reason} ({most} on {catalogue.label(site)}: {_yes(leads)})")


def _none(found: Evidence, method: str, name: str, sites: Iterable[str]) -> Answer:
    """Whether nothing is critical in a class on the sites."""
    counts = {site: count for site, count in found.counts(method, name).items() if site in sites}
    if any(counts.values()):
        verdict = FAILS
    else:
        verdict = HOLDS if set(counts) == set(sites) else UNKNOWN
    where = " and ".join(catalogue.label(site) for site in sites) if len(tuple(sites)) < len(SITES) else "any site"
    return Answer(verdict, f"{_title(method)} {name} {_list(counts)} (none on {where}: {_yes(verdict)})")


def _leaders(found: Evidence, keys) -> list[str]:
    """The site with the largest share in each class in which anything is critical; ties name nobody."""
    leaders = []
    for key in keys:
        shares = found.shares(*key)
        if any(shares.values()):
            most = [site for site, share in shares.items() if share == max(shares.values())]
            leaders.append(most[0] if len(most) == 1 else "")
    return leaders


def _complete(values: Mapping, holds: Callable[[], bool]) -> str:
    """The verdict of a test that needs all three sites."""
    if set(values) != set(SITES):
        return UNKNOWN
    return HOLDS if holds() else FAILS


def _title(method: str) -> str:
    return notation.METHODS.get(method, method)


def _list(values: Mapping, form: str = "d", unit: str = "") -> str:
    if not values:
        return "without figures"
    return ", ".join(f"{catalogue.label(site)} {value:{form}}{unit}" for site, value in values.items())


def _yes(verdict: str) -> str:
    return {HOLDS: "yes", FAILS: "no", UNKNOWN: "open"}[verdict]
