"""A road on its way from the file to its use: as measured, repaired and, where asked, smoothed."""

from __future__ import annotations

from dataclasses import dataclass

import xarray as xr

from ..errors import InputError
from . import clean, crg, smoothing
from .surface import INTERPOLATION

SMOOTHING = ("none", "cross-validation")
"""The choices of the option ``smoothing``; the first is the default."""


@dataclass(frozen=True)
class Prepared:
    """A road in each of its states, and what was done in between.

    ``smoothed`` is None unless asked for; ``cutoffs`` are those of `smoothing.smooth_surface`.
    """

    measured: xr.Dataset
    repaired: xr.Dataset
    smoothed: xr.Dataset | None
    repair: clean.Report
    cutoffs: dict[str, smoothing.Choice]

    @property
    def used(self) -> xr.Dataset:
        """The road as the study uses it."""
        return self.repaired if self.smoothed is None else self.smoothed


def prepare(path, **options: str) -> Prepared:
    """The road of an OpenCRG file, read, cleaned and smoothed as the options say.

    Options are those of `crg.read` (but ``interpolation``: `INTERPOLATION` unless
    named, and ``holes``: kept where they are to be filled), those of `clean.clean`,
    and ``smoothing`` (`SMOOTHING`). Raises InputError as these do.
    """
    options = {"interpolation": INTERPOLATION, "smoothing": SMOOTHING[0], **options}
    asked = options.pop("smoothing")
    if asked not in SMOOTHING:
        raise InputError(f"{asked!r}, expected one of {', '.join(SMOOTHING)}", file=path, place="road.smoothing")
    cleaning = {name: value for name, value in options.items() if name in clean.CHOICES}
    reading = {name: value for name, value in options.items() if name not in cleaning}
    reading["holes"] = "keep" if cleaning.get("holes") == "fill" else "refuse"
    measured = crg.read(path, **reading)
    try:
        repaired, report = clean.clean(measured, **cleaning)
    except InputError as problem:
        raise InputError(str(problem), file=path) from None
    smoothed, cutoffs = smoothing.smooth_surface(repaired) if asked == "cross-validation" else (None, {})
    return Prepared(measured, repaired, smoothed, report, cutoffs)
