"""The least-squares problem of a calibration: residuals of measured drives as a function of parameters.

Points are in units of the bounds, 0 at the lower and 1 at the upper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .calibrated import with_values
from .drive.leftover import FLOOR, INDEPENDENT, Projection, corrected, leftover
from .drive.paced import Paced, paced
from .drive.replay import ASTRAY, CLOCK_LEFT, CORRECTED, Replay
from .drive.sampling import low_pass, low_pass_matrix
from .errors import InputError
from .vocabulary import SIGNALS

DIFFERENCE = 2e-3
"""Step of the finite differences in units of the bounds' width."""

ROUNDS = 4
"""Times that path and speed are corrected by what the residual asks for, which is linear in them only when near. What an
error of them does to the signals is found once: found again about the corrected path, it changes no parameter by a tenth of
its interval."""

PASSED = 0.7
"""Share of the record's cut-off up to which signals are fitted. Above it the shape of the instrument's filter,
which no data sheet gives to a percent, would pass for a damping of the tyre."""


@dataclass
class Problem:
    """The least-squares problem: drives, parameters (``effect.parameter`` for those of an effect) and bounds.

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
    paced: Sequence[Paced | None] = ()
    """How each drive answers to its speed, where a driver's foot is heard: then what is missing of the speed yet is made good."""
    each: Callable = map
    """A ``map`` that may simulate drives side by side (``pool.side_by_side``)."""
    scales: Sequence[float] | None = None
    """What each of SIGNALS is divided by, in its unit, if not by its measured range."""

    def __post_init__(self):
        self._used = [SIGNALS.index(signal) for signal in self.signals]
        self._ranges = [
            np.ptp(again.measured()[:, again.compared], axis=1) if self.scales is None else np.asarray(self.scales)
            for again in self.replays
        ]
        self._known: dict[bytes, list[tuple[np.ndarray, np.ndarray]] | InputError] = {}
        self._scale = [
            np.where(ranges > 0, ranges, np.inf)[self._used]  # a signal that never changes has no NRMSE
            * np.sqrt(again.compared.sum() * len(self.replays))
            for again, ranges in zip(self.replays, self._ranges)
        ]
        self._left_over = list(self.each(self._left, range(len(self.replays))))

    def _left(self, i: int) -> Projection:
        """What takes the errors of alignment out of the residual of a drive."""
        again = self.replays[i]
        interval, count = again.time[1] - again.time[0], again.compared.sum()
        share = INDEPENDENT / interval * FLOOR**2 / (count * len(self.replays))
        passing = low_pass_matrix(count, interval, PASSED * float(again.drive.attrs["cut_off"]))
        errors = leftover(again, self.vehicle, self.effects, driven=bool(self.uncorrected)).through(passing)
        return errors.scaled(self._used, self._scale[i], share)

    def about(self, point: np.ndarray) -> Problem:
        """The same problem with driver, path and speed, and what alignment may have left, seen from this point."""
        vehicle, effects = self._car(point)
        replays = list(self.each(lambda again: again.tuned(vehicle, effects), self.replays))
        answers = list(self.each(lambda again: paced(again, vehicle, effects), replays))
        nearer = replace(self, replays=replays, vehicle=vehicle, effects=effects, uncorrected=replays, paced=answers)

        def as_asked(i: int) -> tuple[Replay, Projection]:
            again = nearer.replays[i]
            return corrected(again, nearer._left_over[i], nearer._scaled(again.residual(again(vehicle, effects)), i))

        for _ in range(ROUNDS):
            nearer.replays, nearer._left_over = map(list, zip(*self.each(as_asked, range(len(replays)))))
        nearer.replays = list(self.each(lambda again: again.keeping(again.run(vehicle, effects)), nearer.replays))
        return nearer

    def point(self, values) -> np.ndarray:
        """Values in SI units as a point, clipped to the bounds."""
        return np.clip((np.asarray(values, dtype=float) - self.lower) / (self.upper - self.lower), 0.0, 1.0)

    def values(self, point: np.ndarray) -> np.ndarray:
        """A point as values in SI units."""
        return self.lower + np.asarray(point) * (self.upper - self.lower)

    def residuals(self, point: np.ndarray) -> list[np.ndarray]:
        """Per drive (signal, sample), scaled so that the sum of squares is the mean over drives of sum NRMSE^2."""
        return [left for _, left in self._evaluated(point)]

    def _evaluated(self, point: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Per drive the residual and what the projection leaves of it. Raises InputError where a vehicle cannot be driven."""
        self._evaluate([point])
        found = self._known[_key(point)]
        if isinstance(found, InputError):
            raise found
        return found

    def _evaluate(self, points: Iterable[np.ndarray]) -> None:
        """Simulate all drives at points, side by side; the last ones are remembered."""
        new = {_key(point): point for point in points if _key(point) not in self._known}
        jobs = [(i, point) for point in new.values() for i in range(len(self.replays))]
        pieces = self.each(lambda job: self._piece(*job), jobs)
        for key in new:
            if len(self._known) > 4 * len(self.parameters):
                del self._known[next(iter(self._known))]
            self.evaluations += 1
            found = [next(pieces) for _ in self.replays]
            self._known[key] = next((piece for piece in found if isinstance(piece, InputError)), found)

    def _piece(self, i: int, point: np.ndarray) -> tuple[np.ndarray, np.ndarray] | InputError:
        """Residual of one drive and what the projection leaves of it, or why it cannot be driven."""
        try:
            whole = self._residual(self.replays[i], i, *self._car(point))
        except InputError as problem:
            return problem
        return whole, self._left_over[i](whole)

    def residuals_as_aligned(self, point: np.ndarray) -> list[np.ndarray]:
        """The same as ``residuals``, with all that alignment left in them."""
        vehicle, effects = self._car(point)
        return [self._residual(again, i, vehicle, effects) for i, again in enumerate(self.uncorrected or self.replays)]

    def influence(self, point: np.ndarray, jacobian: np.ndarray) -> list[np.ndarray]:
        """Per drive (signal, sample, parameter): by how much each sample as aligned moves the gradient of the cost.

        The least squares are those of a residual that errors have been taken out of, so what a sample adds to the gradient
        is its Jacobian (``jacobian``, of all drives) with the errors taken out once more.
        """
        columns, first = [], 0
        for residual, projection, (clock, _) in zip(self.residuals(point), self._left_over, self.left_over(point)):
            part = jacobian[first : first + residual.size].reshape(*residual.shape, -1)
            first += residual.size
            columns.append(projection.change(part, clock=abs(clock) < CLOCK_LEFT))
        return columns

    def _car(self, point: np.ndarray):
        return with_values(self.vehicle, self.effects, dict(zip(self.parameters, self.values(point))))

    def _residual(self, again: Replay, i: int, vehicle, effects) -> np.ndarray:
        """With a driver who makes up for what moves a vehicle aside, as the measured one did: wheels that steer as they rise else lead it over
        another road, and come out at half of their size."""
        answer = self.paced[i] if self.paced else None
        found = again.following(vehicle, effects, ASTRAY if answer else again.strictly(ASTRAY), CORRECTED)
        residual = found.residual()
        if answer and "speed" in found.astray:
            residual[:, again.compared] += answer.made_good(found.astray["speed"])
        return self._scaled(residual, i)

    def _scaled(self, residual: np.ndarray, i: int) -> np.ndarray:
        """A residual (6, time) of a drive as it counts, (signal, sample)."""
        again = self.replays[i]
        rows = residual[np.ix_(self._used, again.compared)]
        return self._filtered(again, rows.T).T / self._scale[i][:, None]

    @staticmethod
    def _filtered(again: Replay, rows: np.ndarray) -> np.ndarray:
        """Samples (time, channel) without what the instrument's own filter has begun to take away."""
        return low_pass(rows, again.time[1] - again.time[0], PASSED * float(again.drive.attrs["cut_off"]))

    def left_over(self, point: np.ndarray) -> np.ndarray:
        """Clock offset (s) of each drive at a point, and mean distance (m) of its path to the left of the aligned one, (drive, 2)."""
        rows = []
        for (residual, _), projection in zip(self._evaluated(point), self._left_over):
            errors = projection.errors(residual)
            aside = errors + projection.driven  # what is driven counts from the aligned path, too
            path = aside[projection.parts["lateral"]] if "lateral" in projection.parts else np.zeros(1)
            rows.append((errors[0], path.mean()))
        return np.array(rows)

    def flat(self, point: np.ndarray) -> np.ndarray:
        """All residuals in one vector."""
        return np.concatenate([residual.ravel() for residual in self.residuals(point)])

    def jacobian(self, point: np.ndarray, free: Sequence[int]) -> np.ndarray:
        """Differences of ``flat`` by the free parameters, (residual, free), inwards at the upper bound and where nothing can be driven
        beyond."""
        base = self.flat(point)

        def moved(index: int, step: float) -> np.ndarray:
            there = np.array(point, dtype=float)
            there[index] += step
            return there

        steps = {index: DIFFERENCE if point[index] + DIFFERENCE <= 1.0 else -DIFFERENCE for index in free}
        self._evaluate([moved(index, step) for index, step in steps.items()])
        columns = []
        for index, step in steps.items():
            try:
                columns.append((self.flat(moved(index, step)) - base) / step)
            except InputError:
                columns.append((self.flat(moved(index, -step)) - base) / -step)
        return np.stack(columns, axis=1) if columns else np.zeros((base.size, 0))

    def nrmse(self, point: np.ndarray) -> np.ndarray:
        """RMSE over the measured range, (drive, signal)."""
        count = len(self.replays)
        return np.stack([np.sqrt(count * np.sum(residual**2, axis=1)) for residual in self.residuals(point)])


def _key(point: np.ndarray) -> bytes:
    return np.asarray(point, dtype=float).tobytes()
