"""Classes of ride quality by the IRI at the speed driven (tab:IRI_thresholds)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from ..errors import InputError
from ..road.wheeltracks import WHEEL_TRACKS, tracks
from . import iri, runs, sections
from .iriedges import QUALITIES, Edges
from .quartercar import MOVING_AVERAGE

def evaluate(
    shards: Iterable[xr.Dataset],
    road: xr.Dataset,
    *,
    edges: Edges | None = None,
    length: float = sections.LENGTH,
    resolution: float = 50.0,
    wheel_tracks: Sequence[float] = WHEEL_TRACKS,
    moving_average: float | None = MOVING_AVERAGE,
    sliding: bool = False,
) -> xr.Dataset:
    """Classes of ride quality along a road at the mean speed and, as probability, at the speeds of the runs.

    ``shards``: datasets with dims run and s and ``v_x`` in m/s, taken one after
    another. The IRI is the mean of the wheel tracks: as a survey reports it, of
    segments of ``resolution`` metres, linear between (``iri``), and continuous over
    the length of a section (``iri_full``). Both are defined at 80 km/h; only the
    edges follow the speed. A window, sequential or ``sliding``, is of a class where
    the survey lies within it in the whole window.

    Returns the comfort dataset ``iri``: dims quality, window, s, run, track. Beside what
    all methods have: ``iri_track``, the survey of each wheel track, ``hri``, that of their
    mean profile, and ``critical_full``, ``critical_count_full`` by ``iri_full`` instead of
    the survey: what its 50 m hide.
    """
    edges = edges or Edges()
    profile, u = tracks(road, wheel_tracks), road["u"].values
    mean, counts, shares, numbers, along = runs.Mean(), None, [], [], None
    for number, s, (speed,) in runs.checked(shards, ["v_x"]):
        if along is None:
            if s[0] < u[0] or s[-1] > u[-1]:
                raise InputError(f"places from {s[0]:g} to {s[-1]:g} m leave the road, {u[0]:g} to {u[-1]:g} m")
            along = sections.windows(s, length, sliding=sliding)
            settings = {"moving_average": moving_average}
            by_track = iri.survey(profile, u, s, resolution, **settings)
            rough = by_track.mean(axis=0)
            full = iri.sliding(profile, u, s, length, **settings).mean(axis=0)
            limits = edges.speed(rough).astype(speed.dtype)
            counts = np.zeros((len(QUALITIES), len(along)), np.int64)
        mean.add(speed)
        quality = (speed >= limits[:, None, :]).sum(axis=0, dtype=np.int8)
        found = np.array([along.whole(quality == index) for index in range(len(QUALITIES))])
        counts += found.sum(axis=1)
        shares.append(found.sum(axis=2))
        numbers.append(number)
    number = np.concatenate(numbers)
    upper = edges.at(mean.value())
    found, found_full = (
        np.array([along.whole((values >= upper).sum(axis=0) == index) for index in range(len(QUALITIES))])
        for values in (rough, full)
    )
    variables = {
        "v_x": ("s", mean.value()),
        "iri": ("s", rough, {"comment": f"segments of {resolution:g} m, linear between their middles"}),
        "iri_full": ("s", full, {"comment": f"over {length:g} m around each place"}),
        "iri_track": (("track", "s"), by_track),
        "hri": ("s", iri.survey(profile.mean(axis=0), u, s, resolution, **settings)),
        "critical_full": (("quality", "window"), found_full.astype(np.int8)),
        "critical_count_full": ("quality", found_full.sum(axis=1).astype(np.int32)),
        "threshold": (
            ("quality", "s"),
            np.vstack([upper, np.full((1, len(s)), np.inf)]),
            {"units": "m/km", "long_name": "upper edge of the class at the mean speed"},
        ),
    }
    variables |= runs.detections(
        found, counts, len(number), along, ("quality",), np.concatenate(shares, axis=-1)
    )
    return runs.dataset(
        variables,
        {"quality": list(QUALITIES), "s": s, "run": number, "track": np.asarray(wheel_tracks, float)},
        along,
        len(number),
        method="iri",
        moving_average=moving_average or 0.0,
    )
