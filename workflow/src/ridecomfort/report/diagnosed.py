"""What there is to show of a diagnosis: tables and figures by name, as in the catalogue."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from . import style
from .figures import evidence, signature
from .study import Diagnosis
from .table import Table
from .tables import diagnosis, score


def tables(found: Diagnosis) -> dict[str, Table]:
    """Every table of ``catalogue.DIAGNOSIS_TABLES``."""
    return {
        "verdict": diagnosis.verdict(found),
        "missing_effects": diagnosis.missing_effects(found),
        "evidence": diagnosis.evidence(found),
        "excluded": diagnosis.excluded(found),
        "forms": diagnosis.forms(found),
    }


def scores(found: Diagnosis) -> dict[str, Table]:
    """Every table of ``catalogue.SCORE_TABLES``; none where nothing was hidden."""
    return {"standin_score": score.standin_score(found)} if found.score else {}


def figures(found: Diagnosis) -> dict[str, Callable]:
    """Functions without arguments that draw the figures of ``catalogue.DIAGNOSIS_FIGURES``; each says what was diagnosed."""
    mark = " ".join(filter(None, [found.subject(), found.standin_mark()]))
    marked = lambda draw: style.marked(draw(found), mark)
    drawn = {"evidence": evidence.evidence, "forms": evidence.forms, "signature": signature.signature}
    return {name: partial(marked, draw) for name, draw in drawn.items()}
