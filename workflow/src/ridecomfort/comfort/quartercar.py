"""The quarter-car of the IRI, carried from sample to sample by its exact state transition."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

from ..errors import InputError
from . import signals

SPEED = 80 / 3.6
"""m/s; the speed that the IRI is defined at."""

INITIAL_LENGTH = 11.0
"""m; the mean slope over this length is the state that the quarter-car starts with (Sayers 1995)."""

MOVING_AVERAGE = 0.25
"""m; base length of the moving average that stands for the tyre's contact (Sayers 1995, ASTM E1926)."""

FINE_SPACING = 0.05
"""m; samples this close resolve a profile that is smoothed over ``MOVING_AVERAGE``."""

ROUNDING = 1e-6
"""Of an interval; half intervals are rounded up though the mean spacing of positions is a last digit too large (Sayers 1995 has 3 at 0.1 m)."""

CONVERGED = 1e-12


@dataclass(frozen=True)
class GoldenCar:
    """Parameters of the quarter-car, per sprung mass (Sayers 1995; sec:IRI_concept)."""

    damping: float = 6.0
    tyre_stiffness: float = 653.0
    spring_stiffness: float = 63.3
    unsprung_mass: float = 0.15

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """A (4, 4) in 1/s and B (4,) in 1/s2 of x' = A x + B h, put right (docs/method.md)."""
        c, k1, k2, mu = self.damping, self.tyre_stiffness, self.spring_stiffness, self.unsprung_mass
        a = [[0, 1, 0, 0], [-k2, -c, k2, c], [0, 0, 0, 1], [k2 / mu, c / mu, -(k1 + k2) / mu, -c / mu]]
        return np.array(a, float), np.array([0, 0, 0, k1 / mu])

    def gain(self, frequency) -> np.ndarray:
        """Suspension stroke rate per rate of height of the road, magnitude at frequencies in Hz."""
        a, b = self.matrices()
        p = 2j * np.pi * np.atleast_1d(np.asarray(frequency, float))
        states = np.linalg.solve(p[:, None, None] * np.eye(4) - a, np.broadcast_to(b, (len(p), 4))[..., None])
        return np.abs(states[:, 0, 0] - states[:, 2, 0]).reshape(np.shape(frequency))


GOLDEN_CAR = GoldenCar()


@lru_cache(maxsize=64)
def transition(spacing: float, speed: float = SPEED, car: GoldenCar = GOLDEN_CAR) -> tuple[np.ndarray, np.ndarray]:
    """State transition ST (4, 4) and partial response PR (4,) over ``spacing`` metres of constant slope.

    ST = exp(A dt), PR = A^-1 (ST - I) B with dt = spacing / speed (World Bank
    Technical Paper 46, appendix A). The state is made of slopes and their rates.
    """
    found = transitions(np.array([spacing]), speed, car)
    for each in found:
        each.flags.writeable = False  # they are kept
    return found[0][0], found[1][0]


def transitions(
    spacings: np.ndarray, speed: float = SPEED, car: GoldenCar = GOLDEN_CAR
) -> tuple[np.ndarray, np.ndarray]:
    """ST (n, 4, 4) and PR (n, 4) for every one of ``spacings`` in metres."""
    a, b = car.matrices()
    times = np.asarray(spacings, float) / speed
    if len(times) <= 16:
        exact = np.array([_held(a, b, time, 0) for time in times])
        return exact[:, :, :4], exact[:, :, 4]
    values, vectors = np.linalg.eig(a)
    inverse = np.linalg.inv(vectors)
    st = np.einsum("ij,nj,jk->nik", vectors, np.exp(values * times[:, None]), inverse).real
    pr = np.einsum("ij,nj,jk,k->ni", vectors, np.expm1(values * times[:, None]) / values, inverse, b).real
    return st, pr


def _held(a: np.ndarray, b: np.ndarray, time: float, degree: int) -> np.ndarray:
    """ST beside the responses to the inputs 1, q, ... q^degree, q = 0 to 1 over ``time``: (4, 5 + degree).

    The exponential of A bordered by B and a chain of integrators holds them side
    by side, without A^-1 and its cancellation.
    """
    size = 5 + degree
    bordered = np.zeros((size, size))
    bordered[:4, :4], bordered[:4, 4] = a * time, b * time
    for power in range(1, degree + 1):
        bordered[3 + power, 4 + power] = power
    return expm(bordered)[:4]


@dataclass(frozen=True)
class Response:
    """How the quarter-car answers a profile.

    ``position`` (n,) in m; ``travel`` (..., n), the stroke of the suspension
    accumulated from the first sample on, in m; ``state`` (..., 4) behind the last
    sample, with which the next stretch of the same road goes on.
    """

    position: np.ndarray
    travel: np.ndarray
    state: np.ndarray

    def between(self, start, stop) -> np.ndarray:
        """IRI in m/km from ``start`` to ``stop`` (m), arrays of equal shape; NaN outside the profile."""
        start, stop = np.broadcast_arrays(np.asarray(start, float), np.asarray(stop, float))
        flat = self.travel.reshape(-1, self.travel.shape[-1])
        ends = [
            np.array([np.interp(x, self.position, row, np.nan, np.nan) for row in flat]) for x in (start, stop)
        ]
        rough = 1000.0 * (ends[1] - ends[0]) / (stop - start)
        return rough.reshape(self.travel.shape[:-1] + start.shape)


def respond(
    profile,
    spacing,
    *,
    moving_average: float | None = MOVING_AVERAGE,
    speed: float = SPEED,
    state=None,
    between: str = "auto",
    car: GoldenCar = GOLDEN_CAR,
) -> Response:
    """The answer of the quarter-car to a profile of heights in m, last axis along the road.

    ``spacing``: metres between samples, or the ascending positions of all samples.
    ``moving_average``: base length in m; None where the profile is smoothed already.
    ``between`` samples the slope is constant as in the standard ("linear"), or the
    profile a spline of third order ("cubic", equal spacing only), which attenuates
    no wavelength; "auto" takes the spline where a profile is not averaged and its
    samples lie closer than 50 mm. The stroke is integrated to third order.

    Raises InputError for gaps, profiles of less than two samples, or samples out of order.
    """
    heights, position = _checked(profile, spacing)
    if not speed > 0.0:
        raise InputError(f"{speed!r} is not a speed; expected more than 0 m/s", place="speed")
    steps = np.diff(position)
    inputs, st, pr = _inputs(heights, position, steps, moving_average, speed, between, car)
    flat = np.ascontiguousarray(inputs.reshape(-1, *inputs.shape[-2:]))
    if state is None:
        states = _start(heights.reshape(len(flat), -1), position)
    else:
        states = np.array(np.broadcast_to(state, (*heights.shape[:-1], 4)), float).reshape(-1, 4)
    travel = np.empty((len(flat), len(position)))
    for row in range(len(flat)):
        _march(flat[row], st, pr, steps, speed, states[row], travel[row])
    return Response(position, travel.reshape(heights.shape), states.reshape(heights.shape[:-1] + (4,)))


def _inputs(heights, position, steps, moving_average, speed, between, car):
    """Slope in powers of the place in each interval, (..., n - 1, degree + 1), and ST and PR for them."""
    even = bool(np.ptp(steps) <= 1e-6 * steps.mean())
    if between == "auto":
        fine = even and not moving_average and len(position) > 3 and steps.mean() <= FINE_SPACING * (1 + 1e-6)
        between = "cubic" if fine else "linear"
    if between == "linear":
        st, pr = transitions(steps.mean(keepdims=True) if even else steps, speed, car)
        return _slopes(heights, position, steps, even, moving_average)[..., None], st, pr[:, :, None]
    if between != "cubic" or not even or moving_average:
        raise InputError(f"{between!r} needs equal spacing and no moving average", place="between")
    step = float(steps.mean())
    held = _held(*car.matrices(), step / speed, 2)[None]
    c3, c2, c1, _ = CubicSpline(position, heights, axis=-1).c
    inputs = np.moveaxis(np.stack([c1, 2 * c2 * step, 3 * c3 * step**2], axis=-1), 0, -2)
    return inputs, np.ascontiguousarray(held[:, :, :4]), np.ascontiguousarray(held[:, :, 4:])


def _start(heights: np.ndarray, position: np.ndarray) -> np.ndarray:
    """States (row, 4) at the first sample: both masses follow the mean slope of the first metres."""
    base = min(max(int(np.searchsorted(position, position[0] + INITIAL_LENGTH)), 1), len(position) - 1)
    states = np.zeros((len(heights), 4))
    states[:, 0] = states[:, 2] = (heights[:, base] - heights[:, 0]) / (position[base] - position[0])
    return states


def _checked(profile, spacing) -> tuple[np.ndarray, np.ndarray]:
    signals.check_units(profile, "m")
    heights = np.asarray(profile, float)
    if heights.ndim == 0 or heights.shape[-1] < 2:
        raise InputError("expected at least two heights along the last axis", place="profile")
    bad = np.flatnonzero(~np.isfinite(heights.reshape(-1, heights.shape[-1])).all(axis=0))
    if bad.size:
        raise InputError("is not finite; a profile with a gap has no IRI", place=f"profile, sample {bad[0]}")
    signals.check_units(spacing, "m")
    along = np.asarray(spacing, float)
    if along.ndim == 0:
        if not (np.isfinite(along) and along > 0.0):
            raise InputError(f"{spacing!r} is not a spacing; expected more than 0 m", place="spacing")
        return heights, along * np.arange(heights.shape[-1])
    if along.shape != heights.shape[-1:]:
        raise InputError(f"{along.size} positions for {heights.shape[-1]} heights", place="spacing")
    if not np.all(np.diff(along) > 0.0):
        sample = int(np.argmin(np.diff(along) > 0.0)) + 1
        raise InputError("positions must ascend", place=f"spacing, sample {sample}")
    return heights, along


def _slopes(heights, position, steps, even: bool, base: float | None) -> np.ndarray:
    """Slope of the averaged profile in every interval between samples, (..., n - 1).

    The mean of the slope over the base length, centred: on equal spacing over a
    whole number of intervals as in Sayers (1995), else over exactly ``base``;
    never over less than the interval. Towards both ends the base shrinks.
    """
    middle, half = 0.5 * (position[1:] + position[:-1]), 0.5 * steps
    if base and even:
        count = max(1, int(base / steps.mean() + 0.5 + ROUNDING))
        # An even number of intervals is centred on a sample: the one behind the interval.
        middle = position[1:] if count % 2 == 0 else middle
        half = np.full(len(steps), 0.5 * count * steps.mean())
    elif base:
        half = np.maximum(half, 0.5 * base)
    half = np.minimum(half, np.minimum(middle - position[0], position[-1] - middle))
    cut = half < 0.25 * steps
    left = np.where(cut, position[:-1], middle - half)
    right = np.where(cut, position[1:], middle + half)
    flat = heights.reshape(-1, heights.shape[-1])
    rise = np.array([np.interp(right, position, row) - np.interp(left, position, row) for row in flat])
    return (rise / (right - left)).reshape(heights.shape[:-1] + (-1,))


@njit(cache=True)
def _march(slopes, st, pr, steps, speed, x, travel):
    """Carry the state ``x`` along the slopes and accumulate the stroke of the suspension."""
    total = 0.0
    travel[0] = 0.0
    y = np.empty(4)
    one = st.shape[0] == 1
    for sample in range(len(slopes)):
        which = 0 if one else sample
        for i in range(4):
            value = 0.0
            for k in range(slopes.shape[1]):
                value += pr[which, i, k] * slopes[sample, k]
            for j in range(4):
                value += st[which, i, j] * x[j]
            y[i] = value
        step = steps[sample]
        total += step * _absolute(
            x[0] - x[2], y[0] - y[2], (x[1] - x[3]) * step / speed, (y[1] - y[3]) * step / speed
        )
        travel[sample + 1] = total
        x[:] = y


@njit(cache=True)
def _absolute(y0, y1, d0, d1):
    """Integral of |y| over the unit interval, y cubic with values y0, y1 and slopes d0, d1 at its ends."""
    if (y0 >= 0.0) == (y1 >= 0.0):
        return abs(0.5 * (y0 + y1) + (d0 - d1) / 12.0)
    low, high = 0.0, 1.0
    root = y0 / (y0 - y1)
    c2, c3 = 3.0 * (y1 - y0) - 2.0 * d0 - d1, 2.0 * (y0 - y1) + d0 + d1
    for _ in range(50):
        value = y0 + root * (d0 + root * (c2 + root * c3))
        if (value >= 0.0) == (y0 >= 0.0):
            low = root
        else:
            high = root
        slope = d0 + root * (2.0 * c2 + 3.0 * root * c3)
        step = root - value / slope if slope != 0.0 else -1.0
        if not (low < step < high):
            step = 0.5 * (low + high)
        if abs(step - root) < CONVERGED:
            root = step
            break
        root = step
    whole = y0 + 0.5 * d0 + c2 / 3.0 + 0.25 * c3
    part = root * (y0 + root * (0.5 * d0 + root * (c2 / 3.0 + root * 0.25 * c3)))
    return abs(part) + abs(whole - part)
