"""One self-contained HTML page: claims, tables, figures and where everything comes from."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from importlib.resources import files
from pathlib import PurePath

import jinja2
import xarray as xr
import yaml
from markupsafe import Markup

from ..discrepancy.ranking import forms
from . import catalogue, claims, notation, published
from .figures import standin_mark
from .study import STANDIN, Study
from .table import Table, to_html

SECTIONS = (
    ("sites", "Sites", ("sites", "testsection_figs")),
    ("roads", "Road surfaces", ("views_*", "roughness", "spectrum_*", "repair", "smoothing", "smoothing.figure")),
    (
        "method",
        "Method",
        (
            "framework",
            "quantities",
            "lhs_input",
            "thresholds_manual",
            "acc_thresholds",
            "IRI_thresholds",
            "validation_iso",
            "weighting",
        ),
    ),
    (
        "calibration",
        "Calibration",
        ("leastsquare", "optichain", "convergence", "constraints", "baseline_res", "opti_res_*", "opti_plots"),
    ),
    (
        "difference",
        "Where model and measurement differ",
        ("located_*", "findings", "explainable", "conditions_*", "responses_*", "alignment", "calibrated"),
    ),
    (
        "missing",
        "Which effect is missing",
        ("verdict", "missing_effects", "evidence.figure", "signature", "evidence", "excluded", "forms.figure", "forms", "standin_score"),
    ),
    ("ladder", "How the error falls", ("error_ladder.figure", "error_ladder", "error_ladder_sections")),
    ("overview", "Comfort at a glance", ("critical_shares", "exceedance")),
    (
        "thresholding",
        "Thresholding",
        ("thresholding_results_1", "thresholding_results_2", "thresholding_table", "jerk"),
    ),
    ("iso2631", "ISO 2631", ("ride_comfors", "rid_comf_res", "perception", "vibration", "exposure")),
    (
        "iri",
        "International Roughness Index",
        ("IRI_thresholds.figure", "rid_comf_res2", "iri_resolution.figure", "iri_resolution", "iri_tracks"),
    ),
    (
        "agreement",
        "Agreement of the methods",
        ("agreement.figure", "agreement", "confusion", "influence.figure", "influence"),
    ),
    ("runs", "Number of runs", ("number_of_runs.figure", "number_of_runs")),
)
"""Key, title and pieces of each section; ``.figure`` tells a figure from the table of the same name."""

JSON = {"verdict.json": "Which effect is missing", "score.json": "The verdict against the truth of the stand-in drives"}
"""What the files hold that are no datasets."""

KINDS = {claims.HOLDS: "holds", claims.FAILS: "fails", claims.UNKNOWN: "open"}


def render(study: Study, tables: Mapping[str, Table], figures: Mapping[str, bytes]) -> str:
    """The page as HTML text. ``tables`` hold the claims too; ``figures`` are PNG files by name."""
    environment = jinja2.Environment(autoescape=True, trim_blocks=False, undefined=jinja2.StrictUndefined)
    template = environment.from_string(files(__package__).joinpath("page.html").read_text(encoding="utf-8"))
    return template.render(
        title="Critical ride comfort along the road",
        lead=_lead(study),
        standin=_standin(study),
        claims=[_claim(row) for row in tables["claims"].rows] if "claims" in tables else [],
        sections=list(_sections(study, tables, figures)),
        files=_files(study),
        software=sorted(study.software.items()),
        configuration=yaml.safe_dump(dict(study.settings), default_flow_style=None, allow_unicode=True, width=100),
        citation=published.CITATION,
    )


def captions(study: Study) -> dict[str, str]:
    """Name and caption of every figure of the page."""
    found = catalogue.figures(study.settings["sites"])
    if study.difference:
        found |= catalogue.difference_figures(site.name for site in study.difference.sites)
    if study.diagnosis:
        found |= catalogue.DIAGNOSIS_FIGURES
        if forms(study.diagnosis.ranking) is None:  # an empty figure, for whom asks for it by name
            del found["forms"]
    return found


def _standin(study: Study) -> str | None:
    note = study.standin_note()
    if note is None:
        return None
    sentence = note.removeprefix(STANDIN)
    return sentence[0].upper() + sentence[1:]


def _lead(study: Study) -> str:
    runs = ", ".join(f"{site.samples.sizes['run']} on {site.label}" for site in study.sites)
    return (
        f"From the road surface to critical sections by three methods: thresholds, ISO 2631 and the IRI. "
        f"Simulated drives: {runs}; model: {study.model}. The study follows {published.CITATION}."
    )


def _sections(study: Study, tables: Mapping[str, Table], figures: Mapping[str, bytes]):
    said = captions(study)
    figure_of = lambda name: _figure(name, said[name], figures[name], _standin_mark(study, name))  # noqa: E731
    for key, title, names in SECTIONS:
        pieces = []
        for name in names:
            figure = name.removesuffix(".figure")
            if name.endswith("*"):
                pieces += [_table(table) for other, table in tables.items() if other.startswith(name[:-1])]
                pieces += [figure_of(other) for other in figures if other.startswith(name[:-1])]
            elif name in tables:
                pieces.append(_table(tables[name]))
            elif figure in figures:
                pieces.append(figure_of(figure))
        if pieces:
            yield {"key": key, "title": title, "pieces": pieces}


def _table(table: Table) -> dict:
    return {
        "name": table.name,
        "image": None,
        "caption": _marked(table.caption),
        "table": Markup(to_html(table)),
        "notes": [_marked(note) for note in table.notes if not note.startswith(STANDIN)],
        "sources": [
            [_marked(text) for text in (source.cells, source.file, source.variable, source.rule)]
            for source in table.sources
        ],
    }


def _standin_mark(study: Study, name: str) -> str | None:
    """The words for the stand-in sites whose data a figure shows, as they stand in its corner; None where it shows none."""
    if name in catalogue.figures(study.settings["sites"]):
        return standin_mark(study, name)
    if name in catalogue.DIAGNOSIS_FIGURES:
        return study.diagnosis.standin_mark()
    if name in catalogue.DIFFERENCE_FIGURES:
        return study.difference.standin_mark()
    return study.difference.site(name.partition("_")[2]).standin_mark()


def _figure(name: str, caption: str, image: bytes, mark: str | None) -> dict:
    return {
        "name": name,
        "image": base64.b64encode(image).decode("ascii"),
        "caption": _marked(caption),
        "alternative": notation.plain(caption),
        "mark": mark,
    }


def _claim(row) -> dict:
    answer = dict(zip(("number", "text", "verdict", "reason", "paper"), row))
    return answer | {"kind": KINDS[answer["verdict"]]}


def _files(study: Study) -> list[tuple[str, ...]]:
    """File, title, configuration hash, seed and source of everything that was read, each file once."""
    measured = study.difference.sites if study.difference else ()
    found = {file: getattr(site, name) for site in (*study.sites, *measured) for name, file in site.files.items()}
    found |= {study.calibration_files[name]: dataset for name, dataset in study.calibrations.items()}
    found[study.assessment_file] = study.assessment
    if study.difference:
        found[study.difference.ladder_file] = study.difference.ladder
    if study.diagnosis:
        found |= {file: getattr(study.diagnosis, name) for name, file in study.diagnosis.files.items()}
    return [_file(file, read) for file, read in found.items() if read is not None]


def _file(file: str, read: xr.Dataset | Mapping) -> tuple[str, ...]:
    """A file as ``_files`` tells of it; one of JSON is only called what it is."""
    if not isinstance(read, xr.Dataset):
        return file, JSON[PurePath(file).name], "", "", ""
    keys = ("title", "configuration_hash", "seed", "source")
    return file, *(str(read.attrs.get(key, "")) for key in keys)


def _marked(text: str) -> Markup:
    return Markup(notation.html(text))
