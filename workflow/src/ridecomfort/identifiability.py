"""What a fit by least squares does and does not know: covariance, intervals, collinear parameters.

Parameters are in units of their bounds (0 at the lower, 1 at the upper), so that
sizes can be compared and "the data do not see it" has a meaning.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.stats import t as student

CONFIDENCE = 0.90
"""Of all intervals of sizes and parameters."""

AT_BOUND = 1e-3
"""Share of the bounds' width within which a parameter counts as at its bound."""

UNIDENTIFIED = 0.5
"""Half width of a 90 % interval, in widths of the bounds, from which on it covers them: the data say nothing."""

COLLINEAR = 0.9
"""Correlation of two estimates beyond which they are named as a pair."""


SEEN, LEAST_PART = 1e-10, 1e-6
"""Share of the largest information below which a direction is not seen at all, and the least part that a parameter of it has."""

ONLY_HERE = 1e-9
"""Share of a direction's information that counts as none: a block that alone knows a direction leaves it unknown."""


@dataclass(frozen=True)
class Knowledge:
    """``covariance`` and ``half_width`` of the 90 % intervals (units of the bounds), ``singular_values`` of the
    Jacobian, ``information`` (parameter, signal): share of each signal in what drives a parameter."""

    covariance: np.ndarray
    half_width: np.ndarray
    singular_values: np.ndarray
    information: np.ndarray


def assess(
    jacobian: np.ndarray, residual: np.ndarray, block: np.ndarray, influence: np.ndarray | None = None
) -> Knowledge:
    """From Jacobian (signal, sample, parameter), residual (signal, sample) and the block each sample belongs to.

    ``influence``, as the Jacobian: what a unit of the residual adds to the gradient of the squares, where the least squares
    are not those of this residual itself but of what is left of it when errors have been taken out.

    Jackknife over blocks, CV3 of MacKinnon, Nielsen and Webb (2023), J. Econometrics 232:272, eq. 14: residuals may be
    correlated in any way among signals and within a block, and have any variance; blocks are independent. Unlike the
    sandwich it holds where few blocks (the only bends of a road) carry what is known of a parameter.
    Intervals take Student's t with blocks - 1 degrees of freedom. A parameter that has a part in a direction which the
    data do not see at all gets an infinite variance, not an error. So does every parameter where there is one
    block only: nothing tells by how much another would differ.
    """
    count = jacobian.shape[-1]
    influence = jacobian if influence is None else influence
    size = np.sqrt(np.einsum("stp,stp->p", jacobian, jacobian))
    seen = size > 1e-9 * size.max()
    size = np.where(seen, size, 1.0)
    labels, index = np.unique(block, return_inverse=True)
    squares, scores = np.zeros((labels.size, count, count)), np.zeros((labels.size, count))
    for label in range(labels.size):
        part, left = jacobian[:, index == label] / size, residual[:, index == label]
        squares[label] = np.einsum("stp,stq->pq", part, part)
        scores[label] = np.einsum("stp,st->p", influence[:, index == label] / size, left)
    normal = squares.sum(axis=0)
    weights, directions = np.linalg.eigh(normal)
    is_known = weights > SEEN * weights.max()
    known = directions[:, is_known]
    seen = seen & ~(np.abs(directions[:, ~is_known]) > LEAST_PART).any(axis=1) & (labels.size > 1)
    without = known.T @ (normal - squares) @ known + ONLY_HERE * np.diag(weights[is_known])
    shifts = np.linalg.solve(without, (scores @ known)[:, :, None])[:, :, 0] @ known.T / size
    covariance = (labels.size - 1) / labels.size * shifts.T @ shifts
    covariance[~seen, :] = covariance[:, ~seen] = 0.0
    covariance[np.diag(~seen)] = np.inf
    quantile = student.ppf(0.5 + CONFIDENCE / 2, max(labels.size - 1, 1))
    information = np.einsum("stp,stp->ps", jacobian, jacobian)
    return Knowledge(
        covariance,
        quantile * np.sqrt(np.diag(covariance)),
        np.linalg.svd(jacobian.reshape(-1, count), compute_uv=False),
        information / (information.sum(axis=1, keepdims=True) + 1e-300),
    )


def verdict(place: float, half_width: float) -> str:
    """In words what is known of a parameter at ``place`` (0 to 1 between its bounds)."""
    words = [] if half_width < UNIDENTIFIED else ["not identified"]
    if place < AT_BOUND:
        words.append("at its lower bound")
    elif place > 1 - AT_BOUND:
        words.append("at its upper bound")
    return ", ".join(words) or "identified"


def remarks(names: list[str], places: np.ndarray, knowledge: Knowledge) -> list[str]:
    """Sentences on every parameter at a bound or not identified, and on those that are hard to tell apart."""
    sentences = []
    for name, place, width in zip(names, places, knowledge.half_width):
        words = verdict(place, width)
        if words.startswith("not identified"):
            how = f"its 90 % interval is {2 * width:.2g} times as wide as its bounds" if np.isfinite(width) else "they hold nothing of it"
            sentences.append(f"{name} is {words}: these drives leave open where in its bounds it lies ({how})")
        elif words != "identified":
            of_effect = ", or for none of it where that is nil" if "." in name else ""
            side = "less" if place < 0.5 else "more"
            sentences.append(f"{name} is {words}: the data ask for {side} than the bounds allow{of_effect}")
    deviation = np.sqrt(np.diag(knowledge.covariance))
    is_finite = (deviation > 0) & np.isfinite(deviation)
    scale = np.where(is_finite, deviation, np.inf)
    correlation = np.where(np.outer(is_finite, is_finite), knowledge.covariance, 0.0) / np.outer(scale, scale)
    is_alike = np.abs(correlation) > COLLINEAR
    _, group = connected_components(is_alike, directed=False)
    for number in np.unique(group):
        own = np.flatnonzero(group == number)
        if own.size > 1:
            among = correlation[np.ix_(own, own)][np.triu_indices(own.size, 1)]
            strongest = among[np.argmax(np.abs(among))]
            up_to = "" if own.size == 2 else "up to "
            told = f"{', '.join(names[k] for k in own[:-1])} and {names[own[-1]]}"
            sentences.append(f"{told} are hard to tell apart (correlation {up_to}{strongest:+.2f})")
    return sentences
