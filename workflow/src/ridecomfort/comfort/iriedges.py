"""Upper edges of the classes of ride quality by IRI and speed; light enough for the configuration to check them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError

QUALITIES = ("VG", "G", "F", "M", "P")
"""Very good, good, fair, mediocre, poor."""

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
    Raises InputError for edges that do not rise from class to class or fall with speed.
    """

    speed_km_h: Sequence[float] = SPEED_KM_H
    upper: Mapping[str, Sequence[float]] = field(default_factory=lambda: EDGES)

    def __post_init__(self) -> None:
        speed = np.asarray(self.speed_km_h, float)
        twice = sorted({value for value in speed.tolist() if np.sum(speed == value) > 1})
        if twice or np.any(speed <= 0):
            found = f"{twice[0]:g} stands twice" if twice else f"{speed.min():g}"
            raise InputError(f"{found}, expected different speeds above 0 km/h", place="iri: speed_km_h")
        if set(self.upper) != set(QUALITIES[:-1]):
            raise InputError(f"edges of {', '.join(self.upper)}, expected of {', '.join(QUALITIES[:-1])}", place="iri: thresholds")
        for quality, edges in self.upper.items():
            if len(edges) != len(speed):
                problem = f"{len(edges)} values, expected one for each of the {len(speed)} speeds"
                raise InputError(problem, place=f"iri: thresholds: {quality}")
        slowness, table = self._table()
        for quality, edges, below in zip(QUALITIES, table, [np.zeros(len(speed)), *table]):
            place = f"iri: thresholds: {quality}"
            if np.any(edges <= below):
                k = int(np.argmax(edges <= below))
                problem = f"{edges[k]:g} m/km at {3.6 / slowness[k]:g} km/h, expected values above those of the class before ({below[k]:g})"
                raise InputError(problem, place=place)
            if np.any(np.diff(edges) <= 0):
                k = int(np.argmax(np.diff(edges) <= 0))
                slow, fast = (f"{edges[i]:g} m/km at {3.6 / slowness[i]:g} km/h" for i in (k + 1, k))
                problem = f"{fast} and {slow}, expected edges that fall with speed (do they stand in the order of speed_km_h?)"
                raise InputError(problem, place=place)

    def _table(self) -> tuple[np.ndarray, np.ndarray]:
        """Slowness in s/m, ascending, and edges (quality, slowness) in m/km."""
        slowness = 3.6 / np.asarray(self.speed_km_h, float)
        order = np.argsort(slowness)
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
