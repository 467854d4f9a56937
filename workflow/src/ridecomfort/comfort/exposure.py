"""Health and motion sickness: doses over a stated time of exposure.

A site is driven in two minutes; health and sickness are matters of hours. Every
function here therefore takes the exposure as an argument: ``repeated`` says what
a site would mean if a trip of a given length were made of nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..errors import InputError
from . import total

WORKING_DAY = 8 * 3600.0
"""s; what daily exposure is referred to (A(8))."""

VOMITING = 1 / 3
"""Percent per m/s1.5; K_m of a mixed population of unadapted adults (ISO 2631-1:1997 D.3)."""

ILLNESS = 1 / 50
"""Per m/s1.5; of the mean illness rating from 0, well, to 3, dreadful (Lawther and Griffin 1987; BS 6841:1987)."""


@dataclass(frozen=True)
class Zone:
    """A health guidance caution zone: below ``lower`` effects are not documented, above ``upper`` likely."""

    lower: float
    upper: float

    def place(self, value: float) -> str:
        """"below", "caution" or "likely risk"."""
        return "below" if value < self.lower else "caution" if value <= self.upper else "likely risk"


def rms_zone(exposure: float) -> Zone:
    """Zone of the weighted rms in m/s2 (with k = 1.4 on x and y) for a daily exposure in s.

    Equal energy a_w T^1/2 between 10 minutes (3 to 6 m/s2) and 24 hours; shorter
    exposures have the values of 10 minutes (ISO 2631-1:1997 B.3.1, figure B.1, eq. B.1).
    """
    share = np.sqrt(600.0 / np.clip(_positive(exposure, "exposure"), 600.0, 86400.0))
    return Zone(float(3.0 * share), float(6.0 * share))


DOSE_ZONE = Zone(8.5, 17.0)
"""Zone of the (estimated) vibration dose value in m/s1.75 (ISO 2631-1:1997 B.3.1, note to eq. B.2)."""


def a8(rms, exposure: float):
    """Daily exposure A(8) in m/s2 of a weighted rms (with its k factor) that lasts ``exposure`` s a day."""
    return np.asarray(rms) * np.sqrt(_positive(exposure, "exposure") / WORKING_DAY)


def a8_of_periods(periods: Mapping[float, float] | list[tuple[float, float]]) -> float:
    """A(8) in m/s2 of several periods (rms in m/s2, exposure in s) of one day (ISO 2631-1:1997 B.3.2)."""
    pairs = periods.items() if isinstance(periods, Mapping) else periods
    return float(np.sqrt(sum(rms**2 * _positive(exposure, "exposure") for rms, exposure in pairs) / WORKING_DAY))


@dataclass(frozen=True)
class Dose:
    """Doses over a trip: VDV in m/s1.75, MSDV in m/s1.5, and the trip they are stated for in s."""

    vdv: float
    msdv: float
    exposure: float


def repeated(vdv: float, msdv: float, duration: float, exposure: float) -> Dose:
    """Doses of a trip of ``exposure`` s that repeats a stretch of ``duration`` s with these doses.

    VDV grows with the fourth root of time and MSDV with its square root.
    """
    times = _positive(exposure, "exposure") / _positive(duration, "duration")
    return Dose(float(vdv * times**0.25), float(msdv * times**0.5), float(exposure))


def of_runs(runs: xr.Dataset, exposure: float) -> xr.Dataset:
    """Health and sickness of a trip of ``exposure`` s that repeats a stretch, for each run over it (dim run).

    ``runs``: ``doses.Doses.dataset``. Returns over run ``rms`` in m/s2, its ``a8`` and ``vdv`` in m/s1.75, each of the axis in
    which it is largest (with the k factors of health, 1.4 on x and y), ``msdv_z`` in m/s1.5, ``vomiting_share`` in percent and
    ``illness_rating`` of 3; and ``worst_axis``, that of the rms in most runs.
    """
    factors = [total.HEALTH["seat", str(axis)[-1]][1] for axis in runs["axis"].values]
    times = _positive(exposure, "exposure") / runs["duration"]
    weighted = (runs["weighted_rms"] * factors).transpose("run", "axis")
    rms, dose = weighted.max("axis"), times**0.5 * runs["msdv_z"]
    worst = np.bincount(weighted.values.argmax(axis=1), minlength=len(factors)).argmax()
    return xr.Dataset(
        {
            "rms": rms,
            "a8": rms.copy(data=a8(rms.values, exposure)),
            "vdv": (runs["vdv"] * factors).max("axis") * times**0.25,
            "msdv_z": dose,
            "vomiting_share": dose.copy(data=vomiting_share(dose.values)),
            "illness_rating": dose.copy(data=illness_rating(dose.values)),
            "worst_axis": runs["axis"].values[worst],
        },
        attrs={"exposure": float(exposure)},
    )


def vomiting_share(msdv_z, susceptibility: float = VOMITING):
    """Percent of the people who may vomit after a dose MSDV_z in m/s1.5 (ISO 2631-1:1997 D.3).

    Meant for 20 minutes to 6 hours of vertical motion from 0.1 to 0.5 Hz and for up to 70 %.
    """
    return np.minimum(susceptibility * np.asarray(msdv_z), 100.0)


def illness_rating(msdv_z, factor: float = ILLNESS):
    """Mean illness rating after a dose MSDV_z in m/s1.5: 0 all right, 1 slightly unwell, 2 quite ill, 3 dreadful."""
    return np.minimum(factor * np.asarray(msdv_z), 3.0)


def _positive(value: float, place: str) -> float:
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{value!r} is not a time; expected more than 0 s", place=place)
    return float(value)
