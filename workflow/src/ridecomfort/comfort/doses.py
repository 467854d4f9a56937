"""What a run amounts to over a stretch of road: the quantities of ISO 2631-1, dose of motion sickness included."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numba import njit

from ..vocabulary import describe
from . import quantities, signals, weighting

AXES = ("a_x", "a_y", "a_z")

NAMES = ("weighted_rms", "mtvv", "crest_factor", "vdv", "msdv_z", "duration")
"""What ``Doses.dataset`` holds."""


class Doses:
    """Doses of runs (run, time) from the samples at which they are within a stretch of road.

    ``distance`` (run, time) in m, NaN behind the end of a run; the stretch is from
    ``start`` to ``end`` m. ``rate`` in Hz; ``time_constant`` in s and ``method`` of the running rms, as in
    ``quantities.running_rms``.
    """

    def __init__(
        self, distance, rate: float, start: float, end: float, time_constant: float = 1.0, method: str = "linear"
    ) -> None:
        inside = (np.asarray(distance) >= start) & (np.asarray(distance) <= end)
        self.rate = signals.check_rate(rate)
        self._first = np.argmax(inside, axis=1)
        self._behind = inside.shape[1] - np.argmax(inside[:, ::-1], axis=1)
        self._behind[~inside.any(axis=1)] = 0
        self._averaging = time_constant, method
        self._second, self._fourth, self._peak, self._mtvv = np.zeros((4, len(AXES), len(inside)))
        self._sickness = np.zeros(len(inside))

    def weighted(self, axis: int, rows: np.ndarray, acceleration: np.ndarray) -> None:
        """Take in the weighted acceleration (row, time) in m/s2 of some runs along one of AXES."""
        first, behind = self._first[rows], self._behind[rows]
        running = np.square(acceleration, dtype=float)
        quantities.running_root(running, behind, self.rate, *self._averaging)
        found = _sums(acceleration, first, behind)
        self._second[axis, rows], self._fourth[axis, rows], self._peak[axis, rows] = found
        self._mtvv[axis, rows] = _sums(running, first, behind)[2]

    def vertical(self, a_z, *, before: str = "rest") -> None:
        """Take in the vertical acceleration (run, time) in m/s2 of all runs, which is weighted by Wf here."""
        values, _ = signals.time_last(a_z, self.rate, "m/s2")
        table, lengths = signals.rows(values)
        for rows, sick in weighting.spectral(table, lengths, self.rate, weighting.named("Wf"), before):
            self._sickness[rows] = _sums(sick, self._first[rows], self._behind[rows])[0]

    def dataset(self, run) -> xr.Dataset:
        """``weighted_rms``, ``mtvv``, ``crest_factor``, ``vdv`` (run, axis), ``msdv_z``, ``duration`` (run).

        Without k factors. The crest factor is NaN where the rms is ``quantities.UNFELT``. Source: ISO 2631-1:1997 eq. 1, 4, 5, 6.2.1 and 9.2.1.
        """
        duration = (self._behind - self._first) / self.rate
        with np.errstate(divide="ignore", invalid="ignore"):
            rms = np.sqrt(self._second / self.rate / duration)
        crest = self._peak / np.where(rms >= quantities.UNFELT, rms, np.nan)
        variables = {
            "weighted_rms": (("run", "axis"), rms.T),
            "mtvv": (("run", "axis"), self._mtvv.T.copy()),
            "crest_factor": (("run", "axis"), crest.T),
            "vdv": (("run", "axis"), (self._fourth.T / self.rate) ** 0.25),
            "msdv_z": ("run", np.sqrt(self._sickness / self.rate)),
            "duration": ("run", duration),
        }
        return describe(xr.Dataset(variables, {"run": run, "axis": list(AXES)}))


@njit(cache=True)
def _sums(table, first, behind):
    """Sums of the second and of the fourth powers and the largest size of rows between two samples of each."""
    second, fourth, peak = np.zeros(len(table)), np.zeros(len(table)), np.zeros(len(table))
    for row in range(len(table)):
        for sample in range(first[row], behind[row]):
            square = float(table[row, sample]) ** 2
            second[row] += square
            fourth[row] += square * square
            peak[row] = max(peak[row], square)
    return second, fourth, np.sqrt(peak)
