"""The least-squares problem of a calibration: residuals of measured drives as a function of parameters.

Points are in units of the bounds, 0 at the lower and 1 at the upper.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from .calibrated import with_values
from .drive.replay import CLOCK_LEFT, PATH_LEFT, Replay
from .vocabulary import SIGNALS

DIFFERENCE = 2e-3
"""Step of the finite differences in units of the bounds' width."""

@dataclass
class Problem:
    """The least-squares problem: drives, parameters (``effect.parameter`` for those of an effect), bounds, start.

    Points are in units of the bounds (0 to 1). Every simulated point is counted in ``evaluations``.
    """

    replays: Sequence[Replay]
    vehicle: object
    parameters: tuple[str, ...]
    lower: np.ndarray
    upper: np.ndarray
    effects: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    signals: Sequence[str] = SIGNALS
    evaluations: int = 0

    def __post_init__(self):
        self._used = [SIGNALS.index(signal) for signal in self.signals]
        self._ranges = [np.ptp(again.measured()[:, again.compared], axis=1) for again in self.replays]
        self._aside = [again.aside(self.vehicle, self.effects) for again in self.replays]
        self._known: dict[bytes, list[np.ndarray]] = {}

    def point(self, values) -> np.ndarray:
        """Values in SI units as a point, clipped to the bounds."""
        return np.clip((np.asarray(values, dtype=float) - self.lower) / (self.upper - self.lower), 0.0, 1.0)

    def values(self, point: np.ndarray) -> np.ndarray:
        """A point as values in SI units."""
        return self.lower + np.asarray(point) * (self.upper - self.lower)

    def residuals(self, point: np.ndarray) -> list[np.ndarray]:
        """Per drive (signal, sample), scaled so that the sum of squares is the mean over drives of sum NRMSE^2."""
        key = np.asarray(point, dtype=float).tobytes()
        if key not in self._known:
            if len(self._known) > 4 * len(self.parameters):
                self._known.clear()
            self.evaluations += 1
            vehicle, effects = with_values(self.vehicle, self.effects, dict(zip(self.parameters, self.values(point))))
            self._known[key] = [self._residual(i, vehicle, effects)[0] for i in range(len(self.replays))]
        return self._known[key]

    def _residual(self, i: int, vehicle, effects) -> tuple[np.ndarray, np.ndarray]:
        """Scaled residual of a drive at the best clock and path that alignment may have left, and both (s, m)."""
        again = self.replays[i]
        simulated = again(vehicle, effects)
        kept = again.compared
        rows = np.ix_(self._used, kept)
        span = np.where(self._ranges[i] > 0, self._ranges[i], np.inf)  # a signal that never changes has no NRMSE
        scale = (span[self._used] * np.sqrt(kept.sum() * len(self.replays)))[:, None]
        residual = again.residual(simulated)[rows] / scale
        nuisance = np.stack([simulated.slopes[rows] / scale, -self._aside[i][rows] / scale]).reshape(2, -1)
        left = np.linalg.lstsq(nuisance @ nuisance.T, nuisance @ residual.ravel(), rcond=1e-12)[0]
        left = np.clip(left, (-CLOCK_LEFT, -PATH_LEFT), (CLOCK_LEFT, PATH_LEFT))
        return residual - (left @ nuisance).reshape(residual.shape), left

    def left_over(self, point: np.ndarray) -> np.ndarray:
        """Clock offset (s) and distance from the path (m, to the left) left of each drive at a point, (drive, 2)."""
        vehicle, effects = with_values(self.vehicle, self.effects, dict(zip(self.parameters, self.values(point))))
        return np.stack([self._residual(i, vehicle, effects)[1] for i in range(len(self.replays))])

    def flat(self, point: np.ndarray) -> np.ndarray:
        """All residuals in one vector."""
        return np.concatenate([residual.ravel() for residual in self.residuals(point)])

    def jacobian(self, point: np.ndarray, free: Sequence[int]) -> np.ndarray:
        """Differences of ``flat`` by the free parameters, (residual, free), inwards at the upper bound."""
        base = self.flat(point)
        columns = []
        for index in free:
            step = DIFFERENCE if point[index] + DIFFERENCE <= 1.0 else -DIFFERENCE
            moved = np.array(point, dtype=float)
            moved[index] += step
            columns.append((self.flat(moved) - base) / step)
        return np.stack(columns, axis=1)

    def nrmse(self, point: np.ndarray) -> np.ndarray:
        """RMSE over the measured range, (drive, signal)."""
        count = len(self.replays)
        return np.stack([np.sqrt(count * np.sum(residual**2, axis=1)) for residual in self.residuals(point)])
