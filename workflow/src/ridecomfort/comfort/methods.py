"""The three methods on one scale, window by window, and how they agree per site and pooled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..errors import InputError
from . import agreement, bands, sections
from .iriclass import QUALITIES

ISO_GRADES = ("NU", "LU", "FU", "U", "VU/EU")
IRI_GRADES = QUALITIES
THRESHOLD_GRADES = ("none", "PT", "ND", "AG")

COMMON = 5
"""Grades of the common scale: the five of the IRI. ISO 2631 shares it with its two worst bands as
one; thresholding has the four that its styles make, from none passed to AG passed."""

PAIRS = (("iso2631", "iri"), ("thresholds", "iri"), ("a_z", "iri"), ("thresholds", "iso2631"))
"""What is compared: the first against the second. ``thresholds`` is the worst of its axes, ``a_z`` that axis alone."""


@dataclass(frozen=True)
class Site:
    """What the methods say along one site, by method.

    ``grades`` and the mean ``severity`` of windows of ``length`` m; the ``signal`` of severity every ``spacing`` m.
    """

    grades: Mapping[str, np.ndarray]
    severity: Mapping[str, np.ndarray]
    signal: Mapping[str, np.ndarray]
    length: float
    spacing: float


def site(
    thresholds: xr.Dataset, iso2631: xr.Dataset, iri: xr.Dataset, *, rule: str = "middle", every: float = 1.0
) -> Site:
    """One site from its three comfort datasets.

    A window's grade is that of the mean of the signal over it: every window has
    one, also where the signal passes an edge within it; by thresholding it is the
    style whose band, and those of the milder ones, the signal leaves over more than
    half of it. ``rule`` is that of ``bands.label``. Severity is what ranks and lags
    are made of: a_v, the IRI over the edge of its class F, accelerations over their PT band.
    Signals are taken ``every`` metre.
    """
    s = iso2631["s"].values
    for other in (thresholds, iri):
        if not np.array_equal(other["s"].values, s):
            raise InputError("the comfort datasets of a site do not cover the same places s")
    along = sections.windows(s, float(iso2631.attrs["critical_length"]))
    limits = {
        str(name): (float(low), float(high))
        for name, low, high in zip(iso2631["band"].values, iso2631["band_lower"].values, iso2631["band_upper"].values)
    }
    level = along.mean(iso2631["a_v"].values)
    edges = np.array([along.mean(row) for row in iri["threshold"].values[:-1]])
    grades = {
        "iso2631": np.minimum(bands.label(level, rule, limits), COMMON - 1),
        "iri": (along.mean(iri["iri"].values) >= edges).sum(axis=0),
    }
    severity = {"iso2631": iso2631["a_v"].values, "iri": iri["iri"].values / iri["threshold"].sel(quality="F").values}
    for axis in thresholds["axis"].values:
        signal = thresholds[str(axis)].values
        lower, upper = (thresholds[name].sel(axis=axis).values for name in ("lower", "upper"))
        passed = np.array([along.mean((signal < a) | (signal > b)) > 0.5 for a, b in zip(lower, upper)])
        grades[str(axis)] = np.logical_and.accumulate(passed, axis=0).sum(axis=0)
        severity[str(axis)] = np.maximum(signal / upper[0], signal / lower[0])
    axes = [str(axis) for axis in thresholds["axis"].values]
    grades["thresholds"] = np.max([grades[axis] for axis in axes], axis=0)
    severity["thresholds"] = np.max([severity[axis] for axis in axes], axis=0)
    step = max(1, round(every / (s[1] - s[0])))
    return Site(
        grades,
        {name: along.mean(values) for name, values in severity.items()},
        {name: values[::step] for name, values in severity.items()},
        along.length,
        step * float(s[1] - s[0]),
    )


def agree(
    sites: Mapping[str, Site],
    *,
    block: float = agreement.BLOCK,
    repetitions: int = agreement.REPETITIONS,
    seed: int = 0,
) -> xr.Dataset:
    """Agreement of every pair of methods, per site and pooled (the last of dim ``site``).

    Returns ``kappa`` (quadratic weights), ``same`` (share of windows with the same
    grade), ``spearman`` and ``lag`` [m] over pair, site and bound (estimate, lower,
    upper); ``confusion`` (pair, site, first_grade, second_grade); 95 % intervals by
    block bootstrap along the road. ``kappa_difference`` (site, bound): how much closer to the IRI
    ISO 2631 is than thresholding, from the same resamples. Attributes ``verdict`` and ``reason`` answer
    whether ISO 2631 and IRI are substantially similar.
    """
    groups = {name: [each] for name, each in sites.items()} | {"pooled": list(sites.values())}
    names = [" - ".join(pair) for pair in PAIRS]
    settings = {"block": block, "repetitions": repetitions, "seed": seed}

    def same(first, second):
        return float(np.mean(first == second))

    def kappa(first, second):
        if np.ptp(first) == 0 or np.ptp(second) == 0:
            # A method that knows one grade only neither agrees nor disagrees: kappa would be 0 by construction.
            return float("nan")
        return agreement.kappa(agreement.confusion(first, second, (COMMON, COMMON)))

    figures = {name: np.full((len(PAIRS), len(groups), 3), np.nan) for name in ("kappa", "same", "spearman", "lag")}
    tables = np.zeros((len(PAIRS), len(groups), COMMON, COMMON), np.int64)
    similar = {}
    for i, (first, second) in enumerate(PAIRS):
        for j, (name, group) in enumerate(groups.items()):
            grades = [(each.grades[first], each.grades[second]) for each in group]
            # Ranks within each site: pooled, they must not measure how the sites differ.
            ranks = [
                tuple(agreement.ranks(each.severity[method]) / len(each.severity[method]) for method in (first, second))
                for each in group
            ]
            signals = [(each.signal[first], each.signal[second]) for each in group]
            spacing, length = group[0].spacing, group[0].length
            tables[i, j] = sum(agreement.confusion(*pair, (COMMON, COMMON)) for pair in grades)
            found = {
                "kappa": agreement.bootstrap(kappa, grades, length, **settings),
                "same": agreement.bootstrap(same, grades, length, **settings),
                "spearman": agreement.bootstrap(agreement.spearman, ranks, length, **settings),
                "lag": _lag(signals, spacing, settings),
            }
            if (first, second) == ("iso2631", "iri"):
                similar[name] = found["kappa"]
            for key, estimate in found.items():
                figures[key][i, j] = estimate.value, estimate.lower, estimate.upper
    answer = xr.Dataset(
        {key: (("pair", "site", "bound"), values) for key, values in figures.items()},
        coords={"pair": names, "site": list(groups), "bound": ["estimate", "lower", "upper"]},
    )
    answer["confusion"] = (("pair", "site", "first_grade", "second_grade"), tables)
    described = {
        "kappa": ("1", "Cohen's kappa with quadratic weights"),
        "same": ("1", "share of the windows with the same grade"),
        "spearman": ("1", "rank correlation along the road"),
        "lag": ("m", "distance by which the first method follows the second"),
        "confusion": ("1", "number of windows by grade of the first and the second method"),
    }
    for key, (unit, meaning) in described.items():
        answer[key].attrs = {"units": unit, "long_name": meaning}
    closer = [
        agreement.bootstrap(
            lambda iso, thresholding, iri: kappa(iso, iri) - kappa(thresholding, iri),
            [tuple(each.grades[method] for method in ("iso2631", "thresholds", "iri")) for each in group],
            group[0].length,
            **settings,
        )
        for group in groups.values()
    ]
    answer["kappa_difference"] = (("site", "bound"), [(each.value, each.lower, each.upper) for each in closer])
    meaning = "kappa of ISO 2631 and IRI minus that of thresholding and IRI"
    answer["kappa_difference"].attrs = {"units": "1", "long_name": meaning}
    answer.attrs["verdict"], answer.attrs["reason"] = agreement.substantially_similar(similar)
    answer.attrs |= {"block": block, "repetitions": repetitions, "seed": seed}
    return answer


def _lag(signals, spacing: float, settings: Mapping) -> agreement.Estimate:
    """The lag, NaN on a road too short to look for one."""
    try:
        return agreement.lag(signals, spacing, **settings)
    except InputError:
        return agreement.Estimate(float("nan"), float("nan"), float("nan"))
