"""What a record shows of instruments and loggers that fail: values at a limit, held, told twice, or alone.

Only samples as they were recorded show it: filters and alignment take it out of sight, and leave an error
that is neither noise nor the vehicle's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..vocabulary import SIGNALS, STANDARD_GRAVITY, VARIABLES

AT_LIMIT, LEVELS, TIMES = 5, 4, 3.0
"""Samples at its largest or smallest value that a signal at a limit has at least, and how many times as many as at any of so many values
next to it, in more than one place: chance leaves the fewest at the end."""

AWAY = 1.0
"""Standard deviation that a limit lies from the mean at least: a signal that rests is not at a limit."""

HELD, STRETCHES = 5, 3
"""Samples in a row that are equal where a value is held, and how often that happens at least."""

FROZEN, LONG = 0.1, 0.5
"""s from which on a value that is held once is told, too: where all six signals are, and where one is."""

BESIDE = 3
"""Changes before and behind a value that is held that must not be COARSE either (median): a signal that comes to rest slowly, as at the
crest of a bend or in a vehicle that is parked, is held by its steps."""

STANDING = 0.5
"""m/s, the mean speed up to which a vehicle stands: what it feels may be the same then."""

COARSE = 5.0
"""Steps by which a signal that changes does so at least (median): where they are coarser, equal and lone values say nothing."""

REGULAR = 0.9
"""Share of the changes of a signal whose values are told several times that lie so many samples apart, or a multiple."""

AGAIN, EVEN = 0.15, 0.99
"""Share of values that are those before them from which on a signal is told faster than recorded, chance leaving less than a tenth where
changes are COARSE; and share of stretches without a change that then last the mean or the sample beside it: where a calm road leaves values
equal by chance, some last longer."""

ALONE, FARTHER, SPIKES, SHAKEN = 20.0, 4.0, 3, 4.0
"""Times the median distance of a sample from the middle of its neighbours, and times the changes around it, that one which stands alone is
away from these; how many there are at least; and times the median by which another signal changes around one that a blow has made: an edge
that a wheel meets in braking is felt for a sample along the road, and for some up and down."""

FALLS, LOST = 0.5, 3
"""Share of standard gravity that a_z holds on average from which on one of exactly 0 is lost, if those before and behind hold so much: no body falls and
is caught within a sample. And samples in a row in which all six signals are exactly 0 otherwise: finely told ones are so by chance once in a
million."""

WILD, BULK, MOMENT, BACK = 10.0, 0.99, 0.03, 3
"""Times the BULK of all distances from the median by which a value is wild if that lasts for a MOMENT (s) at most, and so many samples before and
behind it are within a third of that: what road and potholes shake is up to 4 times as far, and a body goes on moving behind one."""


def found(quantities: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> list[str]:
    """What speaks against the inertial signals among the ``quantities`` of a record, in words; each is (time in s, values in SI units) as
    recorded. Where ``v_x`` or ``s`` is among them, too, nothing is held while the vehicle stands; a ``v_x`` that is held for LONG is told as well."""
    signals = {name: tuple(np.asarray(part, dtype=float) for part in quantities[name]) for name in SIGNALS}
    steps = {name: step for name, (_, values) in signals.items() if (step := _step(values))}
    again = {name: _told_again(signals[name][1]) for name in steps}
    frozen = [] if any(again.values()) else _frozen(signals, steps, quantities)
    said: dict[str, list[str]] = {_in_words(frozen): list(SIGNALS)} if frozen else {}
    lost, held = _lost(signals, quantities), list(frozen)
    for name, (time, values) in signals.items():
        kept = ~lost.covers(time) if lost and name in lost.names else np.full(time.size, True)
        wild = _wild(time[kept], values[kept])
        if name not in steps:
            said.setdefault(wild, []).append(name)
            continue
        step = steps[name]
        levels, counts = np.unique(values, return_counts=True)
        ends = ("largest", levels[::-1], counts[::-1]), ("smallest", levels, counts)
        stays = [words for end in ends if (words := _at_limit(name, values, *end))]
        if not stays and not again[name]:
            own = _held(_holds(time, values, np.diff(values) == 0.0, step, quantities), frozen)
            held, stays = [*held, *own], [_in_words(own)] if own else []
        others = [signals[other] for other in SIGNALS if other != name]
        for words in (*(stays or [again[name]]), _alone(time, values, others) or wild):
            said.setdefault(words, []).append(name)
    if lost and (unheld := lost.beside(held)):
        said.setdefault(unheld.words(), []).extend(unheld.names)
    if "v_x" in quantities and (stands := _speed_held(*quantities["v_x"])):
        said.setdefault(stands, []).append("v_x")
    return [f"{', '.join(names)}: {words}" for words, names in said.items() if words]


def _step(values: np.ndarray) -> float:
    """The step that a signal is told in where it changes by more than COARSE of them, else 0."""
    changes = np.abs(np.diff(values))
    step = float(np.median(np.diff(np.unique(values)))) if np.any(changes > 0) else 0.0
    return step if step and np.median(changes[changes > 0]) > COARSE * step else 0.0


def _at_limit(name: str, values: np.ndarray, which: str, levels: np.ndarray, counts: np.ndarray) -> str:
    """Where a signal is at the first of its ``levels`` again and again, each taken on so often as ``counts`` tells."""
    places = np.count_nonzero(np.diff(np.flatnonzero(values == levels[0])) > 1) + 1
    is_often = counts[0] >= max(AT_LIMIT, TIMES * max(counts[1 : 1 + LEVELS], default=0)) and places > 1
    if not (is_often and abs(levels[0] - values.mean()) > AWAY * values.std()):
        return ""
    return f"{counts[0]} samples are at the {which} value, {levels[0]:.4g} {VARIABLES[name].unit}: does the instrument reach a limit there?"


def _told_again(values: np.ndarray) -> str:
    """Where a slower signal is told in a faster table, each value several times, or some once more than others."""
    gaps = np.diff(np.flatnonzero(np.diff(values) != 0.0))
    times = int(np.median(gaps)) if gaps.size else 0
    instead = "told faster than recorded (expected a table of the instrument's own rate)"
    if times >= 2 and gaps.size >= len(values) // (2 * times) and np.mean(gaps % times == 0) >= REGULAR:
        return f"every value stands {times} times in a row: {instead}"
    share = np.mean(np.diff(values) == 0.0)
    mean = 1.0 / (1.0 - share) if share < 1.0 else np.inf
    usual = gaps[gaps <= np.quantile(gaps, REGULAR)] if gaps.size else gaps  # without what is held
    is_even = gaps.size > 0 and np.mean(np.abs(gaps - mean) < 1.0) >= EVEN and usual.mean() > 1.0 + 0.5 * AGAIN
    return f"every value stands {mean:.2g} times on average: {instead}" if share > AGAIN and is_even else ""


@dataclass(frozen=True)
class _Hold:
    """A stretch of a record, from ``begin`` to ``end`` in s, in so many ``samples`` of which nothing changes."""

    begin: float
    end: float
    samples: int

    def meets(self, others: Sequence[_Hold]) -> bool:
        """Whether it overlaps any of these."""
        return any(self.begin <= other.end and other.begin <= self.end for other in others)


@dataclass(frozen=True)
class _Lost:
    """Where signals of these ``names`` are exactly 0 as if samples had been lost and filled."""

    names: Sequence[str]
    places: Sequence[_Hold]

    def covers(self, time: np.ndarray) -> np.ndarray:
        """Which of these times (s) lie within a place, (time,)."""
        return np.any([(place.begin <= time) & (time <= place.end) for place in self.places], axis=0)

    def beside(self, held: Sequence[_Hold]) -> _Lost | None:
        """The same beside where a value is ``held``, by nought or another; None where nothing is left."""
        places = [place for place in self.places if not place.meets(held)]
        return _Lost(self.names, places) if places else None

    def words(self) -> str:
        """How many there are, and where the first."""
        samples = sum(place.samples for place in self.places)
        what = "samples are" if samples > 1 else "sample is"
        return f"{samples} {what} exactly 0, the first at {self.places[0].begin:.2f} s: lost, and filled with noughts?"


def _holds(time: np.ndarray, values: np.ndarray, equal: np.ndarray, step: float, quantities: Mapping) -> list[_Hold]:
    """Where HELD samples and more are ``equal`` (samples - 1,) to the one before though the vehicle moves and the signal was changing by more
    than COARSE of its ``step`` until then, and does so from then on; at an end of the record one of these will do."""
    holds, changes = [], np.abs(np.diff(values))
    for begin, end in _runs(equal):
        hold = _Hold(float(time[begin]), float(time[end]), int(end - begin) + 1)
        before, behind = (beside[beside > 0] for beside in (changes[max(begin - BESIDE, 0) : begin], changes[end : end + BESIDE]))
        is_quick = [beside.size > 0 and np.median(beside) > COARSE * step for beside in (before, behind)]
        if hold.samples >= HELD and (is_quick[0] or begin == 0) and (is_quick[1] or end == changes.size) and _moves(quantities, hold):
            holds.append(hold)
    return holds


def _runs(marked: np.ndarray) -> list[tuple[int, int]]:
    """Where samples in a row are ``marked`` (sample,): the first of each run, and the one behind its last."""
    sides = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return list(zip(sides[::2].tolist(), sides[1::2].tolist()))


def _speed_held(time: np.ndarray, speed: np.ndarray) -> str:
    """Where a speed is held for LONG though the vehicle moves."""
    time, speed = np.asarray(time, dtype=float), np.asarray(speed, dtype=float)
    step = _step(speed)
    holds = _holds(time, speed, np.diff(speed) == 0.0, step, {"v_x": (time, speed)}) if step else []
    long = [hold for hold in holds if hold.end - hold.begin >= LONG]
    return _in_words(long) if long else ""


def _moves(quantities: Mapping, hold: _Hold) -> bool:
    """Whether a vehicle moves meanwhile; taken for granted where nothing tells."""
    time = np.linspace(hold.begin, hold.end, hold.samples)
    if "v_x" in quantities:
        return abs(float(np.interp(time, *quantities["v_x"]).mean())) > STANDING
    return "s" not in quantities or np.ptp(np.interp(time, *quantities["s"])) > STANDING * (hold.end - hold.begin)


def _frozen(signals: Mapping, steps: Mapping[str, float], quantities: Mapping) -> list[_Hold]:
    """Where all six signals are held at once for FROZEN, by any of those with ``steps``."""
    for name, step in steps.items():
        time, values = signals[name]
        middle = 0.5 * (time[1:] + time[:-1])
        here = lambda clock, own: (np.diff(own) == 0.0)[np.clip(np.searchsorted(clock, middle) - 1, 0, own.size - 2)]
        equal = np.all([here(*signal) for signal in signals.values()], axis=0)
        holds = [hold for hold in _holds(time, values, equal, step, quantities) if hold.end - hold.begin >= FROZEN]
        if holds:
            return holds
    return []


def _held(holds: Sequence[_Hold], frozen: Sequence[_Hold]) -> list[_Hold]:
    """Where a value is held as if nothing came from the instrument, beside where all are ``frozen``."""
    own = [hold for hold in holds if not hold.meets(frozen)]
    is_told = len(own) >= STRETCHES or any(hold.end - hold.begin >= LONG for hold in own)
    return own if is_told else []


def _in_words(holds: Sequence[_Hold]) -> str:
    longest = max(holds, key=lambda hold: hold.samples)
    if len(holds) == 1:
        return f"a value is held for {longest.samples} samples, {longest.begin:.2f} to {longest.end:.2f} s: did the instrument freeze, or was the record interrupted?"
    return f"a value is held for up to {longest.samples} samples in {len(holds)} places, the first at {holds[0].begin:.2f} s: was the record interrupted?"


def _alone(time: np.ndarray, values: np.ndarray, others: Sequence[tuple[np.ndarray, np.ndarray]]) -> str:
    """Where one sample is far from all around it and none of the ``others`` (time, values) is shaken there, as no vehicle moves."""
    away = np.abs(values[2:-2] - 0.5 * (values[1:-3] + values[3:-1]))
    places = np.flatnonzero((away > ALONE * np.median(away)) & (away > FARTHER * _around(values))) + 2
    if places.size < SPIKES:
        return ""
    for its_time, its_values in others:
        changes = _around(its_values)
        there = np.clip(np.searchsorted(its_time, time[places]) - 2, 0, changes.size - 1)
        usual = np.median(changes)
        places = places[changes[there] <= SHAKEN * usual] if usual > 0 else places  # one that rests tells nothing
    if places.size < SPIKES:
        return ""
    return f"{places.size} samples stand alone, far from those before and behind, the first at {time[places[0]]:.2f} s: were they transmitted wrongly?"


def _around(values: np.ndarray) -> np.ndarray:
    """The largest change beside every sample but the first and last two, itself left out."""
    before, after = values[1:-3], values[3:-1]
    return np.max(np.abs([after - before, before - values[:-4], values[4:] - after]), axis=0, initial=0.0)


def _wild(time: np.ndarray, values: np.ndarray) -> str:
    """Where a few samples are farther from all others than any motion, and these are as if nothing had been."""
    away = np.abs(values - np.median(values))
    usual = float(np.quantile(away, BULK))
    levels = np.unique(values[away <= usual])
    steps = np.diff(levels) if levels.size > 1 else np.sort(np.diff(np.unique(values)))[:1]
    usual += float(np.median(steps)) if steps.size else 0.0  # what is less than a step is told as none
    if not usual > 0:
        return ""
    most = max(1, round(MOMENT * (len(time) - 1) / (time[-1] - time[0])))
    wild = []
    for begin, end in _runs(away > WILD * usual):
        beside = np.concatenate([away[max(begin - BACK, 0) : begin], away[end : end + BACK]])
        if end - begin <= most and beside.size and beside.max() < WILD / 3.0 * usual:
            wild.append((begin, end))
    if not wild:
        return ""
    samples, first = sum(end - begin for begin, end in wild), wild[0][0]
    farthest = max(float(np.max(away[begin:end])) for begin, end in wild) / usual
    where = f"{samples} samples lie" if samples > 1 else "a sample lies"
    return f"{where} up to {farthest:.0f} times as far out as 99 % of all do, the first at {time[first]:.2f} s: transmitted wrongly?"


def _lost(signals: Mapping, quantities: Mapping) -> _Lost | None:
    """Signals that are exactly 0 for some samples as if these had been lost and filled."""
    time, a_z = signals["a_z"]
    is_one_clock = all(values.size == a_z.size for _, values in signals.values())
    all_nought = np.all([values == 0.0 for _, values in signals.values()], axis=0) if is_one_clock else np.full(a_z.size, False)
    holds_gravity = abs(a_z.mean()) > FALLS * STANDARD_GRAVITY
    if not holds_gravity and not all(map(_step, (values for _, values in signals.values()))):
        return None
    nought, runs = a_z == 0.0 if holds_gravity else all_nought, []
    for begin, end in _runs(nought):
        beside = np.concatenate([a_z[max(begin - 1, 0) : begin], a_z[end : end + 1]])
        is_lost = np.all(np.abs(beside) > FALLS * STANDARD_GRAVITY) if holds_gravity else end - begin >= LOST
        if is_lost and (holds_gravity or _moves(quantities, _Hold(float(time[begin]), float(time[end - 1]), int(end - begin)))):
            runs.append((begin, end))
    if not runs:
        return None
    names = SIGNALS if all(all_nought[begin:end].all() for begin, end in runs) else ("a_z",)
    return _Lost(names, [_Hold(float(time[begin]), float(time[end - 1]), end - begin) for begin, end in runs])
