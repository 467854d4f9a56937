"""A mass on a spring and a damper as an Experiment: the search for a missing effect is not tied to cars.

    y'' = gain u - damping y' - stiffness y - (what may be missing)

with everything per unit of mass. The input is sampled fast enough to be interpolated
by its Fourier series.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import tanh
from typing import ClassVar

import numpy as np
from numba import njit
from scipy.signal import resample

from ..errors import InputError
from .experiment import Candidate, Record, Size

SUBSTEPS = 4
"""Steps of the Runge-Kutta scheme in a sampling interval."""

BLOCK = 0.25
"""s of the blocks of the bootstrap, many periods of the resonances that this is meant for."""

FRICTION_SPEED = 0.02
"""Share of the rms speed within which Coulomb friction turns."""


@njit(cache=True)
def _respond(force, step, gain, damping, stiffness, extra, turn, response):
    """Fill ``response`` with the positions at every ``2 SUBSTEPS``-th value of ``force`` (RK4, at rest before)."""
    y, v = 0.0, 0.0
    slope = np.zeros((4, 2))
    response[0] = 0.0
    for k in range(1, len(response)):
        for j in range(SUBSTEPS):
            base = 2 * ((k - 1) * SUBSTEPS + j)
            for stage in range(4):
                part = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                at_y = y + part * step * slope[stage - 1, 0] if stage else y
                at_v = v + part * step * slope[stage - 1, 1] if stage else v
                u = force[base + (0 if stage == 0 else 2 if stage == 3 else 1)]
                missing = extra[0] * at_y**3 + extra[1] * at_y * abs(at_y) + extra[2] * at_y**2
                missing += extra[3] * tanh(at_v / turn) + extra[4] * at_v * abs(at_v)
                missing -= extra[5] * min(max(at_y, -extra[6]), extra[6])
                slope[stage, 0] = at_v
                slope[stage, 1] = gain * u - damping * at_v - stiffness * at_y - missing
            y += step * (slope[0, 0] + 2 * slope[1, 0] + 2 * slope[2, 0] + slope[3, 0]) / 6
            v += step * (slope[0, 1] + 2 * slope[1, 1] + 2 * slope[2, 1] + slope[3, 1]) / 6
        response[k] = y


EXTRA = (
    "cubic_spring.stiffness",
    "signed_quadratic_spring.stiffness",
    "quadratic_spring.stiffness",
    "coulomb_friction.force",
    "quadratic_damping.damping",
    "backlash.stiffness",
    "backlash.gap",
)


@dataclass
class OneMass:
    """Measured inputs and outputs of a mass on a spring; ``records`` start at rest."""

    inputs: Sequence[np.ndarray]
    outputs: Sequence[np.ndarray]
    rate: float
    roles: Sequence[str]
    names: Sequence[str]
    band: tuple[float, float]
    channels: Sequence[str] = ("y",)
    records: Sequence[Record] = field(init=False)
    free: Sequence[Size] = field(init=False)
    candidates: Sequence[Candidate] = field(init=False)

    def __post_init__(self):
        # Records repeat one another where their inputs are the same.
        first = lambda own: next(name for name, other in zip(self.names, self.inputs) if np.array_equal(other, own))
        self.records = [
            Record(name, role, name, first(own), self.rate, self.band, np.arange(len(output)) / self.rate, BLOCK)
            for name, role, own, output in zip(self.names, self.roles, self.inputs, self.outputs)
        ]
        self._forces = [_fine(values) for values in self.inputs]
        start = self._linear()
        self.free = tuple(
            Size(key, unit, value, 0.3 * value, 3.0 * value, 0.01 * value)
            for (key, unit), value in zip((("gain", "1/s2"), ("damping", "1/s"), ("stiffness", "1/s2")), start)
        )
        y = float(np.std(self.outputs[0]))
        v = y * np.sqrt(start[2])
        self._turn = FRICTION_SPEED * v
        k, d = start[2], start[1]
        # A probe takes or gives a tenth of the spring's or damper's force at the rms of the motion.
        self.candidates = (
            Candidate("cubic_spring", (Size(EXTRA[0], "1/(V2 s2)", 0.0, -k / y**2, k / y**2, 0.1 * k / y**2),)),
            Candidate("signed_quadratic_spring", (Size(EXTRA[1], "1/(V s2)", 0.0, -k / y, k / y, 0.1 * k / y),)),
            Candidate("quadratic_spring", (Size(EXTRA[2], "1/(V s2)", 0.0, -k / y, k / y, 0.1 * k / y),)),
            Candidate("coulomb_friction", (Size(EXTRA[3], "V/s2", 0.0, 0.0, d * v, 0.1 * d * v),)),
            Candidate("quadratic_damping", (Size(EXTRA[4], "1/V", 0.0, 0.0, d / v, 0.1 * d / v),)),
            Candidate(
                "backlash",
                (Size(EXTRA[5], "1/s2", 0.0, 0.0, k, 0.1 * k),),
                shapes=tuple({EXTRA[6]: share * y} for share in (0.1, 0.4, 1.2)),
            ),
            Candidate("delay", (Size("delay.time", "s", 0.0, 0.0, 2 / self.rate, 0.05 / self.rate),)),
        )

    def simulated(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """Response (sample,) of a record. Raises InputError when it does not stay finite."""
        force = self._forces[index]
        fine_step = 1.0 / (self.rate * 2 * SUBSTEPS)
        delay = values.get("delay.time", 0.0) / fine_step
        if delay:
            force = np.interp(np.arange(force.size) - delay, np.arange(force.size), force)
        response = np.empty(len(self.outputs[index]))
        extra = np.array([values.get(key, 0.0) for key in EXTRA])
        first = {size.key: size.neutral for size in self.free}
        gain, damping, stiffness = (values.get(key, first[key]) for key in ("gain", "damping", "stiffness"))
        _respond(force, 2 * fine_step, gain, damping, stiffness, extra, self._turn, response)
        if not np.isfinite(response).all():
            raise InputError("the response does not stay finite", place=self.records[index].name)
        return response

    each_record = staticmethod(map)
    inexact: ClassVar[Mapping] = {}

    def residual(self, values: Mapping[str, float], index: int) -> np.ndarray:
        return (self.simulated(values, index) - self.outputs[index])[None, :]

    def nuisances(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """An offset of the recorded output."""
        return np.full((1, 1, len(self.outputs[index])), np.std(self.outputs[index]))

    def retuned(
        self, values: Mapping[str, float], indices: Sequence[int], exactly: bool = False
    ) -> tuple[OneMass, dict[int, np.ndarray]]:
        """The same, as its input is given and its steps are exact enough, and the residuals."""
        return self, {index: self.residual(values, index) for index in indices}

    def realigned(self, amounts: Mapping[int, np.ndarray]) -> OneMass:
        """The same: an offset is linear."""
        return self

    def would_differ(self, one: Mapping[str, float], other: Mapping[str, float], index: int) -> dict[str, np.ndarray]:
        """None: what drives it is no road."""
        return {}

    def taking(self, other: OneMass, indices: Sequence[int]) -> OneMass:
        """The same: nothing is realigned."""
        return self

    def coarser(
        self, values: Mapping[str, float], residuals: Mapping[int, np.ndarray]
    ) -> tuple[OneMass, Mapping[int, np.ndarray]]:
        """The same: it is simulated soon enough."""
        return self, residuals

    def _linear(self) -> tuple[float, float, float]:
        """Gain, damping, stiffness from the response of the first record (Sanathanan and Koerner 1963)."""
        u, y = np.fft.rfft(self.inputs[0]), np.fft.rfft(self.outputs[0])
        frequency = np.fft.rfftfreq(len(self.inputs[0]), 1.0 / self.rate)
        kept = (frequency > self.band[0]) & (frequency < self.band[1])
        s, u, y = 2j * np.pi * frequency[kept], u[kept], y[kept]
        peak = abs(s[np.argmax(np.abs(y))])
        found = np.array([peak**2, 0.1 * peak, peak**2])
        for _ in range(20):
            weight = 1.0 / np.abs(s**2 + found[1] * s + found[2])
            columns = np.stack([u, -s * y, -y], axis=1) * weight[:, None]
            target = s**2 * y * weight
            found = np.linalg.lstsq(
                np.concatenate([columns.real, columns.imag]), np.concatenate([target.real, target.imag]), rcond=None
            )[0]
        return tuple(float(value) for value in found)


def _fine(values: np.ndarray) -> np.ndarray:
    """The input between its samples, for all stages of all steps."""
    padded = np.concatenate([values, np.zeros(64)])
    fine = resample(padded, padded.size * 2 * SUBSTEPS)
    return fine[: values.size * 2 * SUBSTEPS]
