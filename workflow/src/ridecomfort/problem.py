"""The least-squares problem of a calibration: residuals of measured drives as a function of parameters.

Points are in units of the bounds, 0 at the lower and 1 at the upper.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .calibrated import with_values
from .drive.leftover import FLOOR, INDEPENDENT, corrected, leftover
from .drive.replay import Replay
from .drive.sampling import low_pass, low_pass_matrix
from .vocabulary import SIGNALS

DIFFERENCE = 2e-3
"""Step of the finite differences in units of the bounds' width."""

ROUNDS = 4
"""Times that path and speed are corrected by what the residual asks for, which is linear in them only when near."""

PASSED = 0.7
"""Share of the record's cut-off up to which signals are fitted. Above it the shape of the instrument's filter,
which no data sheet gives to a percent, would pass for a damping of the tyre."""


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
    uncorrected: Sequence[Replay] = ()
    """The drives as alignment left them, where ``replays`` have been corrected further. Path and speed are asked for
    again only then: what they change is seen from a vehicle that fits roughly."""

    def __post_init__(self):
        self._used = [SIGNALS.index(signal) for signal in self.signals]
        self._ranges = [np.ptp(again.measured()[:, again.compared], axis=1) for again in self.replays]
        self._known: dict[bytes, list[np.ndarray]] = {}
        self._scale, self._left_over = [], []
        for again, ranges in zip(self.replays, self._ranges):
            span = np.where(ranges > 0, ranges, np.inf)[self._used]  # a signal that never changes has no NRMSE
            self._scale.append(span * np.sqrt(again.compared.sum() * len(self.replays)))
            share = INDEPENDENT / (again.time[1] - again.time[0]) * FLOOR**2 / (again.compared.sum() * len(self.replays))
            interval = again.time[1] - again.time[0]
            passing = low_pass_matrix(again.compared.sum(), interval, PASSED * float(again.drive.attrs["cut_off"]))
            errors = leftover(again, self.vehicle, self.effects, driven=bool(self.uncorrected)).through(passing)
            self._left_over.append(errors.scaled(self._used, self._scale[-1], share))

    def about(self, point: np.ndarray) -> Problem:
        """The same problem with driver, path and speed, and what alignment may have left, seen from this point."""
        vehicle, effects = self._car(point)
        replays = [again.tuned(vehicle, effects) for again in self.replays]
        nearer = replace(self, replays=replays, vehicle=vehicle, effects=effects, uncorrected=replays)
        for _ in range(ROUNDS):
            nearer.replays = [
                corrected(again, projection, nearer._residual(again, i, vehicle, effects))
                for i, (again, projection) in enumerate(zip(nearer.replays, nearer._left_over))
            ]
        return replace(nearer)

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
            vehicle, effects = self._car(point)
            self._known[key] = [
                projection(self._residual(again, i, vehicle, effects))
                for i, (again, projection) in enumerate(zip(self.replays, self._left_over))
            ]
        return self._known[key]

    def residuals_as_aligned(self, point: np.ndarray) -> list[np.ndarray]:
        """The same as ``residuals``, with all that alignment left in them."""
        vehicle, effects = self._car(point)
        return [self._residual(again, i, vehicle, effects) for i, again in enumerate(self.uncorrected or self.replays)]

    def _car(self, point: np.ndarray):
        return with_values(self.vehicle, self.effects, dict(zip(self.parameters, self.values(point))))

    def _residual(self, again: Replay, i: int, vehicle, effects) -> np.ndarray:
        residual = again.residual(again(vehicle, effects))[np.ix_(self._used, again.compared)]
        return self._filtered(again, residual.T).T / self._scale[i][:, None]

    @staticmethod
    def _filtered(again: Replay, rows: np.ndarray) -> np.ndarray:
        """Samples (time, channel) without what the instrument's own filter has begun to take away."""
        return low_pass(rows, again.time[1] - again.time[0], PASSED * float(again.drive.attrs["cut_off"]))

    def left_over(self, point: np.ndarray) -> np.ndarray:
        """Clock offset (s) and mean distance from the path (m, to the left) left of each drive at a point, (drive, 2)."""
        vehicle, effects = self._car(point)
        rows = []
        for i, (again, projection) in enumerate(zip(self.replays, self._left_over)):
            errors = projection.errors(self._residual(again, i, vehicle, effects))
            path = errors[projection.parts["lateral"]] if "lateral" in projection.parts else np.zeros(1)
            rows.append((errors[0], path.mean()))
        return np.array(rows)

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
