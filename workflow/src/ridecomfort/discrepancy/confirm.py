"""What drives held out say of a refit, what speaks against it, and which of several refits is the best."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..errors import InputError
from . import experiment as exp
from . import floor, realign, refit
from .balance import SHARED_Z
from .experiment import Candidate
from .propose import HELD_OUT_Z
from .refit import Fit
from .rung import Rung, roles
from .selection import State, Trial, removed
from .shared import shared_power
from .tries import implausible

LEAST_SHARE = 0.02
"""Share of the explainable error below which an effect is not worth naming..."""

MOST_OF_REST = 0.5
"""...but for one that takes this share of what is left of it: beside a large effect another of the size of the noise may be some thousandths..."""

OF_SHARED = 0.25
"""...or, after a first one, this share of what repeats have in common yet, all frequencies weighing alike: links against diving took 0.2 % of the
error beside friction that took 99 %, and 43 % of that; what was not there up to 2 %."""

LEAST_UNMET = 0.2
"""The same where no drive held out meets what the effect acts on: a stop that was found once where nothing was missing removed 3 %."""

WEAK = 16.0
"""White power of what an effect changes on the held-out drives below which even the true effect misses HELD_OUT_Z half of the time: if
it is there their loss falls by that power on average, with a standard deviation of twice its root; if not, it rises by as much. Below
this a fall beyond chance (ABSENT_Z) confirms an effect that the fitted drives leave no doubt of. A first effect is confirmed so at any
power; a later one, which may be what the shape of those before it leaves on all drives, must reach HELD_OUT_Z."""

ABSENT_Z = 1.645
"""z of that chance: one in twenty."""

MET = 0.01
"""White power of what an effect does to a drive held out, against that on a fitted one, below which the first cannot decide on it."""

EQUAL = 0.02
"""Share of the explainable error by which two explanations that count as equal may differ."""


@dataclass(frozen=True)
class Confirmation:
    """Judges refits of ``candidates`` (by name) from a ``rung``. ``first``: the model before any effect, whose explainable error shares are of;
    ``rare``: names that act at few places; ``certain``: those that the fitted drives leave no doubt of; ``is_first``: whether none is
    accepted yet."""

    rung: Rung
    candidates: Mapping[str, Candidate]
    first: State
    rare: Collection[str]
    certain: Collection[str]
    is_first: bool

    def __call__(self, trial: Trial) -> Trial | None:
        """A trial with what it does to the drives held out; None where these cannot be simulated."""
        rung, candidate, fit = self.rung, self.candidates[trial.name], trial.fit
        held_out = roles(rung.experiment)[1]
        held_out_gain, held_out_z, is_weak = float("nan"), float("nan"), False
        try:
            check = exp.simulate(rung.experiment, fit.values, held_out)
            if rung.check_frame is not None:
                check, _ = realign.closer(rung.experiment, fit.values, check, rung.check_frame)
                held_out_gain, held_out_z, is_weak = self._held_out_gain(candidate.name, check)
            met = not held_out or candidate.name not in self.rare or held_out_z > HELD_OUT_Z or self._meets(candidate, fit)
        except (InputError, ValueError):
            return None
        if not met:
            held_out_gain, held_out_z = float("nan"), float("nan")
        now, before, first = State.of(rung, candidate.name, fit, check), State.of(rung, "", rung.fit, rung.check), self.first
        share, held_out_share = removed(first, before, now, rung.floor_squares, rung.held_out_floor_squares)
        trial = replace(
            trial, held_out_gain=held_out_gain, held_out_z=held_out_z, share=share, held_out_share=held_out_share, met=met,
            before=before, after=now,
        )  # fmt: skip
        if met and not share >= LEAST_SHARE and rung.has_repeats and not self.is_first:
            trial = replace(trial, rest_gone=self._rest_gone(fit))
        left = floor.explained_share(before.squares, rung.floor_squares, first.squares, rung.floor_squares)
        return replace(trial, objection=objection(trial, candidate, is_weak, left))

    def _rest_gone(self, fit: Fit) -> float:
        """Share of what repeats have in common that is gone with a ``fit``; nan where they have nothing for certain."""
        before, z = self._rest
        return 1.0 - shared_power(self.rung.frame, fit.residuals)[0] / before if z > SHARED_Z else float("nan")

    @cached_property
    def _rest(self) -> tuple[float, float]:
        """What repeats have in common yet, and its z."""
        return shared_power(self.rung.frame, self.rung.fit.residuals)

    def _held_out_gain(self, name: str, held: Mapping[int, np.ndarray]) -> tuple[float, float, bool]:
        """What residuals of the drives held out gain against those of the rung, the z of that, and whether it is too weak to reach HELD_OUT_Z
        and yet confirms the effect of this name."""
        frame, before = self.rung.check_frame, self.rung.check
        gain = refit.information(frame, held) - refit.information(frame, before)
        fall, z = refit.advantage(frame, held, before)
        change = frame.flat(held) - frame.flat(before)
        size = float(change @ change)
        is_there = fall > 2.0 * ABSENT_Z * np.sqrt(size) - size
        return gain, z, name in self.certain and is_there and (self.is_first or size < WEAK)

    def _meets(self, candidate: Candidate, fit: Fit) -> bool:
        """Whether any drive held out has what the candidate acts on, a stop that is reached for example."""
        powers = []
        fitted, held_out = roles(self.rung.experiment)
        for frame, indices in ((self.rung.frame, fitted), (self.rung.check_frame, held_out)):
            with_it, without = (
                exp.simulate(self.rung.experiment, values, indices) for values in (fit.values, {**fit.values, **candidate.at({})})
            )
            powers.append(np.sum(frame.flat({i: with_it[i] - without[i] for i in indices}) ** 2) / len(indices))
        return powers[1] > MET * powers[0]


def objection(trial: Trial, candidate: Candidate, is_weak: bool, left: float) -> str:
    """What speaks against a trial, in words; empty where nothing does. ``is_weak``: whether drives held out that are not sure confirm it;
    ``left``: share of the explainable error that is left before it."""
    outside = implausible(candidate, trial.fit.values)
    if outside:
        return outside
    if trial.bic <= 0:
        return "not worth its sizes (BIC)"
    if np.isfinite(trial.held_out_gain):
        enough = trial.held_out_z > HELD_OUT_Z or is_weak and trial.held_out_z > 0 and not trial.held_out_share <= 0
        if not (trial.held_out_gain > 0 and enough):
            return "not surely better on drives held out"
    is_most_of_rest = trial.met and (trial.share > MOST_OF_REST * left or trial.rest_gone > OF_SHARED)
    if np.isnan(trial.share) and trial.rest_gone <= OF_SHARED:  # hardly anything lies above the floor, and repeats share something for certain
        return f"removes {100 * trial.rest_gone:.1f} % of what repeats share yet"
    if trial.share < (LEAST_SHARE if trial.met else LEAST_UNMET) and not is_most_of_rest:
        return f"removes {100 * trial.share:.1f} % of the explainable error" + ("" if trial.met else ", and no drive held out meets it")
    return ""


def best(trials: Sequence[Trial], simpler: Collection[str] = ()) -> Trial | None:
    """The trial with the most merit of those that nothing speaks against; one that explains more of the drives it was fitted to, and of those
    held out by likelihood and by share, goes before it: where a rough patch holds most of an error few blocks count, and the z of the
    right damper was 1.9 beside a tyre that explained less than half as much. What is ``simpler`` goes before what explains no EQUAL more."""
    sound = [trial for trial in trials if not trial.objection]
    first = max(sound, key=_merit, default=None)
    explained = lambda trial: np.array([trial.bic, trial.held_out_gain, trial.held_out_share])
    is_more = lambda trial: np.all((explained(trial) > explained(first))[np.isfinite(explained(first))])  # a drive held out that says nothing aside
    most = max((trial for trial in sound if is_more(trial)), key=_merit, default=first)
    alike = (trial for trial in sound if trial.name in simpler and not _explains_more(most, trial))
    return most if most is None or most.name in simpler else max(alike, key=_merit, default=most)


def _explains_more(one: Trial, other: Trial) -> bool:
    """Whether one trial removes EQUAL more than another of the explainable error, on fitted drives or on those held out, if any."""
    return one.share > other.share + EQUAL or one.held_out_share > other.held_out_share + EQUAL


def _merit(trial: Trial) -> tuple[bool, float]:
    """What the drives held out confirm goes before what they do not refute."""
    unasked = not np.isfinite(trial.held_out_gain)
    return unasked or trial.held_out_z > HELD_OUT_Z, trial.bic + (0.0 if unasked else trial.held_out_gain)
