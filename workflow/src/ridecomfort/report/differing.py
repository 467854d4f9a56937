"""What there is to show of how model and measurement differ: tables and figures by name, as in the catalogue."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from . import style
from .figures import conditions, ladder, located
from .study import Difference
from .table import Table
from .tables import calibration, difference
from .tables import ladder as rungs


def tables(found: Difference) -> dict[str, Table]:
    """Every table of ``catalogue.DIFFERENCE_TABLES``."""
    return {
        "alignment": difference.alignment(found),
        "calibrated": calibration.calibrated(found),
        "findings": difference.findings(found),
        "explainable": difference.explainable(found),
        "error_ladder": rungs.error_ladder(found),
        "error_ladder_sections": rungs.error_ladder_sections(found),
    }


def figures(found: Difference) -> dict[str, Callable]:
    """Functions without arguments that draw the figures of ``catalogue.difference_figures``."""
    kinds = {"located": located.located, "conditions": conditions.conditions, "responses": conditions.responses}
    of_site = lambda draw, name: style.marked(draw(found, name), found.standin_mark(name))
    of_sites = {f"{kind}_{site.name}": partial(of_site, draw, site.name) for site in found.sites for kind, draw in kinds.items()}
    return {**of_sites, "error_ladder": lambda: style.marked(ladder.error_ladder(found), found.standin_mark())}
