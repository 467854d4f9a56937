"""How exact the frequency weightings are, and how exact the paper's way would be."""

from __future__ import annotations

from functools import cache

from ...comfort import deviation
from .. import catalogue
from ..study import Study
from ..table import Column, Source, Table

NAMES = ("Wb", "Wc", "Wd", "We", "Wf", "Wj", "Wk")
RATES = (100, 200, 500, 1000)
FORMATS = {"exact": ".4f", "causal": ".4f", "bilinear": ".1f"}


def weighting(study: Study) -> Table:
    """Largest deviation of each weighting at each rate, by the way that the digital filter is made."""
    columns = [Column("weighting", ("", "Weighting"))]
    for rate in RATES:
        columns += [Column(f"{way}_{rate}_hz", (f"{rate} Hz", way), FORMATS[way]) for way in deviation.WAYS]
    rows = deviations()
    sources = (
        Source(
            "all",
            "ridecomfort/comfort/deviation.py",
            "largest",
            "largest absolute deviation in dB over 0.5 to 80 Hz, at most 0.45 times the rate, of the answer to an impulse",
        ),
    )
    notes = (
        "exact: in the frequency domain (comfort.weighting.weight), as everywhere in this study. causal: second-order "
        "sections fitted to the analogue response, for streaming. bilinear: the bilinear transform without prewarping.",
        "bilinear is the paper's way (eq:transf, with the sampling period).",
        "0.5 to 80 Hz lies above most of what Wf, for 0.1 to 0.5 Hz, lets pass: what deviates there is next to nothing.",
    )
    caption = catalogue.INPUT_TABLES["weighting"]
    return Table("weighting", caption, tuple(columns), rows, sources, notes)


@cache
def deviations() -> tuple[tuple, ...]:
    """Rows of the table; the same for every study."""
    return tuple(
        (name, *(deviation.largest(name, rate, way) for rate in RATES for way in deviation.WAYS)) for name in NAMES
    )
