"""The paper's published figures, as data, for the columns that stand beside ours.

All figures are Genser et al. (2021) as printed; ``published.yaml`` names the table of each.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files

import yaml

CITATION = (
    "Genser, A., Spielhofer, R., Nitsche, P., Kouvelas, A. (2021): "
    "Critical ride comfort detection for automated vehicles"
)


@cache
def figures() -> dict:
    """All published figures, nested as in ``published.yaml``; units are in its keys and comments."""
    text = files(__package__).joinpath("published.yaml").read_text(encoding="utf-8")
    return yaml.safe_load(text)


def windows(site: str) -> int | None:
    """Number of 5 m sections of a site in the detection tables, None for a site that is not the paper's."""
    known = figures()["sites"].get(site)
    return None if known is None else known["windows_5m"]


def detection(table: str, row: tuple[str, ...], site: str) -> tuple | None:
    """C, R_c, N, R_n of one row and site of a detection table as printed, misprints included.

    ``table`` is ``thresholding_table`` (row: axis, style), ``rid_comf_res`` (row: band) or
    ``rid_comf_res2`` (row: quality). None where the paper prints nothing.
    """
    entry = figures()["detections"][_DETECTIONS[table]]
    for key in row:
        entry = entry.get(key, {})
    if site not in entry:
        return None
    count, share = entry[site]
    misprint = misprinted(table, row, site)
    rest = misprint or (windows(site) - count, 100.0 - share)
    return (count, share, *rest)


def misprinted(table: str, row: tuple[str, ...], site: str) -> tuple | None:
    """N and R_n as printed where they contradict C and the number of windows, else None."""
    entry = figures()["misprints"].get(table, {})
    for key in row:
        entry = entry.get(key, {})
    return tuple(entry[site]) if site in entry else None


_DETECTIONS = {"thresholding_table": "thresholding", "rid_comf_res": "iso2631", "rid_comf_res2": "iri"}
