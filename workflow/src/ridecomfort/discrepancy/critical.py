"""What the error of the model does to the comfort result: critical sections of measured drives and of their replays."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..comfort import bands, iso2631, quantities, sections
from ..comfort import limits as acceptable
from ..comfort.seat import Seat
from ..drive.sampling import rate_of, resampled
from . import explain

METHODS = ("thresholds", "iso2631")
ACCELERATIONS = ("a_x", "a_y", "a_z")

NOT_DRIVEN = -1
"""Grade of a section that a drive does not cover."""


def critical(
    comparison: xr.Dataset,
    *,
    spacing: float,
    length: float = sections.LENGTH,
    limits: Mapping[str, Mapping] | None = None,
    weighting: Mapping | None = None,
) -> xr.Dataset:
    """Grades of the sections of every measured drive, and of the model on the same path at the same speed, at the sensor.

    ``comparison``: as of ``compare.compare``. Places are ``spacing`` (m) apart, sections ``length`` (m); ``limits`` are
    those of ``limits.bands``, ``weighting`` the settings of ISO 2631 (bands, time_constant, averaging, weightings,
    factors, seat).

    Returns ``grade(source, method, drive, window)``: by thresholds the number of driving styles whose band some
    acceleration leaves in the whole section, by ISO 2631 the number of bands behind the first whose lower edge the
    total value reaches in the whole section; 0 is not critical, NOT_DRIVEN where the drive is not compared, or its running rms knows too little of
    what came before. ``source`` is
    "measured" and each state. ``window_start`` in m; ``repeat_group(drive)`` is equal for drives that repeat one another,
    else unique.
    """
    table, settings = acceptable.bands(limits), dict(weighting or {})
    edges = np.array([lower for lower, _ in bands.edges(settings.get("bands")).values()])[1:]
    sources = ["measured", *(str(state) for state in comparison["state"].values)]
    s = comparison["s"].values
    compared = np.isfinite(comparison["residual"].transpose("drive", "state", "signal", "time").values).all(axis=(1, 2))
    first, last = s[compared].min(), s[compared].max()
    places = np.arange(np.ceil(first / length) * length, last, spacing)
    along = sections.windows(places, length)
    count = comparison.sizes["drive"]
    grade = np.full((len(sources), len(METHODS), count, len(along)), NOT_DRIVEN, np.int8)
    for drive in range(count):
        row = comparison.isel(drive=drive, time=compared[drive])
        own = row["s"].values
        covered = np.stack([along.whole((places >= start) & (places <= own[-1])) for start in (own[0], _settled(row, settings))])
        for k, source in enumerate(sources):
            signals = row["measured"] if source == "measured" else row["simulated"].sel(state=source)
            signals = {name: signals.sel(signal=name).values for name in ACCELERATIONS}
            found = _graded(signals, row["time"].values, own, places, along, table, edges, settings)
            grade[k, :, drive] = np.where(covered, found, NOT_DRIVEN)
    groups = np.arange(count)
    for number, group in enumerate(explain.repeats(comparison), start=count):
        groups[group] = number
    return xr.Dataset(
        {
            "grade": (("source", "method", "drive", "window"), grade),
            "window_start": ("window", along.start),
            "role": comparison["role"],
            "repeat_group": ("drive", groups),
        },
        {"source": sources, "method": list(METHODS), "drive": comparison["drive"].values},
        {"critical_length": length},
    )


def _settled(row: xr.Dataset, settings: Mapping) -> float:
    """Place (m) from which on the running rms of a drive is known."""
    time = row["time"].values
    seconds = quantities.SETTLED[settings.get("averaging", "linear")] * settings.get("time_constant", 1.0)
    return float(np.interp(time[0] + seconds, time, row["s"].values))


def _graded(signals, time, own, places, along, table, edges, settings) -> np.ndarray:
    """Grades (method, window) of one drive's accelerations over time, ``own`` its places in m."""
    index = np.interp(places, np.maximum.accumulate(own), np.arange(len(own)))
    rate = rate_of(time)
    over_s = dict(zip(signals, resampled(np.stack(list(signals.values())), 1.0 / rate, index, 0.5 * rate)))
    styles = acceptable.STYLES
    passed = np.zeros((len(styles), len(along)), bool)
    for name in ACCELERATIONS:
        for k, style in enumerate(styles):
            band = table[name][style]
            passed[k] |= along.whole((over_s[name] < band.lower) | (over_s[name] > band.upper))
    options = {key: settings[key] for key in ("time_constant", "weightings", "factors") if key in settings}
    if "averaging" in settings:
        options["method"] = settings["averaging"]
    seat = Seat(**settings["seat"]) if settings.get("seat") else None
    total = iso2631.running_total_value(
        *(signals[name] for name in ACCELERATIONS), rate, before="mirror", seat=seat, **options
    )
    total = np.interp(index, np.arange(len(total)), total)
    reached = np.array([along.whole(total >= edge) for edge in edges])
    return np.stack([np.logical_and.accumulate(each, axis=0).sum(axis=0) for each in (passed, reached)])
