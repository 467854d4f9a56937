"""What a search for missing effects holds: refits, rounds, the states of the model, and the selection of it all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from . import floor
from .across import Borne
from .allowance import Allowance
from .exclusion import Excluded
from .experiment import Frame
from .probe import Job, Raw
from .refit import Fit
from .rung import Rung
from .shared import Shared


RESOLUTION = 0.003
"""Share of a size (standard deviation) by which it comes out otherwise in all drives alike, which neither their noise nor the places on the road show:
paths known to a centimetre or two, roads between their points, steps of integration. Of 16 sizes of eight stand-in cars that noise leaves open by
less than 1 % all but one were so close, beyond their noise."""


@dataclass(frozen=True)
class Trial:
    """A candidate refitted: its fit, gains in twice the log-likelihood, shares of the explainable error, and what
    speaks against it."""

    name: str
    shape: Mapping[str, float]
    fit: Fit
    gain: float
    bic: float
    held_out_gain: float
    held_out_z: float
    share: float
    held_out_share: float
    objection: str
    met: bool = True
    """Whether the drives held out have what the candidate acts on."""
    rest_gone: float = float("nan")
    """Share of what repeats have in common yet, all frequencies weighing alike, that it removes; nan where that was not asked, or is nothing for
    certain."""
    before: State | None = None
    after: State | None = None
    """The model without and with it, as far as this refit goes."""


@dataclass(frozen=True)
class Round:
    """One step of the selection: the evidence by candidate, the refits, who won, and who cannot be told from it."""

    names: tuple[str, ...]
    p_value: np.ndarray
    gain: np.ndarray
    absorbed: np.ndarray
    trials: tuple[Trial, ...]
    winner: Trial | None
    cluster: tuple[str, ...]
    correlation: dict[str, float]
    differ_on: dict[str, str]
    """For each of the cluster, the drive on which it differs most from the winner."""
    decoy_p_value: float
    decoy_ranks: bool
    """Whether a decoy is significant and gains more than any candidate."""
    is_large: bool
    """Whether the winner gains so much that the error changes its colour by it."""
    passed_over: Mapping[str, str] = field(default_factory=dict)
    """Why others that are significant were not refitted, or not judged after it, by name; in the first round, why some could not be tested."""
    borne: Borne = Borne()
    """How far repeats bear the winner out among themselves (``across``)."""
    excluded: tuple[Excluded, ...] = ()
    """How large the candidates may be, in a round without a winner."""

    @classmethod
    def empty(cls) -> Round:
        """A round without any candidate that the data could see."""
        nothing = np.zeros(0)
        return cls((), nothing, nothing, nothing, (), None, (), {}, {}, 1.0, False, False)


@dataclass(frozen=True)
class State:
    """The model before or with what was accepted: its name, fit, and mean squares (record, channel) on fitted and held-out records."""

    name: str
    fit: Fit
    squares: np.ndarray
    held_out_squares: np.ndarray

    @classmethod
    def of(cls, rung: Rung, name: str, fit: Fit, check: Mapping[int, np.ndarray]) -> State:
        """The model of a ``fit`` beside the drives of a rung; ``check``: its residuals of those held out."""
        return cls(name, fit, *rung.squares(fit, check))


@dataclass(frozen=True)
class Selection:
    """What the selection found: its rounds, the states of the model from the calibrated one on, the floor, the final frame."""

    rounds: tuple[Round, ...]
    states: tuple[State, ...]
    floor_squares: np.ndarray
    held_out_floor_squares: np.ndarray
    has_repeats: bool
    frame: Frame
    accepted: tuple[str, ...]
    intervals: dict[str, tuple[float, float]]
    sure: frozenset[str]
    """Keys of the sizes that are there at all, with 90 % confidence."""
    final: Fit
    remaining: Shared
    """What all repeats still have in common of their errors; nan without repeats."""
    shared_gone: float
    """Share of what the repeats had in common before the first effect that is gone; nan without repeats."""
    shared_z: float
    """How surely repeats shared any error before the first effect, as a z; nan without repeats."""
    left_z: float
    """How surely more than half of that is left, as a z; nil without repeats."""
    faster_gone: float
    """Share of what the repeats had in common above ``shared.OF_DRIVER`` before the first effect that is gone..."""
    faster_z: float
    """...and how surely they had anything in common there, as a z; nan without repeats."""
    check: Mapping[int, np.ndarray] = field(default_factory=dict)
    """Residuals of the records held out with the last model..."""
    check_frame: Frame | None = None
    """...and their frame; none without such records."""
    birge_ratio: float = 1.0
    """Times by which those drives miss the sizes beyond the errors of both, and by which the intervals are widened (``consistency``)."""
    probed: Mapping[Job, Raw] = field(default_factory=dict)
    """Change of the residuals of the rung that it began from per probe of every size of the candidates."""
    allowed: Mapping[str, Allowance] = field(default_factory=dict)
    """By key of a size of an accepted effect, what its interval has to allow for beside ``intervals`` (``allowance``)."""
    needless: frozenset[str] = frozenset()
    """Names of accepted effects without which the last fit is no worse: nil in ``final``, with no ``intervals``."""
    floor_time_share: Mapping[str, float] = field(default_factory=dict)
    """By signal the least share of the time that holds half of what repeats differ by with the last model (``bursts.of_repeats``); empty
    without repeats."""
    is_floor_known: bool = False
    """Whether any drive was repeated, fitted or held out; ``has_repeats``: whether a fitted one was by another, so that it is known what
    repeats share."""

    @property
    def kept(self) -> tuple[str, ...]:
        """Names of the accepted effects that the last fit does not do without, in the order in which they were found."""
        return tuple(name for name in self.accepted if name not in self.needless)

    def told(self, key: str) -> tuple[float, float]:
        """The interval of a size with what it has to allow for, and no narrower than RESOLUTION."""
        common = Allowance(RESOLUTION * abs(self.final.values[key]))
        return common.widened(self.allowed.get(key, Allowance()).widened(self.intervals[key]))


def shares(selection: Selection, before: State, after: State, *others: Selection | Rung) -> tuple[float, float]:
    """Share of the explainable error of a selection by which two models differ, on fitted and on held-out drives (nan without); above the
    floor of all that are given."""
    given = selection, *others
    floors = (np.minimum.reduce([getattr(one, name) for one in given]) for name in ("floor_squares", "held_out_floor_squares"))
    return removed(selection.states[0], before, after, *floors)


def around(selection: Selection, name: str) -> tuple[State, State]:
    """The models before and after what went when an effect was accepted. What went with needless ones right before it counts as its own, as of any
    that come after the last: those of all that are kept add up to what the last model removes."""
    before = selection.accepted.index(name)
    after = before + 1
    if name in selection.kept:
        after = len(selection.accepted) if name == selection.kept[-1] else after
        while before and selection.accepted[before - 1] in selection.needless:
            before -= 1
    return selection.states[before], selection.states[after]


def shares_of(selection: Selection, name: str) -> tuple[float, float]:
    """Share of the explainable error that went when an effect was accepted (``around``), on fitted and on held-out drives (nan without)."""
    return shares(selection, *around(selection, name))


def removed(
    first: State, before: State, after: State, floor_squares: np.ndarray, held_out_floor_squares: np.ndarray
) -> tuple[float, float]:
    """Share of what was explainable of a ``first`` model by which two others differ, on fitted and on held-out drives (nan without), above these
    floors, (record, channel)."""
    return (
        floor.explained_share(before.squares, after.squares, first.squares, floor_squares),
        floor.explained_share(before.held_out_squares, after.held_out_squares, first.held_out_squares, held_out_floor_squares),
    )
