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
from . import curves, evidence, probe
from .curves import LINE, Seen
from .experiment import Frame
from .made import beside
from .places import AXLES
from .rung import Rung


def signature(
    rung: Rung, *, named: Mapping[str, Mapping[str, float]] | None = None, others: Sequence[str] = (), effects_folder=None,
    each: Callable = map,
) -> xr.Dataset:  # fmt: skip
    """Curves of what a ``rung`` misses, from the drives that are fitted.

    ``named``: sizes of effects to compare with, as mapping of name to {parameter: value}; ``others``: names of effects at whose ports
    curves are estimated, too; ``each``: a ``map`` over curves.
    Returns over ``seen`` (what it depends on), ``axle`` and ``knot``: ``seen_at`` (in ``seen_unit``, of what ``seen_axis`` says),
    ``missing`` (``missing_what``, in ``missing_unit``) with its standard ``missing_error``, and over ``named_effect`` too
    ``named_missing``: what the estimate would show were the effect the truth (nan where it acts elsewhere); ``seen_share`` of the
    error when white, noise included, that the curves of a place take says which explains most.
    """
    frame, values, residuals = rung.frame, rung.fit.values, rung.fit.residuals
    free = evidence.basis(frame.flats(list(rung.raw.values())).astype(float))
    known = library.find(effects_folder)
    chosen = curves.at([known[name].effect.port for name in (*(named or {}), *others)])
    sources = {_name(number): curves.source(_name(number), seen) for number, seen in enumerate(chosen.values())}
    with beside(effects_folder, sources) as folder:
        candidates = [curves.candidate(_name(number), seen) for number, seen in enumerate(chosen.values())]
        experiment = rung.experiment.looking_for(candidates, folder)
        start = probe.coarsely(experiment, values, residuals)
        found = each(probe.Probe(*start), [(c.name, 0) for c in candidates])
        estimates = list(each(_Estimate(frame, residuals, free), list(zip(found, chosen.values()))))
    vehicle, _ = with_values(rung.experiment.vehicle, {}, values)
    shapes = {name: curves.known(known[name], sizes, vehicle, chosen) for name, sizes in (named or {}).items()}
    return _dataset(chosen, estimates, {name: own for name, own in shapes.items() if own})


@dataclass(frozen=True)
class _Curve:
    missing: np.ndarray
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
    count = len(AXLES) * len(seen.knots)
    if not keys:
        return _Curve(np.zeros(count), np.full(count, np.nan), np.zeros((count, count)), 0.0)
    rows = evidence.without(frame.flats([columns[key] for key in keys]).astype(float) / seen.probe, free)
    residual = evidence.without(frame.flat(residuals), free)
    normal = rows @ rows.T
    # What is usual holds what the data do not show, near zero.
    held = np.linalg.inv(normal + np.eye(len(rows)) / seen.usual**2)
    missing = -held @ (rows @ residual)
    left = residual + missing @ rows
    blocks = np.unique(frame.blocks(), return_inverse=True)[1]
    sums = np.stack([np.bincount(blocks, row * left) for row in rows])
    where = [curves.row(key, seen) for key in keys]
    values, spread, resolution = np.zeros(count), np.zeros((count, count)), np.zeros((count, count))
    values[where], spread[np.ix_(where, where)] = missing, held @ (sums @ sums.T) @ held
    resolution[np.ix_(where, where)] = held @ normal
    is_met = np.isin(np.arange(count), where)
    shown = _as_known(seen, spread, is_met)
    error = np.where(is_met, np.sqrt(np.diag(shown @ spread @ shown.T)), np.nan)
    return _Curve(shown @ values, error, shown @ resolution, 1.0 - float(left @ left / (residual @ residual)))


def _as_known(seen: Seen, spread: np.ndarray, is_met: np.ndarray) -> np.ndarray:
    """Matrix that takes from the values at the knots of all axles what no drive knows of them; ``is_met``: the knots that drives come near.

    A force that is there at rest only moves the place of rest, and a line is what calibration takes up; of what has no rest
    only the level is unknown: the mean by how well each value is known.
    """
    knots, count = np.array(seen.knots), len(seen.knots)
    rest = np.eye(count) - np.repeat(np.eye(count)[[np.argmin(np.abs(knots))]], count, axis=0)
    least = (1e-3 * seen.probe) ** 2
    parts = []
    for axle in range(len(AXLES)):
        own = slice(axle * count, (axle + 1) * count)
        if seen.open == LINE:
            weight = is_met[own] / (np.diag(rest @ spread[own, own] @ rest.T) + least)
            line = np.outer(knots, knots * weight) / (np.sum(knots**2 * weight) or 1.0)
            parts.append((np.eye(count) - line) @ rest)
        else:
            weight = is_met[own] / (np.diag(spread[own, own]) + least)
            parts.append(np.eye(count) - np.outer(np.ones(count), weight / (weight.sum() or 1.0)))
    return block_diag(*parts)


def _dataset(
    chosen: Mapping[str, Seen], estimates: Sequence[_Curve], shapes: Mapping[str, Mapping[str, np.ndarray]]
) -> xr.Dataset:
    most = max(len(seen.knots) for seen in chosen.values())
    shape = (len(chosen), len(AXLES), most)
    at, missing, error = np.full((len(chosen), most), np.nan), np.full(shape, np.nan), np.full(shape, np.nan)
    drawn = np.full((len(shapes), *shape), np.nan)
    for number, ((label, seen), curve) in enumerate(zip(chosen.items(), estimates)):
        count = len(seen.knots)
        at[number, :count] = seen.knots
        missing[number, :, :count] = curve.missing.reshape(len(AXLES), count)
        error[number, :, :count] = curve.error.reshape(len(AXLES), count)
        for k, own in enumerate(shapes.values()):
            if label in own:
                drawn[k, number, :, :count] = (curve.resolution @ own[label].ravel()).reshape(len(AXLES), count)
    over = ("seen", "axle", "knot")
    text = lambda key: ("seen", np.array([getattr(seen, key) for seen in chosen.values()]))
    return xr.Dataset(
        {
            "seen_at": (("seen", "knot"), at),
            "seen_unit": text("unit"),
            "seen_axis": text("axis"),
            "seen_share": ("seen", np.array([curve.share for curve in estimates]), {"units": "1"}),
            "missing_what": text("lacks"),
            "missing_unit": text("lacks_unit"),
            "missing": (over, missing, {"long_name": "what the model lacks, in missing_unit"}),
            "missing_error": (over, error, {"long_name": "standard error of it"}),
            "named_missing": (("named_effect", *over), drawn, {"long_name": "what named effects would show"}),
        },
        {"seen": list(chosen), "axle": list(AXLES), "named_effect": np.array(list(shapes), dtype=str)},
    )


def _name(number: int) -> str:
    return f"unknown_curve_{number}"
