"""One round of the search: the candidates that the drives speak for, refitted and judged, and which of them is the next effect."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.stats import chi2

from . import across, cluster, exclusion, foresight, probe, refit
from .confirm import LEAST_SHARE, Confirmation, best
from .experiment import Candidate, Experiment, Size
from .probe import Job, Raw
from .propose import LEVEL, Proposal, propose
from .rung import Rung
from .selection import Round, State, Trial
from .tries import Tries

PROPOSED = 5
"""Candidates that are refitted in a round."""

ASKED, BENT = 15, 2.0
"""Candidates that gain most by the score test, which are asked what they do in typical sizes before it is settled which are refitted, and times the
gain by small sizes that they must foresee for a refit to begin by the columns over typical ones."""

SHOWN = 0.5
"""Share of a gain that borrowed columns show at least."""

MINOR = 0.05
"""Share of the largest gain of a round's refits below which one is followed up only where none above it will do."""

SETTLED, FAR = 3, 0.25
"""Refits of a round that are settled, the best, and share of the largest gain below which none catches up. From there on shapes are
fitted, too, if that is no less than LEAST_SHARE of the first effect's."""

UNDRIVEN = "could not be simulated"
"""What is said of a candidate that the model could not be driven with..."""

UNSIZED = "no size to fit: no parameter of it is typically another than the value that changes nothing"
"""...and of one that no size switches on."""


@dataclass
class Contest:
    """The round of this ``number`` (from 0 on) on a ``rung``, between ``candidates`` (by name).

    ``fitted``: sizes that are fitted anyway; ``columns``: raw change of the residuals per probe of every size, by job, of what may come next, some
    made anew; ``sooner``: the experiment of the rung in longer steps, and its residuals (``probe.coarsely``); ``first``: the model before any effect; ``first_gain``: that of
    the first effect's refit, 0 before it; ``seed``, ``each``, ``say``, ``simpler`` and ``known``: as for ``select.search``.
    """

    number: int
    rung: Rung
    candidates: Mapping[str, Candidate]
    fitted: Sequence[Size]
    columns: dict[Job, Raw]
    sooner: tuple[Experiment, Mapping[int, np.ndarray]]
    first: State
    first_gain: float
    seed: int
    each: Callable
    say: Callable[[str], None]
    simpler: Collection[str]
    known: Mapping[str, float]
    borrowed: set[Job] = field(default_factory=set)
    """Jobs whose columns repeats have of one of them (``exemplar``)."""
    refitted: dict[Job, Trial | None] = field(default_factory=dict)
    """Refits as they came, None of what cannot be simulated. They are the same whoever of them is taken back."""
    followed: dict[tuple, Trial | None] = field(default_factory=dict)
    """Refits settled and judged, by what was done to which."""

    def round(self, vain: Mapping[str, Trial] = {}) -> Round:
        """What came of it, without what was taken back: the refits ``vain``, by name."""
        if not self.columns:
            return Round.empty()
        rung, found = self.rung, self.proposal
        order = [name for name in found.significant(PROPOSED + len(vain)) if name not in vain][:PROPOSED]
        again, nothing = (" again", "nothing else significant") if vain else ("", "nothing significant")
        self.say(f"round {self.number + 1}{again}: {', '.join(order) or nothing}")
        tried = self._as_is_typical(self._refits([found.best[name] for name in order]))
        least = MINOR * max((trial.gain for trial in tried), default=0.0)
        trials, winner = [], None
        for stage in ([t for t in tried if t.gain >= least], [t for t in tried if t.gain < least]):
            if winner is None:
                trials += self._followed_up(stage)
                winner = best(trials, self.simpler)
        like, correlation, apart, borne = (), {}, {}, across.Borne()
        if winner is not None:
            borne = across.borne_out(rung.frame, rung.fit.residuals, self._change(winner), self._fitted_raw)
            frames = [frame for frame in (rung.frame, rung.check_frame) if frame is not None]
            like, correlation, apart = cluster.cluster(
                rung.experiment, frames, rung.fit.values, winner, trials, found.columns
            )
        return Round(
            found.names, found.p_value, found.gain, found.absorbed, (*trials, *vain.values()), winner,
            like, correlation, apart, found.decoy_p_value, found.decoy_ranks, winner is not None and self.tries.is_large(winner.gain),
            passed_over(found, {trial.name for trial in tried if trial.gain < least}, trials, vain), borne,
            () if winner else exclusion.of_all(rung.frame, found.residual, found.columns, self.candidates, found.best),
        )  # fmt: skip

    def _change(self, trial: Trial) -> dict[int, np.ndarray]:
        """What an effect of the size that its refit gave it changes of the residuals, by record, as far as that is proportional to its sizes."""
        raw, sizes = self.columns[self.proposal.best[trial.name]], self.candidates[trial.name].sizes
        amounts = {size.key: (trial.fit.values[size.key] - size.neutral) / size.probe for size in sizes if size.key in raw}
        return {index: sum(amount * raw[key][index] for key, amount in amounts.items()) for index in self.rung.frame.indices}

    @cached_property
    def proposal(self) -> Proposal:
        """What the score test says of the candidates, and what is foreseen of typical sizes."""
        gains = foresight.gains(self.rung.frame, self.rung.fit.residuals, self._free, self.candidates, self._asked)
        return replace(self._scored, foreseen={job[0]: gain for job, gain in gains.items()})

    @cached_property
    def tries(self) -> Tries:
        rung, found = self.rung, self.proposal
        small = dict(zip(found.names, found.gain))
        bent = {job: own for job, own in self._asked.items() if found.foreseen.get(job[0], 0.0) > BENT * small[job[0]]}
        likely = refit.information(rung.frame, rung.fit.residuals)
        return Tries(rung, self.candidates, self.fitted, {**self.columns, **bent}, self.sooner[0], likely)

    @cached_property
    def _free(self) -> np.ndarray:
        """White directions that are fitted anyway."""
        return self.rung.frame.flats(self._fitted_raw)

    @property
    def _fitted_raw(self) -> list[Mapping[int, np.ndarray]]:
        """Change of the residuals per probe of all that is fitted anyway and is not at the end of what is plausible."""
        rung = self.rung
        return [rung.raw[size.key] for size in self.fitted if refit.is_within(size, rung.fit.values)]

    @cached_property
    def _scored(self) -> Proposal:
        """What the score test says. Above the first rung the columns of what it speaks for most are made anew, until it speaks by such alone:
        what those of another rung leave of a candidate, beside columns of the parameters that are made there, passes for evidence of it. So are
        borrowed ones of what would gain most."""
        anew = self._returned()
        found = self._tested()
        while old := {name for name in found.significant(ASKED) if self.number or self._is_borrowed(name)} - anew:
            self._make([job for job in self.columns if job[0] in old])
            anew, found = anew | old, self._tested()
        return found

    def _returned(self) -> set[str]:
        """Names of the candidates that borrowed columns and may be significant, of the ASKED that gain most, which are made anew until none is."""
        least = SHOWN * float(chi2.isf(LEVEL / len(self.candidates), 1))
        foresee = lambda jobs: foresight.gains(
            self.rung.frame, self.rung.fit.residuals, self._free, self.candidates, {job: self.columns[job] for job in jobs}
        )
        gains, anew = foresee(self.columns) if self.borrowed else {}, set()
        while self.borrowed:
            order = dict.fromkeys(job[0] for job in sorted(gains, key=lambda job: -gains[job]) if gains[job] >= least)
            leading = [name for name in list(order)[:ASKED] if self._is_borrowed(name)]
            if not leading:
                break
            jobs = [job for job in self.columns if job[0] in leading]
            self._make(jobs)
            gains, anew = {**gains, **foresee(jobs)}, anew | {*leading}
        return anew

    def _is_borrowed(self, name: str) -> bool:
        return any(job[0] == name for job in self.borrowed)

    def _make(self, jobs: Sequence[Job]) -> None:
        """Make the columns of these jobs anew, on every record of the rung; as they were where fewer could be."""
        sooner, residuals = self.sooner
        made = zip(jobs, self.each(probe.Probe(sooner, self.rung.fit.values, residuals), jobs))
        self.columns |= {job: own for job, own in made if own.keys() >= self.columns[job].keys()}
        self.borrowed -= {*jobs}

    def _tested(self) -> Proposal:
        rung = self.rung
        return propose(rung.frame, rung.fit.residuals, self._free, self.columns, self.candidates, [self.seed, self.number], self.known)

    @cached_property
    def _asked(self) -> Mapping[Job, Raw]:
        """Columns over typical sizes of the ASKED candidates that gain most by the score test."""
        sooner, residuals = self.sooner
        jobs = [self._scored.best[name] for name in self._scored.significant(ASKED)]
        return dict(zip(jobs, self.each(foresight.Typical(sooner, self.candidates, self.rung.fit.values, residuals), jobs)))

    @cached_property
    def confirmation(self) -> Confirmation:
        found = self.proposal
        return Confirmation(self.rung, self.candidates, self.first, found.rare, found.certain(), self.number == 0)

    def _refits(self, jobs: Sequence[Job]) -> list[Trial]:
        """The first refits of these jobs; without those that cannot be simulated."""
        new, attempt = [job for job in jobs if job not in self.refitted], _Try(self.tries)
        # The first shares its records among all cores: five by twos would leave one of two idle while the last is tried.
        self.refitted |= zip(new, (*map(attempt, new[:1]), *self.each(attempt, new[1:])))
        return [trial for job in jobs if (trial := self.refitted[job]) is not None]

    def _as_is_typical(self, tried: Sequence[Trial]) -> list[Trial]:
        """Refits with those of another shape than is typical, that gain much, in the typical one where that gains more.

        The score test foresees what small sizes do: of a passenger it took half of the mass at twice the distance, which turns the car as much.
        """
        least = FAR * max((trial.gain for trial in tried), default=0.0)
        shaped = (trial.name for trial in tried if self.proposal.best[trial.name][1] and trial.gain >= least)
        again = [(name, 0) for name in shaped if (name, 0) in self.columns]
        typical = {trial.name: trial for trial in self._refits(again)}
        return [max(trial, typical.get(trial.name, trial), key=lambda one: one.gain) for trial in tried]

    def _followed_up(self, tried: Sequence[Trial]) -> list[Trial]:
        """Refits settled where they gain much, and judged, the best first; without those that cannot be simulated."""
        leading = sorted(tried, key=lambda trial: trial.bic, reverse=True)
        least = FAR * max([trial.gain for trial in leading], default=0.0)
        best = [trial for trial in leading[:SETTLED] if trial.gain >= least]
        least = max(least, LEAST_SHARE * self.first_gain)
        shaped = {trial.name for trial in best if trial.gain >= least and self.candidates[trial.name].shaping}
        follow = _FollowUp(self.tries, self.confirmation, {trial.name for trial in best}, shaped)
        done = {trial.name: (*self.proposal.best[trial.name], *trial.shape.items(), *follow.how(trial)) for trial in leading}
        new = [trial for trial in leading if done[trial.name] not in self.followed]
        # The first that gains much takes as long as all others: it is worth all cores.
        alone = 1 if new and self.tries.is_large(new[0].gain) else 0
        judged = [*map(replace(follow, each=self.each), new[:alone]), *self.each(follow, new[alone:])]
        self.followed |= zip((done[trial.name] for trial in new), judged)
        return [trial for own in leading if (trial := self.followed[done[own.name]]) is not None]


def passed_over(found: Proposal, minor: Collection[str], trials: Sequence[Trial], vain: Collection[str] = ()) -> dict[str, str]:
    """Why candidates that are significant, or would be with the opposite sign, are not among the ``trials`` of a round; ``minor``: names of
    those whose refits gain little, ``vain``: of those that were taken back, which are told elsewhere."""
    significant = [name for name in found.significant(len(found.names)) if name not in vain]
    judged = {trial.name for trial in trials}
    why = dict.fromkeys(found.opposite, "not refitted: the drives ask for the opposite sign, which is not plausible")
    why |= {name: f"not refitted: the {PROPOSED} that gain most were" for name in significant[PROPOSED:]}
    for name in significant[:PROPOSED]:
        why[name] = f"its refit gains less than {100 * MINOR:g} % of the best" if name in minor else UNDRIVEN
    return {name: said for name, said in why.items() if name not in judged}


@dataclass(frozen=True)
class _Try:
    tries: Tries

    def __call__(self, job: Job) -> Trial | None:
        return self.tries.first(job)


@dataclass(frozen=True)
class _FollowUp:
    tries: Tries
    confirmation: Confirmation
    leading: Collection[str]
    """Names of those whose refits are repeated where they gain much."""
    shaped: Collection[str]
    """Names of those whose shapes are fitted."""
    each: Callable = map

    def __call__(self, trial: Trial) -> Trial | None:
        tries = replace(self.tries, each=self.each)
        is_leading, is_shaped = self.how(trial)
        trial = tries.settled(trial) if is_leading else trial
        trial = tries.shaped(trial) if is_shaped else trial
        return self.confirmation(trial)

    def how(self, trial: Trial) -> tuple[bool, bool]:
        """Whether its refit is repeated, and whether its shape is fitted."""
        return trial.name in self.leading, trial.name in self.shaped
