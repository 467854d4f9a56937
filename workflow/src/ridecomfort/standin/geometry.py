"""Reference line of a stand-in road: plan, elevation and bank, drawn from a seed to a site's published figures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve

from ..errors import InputError

GON = np.pi / 200.0
"""One gon in radians."""

END_STRAIGHT = 40.0
"""m; shortest straight at either end, so that a drive starts and stops on one."""

ALTERNATION = 0.75
"""Probability that a curve turns the other way than the one before."""

CLEARANCE = 15.0
"""m; the nearest that a road comes to another part of itself."""

ATTEMPTS = 2000


@dataclass(frozen=True)
class ReferenceLine:
    """The reference line on equidistant ``u``: every field is an array over it, in SI units."""

    u: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    curvature: np.ndarray
    slope: np.ndarray
    bank: np.ndarray
    height: np.ndarray


def reference_line(
    rng: np.random.Generator,
    *,
    length: float,
    spacing: float,
    plan: dict,
    profile: dict,
    bank: dict,
) -> ReferenceLine:
    """A road of ``length`` m that meets its plan and profile exactly, sampled every ``spacing`` m.

    ``plan``, ``profile`` and ``bank`` are the arguments of ``plan_knots``, ``grades`` and
    ``cross_slope``. Draws again while the road would come nearer to itself than CLEARANCE.
    Raises InputError when no draw fits.
    """
    u = spacing * np.arange(round(length / spacing) + 1)
    for _ in range(ATTEMPTS):
        knots, curvatures = plan_knots(rng, length, **plan)
        if knots is None:
            continue
        heading, x, y = trace(u, knots, curvatures)
        if nearest_approach(u, x, y) >= CLEARANCE:
            break
    else:
        raise InputError(
            f"none of {ATTEMPTS} drawn lines of {length:g} m keeps its limits; "
            "expected fewer turns, a smaller radius or shorter clothoids",
            place="plan",
        )
    curvature = np.interp(u, knots, curvatures)
    slope = grades(rng, u, **profile)
    height = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(u))])
    return ReferenceLine(u, x, y, heading, curvature, slope, cross_slope(curvature, spacing, **bank), height)


def plan_knots(
    rng: np.random.Generator,
    length: float,
    *,
    turning_gon_per_km: float,
    curves_per_km: float,
    straight_share: float,
    radius_spread: float,
    radius: tuple[float, float],
    clothoid_minimum: float,
    turn_maximum_deg: float,
):
    """Places in m and curvatures in 1/m between which the curvature runs linearly, or (None, None).

    The line is a chain of straight, clothoid, arc, clothoid. Turns and radii are
    drawn (lognormal), then the turns are scaled to sum in absolute value to
    ``turning_gon_per_km`` and the radii until the straights take ``straight_share`` of the length.
    A clothoid is 0.4 to 0.8 of the length that its arc would have without clothoids.
    A draw that breaks a limit (radii, clothoids, turns, END_STRAIGHT) gives (None, None).
    """
    curves = max(1, round(curves_per_km * length / 1000.0))
    turns = rng.lognormal(0.0, 0.5, curves)
    turns *= turning_gon_per_km * GON * length / 1000.0 / turns.sum()
    radii = rng.lognormal(0.0, radius_spread, curves) / turns**0.5
    easing = rng.uniform(0.4, 0.8, curves)
    radii *= (1.0 - straight_share) * length / np.sum(turns * radii * (1.0 + easing))
    straights = 0.15 + rng.dirichlet(np.ones(curves + 1)) * (curves + 1)
    straights *= straight_share * length / straights.sum()
    sides = np.where(rng.random(curves) < ALTERNATION, -1.0, 1.0)
    sides = rng.choice([-1.0, 1.0]) * np.cumprod(sides)
    clothoids = easing * turns * radii
    if (
        radii.min() < radius[0]
        or radii.max() > radius[1]
        or clothoids.min() < clothoid_minimum
        or turns.max() > np.radians(turn_maximum_deg)
        or min(straights[0], straights[-1]) < END_STRAIGHT
    ):
        return None, None
    arcs = (1.0 - easing) * turns * radii
    pieces = np.column_stack([straights[:-1], clothoids, arcs, clothoids]).ravel()
    knots = np.concatenate([[0.0], np.cumsum(pieces), [length]])
    curved = sides / radii
    still = np.zeros(curves)
    curvatures = np.concatenate([[0.0], np.column_stack([still, curved, curved, still]).ravel(), [0.0]])
    return knots, curvatures


def trace(u, knots, curvatures):
    """Heading in rad, x and y in m along a line of piecewise linear curvature that starts at the origin, due x.

    The heading is exact; x and y are Gauss-Legendre quadratures of three points per step of ``u``.
    """
    areas = np.concatenate([[0.0], np.cumsum(0.5 * (curvatures[1:] + curvatures[:-1]) * np.diff(knots))])
    rates = np.append(np.diff(curvatures) / np.diff(knots), 0.0)

    def heading(place):
        piece = np.clip(np.searchsorted(knots, place, side="right") - 1, 0, len(knots) - 1)
        inside = place - knots[piece]
        return areas[piece] + inside * (curvatures[piece] + 0.5 * rates[piece] * inside)

    nodes, weights = np.polynomial.legendre.leggauss(3)
    step = np.diff(u)
    inner = heading(u[:-1, None] + 0.5 * step[:, None] * (1.0 + nodes))
    x = np.concatenate([[0.0], np.cumsum(0.5 * step * (np.cos(inner) @ weights))])
    y = np.concatenate([[0.0], np.cumsum(0.5 * step * (np.sin(inner) @ weights))])
    return heading(u), x, y


def nearest_approach(u, x, y, *, step: float = 5.0, apart: float = 150.0) -> float:
    """Smallest distance in m between places that lie at least ``apart`` m from each other along the line."""
    every = max(1, round(step / (u[1] - u[0])))
    u, x, y = u[::every], x[::every], y[::every]
    distance = np.hypot(x[:, None] - x, y[:, None] - y)
    distance[np.abs(u[:, None] - u) < apart] = np.inf
    return float(distance.min())


def grades(rng, u, *, mean_absolute: float, climb: float, tangent: float) -> np.ndarray:
    """Slope over ``u``: tangents joined by vertical curves (linear slope), mean of its absolute value as asked.

    ``climb`` is the share of a steady climb (0 a rolling road, 1 an even ramp) and
    ``tangent`` the mean distance in m between changes of grade. A vertical curve takes 0.4
    to 0.8 of the shorter of its neighbouring tangents.
    """
    length = u[-1]
    count = max(2, round(length / tangent))
    lengths = rng.uniform(0.6, 1.4, count)
    lengths *= length / lengths.sum()
    changes = np.cumsum(lengths)[:-1]
    drawn = rng.standard_normal(count)
    grade = climb + (1.0 - climb) * (drawn - drawn.mean()) / drawn.std()
    half = 0.5 * rng.uniform(0.4, 0.8, count - 1) * np.minimum(lengths[:-1], lengths[1:])
    places = np.column_stack([changes - half, changes + half]).ravel()
    slope = np.interp(u, places, np.repeat(grade, 2)[1:-1])
    return slope * mean_absolute / np.mean(np.abs(slope))


def cross_slope(curvature, spacing, *, minimum: float, maximum: float, radius_of_maximum: float, twist_length: float):
    """Bank over u, positive with the left side up: falls to the right on straights, to the inside of curves.

    It grows with curvature from ``minimum`` (drainage) to ``maximum`` at ``radius_of_maximum`` m and is
    averaged with a triangle ``twist_length`` m long, since a road turns into its bank over a distance.
    Orders of size: 2.5 % and 7 % on rural roads (FGSV, Richtlinien fuer die Anlage von Landstrassen, 2012).
    """
    inward = np.clip(np.abs(curvature) * radius_of_maximum, 0.0, 1.0)
    size = minimum + (maximum - minimum) * inward
    # Gentle left curves keep turning over from the right-hand fall of the straight until the fall is inward.
    turnover = np.clip(1.0 - 2.0 * np.maximum(curvature, 0.0) * radius_of_maximum / 0.3, -1.0, 1.0)
    half = max(1, round(0.5 * twist_length / spacing))
    triangle = half - np.abs(np.arange(1 - half, half))
    padded = np.pad(size * turnover, half - 1, mode="edge")
    return fftconvolve(padded, triangle / triangle.sum(), mode="valid")
