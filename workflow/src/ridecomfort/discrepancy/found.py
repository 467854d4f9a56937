"""The effects that a selection found, with their sizes, intervals and evidence, as a verdict names them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from .allowance import Allowance
from .experiment import Candidate, Size
from .selection import Round, Selection, shares_of
from .tries import LEAST_MOVED
from .verdict import Named


def found_effects(selection: Selection, by_name: Mapping[str, Candidate]) -> list[Named]:
    """Those of the accepted that are among the candidates ``by_name``."""
    return [_named(selection, number, by_name) for number, name in enumerate(selection.accepted) if name in by_name]


def told_apart(effects: Sequence[Named]) -> list[Named]:
    """The effects without each other among what they are not told from: what is there beside another is no other name of it."""
    names = {effect.name for effect in effects}
    return [replace(effect, like=tuple(name for name in effect.like if name not in names)) for effect in effects]


def turn_of(selection: Selection, name: str) -> Round:
    """The round that accepted an effect."""
    return next(turn for turn in selection.rounds if turn.winner is not None and turn.winner.name == name)


def _named(selection: Selection, number: int, by_name: Mapping[str, Candidate]) -> Named:
    turn = selection.rounds[number]
    winner = turn.winner
    place = turn.names.index(winner.name)
    sizes = []
    for size in (*by_name[winner.name].sizes, *by_name[winner.name].shaping):
        if size.key in selection.intervals:
            sizes.append(_size(size, selection))
    held = [
        _held(size, selection.final.values.get(size.key, size.neutral))
        for size in by_name[winner.name].shaping
        if size.key not in selection.intervals
    ]
    like = tuple(name for name in turn.cluster if name in by_name)
    return Named(
        winner.name, tuple(sizes), by_name[winner.name].sentence, float(turn.p_value[place]),
        *shares_of(selection, winner.name), float(turn.absorbed[place]), like, turn.differ_on, by_name[winner.name].instrument, tuple(held),
        _is_open(selection, by_name[winner.name]),
    )  # fmt: skip


def _is_open(selection: Selection, candidate: Candidate) -> bool:
    intervals = [(size.neutral, selection.told(size.key)) for size in candidate.sizes if size.key in selection.intervals]
    return bool(intervals) and all(lower <= neutral <= upper for neutral, (lower, upper) in intervals)


def _size(size: Size, selection: Selection) -> dict:
    value, interval = selection.final.values[size.key], selection.intervals[size.key]
    allowed = selection.allowed.get(size.key, Allowance())
    return {
        "parameter": size.key.partition(".")[2] or size.key,
        "size": float(value),
        "unit": size.unit,
        "interval": [float(end) for end in selection.told(size.key)],
        "interval_of_noise": [float(end) for end in interval],
        "allows_for": allowed.name if allowed.is_notable(interval) else "",
        "plausible": [float(size.lower), float(size.upper)],
        "is_plausible": size.holds(value),
        "is_shaping": size.shaping,
    }


def _held(size: Size, value: float) -> dict:
    is_typical = abs(value - size.neutral) < LEAST_MOVED * size.probe
    return {
        "parameter": size.key.partition(".")[2],
        "size": float(size.neutral if is_typical else value),
        "unit": size.unit,
        "is_typical": bool(is_typical),
    }
