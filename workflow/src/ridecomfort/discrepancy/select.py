"""From a library of candidates to the effects that are missing: proposed on fitted drives, decided on held-out ones.

Forward selection. Each round tests every candidate on the white residual of the present
model, refits the best few together with all that is calibrated, and keeps one only if it
is significant over the whole library, plausible in size, worth its parameters (BIC) and
makes drives better that it was never fitted to.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import InputError
from . import cluster, event, floor, probe, realign, refit
from . import experiment as exp
from .consistency import birge_ratio
from .experiment import Candidate, Experiment, Frame
from .probe import Job, Raw
from .propose import HELD_OUT_Z, Proposal, propose
from .refit import Fit
from .rung import Rung, awake, begin, climb, final_fit, roles
from .selection import Round, Selection, State, Trial
from .shared import Shared, shared_error
from .tries import LEAST_MOVED, Tries, implausible, own_sizes

EFFECTS = 5
"""Effects that are looked for, one after another. Cars of other programs differ from the model in three or four things at once, beside which
one more may be missing; a search that ends before them leaves more than half of the error, and what it found has no name."""

LEAST_SHARE = 0.02
"""Share of the explainable error below which an effect is not worth naming..."""

MOST_OF_REST = 0.5
"""...but for one that takes this share of what is left of it: beside a large effect another of the size of the noise may be some thousandths."""

LEAST_UNMET = 0.2
"""The same where no drive held out meets what the effect acts on: a stop that was found once where nothing was missing removed 3 %."""

PROPOSED = 5
"""Candidates that are refitted in a round."""

MINOR = 0.05
"""Share of the largest gain of a round's refits below which one is followed up only where none above it will do."""

WEAK = 16.0
"""White power of what an effect changes on the held-out drives below which even the true effect misses HELD_OUT_Z half of the time: if
it is there their loss falls by that power on average, with a standard deviation of twice its root; if not, it rises by as much. Below
this a fall beyond chance (ABSENT_Z) confirms an effect that the fitted drives leave no doubt of. A first effect is confirmed so at any
power; a later one, which may be what the shape of those before it leaves on all drives, must reach HELD_OUT_Z."""

ABSENT_Z = 1.645
"""z of that chance: one in twenty."""

MET = 0.01
"""White power of what an effect does to a drive held out, against that on a fitted one, below which the first cannot decide on it."""

SETTLED, FAR = 3, 0.25
"""Refits of a round that are settled, the best, and share of the largest gain below which none catches up. From there on shapes are
fitted, too, if that is no less than LEAST_SHARE of the first effect's."""

EQUAL = 0.02
"""Share of the explainable error by which two explanations that count as equal may differ."""

ALIAS, LEAST_OWN = 0.05, 0.01
"""Share of the power that nuisances must leave of an error of an instrument or of what a tyre feels of the road, below which it is one
of them under another name, and of any other effect, which may be much like one and yet be there."""


def select(
    experiment: Experiment,
    start: Mapping[str, float],
    *,
    each: Callable = map,
    **settings,
) -> Selection:
    """Find missing effects from ``start`` (values of the calibrated model); ``settings`` as for ``search``."""
    return search(begin(experiment, start, each), each=each, **settings)


def search(
    rung: Rung,
    *,
    most: int = EFFECTS,
    seed: int = 0,
    each: Callable = map,
    together: Callable[[Sequence[str], str], bool] = lambda accepted, other: True,
    say: Callable[[str], None] = lambda words: None,
    few: float = event.FEW,
    simpler: Collection[str] = (),
    probed: Mapping[Job, Raw] = {},
) -> Selection:
    """Find up to ``most`` missing effects from a ``rung``.

    ``each`` maps a function over candidates (``map`` or that of a pool); ``together`` says whether a candidate may follow those
    accepted, by their names; ``say`` is told what goes on; ``few``: as for ``propose``. ``simpler``: names that go before any other which
    explains hardly more. ``probed``: columns of candidates that are known from a search from the same rung.
    """
    return _Search(rung, most, seed, each, together, say, few, simpler, probed).run()


@dataclass
class _Search:
    rung: Rung
    most: int
    seed: int
    each: Callable
    together: Callable
    say: Callable
    few: float = event.FEW
    simpler: Collection[str] = ()
    probed: Mapping[Job, Raw] = field(default_factory=dict)
    accepted: list[str] = field(default_factory=list)
    shaped: set[str] = field(default_factory=set)
    """Keys of what shapes accepted effects and is fitted."""
    rounds: list[Round] = field(default_factory=list)

    def __post_init__(self):
        self.fitted, self.held_out = roles(self.rung.experiment)
        self.by_name = {candidate.name: candidate for candidate in self.rung.experiment.candidates}

    def run(self) -> Selection:
        states = [self._state("calibrated", self.rung.fit, self.rung.check)]
        self.first = states[0]
        self.say("probing every candidate")
        self.sooner, residuals = self._sooner()
        self.columns = self._probe(residuals)
        rounds = self.rounds
        while len(self.accepted) < self.most:
            turn = self._round(len(rounds))
            rounds.append(turn)
            if turn.winner is None:
                break
            self.accepted.append(turn.winner.name)
            self.shaped |= {size.key for size in self.by_name[turn.winner.name].shaping if size.key in turn.winner.fit.keys}
            self.say(f"accepted {turn.winner.name}")
            self.columns = {job: own for job, own in self.columns.items() if self.together(self.accepted, job[0])}
            self.rung = climb(
                self.rung.experiment, turn.winner.fit.values, self._sizes(), self.each, before=self.rung
            )
            self.rung = awake(self.rung, self._sizes(), self.by_name[turn.winner.name].sizes, self.each)
            self.sooner, _ = self._sooner()
            states.append(self._state(turn.winner.name, self.rung.fit, self.rung.check))
        rung = self.rung
        final, frame = final_fit(rung, self._sizes(), self.each)
        typical = {size.key for size in self._sizes() if size.shaping and abs(final.values[size.key] - size.neutral) < LEAST_MOVED * size.probe}
        wider = birge_ratio(rung, final, frame, self._sizes(), self.each)
        bounds = {
            key: tuple(final.values[key] + wider * (end - final.values[key]) for end in found)
            for key, found in refit.intervals(final, frame, self._sizes()).items()
            if key not in typical
        }
        # What shapes an effect means nothing where that is not there: it is held where only this is asked.
        sizes = [size for size in self._sizes() if not size.shaping]
        strict = refit.intervals(final, frame, sizes, held=True)
        sure = {size.key for size in sizes if not strict[size.key][0] <= size.neutral <= strict[size.key][1]}
        for turn in rounds:  # what gains that much is there, even where parameters that may be wrong leave its size open
            if turn.winner is not None and turn.is_large:
                own = {size.key for size in self.by_name[turn.winner.name].sizes}
                sure |= own if own & sure or self._is_needed(turn.winner.name, final, frame) else set()
        return Selection(
            tuple(rounds), tuple(states), rung.floor_squares, rung.held_out_floor_squares, rung.has_repeats, rung.frame,
            tuple(self.accepted), bounds, frozenset(sure), final, *self._remaining(states[0].fit, rung.fit), rung.check,
            rung.check_frame, wider, self.probed,
        )  # fmt: skip

    def _sizes(self) -> list[exp.Size]:
        """All that is fitted: what is free, and of the accepted effects sizes and shapes."""
        return [*self.rung.experiment.free, *(size for name in self.accepted for size in own_sizes(self.by_name[name], self.shaped))]

    def _is_needed(self, name: str, final: Fit, frame: Frame) -> bool:
        """Whether the last model without an effect, all others fitted anew, is worse by more than its sizes are worth (BIC).

        One that was found before another may have stood in for it, and be nothing beside it.
        """
        own = [size.key for size in own_sizes(self.by_name[name], self.shaped)]
        rest = [size for size in self._sizes() if size.key not in own]
        columns = dict(zip(final.keys, final.columns))
        without = {key: value for key, value in final.values.items() if key not in own}
        try:
            fit = refit.refit(frame.experiment, frame, without, rest, {size.key: columns[size.key] for size in rest})
        except (InputError, ValueError):
            return True
        return fit.loss - final.loss > len(own) * frame.price()

    def _state(self, name: str, fit: Fit, check) -> State:
        return State(name, fit, *self.rung.squares(fit, check))

    def _sooner(self) -> tuple[Experiment, Mapping[int, np.ndarray]]:
        """The experiment of the rung in longer steps, and its residuals."""
        return probe.coarsely(self.rung.experiment, self.rung.fit.values, self.rung.fit.residuals)

    def _probe(self, residuals: Mapping[int, np.ndarray]) -> dict[Job, Raw]:
        """Change of the ``residuals`` in longer steps per probe of every size of every candidate and shape, in single precision."""
        jobs = [(c.name, shape) for c in self.rung.experiment.candidates for shape in range(len(c.shapes))]
        unknown = [job for job in jobs if job not in self.probed]
        found = self.each(probe.Probe(self.sooner, self.rung.fit.values, residuals), unknown)
        self.probed = {**self.probed, **dict(zip(unknown, found))}
        kept = {job: self.probed[job] for job in jobs if self.probed[job]}
        alias = {name for name, candidate in self.by_name.items() if candidate.instrument or candidate.port == "road"}
        least = lambda name: ALIAS if name in alias else LEAST_OWN
        return {job: found for job, found in kept.items() if self.rung.frame.own_shares(list(found.values())).max() > least(job[0])}

    def _round(self, number: int) -> Round:
        rung, base = self.rung, self.rung.fit
        free = rung.frame.flats([rung.raw[size.key] for size in self._sizes() if refit.is_within(size, base.values)])
        jobs = [job for job in self.columns if job[0] not in self.accepted]
        if not jobs:
            return Round.empty()
        columns = {job: self.columns[job] for job in jobs}
        found = propose(rung.frame, base.residuals, free, columns, self.by_name, [self.seed, number], self.few)
        self.rare, self.certain = found.rare, found.certain()
        order = found.significant(PROPOSED)
        self.say(f"round {number + 1}: {', '.join(order) or 'nothing significant'}")
        likely = refit.information(rung.frame, base.residuals)
        self.tries = Tries(rung, self.by_name, self._sizes(), self.columns, self.sooner, likely)
        tried = [trial for trial in self.each(_Try(self.tries), [found.best[name] for name in order]) if trial is not None]
        least = MINOR * max((trial.gain for trial in tried), default=0.0)
        trials, winner = [], None
        for stage in ([t for t in tried if t.gain >= least], [t for t in tried if t.gain < least]):
            if winner is None:
                trials += self._followed_up(stage)
                winner = _best(trials, self.simpler)
        like, correlation, apart = (), {}, {}
        if winner is not None:
            frames = [frame for frame in (rung.frame, rung.check_frame) if frame is not None]
            like, correlation, apart = cluster.cluster(
                rung.experiment, frames, base.values, winner, trials, found.columns
            )
        return Round(
            found.names, found.p_value, found.gain, found.size, found.size_error, found.absorbed, tuple(trials), winner,
            like, correlation, apart, found.decoy_p_value, found.decoy_ranks, winner is not None and self.tries.is_large(winner.gain),
            _passed_over(found, {trial.name for trial in tried if trial.gain < least}, trials),
        )  # fmt: skip

    def _followed_up(self, tried: Sequence[Trial]) -> list[Trial]:
        """Refits settled where they gain much, and judged, the best first; without those that cannot be simulated."""
        leading = sorted(tried, key=lambda trial: trial.bic, reverse=True)
        least = FAR * max([trial.gain for trial in leading], default=0.0)
        best = [trial for trial in leading[:SETTLED] if trial.gain >= least]
        least = max([least, *(LEAST_SHARE * turn.winner.gain for turn in self.rounds[:1])])
        shaped = {trial.name for trial in best if trial.gain >= least and self.by_name[trial.name].shaping}
        follow = _FollowUp(self, {trial.name for trial in best}, shaped)
        # The first that gains much takes as long as all others: it is worth all cores.
        alone, others = (leading[:1], leading[1:]) if leading and self.tries.is_large(leading[0].gain) else ([], leading)
        followed = [*map(replace(follow, each=self.each), alone), *self.each(follow, others)]
        return [trial for trial in followed if trial is not None]

    def _judge(self, trial: Trial) -> Trial | None:
        """A trial with what it does to the drives held out; None where these cannot be simulated."""
        rung, candidate, fit = self.rung, self.by_name[trial.name], trial.fit
        held_gain, held_z, is_weak = float("nan"), float("nan"), False
        try:
            held = exp.simulate(rung.experiment, fit.values, self.held_out)
            if rung.check_frame is not None:
                held, _ = realign.closer(rung.experiment, fit.values, held, rung.check_frame)
                held_gain, held_z, is_weak = self._held_out_gain(candidate.name, held)
            met = not self.held_out or candidate.name not in self.rare or held_z > HELD_OUT_Z or self._meets(candidate, fit)
        except (InputError, ValueError):
            return None
        if not met:
            held_gain, held_z = float("nan"), float("nan")
        now, before, first = self._state(candidate.name, fit, held), self._state("", rung.fit, rung.check), self.first
        share = floor.explained_share(before.squares, now.squares, first.squares, rung.floor_squares)
        held_share = floor.explained_share(
            before.held_out_squares, now.held_out_squares, first.held_out_squares, rung.held_out_floor_squares
        )
        trial = replace(
            trial, held_out_gain=held_gain, held_out_z=held_z, share=share, held_out_share=held_share, met=met,
            before=before, after=now,
        )  # fmt: skip
        left = floor.explained_share(before.squares, rung.floor_squares, first.squares, rung.floor_squares)
        return replace(trial, objection=self._objection(trial, candidate, is_weak, left))

    def _held_out_gain(self, name: str, held: Mapping[int, np.ndarray]) -> tuple[float, float, bool]:
        """What residuals of the drives held out gain against those of the rung, the z of that, and whether it is too weak to reach HELD_OUT_Z
        and yet confirms the effect of this name."""
        frame, before = self.rung.check_frame, self.rung.check
        gain = refit.information(frame, held) - refit.information(frame, before)
        fall, z = refit.advantage(frame, held, before)
        change = frame.flat(held) - frame.flat(before)
        size = float(change @ change)
        is_there = fall > 2.0 * ABSENT_Z * np.sqrt(size) - size
        return gain, z, name in self.certain and is_there and (not self.accepted or size < WEAK)

    def _meets(self, candidate: Candidate, fit: Fit) -> bool:
        """Whether any drive held out has what the candidate acts on, a stop that is reached for example."""
        powers = []
        for frame, indices in ((self.rung.frame, self.fitted), (self.rung.check_frame, self.held_out)):
            with_it, without = (
                exp.simulate(self.rung.experiment, values, indices) for values in (fit.values, {**fit.values, **candidate.at({})})
            )
            powers.append(np.sum(frame.flat({i: with_it[i] - without[i] for i in indices}) ** 2) / len(indices))
        return powers[1] > MET * powers[0]

    def _objection(self, trial: Trial, candidate: Candidate, is_weak: bool, left: float) -> str:
        outside = implausible(candidate, trial.fit.values)
        if outside:
            return outside
        if trial.bic <= 0:
            return "not worth its sizes (BIC)"
        if np.isfinite(trial.held_out_gain):
            enough = trial.held_out_z > 0 and not trial.held_out_share <= 0 if is_weak else trial.held_out_z > HELD_OUT_Z
            if not (trial.held_out_gain > 0 and enough):
                return "not surely better on drives held out"
        if trial.share < (LEAST_SHARE if trial.met else LEAST_UNMET) and not trial.share > MOST_OF_REST * left:
            return f"removes {100 * trial.share:.1f} % of the explainable error" + ("" if trial.met else ", and no drive held out meets it")
        return ""

    def _remaining(self, first: Fit, last: Fit) -> tuple[Shared, float, float]:
        """What all repeats still share, the share of it that is gone, and the z that it had at first."""
        left, before = shared_error(self.rung.frame, last.residuals), shared_error(self.rung.frame, first.residuals)
        return left, 1.0 - left.power / before.power if before.power > 0 else float("nan"), before.z


def _passed_over(found: Proposal, minor: Collection[str], trials: Sequence[Trial]) -> dict[str, str]:
    """Why candidates that are significant, or would be with the opposite sign, are not among the ``trials`` of a round; ``minor``: names of
    those whose refits gain little."""
    significant, judged = found.significant(len(found.names)), {trial.name for trial in trials}
    why = dict.fromkeys(found.opposite, "not refitted: the drives ask for the opposite sign, which is not plausible")
    why |= {name: f"not refitted: the {PROPOSED} that gain most were" for name in significant[PROPOSED:]}
    for name in significant[:PROPOSED]:
        why[name] = f"its refit gains less than {100 * MINOR:g} % of the best" if name in minor else "could not be simulated"
    return {name: said for name, said in why.items() if name not in judged}


def _best(trials: Sequence[Trial], simpler: Collection[str] = ()) -> Trial | None:
    """The trial with the most merit of those that nothing speaks against; one that explains more of the drives it was fitted to, and of those
    held out by likelihood and by share, goes before it: where a rough patch holds most of an error few blocks count, and the z of the
    right damper was 1.9 beside a tyre that explained less than half as much. What is ``simpler`` goes before what explains no EQUAL more."""
    sound = [trial for trial in trials if not trial.objection]
    best = max(sound, key=_merit, default=None)
    explained = lambda trial: np.array([trial.bic, trial.held_out_gain, trial.held_out_share])
    best = max((trial for trial in sound if np.all(explained(trial) > explained(best))), key=_merit, default=best)
    alike = (trial for trial in sound if trial.name in simpler and not _explains_more(best, trial))
    return best if best is None or best.name in simpler else max(alike, key=_merit, default=best)


def _explains_more(one: Trial, other: Trial) -> bool:
    """Whether one trial removes EQUAL more than another of the explainable error, on fitted drives or on those held out, if any."""
    return one.share > other.share + EQUAL or one.held_out_share > other.held_out_share + EQUAL


def _merit(trial: Trial) -> tuple[bool, float]:
    """What the drives held out confirm goes before what they do not refute."""
    unasked = not np.isfinite(trial.held_out_gain)
    return unasked or trial.held_out_z > HELD_OUT_Z, trial.bic + (0.0 if unasked else trial.held_out_gain)


@dataclass(frozen=True)
class _Try:
    tries: Tries

    def __call__(self, job: Job) -> Trial | None:
        return self.tries.first(job)


@dataclass(frozen=True)
class _FollowUp:
    search: _Search
    leading: Collection[str]
    """Names of those whose refits are repeated where they gain much."""
    shaped: Collection[str]
    """Names of those whose shapes are fitted."""
    each: Callable = map

    def __call__(self, trial: Trial) -> Trial | None:
        tries = replace(self.search.tries, each=self.each)
        trial = tries.settled(trial) if trial.name in self.leading else trial
        trial = tries.shaped(trial) if trial.name in self.shaped else trial
        return self.search._judge(trial)
