"""What accepted effects explain of what repeats share (of the error where nothing was repeated), what they leave, and whether that matters."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from . import floor
from .propose import HELD_OUT_Z, SURE
from .selection import Selection, State, around, shares, shares_of
from .shared import shared_error, worth

ENOUGH = 0.5
"""Share of the explainable error below which nothing is named: an effect outside the library would lend it to another."""

DOUBTFUL = 0.8
"""Share of the explainable error below which what was named may be the work of something that is not in the library, and is not named
where repeats surely share an error still."""

SHARED_Z = 3.0
"""z of the error that repeats still share above which something is left to explain."""

LEFT_Z = 2.33
"""z above which more than half of what repeats shared is left, so that something else is missing, too: at a level of 1 %."""

LITTLE = 0.2
"""Share of the explainable error below which what was found may be what a road that is otherwise looks like, or a driver: forces of any
form take up to 0.13 where nothing but noise of the road is wrong."""

SHARED = 0.05
"""Share of the white error in common between repeats below which it may be what alignment left: up to 0.035 in trials where
nothing is missing, 0.06 to 0.14 where something is at a kappa of 0.3."""

IN_WAVES, IN_WAVES_Z = 7.0, 7.0
"""Hz up to which, in waves of some metres, noise of a road's points does not show beside the road itself, and z of an error that repeats
share there from which on it is none: up to 5.7 where the road is noisy by 0.1 mm or interpolated otherwise (8.7 with 0.2 mm, at 30 Hz and
more)."""

SHARED_BAND_Z = 5.0
"""z of an error that repeats share in one band of one signal, of more than a hundred, above which something is left to explain; up to
3.8 where nothing is missing and the road is as its file says, 6.5 where it is interpolated otherwise."""

OF_SIGNAL = 0.05
"""Share of the measured power of a signal up to which an error above the floor is not worth explaining, where no drive was repeated."""

CONFIRMED = 0.25
"""Share of the explainable error of held-out drives below which what was named on the fitted drives is not what is missing."""


@dataclass(frozen=True)
class Balance:
    """What the effects of a selection that stand explain of what repeats share (of the error where nothing was repeated), and what it leaves."""

    share: float
    held_out: float
    explained: float
    is_refuted: bool
    """Whether drives held out, which have what was named, are hardly better for it."""
    is_shared: bool
    """Whether repeats surely share an error still."""
    is_left: bool
    """Whether they share one that is worth explaining."""
    is_little: bool
    """Whether what was found is too little to be what is missing."""
    is_all_that_matters: bool = False
    """Whether it is too little of the explainable error, but more than half of what was worth explaining, of which nothing is left: the rest may be a
    driver's foot and hands."""
    is_most_of_fast: bool = False
    """Whether it is too little of the explainable error, but at least half of what repeats share above ``shared.OF_DRIVER``, and nothing is left that
    is worth explaining."""
    worth_gone: float = float("nan")
    """Share of what repeats share and is worth explaining that is gone..."""
    faster_gone: float = float("nan")
    """...and of what they share above ``shared.OF_DRIVER``."""


def balanced(selection: Selection, notes: Sequence[str], matters: bool, left: float, unnamed: Collection[str] = ()) -> Balance:
    """The balance of a selection; ``notes`` say that the road may be another than that of its file, ``matters`` whether what repeats share
    is worth explaining, ``left`` which share of what was is left (``worth_explaining``). ``unnamed``: effects of its last model that do not stand:
    what went with them is not explained."""
    share, held_out = named_shares(selection, unnamed)
    band = selection.remaining.band
    may_be_road = bool(notes) and not is_slow(selection)  # a road that is another makes errors that repeats share, but fast ones
    in_band = band is not None and band.z > SHARED_BAND_Z and not may_be_road
    still = something_left(selection) or in_band
    is_left = matters and (still or bool(answered(selection)))
    gone = _gone(selection, unnamed)
    # Where hardly anything lies above the floor nobody knows a share of it: what repeats share is asked alone.
    known = gone.shared if np.isnan(share) else share
    explained = max(known, gone.shared) if selection.has_repeats else share
    is_met = all(turn.winner.met for turn in selection.rounds if turn.winner is not None and turn.winner.name not in unnamed)
    is_refuted = is_met and held_out < CONFIRMED
    was_shared = selection.shared_z > SHARED_Z or not selection.has_repeats
    may_be_left = gone.left_z > LEFT_Z or (known < LITTLE and selection.remaining.z > LEFT_Z) or not selection.has_repeats
    enough = ENOUGH if may_be_road else DOUBTFUL  # another road makes errors that repeats share, whatever was named
    is_little = was_shared and ((explained < ENOUGH and may_be_left) or is_refuted) or (known < enough and is_left)
    worth_gone = gone.part * (1.0 - left)
    is_all = is_little and not (matters or held_out <= 0) and worth_gone > ENOUGH
    is_most = is_little and not (matters or is_all or may_be_road or held_out <= 0) and selection.faster_z > SHARED_Z and gone.faster >= ENOUGH
    is_little = is_little and not (is_all or is_most)
    return Balance(share, held_out, explained, is_refuted, still, is_left, is_little, is_all, bool(is_most), worth_gone, gone.faster)


@dataclass(frozen=True)
class _Gone:
    """Share of what repeats had in common that went with the effects that stand, ``shared`` of all of it and ``faster`` of what is faster than a
    driver; ``left_z``: how surely they leave more than half; ``part`` of what went with the last model that they did."""

    shared: float
    faster: float
    left_z: float
    part: float = 1.0


def _gone(selection: Selection, unnamed: Collection[str]) -> _Gone:
    """What went of what repeats had in common, but with the ``unnamed``."""
    found = _Gone(selection.shared_gone, selection.faster_gone, selection.left_z)
    if not (unnamed and selection.has_repeats):
        return found
    of = lambda state: shared_error(selection.frame, state.fit.residuals)
    first, left = of(selection.states[0]), selection.remaining
    for name in unnamed:
        before, after = map(of, around(selection, name))
        found = replace(found, shared=found.shared - (before.power - after.power) / first.power, faster=found.faster - (before.faster - after.faster) / first.faster)
        left = replace(left, by_block=left.by_block + before.by_block - after.by_block)
    part = found.shared / selection.shared_gone if selection.shared_gone > 0 else 0.0
    return replace(found, left_z=left.left_z(first, 1.0 - ENOUGH), part=float(np.clip(part, 0.0, 1.0)))


def named_shares(selection: Selection, unnamed: Collection[str]) -> tuple[float, float]:
    """Share of the explainable error that the last model removes, fitted and held out (nan without), less what went with the ``unnamed``."""
    if unnamed and set(unnamed) >= set(selection.kept):  # nothing is left of it but what rounding does
        return 0.0, 0.0 * total_shares(selection)[1]
    without = [shares_of(selection, name) for name in unnamed]
    fitted, held_out = (whole - sum(parts) for whole, *parts in zip(total_shares(selection), *without))
    return fitted, held_out


def total_shares(selection: Selection) -> tuple[float, float]:
    """Share of the explainable error that all accepted effects remove together, fitted and held out (nan without)."""
    return shares(selection, selection.states[0], selection.states[-1])


def worth_explaining(selection: Selection, measured: Mapping[int, np.ndarray]) -> tuple[bool, bool, float]:
    """Whether what repeats share was worth explaining before anything was found, whether it is yet, by the signals (channel, sample) that were
    ``measured`` in every record, and what share of it is left (nan where it never was); where nothing was repeated, whether what the model leaves
    of any signal above the floor was and is (nan)."""
    first, last = selection.states[0], selection.states[-1]
    if selection.has_repeats:
        was, now = (worth(selection.frame, state.fit.residuals, measured) for state in (first, last))
        return was.matters, now.matters, now.left_of(was)
    power = floor.squares(selection.frame.experiment, measured)
    was, now = (bool(np.any(state.squares - selection.floor_squares > OF_SIGNAL * power)) for state in (first, last))
    return was, now, float("nan")


def something_left(selection: Selection) -> bool:
    """Whether repeats share an error that the last model does not explain; False without repeats."""
    return bool(selection.remaining.z > SHARED_Z and selection.remaining.share > SHARED)


def may_share(selection: Selection) -> bool:
    """Whether repeats share an error still, in all, however little of it, or in one band of one signal, whatever the road may be."""
    band = selection.remaining.band
    return selection.remaining.z > SHARED_Z or (band is not None and band.z > SHARED_BAND_Z)


def answered(selection: Selection) -> list[str]:
    """Names of candidates that make surely something better, on fitted drives and on those held out, where nothing was accepted or
    repeated: what is left is more than noise."""
    if selection.has_repeats or selection.accepted or not selection.rounds:
        return []
    turn = selection.rounds[-1]
    p_value = dict(zip(turn.names, turn.p_value))
    return [trial.name for trial in turn.trials if p_value[trial.name] <= SURE and trial.held_out_z > HELD_OUT_Z]


def is_slow(selection: Selection) -> bool:
    """Whether what repeats share most surely is too slow to be noise of the road's points or what lies between them."""
    band = selection.remaining.band
    return band is not None and band.upper <= IN_WAVES and band.z > IN_WAVES_Z
