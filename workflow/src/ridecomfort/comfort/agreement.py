"""How far methods agree along a road: confusion, kappa, rank correlation, lag, with honest intervals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError

BLOCK = 100.0
"""m; length of the blocks that are drawn together. Signals of comfort are correlated along the road
over less: one second of running rms is 28 m at 100 km/h, a segment of the survey 50 m."""

FEWEST = 5
"""Blocks that a road holds at least for an interval: of two or three that are drawn few differ."""

REPETITIONS = 500

SUBSTANTIAL = 0.61
"""Kappa from which agreement is called substantial (Landis and Koch 1977)."""


@dataclass(frozen=True)
class Estimate:
    """A figure with the bounds of its 95 % interval."""

    value: float
    lower: float
    upper: float


def confusion(first, second, grades: tuple[int, int]) -> np.ndarray:
    """Number of windows by grade of the first method (rows) and of the second (columns).

    Grades are integers from 0; a window with a negative grade has none and is left out.
    """
    first, second = (np.asarray(each, int) for each in (first, second))
    known = (first >= 0) & (second >= 0)
    if np.any(first[known] >= grades[0]) or np.any(second[known] >= grades[1]):
        raise InputError(f"a grade lies beyond the {grades[0]} and {grades[1]} that there are")
    flat = np.bincount(first[known] * grades[1] + second[known], minlength=grades[0] * grades[1])
    return flat.reshape(grades)


def kappa(table, weights: str = "quadratic") -> float:
    """Cohen's kappa of a square confusion table: 1 full agreement, 0 that of chance; NaN where chance is certain.

    ``weights`` of a disagreement by d grades: "quadratic" d^2, "linear" d, "none" 1 (Cohen 1968).
    """
    table = np.asarray(table, float)
    if table.ndim != 2 or table.shape[0] != table.shape[1]:
        raise InputError("expected a square table of equal grades", place="kappa")
    distance = np.abs(np.subtract.outer(np.arange(len(table)), np.arange(len(table)))).astype(float)
    powers = {"quadratic": distance**2, "linear": distance, "none": (distance > 0).astype(float)}
    if weights not in powers:
        raise InputError(f"{weights!r} is unknown; expected one of {', '.join(powers)}", place="weights")
    chance = np.outer(table.sum(axis=1), table.sum(axis=0)) / max(table.sum(), 1)
    expected = (powers[weights] * chance).sum()
    return float(1.0 - (powers[weights] * table).sum() / expected) if expected > 0 else float("nan")


def spearman(first, second) -> float:
    """Rank correlation of two series; NaN where one of them does not vary."""
    first, second = (ranks(each) - 0.5 * (len(each) + 1) for each in (first, second))
    spread = np.sqrt((first @ first) * (second @ second))
    return float(first @ second / spread) if spread > 0 else float("nan")


def ranks(values) -> np.ndarray:
    """Ranks from 1 on, equal values sharing the mean of theirs."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(count) - 0.5 * (count - 1))[place]


def blocks(counts: Sequence[int], length: int, rng: np.random.Generator) -> np.ndarray:
    """Indices of one resample of sites laid end to end: blocks of ``length`` places, drawn within each site.

    Circular blocks (Politis and Romano 1992), which draw the ends of a road as often as its middle; every site keeps its number of places.
    """
    answer, offset = [], 0
    for count in counts:
        size = min(length, count)
        starts = rng.integers(0, count, size=-(-count // size))
        places = (starts[:, None] + np.arange(size)).ravel()[:count] % count
        answer.append(offset + places)
        offset += count
    return np.concatenate(answer)


def bootstrap(
    statistic: Callable[..., float],
    series: Sequence[Sequence[np.ndarray]],
    spacing: float,
    *,
    block: float = BLOCK,
    repetitions: int = REPETITIONS,
    seed: int = 0,
) -> Estimate:
    """A statistic of series along the road and its 95 % interval by block bootstrap, sites pooled.

    ``series``: per site a sequence of equally long arrays (places,), ``spacing`` m
    apart; ``statistic`` takes them, sites joined. Resamples in which it is not
    defined are left out. Where a site is shorter than FEWEST blocks there is no interval (NaN).
    """
    joined = [np.concatenate(parts) for parts in zip(*series)]
    counts = [len(site[0]) for site in series]
    rng = np.random.default_rng(seed)
    length = max(1, round(block / spacing))
    drawn: list[float] = []
    for _ in range(repetitions if min(counts) >= FEWEST * length else 0):
        places = blocks(counts, length, rng)
        drawn.append(statistic(*(each[places] for each in joined)))
    return _estimate(statistic(*joined), drawn)


def lag(
    series: Sequence[Sequence[np.ndarray]],
    spacing: float,
    *,
    reach: float = 50.0,
    block: float = BLOCK,
    repetitions: int = REPETITIONS,
    seed: int = 0,
) -> Estimate:
    """By how many metres the first series follows the second: the shift at which their ranks differ least.

    Positive where the first method reacts behind the place that the second
    points at. ``series`` as in ``bootstrap``: per site a pair. The shift is sought within ``reach`` m.
    """
    shifts = np.arange(-round(reach / spacing), round(reach / spacing) + 1)
    edge = int(shifts[-1])
    unlike, counts = [], []
    for first, second in series:
        if len(first) <= 2 * edge + 1:
            raise InputError(f"{len(first) * spacing:g} m are too short to look {reach:g} m back and forth")
        scores = [_scores(each) for each in (first, second)]
        middle = np.arange(edge, len(first) - edge)
        tells = all(each.any() for each in scores)  # where one does not vary, every shift is as good
        unlike.append(np.array([(scores[0][middle] - scores[1][middle - shift]) ** 2 if tells else np.zeros(len(middle)) for shift in shifts]))
        counts.append(len(middle))
    joined = np.concatenate(unlike, axis=1)
    if not joined.any():
        return _estimate(float("nan"), [])
    # One block of all shifts at once: what a resample adds up are sums over blocks, of which those that begin near the end go on at the start.
    rng, length = np.random.default_rng(seed), max(1, round(block / spacing))
    sums = [_sums(each, min(length, each.shape[1])) for each in unlike]
    drawn: list[float] = []
    for _ in range(repetitions if min(counts) >= FEWEST * length else 0):
        chosen = (each[:, rng.integers(0, count, size=max(1, round(count / length)))] for each, count in zip(sums, counts))
        total = sum(each.sum(axis=1) for each in chosen)
        drawn.append(shifts[np.argmin(total)] * spacing)
    return _estimate(float(shifts[np.argmin(joined.sum(axis=1))] * spacing), drawn)


def _sums(values: np.ndarray, size: int) -> np.ndarray:
    """Sums over ``size`` places from each place on, (row, place), round and round."""
    running = np.cumsum(np.concatenate([np.zeros((len(values), 1)), values, values[:, :size]], axis=1), axis=1)
    return running[:, size : size + values.shape[1]] - running[:, : values.shape[1]]


def _scores(values) -> np.ndarray:
    """Ranks with mean 0 and, unless all are equal, variance 1."""
    centred = ranks(values) - 0.5 * (len(values) + 1)
    return centred / (centred.std() or 1.0)


def verdict(estimate: Estimate, limit: float = SUBSTANTIAL) -> str:
    """"holds" where the whole interval reaches the limit, "does not hold" where none of it does,
    else "cannot be said"."""
    if not np.isfinite(estimate.value):
        return "cannot be said"
    if estimate.lower >= limit:
        return "holds"
    return "does not hold" if estimate.upper < limit else "cannot be said"


def _estimate(value: float, drawn) -> Estimate:
    drawn = np.asarray(drawn, float)
    drawn = drawn[np.isfinite(drawn)]
    if not drawn.size:
        return Estimate(float(value), float("nan"), float("nan"))
    return Estimate(float(value), *(float(bound) for bound in np.quantile(drawn, [0.025, 0.975])))


def substantially_similar(estimates: Mapping[str, Estimate]) -> tuple[str, str]:
    """Verdict on "ISO 2631 and IRI are substantially similar" and its reason, from kappas by site and "pooled"."""
    pooled = estimates["pooled"]
    answer = verdict(pooled)
    told = lambda each: f"{each.value:.2f}" if np.isfinite(each.value) else "none"  # noqa: E731
    if not np.isfinite(pooled.value):
        said = "no pooled weighted kappa, for a method knows one grade only"
    elif not np.isfinite(pooled.lower):
        said = f"pooled weighted kappa {told(pooled)} without an interval, for a road is too short"
    else:
        said = f"pooled weighted kappa {told(pooled)} ({pooled.lower:.2f} to {pooled.upper:.2f})"
    reason = f"{said}; substantial from {SUBSTANTIAL:.2f} (Landis and Koch 1977). By site: " + ", ".join(
        f"{site} {told(each)}" for site, each in estimates.items() if site != "pooled"
    )
    return answer, reason
