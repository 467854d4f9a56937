"""How rough a stand-in road is along its length: a drawn sequence of survey IRI, and the gain that gives it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from ..errors import InputError
from . import defects, texture

CLASSES = ("G", "F", "M", "P")
"""Classes of ride quality whose shares are asked for; the rest is very good (VG) or between classes."""

BATCH = 500


@dataclass(frozen=True)
class Evaluation:
    """Where and how the study will judge the road: all that the shares of the classes depend on.

    ``s`` in m are the places of the comfort signals (whole windows of ``per_window`` places) and
    ``edges`` (4, s) the upper IRI edges in m/km of VG, G, F and M there.
    """

    s: np.ndarray
    per_window: int
    edges: np.ndarray


def shares(iri: np.ndarray, evaluation: Evaluation) -> np.ndarray:
    """Share of windows that lie wholly in G, F, M, P; ``iri`` (..., s) in m/km, result (..., 4)."""
    quality = np.zeros(iri.shape, dtype=np.int8)
    for edge in evaluation.edges:
        quality += iri >= edge
    windows = quality.reshape(*iri.shape[:-1], -1, evaluation.per_window)
    windows = np.ascontiguousarray(np.moveaxis(windows, -1, 0))  # along a short last axis numpy takes ten times as long
    lowest, highest = windows.min(axis=0), windows.max(axis=0)
    whole = np.where(lowest == highest, lowest, 0)
    return np.stack([np.mean(whole == k, axis=-1) for k in range(1, 5)], axis=-1)


def draw_levels(
    rng: np.random.Generator,
    centres: np.ndarray,
    evaluation: Evaluation,
    wanted: np.ndarray,
    *,
    smoothest: float,
    correlation_length: float,
    draws: int,
    tolerance: float,
) -> np.ndarray:
    """IRI in m/km at the segment ``centres``: a correlated process conditioned on the classes' shares.

    Its logarithm follows a Gaussian process of exponential correlation; its marginal is log-linear
    between the mean edges of the classes and reaches down to ``smoothest`` m/km. The share of each
    class in the marginal starts at ``wanted`` (4) and is corrected from batch to batch for what
    interpolation between segments adds and takes. Of ``draws`` sequences the one is taken whose windows
    come nearest to ``wanted`` in the worst class. Raises InputError when that misses by more than
    ``tolerance``.
    """
    edges = evaluation.edges.mean(axis=1)
    logarithm = np.log(np.concatenate([[smoothest], edges, [1.2 * edges[-1]]]))
    root = np.linalg.cholesky(np.exp(-np.abs(centres[:, None] - centres) / correlation_length))
    between = interpolation(centres, evaluation.s)
    marginal = np.array(wanted, dtype=float)
    nearest, chosen = np.inf, None
    for _ in range(max(1, draws // BATCH)):
        process = rng.standard_normal((BATCH, len(centres))) @ root.T
        levels = np.exp(np.interp(ndtr(process), *strictly_rising(marginal, logarithm)))
        found = shares(levels @ between, evaluation)
        miss = np.max(np.abs(found - wanted), axis=-1)
        if miss.min() < nearest:
            nearest, chosen = miss.min(), levels[miss.argmin()]
        marginal = np.maximum(marginal + 0.2 * (wanted - found.mean(axis=0)), 0.0)
    if nearest > tolerance:
        raise InputError(
            f"the nearest of {draws} sequences of IRI misses the share of a class by {nearest:.4f}, "
            f"expected {tolerance:g} at most",
            place="classes",
        )
    return chosen


def strictly_rising(marginal: np.ndarray, quantiles: np.ndarray):
    """Knots (probability, quantile) of the marginal distribution; a class without a share leaves no knot."""
    below = 1.0 - np.cumsum(marginal[::-1])[::-1]
    probability = np.concatenate([[0.0], below, [1.0]])
    keep = np.concatenate([[True], np.diff(probability) > 0.0])
    return probability[keep], quantiles[keep]


def interpolation(nodes: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Matrix (nodes, places) that takes values at nodes to linear interpolations at places; held beyond the ends."""
    return np.stack([np.interp(places, nodes, row) for row in np.eye(len(nodes))])


def place_defects(
    rng: np.random.Generator,
    base: np.ndarray,
    u: np.ndarray,
    v: np.ndarray,
    centres: np.ndarray,
    levels: np.ndarray,
    survey: Callable[[np.ndarray], np.ndarray],
    *,
    per_km: dict[str, float],
    allowance: float,
):
    """Defects where the road is rough, and ``base`` (u, v) in m with them: (list of Defect, elevation).

    The number of each kind that is tried is Poisson of ``per_km``, its place drawn with a density that
    grows as the square of the level. A defect is left out where it and what is there already would
    take more than ``allowance`` of the segment's IRI: a smooth road has no pothole.
    """
    surface = base.copy()
    rough = survey(surface)
    density = np.interp(u, centres, levels) ** 2
    density /= density.sum()
    placed = []
    for kind, rate in per_km.items():
        for place in rng.choice(u, size=rng.poisson(rate * u[-1] / 1000.0), p=density):
            defect = defects.draw(rng, kind, float(place), float(v[-1] - v[0]))
            trial = surface.copy()
            defects.add(trial, u, v, defect)
            rougher = survey(trial)
            if np.all((rougher <= allowance * levels) | (rougher <= 1.001 * rough)):
                surface, rough = trial, rougher
                placed.append(defect)
    return sorted(placed, key=lambda defect: defect.u), surface


def solve_gain(
    surface: np.ndarray,
    base: np.ndarray,
    u: np.ndarray,
    centres: np.ndarray,
    levels: np.ndarray,
    survey: Callable[[np.ndarray], np.ndarray],
    *,
    tolerance: float = 0.002,
    iterations: int = 60,
) -> np.ndarray:
    """Gain of the slope of ``surface`` over u with which ``base`` plus surface has the IRI ``levels`` in each segment.

    The gain is log-linear between segment centres and found by a damped fixed-point iteration. Raises
    InputError when the worst segment stays off by more than ``tolerance`` (relative), as where
    ``base`` alone is rougher than asked.
    """
    gain = levels.copy()
    alone = survey(base)
    for _ in range(iterations):
        along = np.exp(np.interp(u, centres, np.log(gain)))
        found = survey(base + texture.modulate(surface, along))
        if np.max(np.abs(found / levels - 1.0)) < tolerance:
            return along
        # What the base gives and what the surface adds go together about as the root of the sum of squares.
        missing = (levels**2 - alone**2) / np.maximum(found**2 - alone**2, 1e-3 * levels**2)
        gain *= np.clip(missing, 0.2, 5.0) ** 0.4
    worst = int(np.argmax(np.abs(found / levels - 1.0)))
    raise InputError(
        f"the IRI at {centres[worst]:g} m is {found[worst]:.2f} instead of {levels[worst]:.2f} m/km "
        f"after {iterations} iterations",
        place="level",
    )
