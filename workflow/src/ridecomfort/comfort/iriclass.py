"""Classes of ride quality by the IRI at the speed driven (tab:IRI_thresholds)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from ..errors import InputError
from . import iri, runs, sections
from .quartercar import MOVING_AVERAGE

QUALITIES = ("VG", "G", "F", "M", "P")
"""Very good, good, fair, mediocre, poor."""

WHEEL_TRACKS = (-0.75, 0.75)
"""m from the reference line; 1.5 m apart as the wheels of a passenger car."""

SPEED_KM_H = (120, 100, 80, 70, 60, 50, 40, 30, 20, 10)

EDGES = {
    "VG": (0.95, 1.14, 1.43, 1.63, 1.90, 2.28, 2.86, 3.80, 5.72, 11.44),
    "G": (1.49, 1.79, 2.24, 2.57, 2.99, 3.59, 4.49, 5.99, 8.99, 17.99),
    "F": (1.89, 2.27, 2.84, 3.25, 3.79, 4.54, 5.69, 7.59, 11.39, 22.79),
    "M": (2.70, 3.24, 4.05, 4.63, 5.40, 6.25, 8.08, 10.80, 16.16, 32.32),
}
"""m/km, upper edges at the speeds of SPEED_KM_H (Yu, Chou and Yau 2006, as in tab:IRI_thresholds)."""


@dataclass(frozen=True)
class Edges:
    """Upper edges of the classes but the worst, as functions of speed.

    The edges are nearly proportional to 1/v and are interpolated linearly in 1/v;
    beyond the slowest and fastest speed of the table they are proportional to it.
    """

    speed_km_h: Sequence[float] = SPEED_KM_H
    upper: Mapping[str, Sequence[float]] = field(default_factory=lambda: EDGES)

    def __post_init__(self) -> None:
        speed = np.asarray(self.speed_km_h, float)
        if len(set(speed.tolist())) != len(speed) or np.any(speed <= 0):
            raise InputError("expected different speeds above 0 km/h", place="iri.speed_km_h")
        if tuple(self.upper) != QUALITIES[:-1]:
            raise InputError(f"expected edges of {', '.join(QUALITIES[:-1])}", place="iri.thresholds")
        table = self._table()[1]
        if table.shape != (4, len(speed)):
            raise InputError(f"expected {len(speed)} edges for every class", place="iri.thresholds")
        if np.any(np.diff(table, axis=0) <= 0) or np.any(np.diff(table, axis=1) <= 0):
            raise InputError("edges must rise from class to class and fall with speed", place="iri.thresholds")

    def _table(self) -> tuple[np.ndarray, np.ndarray]:
        """Slowness in s/m, ascending, and edges (quality, slowness) in m/km."""
        slowness = 3.6 / np.asarray(self.speed_km_h, float)
        order = np.argsort(slowness)
        lengths = {len(self.upper[name]) for name in self.upper}
        if lengths != {len(slowness)}:
            raise InputError(f"expected {len(slowness)} edges for every class", place="iri.thresholds")
        return slowness[order], np.array([self.upper[name] for name in QUALITIES[:-1]], float)[:, order]

    def at(self, speed) -> np.ndarray:
        """Edges (4, ...) in m/km at speeds in m/s; infinite at standstill."""
        slowness, table = self._table()
        with np.errstate(divide="ignore"):
            now = 1.0 / np.maximum(np.asarray(speed, float), 0.0)
        return np.array([_proportional(now, slowness, row) for row in table])

    def speed(self, rough) -> np.ndarray:
        """Speeds (4, ...) in m/s from which on an IRI in m/km no longer belongs to each class or a better one."""
        slowness, table = self._table()
        rough = np.asarray(rough, float)
        with np.errstate(divide="ignore"):
            return np.array([1.0 / _proportional(rough, row, slowness) for row in table])

    def quality(self, rough, speed) -> np.ndarray:
        """Index into QUALITIES of each IRI in m/km at each speed in m/s."""
        return (np.asarray(rough) >= self.at(speed)).sum(axis=0)


def _proportional(x: np.ndarray, xs: np.ndarray, ys: np.ndarray) -> np.ndarray:
    inside = np.interp(x, xs, ys)
    return np.where(x < xs[0], x * (ys[0] / xs[0]), np.where(x > xs[-1], x * (ys[-1] / xs[-1]), inside))


def tracks(road: xr.Dataset, offsets: Sequence[float] = WHEEL_TRACKS) -> np.ndarray:
    """Profiles (track, u) in m of a road at lateral positions in m to the left of its reference line.

    Raises InputError where a track leaves the road or runs over a hole.
    """
    v, heights = road["v"].values, road["elevation"].transpose("u", "v").values
    answer = []
    for offset in offsets:
        if not v[0] <= offset <= v[-1]:
            raise InputError(f"wheel track at {offset:g} m lies outside the road, {v[0]:g} to {v[-1]:g} m")
        left = min(max(int(np.searchsorted(v, offset, side="right")) - 1, 0), len(v) - 2)
        share = (offset - v[left]) / (v[left + 1] - v[left])
        profile = heights[:, left] if share == 0 else (1 - share) * heights[:, left] + share * heights[:, left + 1]
        if not np.isfinite(profile).all():
            where = float(road["u"][int(np.argmin(np.isfinite(profile)))])
            raise InputError(f"wheel track at {offset:g} m leaves the road at u = {where:g} m")
        answer.append(profile)
    return np.array(answer)


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
