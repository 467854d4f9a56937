"""What a record shows of instruments and loggers that fail: values at a limit, held, told twice, or alone.

Only samples as they were recorded show it: filters and alignment take it out of sight, and leave an error
that is neither noise nor the vehicle's.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..vocabulary import SIGNALS, VARIABLES

AT_LIMIT, LEVELS, TIMES = 5, 4, 3.0
"""Samples at its largest or smallest value that a signal at a limit has at least, and how many times as many as at any of so many values
next to it, in more than one place: chance leaves the fewest at the end."""

AWAY = 1.0
"""Standard deviation that a limit lies from the mean at least: a signal that rests is not at a limit."""

HELD, STRETCHES = 5, 3
"""Samples in a row that are equal where a value is held, and how often that happens at least."""

COARSE = 5.0
"""Steps by which a signal that changes does so at least (median): where they are coarser, equal and lone values say nothing."""

REGULAR = 0.9
"""Share of the changes of a signal whose values are told several times that lie so many samples apart, or a multiple."""

ALONE, FARTHER, SPIKES = 20.0, 4.0, 3
"""Times the median distance of a sample from the middle of its neighbours, and times the changes around it, that one which stands alone is
away from these; and how many there are at least."""


def found(signals: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> list[str]:
    """What speaks against the inertial ``signals`` of a record, in words; each is (time in s, values in SI units) as recorded."""
    said: dict[str, list[str]] = {}
    for name in SIGNALS:
        time, values = (np.asarray(part, dtype=float) for part in signals[name])
        changes, (levels, counts) = np.abs(np.diff(values)), np.unique(values, return_counts=True)
        if np.any(changes > 0) and np.median(changes[changes > 0]) > COARSE * np.median(np.diff(levels)):
            ends = ("largest", levels[::-1], counts[::-1]), ("smallest", levels, counts)
            stays = [words for end in ends if (words := _at_limit(name, values, *end))] or [_told_again(values) or _held(time, values)]
            for words in (*stays, _alone(time, values)):
                said.setdefault(words, []).append(name)
    return [f"{', '.join(names)}: {words}" for words, names in said.items() if words]


def _at_limit(name: str, values: np.ndarray, which: str, levels: np.ndarray, counts: np.ndarray) -> str:
    """Where a signal is at the first of its ``levels`` again and again, each taken on so often as ``counts`` tells."""
    places = np.count_nonzero(np.diff(np.flatnonzero(values == levels[0])) > 1) + 1
    is_often = counts[0] >= max(AT_LIMIT, TIMES * max(counts[1 : 1 + LEVELS], default=0)) and places > 1
    if not (is_often and abs(levels[0] - values.mean()) > AWAY * values.std()):
        return ""
    return f"{counts[0]} samples are at the {which} value, {levels[0]:.4g} {VARIABLES[name].unit}: does the instrument reach a limit there?"


def _told_again(values: np.ndarray) -> str:
    """Where a slower signal is told in a faster table, each value several times."""
    gaps = np.diff(np.flatnonzero(np.diff(values) != 0.0))
    times = int(np.median(gaps)) if gaps.size else 0
    if times < 2 or gaps.size < len(values) // (2 * times) or np.mean(gaps % times == 0) < REGULAR:
        return ""
    return f"every value stands {times} times in a row: told faster than recorded (expected a table of the instrument's own rate)"


def _held(time: np.ndarray, values: np.ndarray) -> str:
    """Where a value is held as if nothing came from the instrument."""
    equal = np.concatenate([[False], np.diff(values) == 0.0, [False]])
    begin, end = (np.flatnonzero(np.diff(equal.astype(int)) == step) for step in (1, -1))
    is_long = end - begin >= HELD - 1
    if is_long.sum() < STRETCHES:
        return ""
    longest, first = int((end - begin)[is_long].max()) + 1, time[begin[is_long][0]]
    return f"a value is held for up to {longest} samples in {is_long.sum()} places, the first at {first:.2f} s: was the record interrupted?"


def _alone(time: np.ndarray, values: np.ndarray) -> str:
    """Where one sample is far from all around it, as no vehicle moves."""
    before, after = values[1:-3], values[3:-1]
    away = np.abs(values[2:-2] - 0.5 * (before + after))
    around = np.max(np.abs([after - before, before - values[:-4], values[4:] - after]), axis=0, initial=0.0)
    places = np.flatnonzero((away > ALONE * np.median(away)) & (away > FARTHER * around)) + 2
    if places.size < SPIKES:
        return ""
    return f"{places.size} samples stand alone, far from those before and behind, the first at {time[places[0]]:.2f} s: were they transmitted wrongly?"
