"""From a library of candidates to the effects that are missing: proposed on fitted drives, decided on held-out ones.

Forward selection. Each round tests every candidate on the white residual of the present
model, refits the best few together with all that is calibrated, and keeps one only if it
is significant over the whole library, plausible in size, worth its parameters (BIC) and
makes drives better that it was never fitted to.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import InputError
from . import cluster, floor, probe, realign, refit
from . import experiment as exp
from .experiment import Candidate, Experiment, Frame
from .propose import propose
from .refit import Fit
from .selection import Round, Selection, State, Trial
from .shared import Shared, shared_error

LEAST_SHARE = 0.02
"""Share of the explainable error below which an effect is not worth naming."""

PROPOSED = 5
"""Candidates that are refitted in a round."""

MINOR = 0.05
"""Share of the largest gain of a round's refits below which one is followed up only where none above it will do."""

CONTENT = 0.98
"""Share of the gain of a size that is not plausible at which a plausible one does as well."""

CHANCE = 3.84
"""Fall of the white loss that one free size reaches by chance in one of twenty fits: so little is no sign of an implausible one."""

HELD_OUT_Z = 2.0
"""z of the improvement of held-out drives that an effect must reach."""

WEAK = 16.0
"""Fall of the white loss of held-out drives below which not even the truth reaches HELD_OUT_Z half of the time: a change of that size
falls by itself on average, with a standard deviation of twice its root. There any fall confirms what the fitted drives leave no doubt of."""

MET = 0.01
"""White power of what an effect does to a drive held out, against that on a fitted one, below which the first cannot decide on it."""

LARGE = 0.02
"""Gain per independent value of the records above which a refit is repeated with the spectrum of its own residuals."""

HUGE = 0.2
"""The same, above which the columns of all parameters are made anew."""

SETTLED = 3
"""Refits that this is done for, the best of a round."""

CYCLES = 8
"""Most such repetitions."""

FINAL_CYCLES = 2
"""Frames of the last fit, each of the residuals of the one before: an error in what makes it white comes out too small."""

ALIAS, LEAST_OWN = 0.05, 0.01
"""Share of the power that nuisances must leave of an error of an instrument or of what a tyre feels of the road, below which it is one
of them under another name, and of any other effect, which may be much like one and yet be there."""


def select(
    experiment: Experiment,
    start: Mapping[str, float],
    *,
    most: int = 3,
    seed: int = 0,
    each: Callable = map,
    say: Callable[[str], None] = lambda words: None,
) -> Selection:
    """Find up to ``most`` missing effects from ``start`` (values of the calibrated model).

    ``each`` maps a function over candidates (``map`` or that of a pool); ``say`` is told what goes on.
    """
    return _Search(experiment, dict(start), most, seed, each, say).run()


@dataclass
class _Search:
    experiment: Experiment
    values: dict[str, float]
    most: int
    seed: int
    each: Callable
    say: Callable
    accepted: list[str] = field(default_factory=list)

    def __post_init__(self):
        records = self.experiment.records
        self.fitted = [i for i, record in enumerate(records) if record.role == "fit"]
        self.held_out = [i for i, record in enumerate(records) if record.role != "fit"]
        if not self.fitted:
            raise InputError("no drive has the role 'fit' (expected at least one)", place="drives")
        self.by_name = {candidate.name: candidate for candidate in self.experiment.candidates}

    def run(self) -> Selection:
        self.frame, base = self._calibrated(self.values)
        self.frame, base = self._calibrated(base.values, self.raw)
        check, self.check_frame = self._aligned(base.values, self.held_out)
        self._grounds(base, check)
        ladder = [self._state("calibrated", base, check)]
        self.base_squares = ladder[0]
        self.say("probing every candidate")
        self.columns = self._probe(base)
        rounds = []
        while len(self.accepted) < self.most:
            turn, base = self._round(base, check, len(rounds))
            rounds.append(turn)
            if turn.winner is None:
                break
            self.accepted.append(turn.winner.name)
            self.say(f"accepted {turn.winner.name}")
            self.frame, base = self._calibrated(base.values)
            check, self.check_frame = self._aligned(base.values, self.held_out)
            self._grounds(base, check)
            ladder.append(self._state(turn.winner.name, base, check))
        final, frame = self._final(base)
        bounds = refit.intervals(final, frame, self._sizes())
        strict = refit.intervals(final, frame, self._sizes(), held=True)
        sure = frozenset(s.key for s in self._sizes() if not strict[s.key][0] <= s.neutral <= strict[s.key][1])
        return Selection(
            tuple(rounds), tuple(ladder), self.ground, self.held_out_ground, self.repeats, self.frame,
            tuple(self.accepted), bounds, sure, final, *self._remaining(ladder[0].fit, base),
        )  # fmt: skip

    def _sizes(self, extra: Sequence[str] = ()) -> list[exp.Size]:
        names = [*self.accepted, *extra]
        return [*self.experiment.free, *(size for name in names for size in self.by_name[name].sizes)]

    def _aligned(self, values, indices) -> tuple[Mapping[int, np.ndarray], Frame | None]:
        """Residuals and frame of records aligned anew for a model; empty and None without any."""
        if not indices:
            return {}, None
        residuals, frame, self.experiment = realign.aligned(self.experiment, values, indices)
        return residuals, frame

    def _calibrated(self, values: dict[str, float], raw: Mapping[str, Mapping[int, np.ndarray]] | None = None) -> tuple[Frame, Fit]:
        """Frame and fit of the present model, at its own spectrum; ``raw``: columns of its sizes where they are known."""
        residuals, frame = self._aligned(values, self.fitted)
        sizes = self._sizes()
        self.raw = raw or probe.secants(self.experiment, values, residuals, sizes, self.each)
        for _ in range(2):
            columns = probe.white(frame, self.raw)
            fit = refit.refit(self.experiment, frame, values, sizes, columns, iterations=3, residuals=residuals)
            values, residuals = fit.values, fit.residuals
            frame = exp.frame(self.experiment, fit.residuals, frame.nuisances, self._cleaned(frame, fit.residuals))
        return frame, fit

    def _final(self, base: Fit) -> tuple[Fit, Frame]:
        """The fit whose sizes are told, with its frame."""
        values = base.values
        residuals, frame = self._aligned(values, self.fitted)
        for cycle in range(FINAL_CYCLES):
            if cycle:
                frame = exp.frame(self.experiment, residuals, frame.nuisances, self._cleaned(frame, residuals))
            columns = probe.white(frame, self.raw)
            fit = refit.refit(self.experiment, frame, values, self._sizes(), columns, iterations=2, residuals=residuals)
            values, residuals = fit.values, fit.residuals
        return fit, frame

    def _cleaned(self, frame: Frame, residuals) -> dict[int, np.ndarray]:
        return {index: frame.cleaned(index, residuals[index]) for index in residuals}

    def _grounds(self, fit: Fit, check) -> None:
        """Mean squares of the floor on fitted and held-out records; of a condition without repeats, as of the others.

        Repeats differ in their path, so what the model lacks differs too: the floor sinks as the model improves.
        """
        known = floor.floor(self.experiment, self._cleaned(self.frame, fit.residuals))
        self.repeats = bool(known)
        for name, indices in (("ground", self.fitted), ("held_out_ground", self.held_out)):
            rows = np.zeros((len(indices), len(self.experiment.channels)))
            for row, index in zip(rows, indices):
                record = self.experiment.records[index]
                found = known.get(record.condition) or next(iter(known.values()), None)
                row[:] = floor.assumed(record) if found is None else found.power(record.band, record.rate)
            before = getattr(self, name, None)
            setattr(self, name, rows if before is None else np.minimum(before, rows))
        # No floor lies above what a model has reached.
        self.ground = np.minimum(self.ground, floor.squares(self.experiment, self._cleaned(self.frame, fit.residuals)))
        if check:
            reached = floor.squares(self.experiment, self._cleaned(self.check_frame, check))
            self.held_out_ground = np.minimum(self.held_out_ground, reached)

    def _state(self, name: str, fit: Fit, check) -> State:
        squares = floor.squares(self.experiment, self._cleaned(self.frame, fit.residuals))
        held_out = floor.squares(self.experiment, self._cleaned(self.check_frame, check)) if check else self.held_out_ground
        return State(name, fit, squares, held_out)

    def _probe(self, base: Fit) -> dict[tuple[str, int], dict[str, dict[int, np.ndarray]]]:
        """Change of the residuals per probe of every size of every candidate and shape, in single precision."""
        jobs = [(c.name, shape) for c in self.experiment.candidates for shape in range(len(c.shapes))]
        results = self.each(probe.Probe(self.experiment, base.values, base.residuals), jobs)
        kept = {job: found for job, found in zip(jobs, results) if found}
        alias = {name for name, candidate in self.by_name.items() if candidate.instrument or candidate.port == "road"}
        least = lambda name: ALIAS if name in alias else LEAST_OWN
        return {job: found for job, found in kept.items() if self.frame.own_shares(list(found.values())).max() > least(job[0])}

    def _round(self, base: Fit, check, number: int) -> tuple[Round, Fit]:
        free = self.frame.flats([self.raw[size.key] for size in self._sizes() if refit.is_within(size, base.values)])
        jobs = [job for job in self.columns if job[0] not in self.accepted]
        if not jobs:
            return Round.empty(), base
        columns = {job: self.columns[job] for job in jobs}
        found = propose(self.frame, base.residuals, free, columns, self.by_name, [self.seed, number])
        self.rare, self.certain = found.rare, found.certain()
        order = found.significant(PROPOSED)
        self.say(f"round {number + 1}: {', '.join(order) or 'nothing significant'}")
        tried = [trial for trial in self.each(_Try(self, base), [found.best[name] for name in order]) if trial is not None]
        least = MINOR * max((trial.gain for trial in tried), default=0.0)
        trials, winner = [], None
        for stage in ([t for t in tried if t.gain >= least], [t for t in tried if t.gain < least]):
            if winner is None:
                trials += self._followed_up(stage, base, check)
                winner = max((t for t in trials if not t.objection), key=_merit, default=None)
        like, correlation, apart = (), {}, {}
        if winner is not None:
            frames = [frame for frame in (self.frame, self.check_frame) if frame is not None]
            like, correlation, apart = cluster.cluster(
                self.experiment, frames, base.values, winner, trials, found.columns
            )
        turn = Round(
            found.names, found.p_value, found.gain, found.size, found.size_error, found.absorbed, tuple(trials), winner,
            like, correlation, apart, found.decoy_p_value, found.decoy_ranks,
        )  # fmt: skip
        return turn, winner.fit if winner is not None else base

    def _followed_up(self, tried: Sequence[Trial], base: Fit, check) -> list[Trial]:
        """Refits settled and judged, the best first; without those that cannot be simulated."""
        leading = sorted(tried, key=lambda trial: trial.bic, reverse=True)
        large = [trial for trial in leading[:SETTLED] if trial.gain > LARGE * self._count()]
        settled = [*self.each(_Settle(self, base), large), *(trial for trial in leading if trial not in large)]
        return [trial for trial in self.each(_Judge(self, base, check), settled) if trial is not None]

    def _try(self, job: tuple[str, int], base: Fit) -> Trial | None:
        """The refit of a candidate in one shape; None where it cannot be simulated."""
        candidate, raw = self.by_name[job[0]], {**self.raw, **self.columns[job]}
        shape = candidate.shapes[job[1]]
        sizes = [size for size in self._sizes([candidate.name]) if size.key in raw]
        columns = probe.white(self.frame, {size.key: raw[size.key] for size in sizes})
        start, own = {**base.values, **candidate.at({}), **shape}, list(self.columns[job])
        try:
            fit = refit.refit(
                self.experiment, self.frame, start, sizes, columns, renewed=own, residuals=base.residuals
            )
            if _implausible(candidate, fit.values):
                inside = refit.refit(
                    self.experiment, self.frame, start, sizes, columns, renewed=own, residuals=base.residuals, beyond=0.0
                )
                before = float(np.sum(self.frame.flat(base.residuals) ** 2))
                does = inside.loss - fit.loss < CHANCE or before - inside.loss > CONTENT * (before - fit.loss)
                fit = inside if does else fit
            return self._trial(candidate, shape, fit, base)
        except (InputError, ValueError):
            return None

    def _settle(self, trial: Trial, base: Fit) -> Trial:
        """The refit repeated in the frame of its own residuals while the error falls by much.

        A large error makes itself white: what is missing weighs least where it is largest.
        """
        candidate, fit, gained = self.by_name[trial.name], trial.fit, trial.gain
        own = [size for size in candidate.sizes if size.key in fit.keys]
        beyond = refit.BEYOND if _implausible(candidate, fit.values) else 0.0
        try:
            for _ in range(CYCLES):
                cleaned = self._cleaned(self.frame, fit.residuals)
                frame = exp.frame(self.experiment, fit.residuals, self.frame.nuisances, cleaned)
                anew = own if gained < HUGE * self._count() else self._sizes([candidate.name])
                raw = {**self.raw, **probe.secants(self.experiment, fit.values, fit.residuals, anew)}
                columns = probe.white(frame, raw)
                sizes = [size for size in self._sizes([candidate.name]) if size.key in columns]
                fit = refit.refit(
                    self.experiment, frame, fit.values, sizes, columns, renewed=[size.key for size in own],
                    residuals=fit.residuals, beyond=beyond,
                )  # fmt: skip
                settled = self._trial(candidate, trial.shape, fit, base)
                gained = settled.gain - trial.gain
                trial = settled if gained > 0 else trial
                if gained < LARGE * self._count():
                    break
        except (InputError, ValueError):
            pass
        return trial

    def _trial(self, candidate: Candidate, shape, fit: Fit, base: Fit) -> Trial:
        """What a refit gains on the drives that it was fitted to; the others have not been asked."""
        gain = refit.information(self.frame, fit.residuals) - refit.information(self.frame, base.residuals)
        bic = gain - len(candidate.sizes) * np.log(len(np.unique(self.frame.blocks())))
        unknown = (float("nan"),) * 4
        return Trial(candidate.name, shape, replace(fit, columns=np.zeros((0, 0))), gain, bic, *unknown, "")

    def _judge(self, trial: Trial, base: Fit, check) -> Trial | None:
        """A trial with what it does to the drives held out; None where these cannot be simulated."""
        candidate, fit = self.by_name[trial.name], trial.fit
        try:
            held = exp.simulate(self.experiment, fit.values, self.held_out)
            if self.check_frame is not None:
                held, _ = realign.closer(self.experiment, fit.values, held, self.check_frame)
        except (InputError, ValueError):
            return None
        held_gain, held_z, is_weak = float("nan"), float("nan"), False
        if self.check_frame is not None:
            held_gain = refit.information(self.check_frame, held) - refit.information(self.check_frame, check)
            held_z = refit.advantage(self.check_frame, held, check)[1]
            change = self.check_frame.flat(held) - self.check_frame.flat(check)
            is_weak = candidate.name in self.certain and float(change @ change) < WEAK
        met = not self.held_out or candidate.name not in self.rare or held_z > HELD_OUT_Z or self._meets(candidate, fit)
        if not met:
            held_gain, held_z = float("nan"), float("nan")
        now, before, first = self._state(candidate.name, fit, held), self._state("", base, check), self.base_squares
        share = floor.explained_share(before.squares, now.squares, first.squares, self.ground)
        held_share = floor.explained_share(
            before.held_out_squares, now.held_out_squares, first.held_out_squares, self.held_out_ground
        )
        trial = replace(
            trial, held_out_gain=held_gain, held_out_z=held_z, share=share, held_out_share=held_share, met=met,
            before=before, after=now,
        )  # fmt: skip
        return replace(trial, objection=self._objection(trial, candidate, is_weak))

    def _meets(self, candidate: Candidate, fit: Fit) -> bool:
        """Whether any drive held out has what the candidate acts on, a stop that is reached for example."""
        powers = []
        for frame, indices in ((self.frame, self.fitted), (self.check_frame, self.held_out)):
            with_it, without = (
                exp.simulate(self.experiment, values, indices) for values in (fit.values, {**fit.values, **candidate.at({})})
            )
            powers.append(np.sum(frame.flat({i: with_it[i] - without[i] for i in indices}) ** 2) / len(indices))
        return powers[1] > MET * powers[0]

    def _count(self) -> float:
        """Independent values in the band of the fitted records and channels."""
        records = [self.experiment.records[i] for i in self.fitted]
        seconds = [len(record.place) / record.rate for record in records]
        return len(self.experiment.channels) * sum(2 * t * (r.band[1] - r.band[0]) for t, r in zip(seconds, records))

    def _objection(self, trial: Trial, candidate: Candidate, is_weak: bool) -> str:
        outside = _implausible(candidate, trial.fit.values)
        if outside:
            return outside
        if trial.bic <= 0:
            return "not worth its parameters (BIC)"
        if np.isfinite(trial.held_out_gain):
            enough = trial.held_out_z > 0 and not trial.held_out_share <= 0 if is_weak else trial.held_out_z > HELD_OUT_Z
            if not (trial.held_out_gain > 0 and enough):
                return "does not improve the drives held out"
        if trial.share < LEAST_SHARE:
            return f"removes {100 * trial.share:.1f} % of the explainable error"
        return ""

    def _remaining(self, first: Fit, last: Fit) -> tuple[Shared, float, float]:
        """What all repeats still share, the share of it that is gone, and the z that it had at first."""
        left, before = shared_error(self.frame, last.residuals), shared_error(self.frame, first.residuals)
        return left, 1.0 - left.power / before.power if before.power > 0 else float("nan"), before.z


def _implausible(candidate: Candidate, values: Mapping[str, float]) -> str:
    """The first size that lies outside its plausible range, in words; empty where all lie within."""
    for size in candidate.sizes:
        value = values.get(size.key, size.neutral)
        room = 1e-3 * (size.upper - size.lower)
        if not size.lower - room <= value <= size.upper + room:
            return f"{size.key} = {value:.3g} {size.unit} lies outside what is plausible ({size.lower:g} to {size.upper:g})"
    return ""


def _merit(trial: Trial) -> tuple[bool, float]:
    """What the drives held out confirm goes before what they do not refute."""
    unasked = not np.isfinite(trial.held_out_gain)
    return unasked or trial.held_out_z > HELD_OUT_Z, trial.bic + (0.0 if unasked else trial.held_out_gain)


@dataclass(frozen=True)
class _Try:
    search: _Search
    base: Fit

    def __call__(self, job: tuple[str, int]) -> Trial | None:
        return self.search._try(job, self.base)


@dataclass(frozen=True)
class _Settle:
    search: _Search
    base: Fit

    def __call__(self, trial: Trial) -> Trial:
        return self.search._settle(trial, self.base)


@dataclass(frozen=True)
class _Judge:
    search: _Search
    base: Fit
    check: Mapping[int, np.ndarray]

    def __call__(self, trial: Trial) -> Trial | None:
        return self.search._judge(trial, self.base, self.check)
