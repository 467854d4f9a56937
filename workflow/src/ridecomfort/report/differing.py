"""What there is to show of how model and measurement differ: tables and figures by name, as in the catalogue."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from . import style
from .figures import conditions, ladder, located
from .study import Compared, Difference
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


def figures_of_site(site: Compared, model: str) -> dict[str, Callable]:
    """Functions without arguments that draw the figures of ``catalogue.site_figures`` of a ``model`` on a site."""
    kinds = {
        "located": partial(located.located, site, model),
        "conditions": partial(conditions.conditions, site, model),
        "responses": partial(conditions.responses, site, model),
    }
    marked = lambda draw: style.marked(draw(), site.standin_mark())
    return {f"{kind}_{site.name}": partial(marked, draw) for kind, draw in kinds.items()}


def figures(found: Difference) -> dict[str, Callable]:
    """The same for ``catalogue.DIFFERENCE_FIGURES``, over all sites."""
    return {"error_ladder": lambda: style.marked(ladder.error_ladder(found), found.standin_mark())}
