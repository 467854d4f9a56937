"""What the study can say of its own methods: agreement, influences, and how many runs were enough."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from . import agreement, enough, influence, methods


@dataclass(frozen=True)
class SiteResults:
    """The comfort datasets of one site and the samples (dim run) that its runs were driven with."""

    thresholds: xr.Dataset
    iso2631: xr.Dataset
    iri: xr.Dataset
    samples: xr.Dataset

    @property
    def methods(self) -> dict[str, xr.Dataset]:
        """The datasets by method."""
        return {"thresholds": self.thresholds, "iso2631": self.iso2631, "iri": self.iri}


def gather(
    sites: Mapping[str, SiteResults],
    *,
    rule: str = "middle",
    repetitions: int = agreement.REPETITIONS,
    seed: int = 0,
) -> xr.Dataset:
    """Assessment of the comfort methods over all sites, in one dataset.

    ``methods.agree`` of the sites (dim site ends with "pooled"), bands labelled by ``rule``; ``rank_correlation`` and
    ``first_order`` (place, measure, factor, bound) of ``influence.influence`` for each of
    ``influence.measures``; ``width`` (place, scheme, size), ``wilson`` (place, size) and ``open_sections``
    (place) of ``enough.interval_width`` for sections whose mean a_v reaches the lower edge of a band. NaN
    where a site has too few runs or no section whose outcome is open.
    """
    graded = {name: methods.site(**each.methods, rule=rule) for name, each in sites.items()}
    found = methods.agree(graded, repetitions=repetitions, seed=seed)
    found = found.merge(_influences(list(sites.values()))).merge(_widths(list(sites.values()), seed))
    found.attrs["rule"] = rule
    return found.assign_coords(place=list(sites))


def _influences(sites: list[SiteResults]) -> xr.Dataset:
    factors = [str(name) for name in sites[0].samples.data_vars]
    measures = list(influence.measures(**sites[0].methods))
    shape = (len(sites), len(measures), len(factors), 3)
    rank, share = np.full(shape, np.nan), np.full(shape, np.nan)
    for i, site in enumerate(sites):
        if site.samples.sizes["run"] >= influence.LEAST_RUNS:
            for j, measure in enumerate(influence.measures(**site.methods).values()):
                told = influence.influence(measure, site.samples)
                rank[i, j], share[i, j] = told["spearman"].values, told["first_order"].values
    dims = ("place", "measure", "factor", "bound")
    answer = xr.Dataset(coords={"measure": measures, "factor": factors})
    one = {"units": "1"}
    answer["rank_correlation"] = dims, rank, one | {"long_name": "rank correlation of a run's comfort with a factor"}
    answer["first_order"] = dims, share, one | {"long_name": "share of the variance explained by the factor alone"}
    return answer


def _widths(sites: list[SiteResults], seed: int) -> xr.Dataset:
    told = [_interval_width(site, seed) for site in sites]
    sizes = sorted({int(size) for each in told if each is not None for size in each["size"].values})
    answer = xr.Dataset(
        {
            "width": (("place", "scheme", "size"), np.full((len(sites), len(enough.SCHEMES), len(sizes)), np.nan)),
            "wilson": (("place", "size"), np.full((len(sites), len(sizes)), np.nan)),
            "designs": (("place", "size"), np.zeros((len(sites), len(sizes)), np.int32)),
            "open_sections": ("place", np.zeros(len(sites), np.int32)),
        },
        coords={"scheme": list(enough.SCHEMES), "size": np.array(sizes, np.int32)},
    )
    for i, each in enumerate(told):
        if each is not None:
            at = np.searchsorted(sizes, each["size"].values)
            answer["width"][i, :, at] = each["width"].values
            answer["wilson"][i, at] = each["wilson"].values
            answer["designs"][i, at] = each["designs"].values
            answer["open_sections"][i] = each.attrs["windows"]
    meanings = {
        "width": "width of the 95 % interval of a probability, counted over smaller designs",
        "wilson": "width of the Wilson interval of a probability",
        "designs": "number of designs that the scatter is told from",
        "open_sections": "pairs of a section and the edge of a band that some runs reach and some do not",
    }
    for name, meaning in meanings.items():
        answer[name].attrs = {"units": "1", "long_name": meaning}
    return answer


def _interval_width(site: SiteResults, seed: int) -> xr.Dataset | None:
    """``enough.interval_width`` for whether the mean a_v of a section reaches an edge, None where it cannot be told."""
    level = site.iso2631["window_mean"].transpose("run", ...).values
    critical = np.concatenate([level >= edge for edge in site.iso2631["band_lower"].values[1:]], axis=1)
    critical = critical[:, critical.any(axis=0) & ~critical.all(axis=0)]
    if not critical.shape[1] or not enough.slice_sizes(site.samples):
        return None
    return enough.interval_width(critical, site.samples, seed=seed)
