"""The missing force, estimated against what it could depend on, without a form in mind: to be checked by eye.

At every place where a force could act it is written as a curve, straight between knots, of
one thing that the place sees. Its values at the knots are found from the white residuals as
the size of an effect is, with what is calibrated and aligned projected out. What calibration
could take up (a straight line) does therefore not show. Each curve is estimated as if nothing
else were missing, so that of several things that are each leaves a trace in the curves of the
others; what is drawn of named effects for comparison are the curves that the same estimate
makes of the drives of a model that has them, and leaves the same traces.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.linalg import block_diag

from . import curves, event, evidence, probe, refit
from .curves import LINE, REST, Seen
from .experiment import Frame
from .made import beside
from .rung import Rung
from .terms import AXLES

LEAST_PLACES = 3.0
"""Blocks of road over which what a knot changes must be spread: of one or two nothing tells how sure its value is."""


def signature(
    rung: Rung, *, found: Mapping[int, np.ndarray] | None = None, ports: Sequence[str] = (), effects_folder=None, each: Callable = map
) -> xr.Dataset:
    """Curves of what a ``rung`` misses, from the drives that are fitted.

    ``found``: residuals of the model with what was found, to compare with; ``ports``: at which curves are estimated beside those of struts
    and tyres; ``each``: a ``map`` over curves.
    Returns over ``seen`` (what it depends on), ``axle`` and ``knot``: ``seen_at`` (in ``seen_unit``, of what ``seen_axis`` says),
    ``missing`` (``missing_what``, in ``missing_unit``) with its standard ``missing_error``, and ``named_missing``: what the estimate
    would show were the model with what was found the truth (nan without any); nan where drives hardly come. ``seen_share`` of the
    error when white, noise included, that the curves of a place, those of both axles, take says which explains most.
    """
    frame, values, residuals = rung.frame, rung.fit.values, rung.fit.residuals
    free = evidence.basis(frame.flats(list(rung.raw.values())).astype(float))
    to_explain = [evidence.without(frame.flat(residuals), free)]
    if found is not None:
        to_explain.append(evidence.without(frame.flat({i: residuals[i] - found[i] for i in residuals}), free))
    chosen = curves.at(ports)
    sources = {_name(number): curves.source(_name(number), seen) for number, seen in enumerate(chosen.values())}
    with beside(effects_folder, sources) as folder:
        candidates = [curves.candidate(_name(number), seen) for number, seen in enumerate(chosen.values())]
        experiment = rung.experiment.looking_for(candidates, folder)
        sooner, base = probe.coarsely(experiment, values, residuals)
        columns = each(probe.Probe(sooner, values, base), [(c.name, 0) for c in candidates])
        estimates = list(each(_Estimate(frame, np.stack(to_explain), free), list(zip(columns, chosen.values()))))
    return _dataset(chosen, estimates)


@dataclass(frozen=True)
class _Curve:
    """Values at the knots of both axles: what is missing, its standard error, what would be were the named effects the truth; and the share
    of the error that it takes."""

    missing: np.ndarray
    error: np.ndarray
    named: np.ndarray
    share: float


@dataclass(frozen=True)
class _Estimate:
    frame: Frame
    to_explain: np.ndarray
    """White residual, and that which the named effects explain if there are any, without what is free (1 or 2, element)."""
    free: np.ndarray
    """White directions that are fitted anyway, orthonormal."""

    def __call__(self, job: tuple[Mapping, Seen]) -> _Curve:
        columns, seen = job
        count = len(AXLES) * len(seen.knots)
        blocks = refit.numbered(self.frame.blocks())
        nothing = _Curve(*np.full((3, count), np.nan), 0.0)
        if not columns:
            return nothing
        white = self.frame.flats(list(columns.values())).astype(float) / seen.probe
        is_often = event.participation(white, blocks) >= LEAST_PLACES
        if not is_often.any():
            return nothing
        where = np.array([curves.row(key, seen) for key in columns])
        rows, residual = evidence.without(white, self.free), self.to_explain[0]
        # What is usual holds what the data do not show, near zero; a knot that is met too seldom to be shown is not held to zero.
        known = np.eye(len(rows)) / seen.usual**2
        held = np.linalg.inv(rows @ rows.T + known)
        found = -self.to_explain @ rows.T @ held
        left = residual + found[0] @ rows
        values, spread, is_met = np.zeros((2, count)), np.zeros((count, count)), np.isin(np.arange(count), where[is_often])
        values[: len(found), where] = found
        spread[np.ix_(where, where)] = refit.clustered(held, rows, left, blocks, len(rows), known)[0]
        shown = _as_known(seen, spread, is_met)
        missing, named = np.where(is_met, values @ shown.T, np.nan)
        error = np.where(is_met, np.sqrt(np.diag(shown @ spread @ shown.T)), np.nan)
        share = 1.0 - float(left @ left / (residual @ residual))
        return _Curve(missing, error, named if len(found) > 1 else np.full(count, np.nan), share)


def _as_known(seen: Seen, spread: np.ndarray, is_met: np.ndarray) -> np.ndarray:
    """Matrix that takes from the values at the knots of all axles what no drive knows of them; ``is_met``: the knots that drives come near.

    A force that is there at rest only moves the place of rest, and a line in what one strut or tyre sees is what calibration takes up; of what
    has no rest only the level is unknown: the mean by how well each value is known.
    """
    knots, count = np.array(seen.knots), len(seen.knots)
    rest = np.eye(count) - np.repeat(np.eye(count)[[np.argmin(np.abs(knots))]], count, axis=0)
    least = (1e-3 * seen.probe) ** 2
    parts = []
    for axle in range(len(AXLES)):
        own = slice(axle * count, (axle + 1) * count)
        if seen.open == REST:
            parts.append(rest)
        elif seen.open == LINE:
            weight = is_met[own] / (np.diag(rest @ spread[own, own] @ rest.T) + least)
            line = np.outer(knots, knots * weight) / (np.sum(knots**2 * weight) or 1.0)
            parts.append((np.eye(count) - line) @ rest)
        else:
            weight = is_met[own] / (np.diag(spread[own, own]) + least)
            parts.append(np.eye(count) - np.outer(np.ones(count), weight / (weight.sum() or 1.0)))
    return block_diag(*parts)


def _dataset(chosen: Mapping[str, Seen], estimates: Sequence[_Curve]) -> xr.Dataset:
    most = max(len(seen.knots) for seen in chosen.values())
    shape = (len(chosen), len(AXLES), most)
    at, table = np.full((len(chosen), most), np.nan), {key: np.full(shape, np.nan) for key in ("missing", "error", "named")}
    for number, (seen, curve) in enumerate(zip(chosen.values(), estimates)):
        count = len(seen.knots)
        at[number, :count] = seen.knots
        for key, values in table.items():
            values[number, :, :count] = getattr(curve, key).reshape(len(AXLES), count)
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
            "missing": (over, table["missing"]),
            "missing_error": (over, table["error"]),
            "named_missing": (over, table["named"]),
        },
        {"seen": list(chosen), "axle": list(AXLES)},
    )


def _name(number: int) -> str:
    return f"unknown_curve_{number}"
