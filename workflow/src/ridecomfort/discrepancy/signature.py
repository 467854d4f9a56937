"""The missing force, estimated against what it could depend on, without a form in mind: to be checked by eye.

At every place where a force could act it is written as a curve, straight between knots, of
one thing that the place sees. Its values at the knots are found from the white residuals as
the size of an effect is, with what is calibrated and aligned projected out. What calibration
could take up (a straight line) does therefore not show, and what is drawn of a named effect
for comparison has passed through the same estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.linalg import block_diag

from ..calibrated import with_values
from ..effects import library
from ..vehicle.constants import DAMPING, SPRING, STATIC_DEFLECTION, wheel_table
from ..vehicle.parameters import Vehicle
from . import evidence, probe
from .experiment import Candidate, Frame, Size
from .made import beside
from .places import AXLES, FORCE, PLACES
from .rung import Rung

EXPECTED = 500.0
"""N; usual size of a missing force, which holds what the data do not show near zero."""


@dataclass(frozen=True)
class Seen:
    """What a force may depend on: port, expression, its unit, and the knots of the curve."""

    port: str
    expression: str
    unit: str
    knots: tuple[float, ...]


SEEN: Mapping[str, Seen] = {
    "strut velocity": Seen("suspension", "velocity", "m/s", (-0.6, -0.3, -0.12, -0.04, -0.01, 0.0, 0.01, 0.04, 0.12, 0.3, 0.6)),
    "strut deflection": Seen("suspension", "deflection", "m", (-0.05, -0.03, -0.015, -0.005, 0.0, 0.005, 0.015, 0.03, 0.05)),
    "tyre deflection": Seen("tyre_vertical", "deflection - rest", "m", (-0.015, -0.008, -0.004, 0.0, 0.004, 0.008, 0.015)),
}

STEP, STEADY = 1e-3, 1000
"""s, and the number of such steps, over which the states of an effect settle at steady motion."""

SPIN = 70.0
"""rad/s of the wheels meanwhile, as at 80 km/h."""

ARGUMENTS = {place.port: ", ".join(place.arguments) for place in PLACES.values()}


def signature(
    rung: Rung, *, named: Mapping[str, Mapping[str, float]] | None = None, effects_folder=None, each: Callable = map
) -> xr.Dataset:
    """Curves of the force that a ``rung`` misses, from the drives that are fitted.

    ``named``: sizes of effects to compare with, as mapping of name to {parameter: value}; ``each``: a ``map`` over curves.
    Returns over ``seen`` (what it depends on), ``axle`` and ``knot``: ``seen_at`` (in ``seen_unit``),
    ``missing_force`` (N) with its standard ``missing_force_error``, and over ``named_effect`` too ``named_force``: what
    the estimate would show were the effect the truth (nan where it acts elsewhere); ``seen_share`` of the
    error when white, noise included, that the curves of a place take says which explains most.
    """
    frame, values, residuals = rung.frame, rung.fit.values, rung.fit.residuals
    free = evidence.basis(frame.flats(list(rung.raw.values())).astype(float))
    sources = {_name(number): _source(_name(number), seen) for number, seen in enumerate(SEEN.values())}
    with beside(effects_folder, sources) as folder:
        candidates = [_candidate(number, seen) for number, seen in enumerate(SEEN.values())]
        experiment = rung.experiment.looking_for(candidates, folder)
        start = probe.coarsely(experiment, values, residuals)
        found = each(probe.Probe(*start), [(c.name, 0) for c in candidates])
        curves = list(each(_Estimate(frame, residuals, free), list(zip(found, SEEN.values()))))
    known = library.find(effects_folder)
    names = [name for name in named or {} if known[name].effect.port in ARGUMENTS]
    vehicle, _ = with_values(rung.experiment.vehicle, {}, values)
    return _dataset(curves, names, [_shapes(known[name], (named or {})[name], vehicle) for name in names])


@dataclass(frozen=True)
class _Curve:
    force: np.ndarray
    error: np.ndarray
    resolution: np.ndarray
    """What the estimate makes of a true curve, (axle and knot, axle and knot)."""
    share: float


@dataclass(frozen=True)
class _Estimate:
    frame: Frame
    residuals: Mapping[int, np.ndarray]
    free: np.ndarray
    """White directions that are fitted anyway, orthonormal."""

    def __call__(self, job: tuple[Mapping, Seen]) -> _Curve:
        return _curve(self.frame, self.residuals, self.free, *job)


def _curve(frame: Frame, residuals, free, columns, seen: Seen) -> _Curve:
    keys = list(columns)
    rows = evidence.without(frame.flats([columns[key] for key in keys]).astype(float) / FORCE, free)
    residual = evidence.without(frame.flat(residuals), free)
    normal = rows @ rows.T
    held = np.linalg.inv(normal + np.eye(len(rows)) / EXPECTED**2)
    force = -held @ (rows @ residual)
    left = residual + force @ rows
    blocks = np.unique(frame.blocks(), return_inverse=True)[1]
    sums = np.stack([np.bincount(blocks, row * left) for row in rows])
    count = len(AXLES) * len(seen.knots)
    where = [AXLES.index(axle) * len(seen.knots) + int(knot) for axle, knot in (_parts(key) for key in keys)]
    values, spread, resolution = np.zeros(count), np.zeros((count, count)), np.zeros((count, count))
    values[where], spread[np.ix_(where, where)] = force, held @ (sums @ sums.T) @ held
    resolution[np.ix_(where, where)] = held @ normal
    shown = _without_line(np.array(seen.knots), spread)
    error = np.sqrt(np.diag(shown @ spread @ shown.T))
    error[[k for k in range(count) if k not in where]] = np.nan
    return _Curve(shown @ values, error, shown @ resolution, 1.0 - float(left @ left / (residual @ residual)))


def _without_line(knots: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Matrix that takes from the values at the knots of all axles their value at rest and a line through it.

    A force that is there at rest only moves the place of rest, and a line is what calibration takes up: neither is known.
    """
    count = len(knots)
    rest = np.eye(count) - np.repeat(np.eye(count)[[np.argmin(np.abs(knots))]], count, axis=0)
    parts = []
    for axle in range(len(AXLES)):
        own = slice(axle * count, (axle + 1) * count)
        weight = 1.0 / (np.diag(rest @ spread[own, own] @ rest.T) + 1e-3)
        weight[knots == 0.0] = 0.0
        line = np.outer(knots, knots * weight) / np.sum(knots**2 * weight)
        parts.append((np.eye(count) - line) @ rest)
    return block_diag(*parts)


def _shapes(entry: library.Entry, sizes: Mapping[str, float], vehicle: Vehicle) -> dict[str, np.ndarray]:
    """Force of an effect of a vehicle at the knots of what it may depend on, (axle, knot), by what that is; of one with states, in steady
    motion."""
    sizes, wheels = entry.effect.values(sizes), wheel_table(vehicle)
    found = {}
    for label, seen in SEEN.items():
        if seen.port != entry.effect.port:
            continue
        force = np.zeros((len(AXLES), len(seen.knots)))
        for a, wheel in enumerate((0, 2)):
            for k, knot in enumerate(seen.knots):
                known = {"wheel": wheel, "deflection": 0.0, "velocity": 0.0, "force_x": 0.0, "force_y": 0.0, "rotation": 0.0, "spin": SPIN}
                known |= {"stiffness": wheels[wheel, SPRING], "damping": wheels[wheel, DAMPING]}
                if seen.port == "tyre_vertical":
                    rest = wheels[wheel, STATIC_DEFLECTION]
                    known |= {"stiffness": vehicle["tyre_radial_stiffness"], "rest": rest, "deflection": rest}
                known[seen.expression.partition(" ")[0]] += knot
                force[a, k] = _steady(entry, [known[name] for name in ARGUMENTS[seen.port].split(", ")], sizes)
        found[label] = force
    return found


def _steady(entry: library.Entry, seen: Sequence[float], sizes: Mapping[str, float]) -> float:
    """Force of an effect that has seen the same for long."""
    act, states = getattr(entry.act, "py_func", entry.act), np.zeros(len(entry.effect.states))
    if not states.size:
        return act(*seen, **sizes)
    for _ in range(STEADY):
        force, *slopes = act(*seen, *states, *sizes.values())
        states = states + STEP * np.array(slopes)
    return force


def _dataset(curves: Sequence[_Curve], names: Sequence[str], shapes: Sequence[Mapping[str, np.ndarray]]) -> xr.Dataset:
    most = max(len(seen.knots) for seen in SEEN.values())
    shape = (len(SEEN), len(AXLES), most)
    at, force, error = np.full((len(SEEN), most), np.nan), np.full(shape, np.nan), np.full(shape, np.nan)
    drawn = np.full((len(names), *shape), np.nan)
    for number, ((label, seen), curve) in enumerate(zip(SEEN.items(), curves)):
        count = len(seen.knots)
        at[number, :count] = seen.knots
        force[number, :, :count] = curve.force.reshape(len(AXLES), count)
        error[number, :, :count] = curve.error.reshape(len(AXLES), count)
        for k, own in enumerate(shapes):
            if label in own:
                drawn[k, number, :, :count] = (curve.resolution @ own[label].ravel()).reshape(len(AXLES), count)
    over = ("seen", "axle", "knot")
    return xr.Dataset(
        {
            "seen_at": (("seen", "knot"), at),
            "seen_unit": ("seen", np.array([seen.unit for seen in SEEN.values()])),
            "seen_share": ("seen", np.array([curve.share for curve in curves]), {"units": "1"}),
            "missing_force": (over, force, {"units": "N", "long_name": "force that the model lacks"}),
            "missing_force_error": (over, error, {"units": "N", "long_name": "standard error of it"}),
            "named_force": (("named_effect", *over), drawn, {"units": "N", "long_name": "what named effects would show"}),
        },
        {"seen": list(SEEN), "axle": list(AXLES), "named_effect": np.array(names, dtype=str)},
    )


def _name(number: int) -> str:
    return f"unknown_curve_{number}"


def _parts(key: str) -> tuple[str, str]:
    axle, _, knot = key.partition(".")[2].partition("_")
    return axle, knot


def _candidate(number: int, seen: Seen) -> Candidate:
    keys = (f"{_name(number)}.{axle}_{knot}" for axle in AXLES for knot in range(len(seen.knots)))
    return Candidate(_name(number), tuple(Size(key, "N", 0.0, -5e3, 5e3, FORCE) for key in keys))


def _source(name: str, seen: Seen) -> str:
    """Text of an effect file (``effects.contract``) of a force that is a curve over knots."""
    own = [f"{axle}_{knot}" for axle in AXLES for knot in range(len(seen.knots))]
    parameters = "\n".join(
        f'        Parameter("{one}", "N", 0.0, {FORCE}, (-5e3, 5e3), "force at a knot of the curve"),' for one in own
    )
    last = len(seen.knots) - 1
    lines = [f"    if x <= {seen.knots[0]}:", "        return front_0 if wheel < 2 else rear_0"]
    for k in range(last):
        low, high = seen.knots[k], seen.knots[k + 1]
        lines += [
            f"    if x <= {high}:",
            f"        part = (x - ({low})) / ({high} - ({low}))",
            f"        if wheel < 2:\n            return front_{k} + part * (front_{k + 1} - front_{k})",
            f"        return rear_{k} + part * (rear_{k + 1} - rear_{k})",
        ]
    lines.append(f"    return front_{last} if wheel < 2 else rear_{last}")
    body = "\n".join(lines)
    return (
        f'"""A force as a curve over {seen.expression}."""\n\nfrom ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="A force that is looked for.",\n    source="none",\n'
        f'    port="{seen.port}",\n    parameters=(\n{parameters}\n    ),\n)\n\n\n'
        f"def act({ARGUMENTS[seen.port]}, {', '.join(own)}):\n    x = {seen.expression}\n{body}\n"
    )
