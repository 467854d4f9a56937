"""From a library of candidates to the effects that are missing: proposed on fitted drives, decided on held-out ones.

Forward selection. Each round tests every candidate on the white residual of the present
model, refits the best few together with all that is calibrated, and keeps one only if it
is significant over the whole library, plausible in size, worth its parameters (BIC) and
makes drives better that it was never fitted to; a later one is taken back if, all drives aligned for it, the error grows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import InputError
from . import allowance, bursts, exemplar, probe, refit
from . import experiment as exp
from .allowance import Allowance
from .balance import ENOUGH
from .confirm import LEAST_SHARE
from .consistency import birge_ratio
from .contest import UNDRIVEN, UNSIZED, Contest
from .experiment import Experiment, Frame
from .probe import Job, Raw
from .refit import Fit
from .rung import Rung, awake, begin, climb, final_fit
from .selection import Round, Selection, State, Trial, removed
from .shared import Shared, shared_error
from .tries import LEAST_MOVED, own_sizes

EFFECTS = 6
"""Effects that are looked for, one after another. Cars of other programs differ from the model in up to six things at once; a search that
ends before them leaves more than half of the error, and what it found has no name."""

VAIN = "makes the error larger once drives are aligned and all is fitted anew with it"
"""What is said of an effect that is taken back."""

ALIAS, LEAST_OWN = 0.05, 0.01
"""Least share of the white power of a candidate that nuisances must leave for it to be tested: of what alignment takes out of every drive, which
below it is a nuisance under another name, and of any other effect, which may be much like one (the delay of a slow instrument) and yet be there."""


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
    simpler: Collection[str] = (),
    probed: Mapping[Job, Raw] = {},
    known: Mapping[str, float] = {},
    alike: Collection[str] = (),
) -> Selection:
    """Find up to ``most`` missing effects from a ``rung``.

    ``each`` maps a function over candidates (``map`` or that of a pool); ``together`` says whether a candidate may follow those
    accepted, by their names; ``say`` is told what goes on; ``simpler``: names that go before any other which
    explains hardly more. ``probed``: columns of candidates that are known from a search from the same rung. ``known``: as for ``propose``.
    ``alike``: names of candidates for which repeats borrow the columns of one of them (``exemplar``) where these would gain little.
    """
    return _Search(rung, most, seed, each, together, say, simpler, probed, known, alike).run()


@dataclass
class _Search:
    rung: Rung
    most: int
    seed: int
    each: Callable
    together: Callable
    say: Callable
    simpler: Collection[str] = ()
    probed: Mapping[Job, Raw] = field(default_factory=dict)
    known: Mapping[str, float] = field(default_factory=dict)
    alike: Collection[str] = ()
    borrowed: set[Job] = field(default_factory=set)
    """Jobs whose columns are borrowed."""
    accepted: list[str] = field(default_factory=list)
    shaped: set[str] = field(default_factory=set)
    """Keys of what shapes accepted effects and is fitted."""
    rounds: list[Round] = field(default_factory=list)
    vain: dict[str, Trial] = field(default_factory=dict)
    """Refits of effects that are VAIN beside those accepted, by name."""
    needless: set[str] = field(default_factory=set)
    """Names of accepted effects that the last fit does without."""
    refused: dict[str, str] = field(default_factory=dict)
    """Why candidates are not tested that have no size, or of which none could be simulated, by name."""

    def __post_init__(self):
        candidates = self.rung.experiment.candidates
        self.by_name = {candidate.name: candidate for candidate in candidates if candidate.sizes}
        self.refused |= {candidate.name: UNSIZED for candidate in candidates if not candidate.sizes}

    def run(self) -> Selection:
        states = [State.of(self.rung, "calibrated", self.rung.fit, self.rung.check)]
        self.first = states[0]
        self.say(f"probing {len(self.by_name)} candidates")
        self.sooner = self._sooner()
        self.columns = self._probe()
        rounds, contest = self.rounds, self._contest()
        while len(self.accepted) < self.most:
            turn = contest.round(self.vain)
            turn = replace(turn, passed_over={**turn.passed_over, **({} if rounds else self.refused)})
            if turn.winner is None:
                rounds.append(turn)
                self.columns |= contest.columns  # what the round leaves open, intervals allow for as it is there
                break
            reached = self._reached(turn.winner)
            state = State.of(reached, turn.winner.name, reached.fit, reached.check)
            if self.accepted and self._is_vain(states[-1], state):
                self.say(f"not accepted: {turn.winner.name}, {VAIN}")
                self.vain[turn.winner.name] = replace(turn.winner, objection=VAIN)
                continue
            rounds.append(turn)
            self.rung, self.vain = reached, {}
            self.shaped |= self._shaped_by(turn.winner)
            self.accepted.append(turn.winner.name)
            self.say(f"accepted {turn.winner.name}")
            self.columns = {job: own for job, own in self.columns.items() if self.together(self.accepted, job[0])}
            self.sooner = self._sooner()
            states.append(state)
            contest = self._contest()
        final, frame, sure = self._final_fit()
        if self.needless:  # shares are those of the model whose sizes are told
            self.rung = climb(self.rung.experiment, final.values, self._sizes(), self.each, before=self.rung)
            without = ", ".join(name for name in self.accepted if name in self.needless)
            states[-1] = State.of(self.rung, f"without {without}", self.rung.fit, self.rung.check)
        rung = self.rung
        typical = {size.key for size in self._sizes() if size.shaping and abs(final.values[size.key] - size.neutral) < LEAST_MOVED * size.probe}
        wider = birge_ratio(rung, final, frame, self._sizes(), self.each)
        found = refit.intervals(final, frame, self._sizes(), wider=wider)
        bounds = {key: interval for key, interval in found.items() if key not in typical}
        for turn in rounds:  # what gains that much is there, even where parameters that may be wrong leave its size open
            if turn.winner is not None and turn.is_large and turn.winner.name not in self.needless:
                own = {size.key for size in self.by_name[turn.winner.name].sizes}
                sure |= own if own & sure or self._is_needed(turn.winner.name, final, frame) else set()
        return Selection(
            tuple(rounds), tuple(states), rung.floor_squares, rung.held_out_floor_squares, rung.has_repeats, rung.frame,
            tuple(self.accepted), bounds, frozenset(sure), final, *self._remaining(states[0].fit, rung.fit), rung.check,
            rung.check_frame, wider, self.probed, self._allowed(final, frame), frozenset(self.needless),
            bursts.of_repeats(rung.frame, rung.fit.residuals), rung.is_floor_known,
        )  # fmt: skip

    def _contest(self) -> Contest:
        """The next round."""
        columns = {job: own for job, own in self.columns.items() if job[0] not in self.accepted}
        first_gain = self.rounds[0].winner.gain if self.accepted else 0.0
        return Contest(
            len(self.rounds), self.rung, self.by_name, self._sizes(), columns, self.sooner, self.first, first_gain,
            self.seed, self.each, self.say, self.simpler, self.known, self.borrowed & columns.keys(),
        )  # fmt: skip

    def _shaped_by(self, winner: Trial) -> set[str]:
        """Keys of what shapes the effect of a trial and was fitted."""
        return {size.key for size in self.by_name[winner.name].shaping if size.key in winner.fit.keys}

    def _reached(self, winner: Trial) -> Rung:
        """The rung of a model with the effect of a trial as well."""
        own = self.by_name[winner.name]
        sizes = [*self._sizes(), *own_sizes(own, self.shaped | self._shaped_by(winner))]
        rung = climb(self.rung.experiment, winner.fit.values, sizes, self.each, before=self.rung)
        return awake(rung, sizes, own.sizes, self.each)

    def _is_vain(self, before: State, after: State) -> bool:
        """Whether an effect that its refit spoke for makes the error larger, and drives held out hardly better, once drives are aligned and all
        is fitted anew with it."""
        share, held_out = removed(self.first, before, after, self.rung.floor_squares, self.rung.held_out_floor_squares)
        return share < -LEAST_SHARE and not held_out > LEAST_SHARE

    def _final_fit(self) -> tuple[Fit, Frame, set[str]]:
        """The fit whose sizes are told, its frame, and keys of the sizes that are there at all: without effects that the others do not need any
        longer, which would stand in for a part of these and only blur them."""
        rung = self.rung
        while True:
            final, frame = final_fit(rung, self._sizes(), self.each)
            # What shapes an effect means nothing where that is not there: it is held where only this is asked.
            sizes = [size for size in self._sizes() if not size.shaping]
            strict = refit.intervals(final, frame, sizes, held=True)
            sure = {size.key for size in sizes if not strict[size.key][0] <= size.neutral <= strict[size.key][1]}
            name = self._found_needless(final, frame, sure)
            if name is None:
                return final, frame, sure
            self.say(f"without {name} the last fit is no worse")
            self.needless.add(name)
            rung = replace(rung, fit=replace(rung.fit, values={**final.values, **self.by_name[name].at({})}))

    def _found_needless(self, final: Fit, frame: Frame, sure: Collection[str]) -> str | None:
        """The latest accepted effect with no size that is ``sure`` and that the fit does not need; one that stands alone stays."""
        standing = [name for name in self.accepted if name not in self.needless]
        blurred = (name for name in reversed(standing) if not any(size.key in sure for size in self.by_name[name].sizes))
        return next((name for name in blurred if len(standing) > 1 and not self._is_needed(name, final, frame)), None)

    def _allowed(self, final: Fit, frame: Frame) -> dict[str, Allowance]:
        """What the sizes of the accepted effects would move by if another effect were there as well."""
        open_yet = self._open() if self.accepted else ()
        raw = {job: own for job, own in self.columns.items() if job[0] in open_yet}
        found = allowance.allowances(final, frame, self._sizes(), raw, self.by_name, len({job[0] for job in self.columns})) if raw else {}
        free = {size.key for size in self.rung.experiment.free}
        return {key: own for key, own in found.items() if key not in free and own.shift > 0}

    def _open(self) -> set[str]:
        """Names of the candidates that the score test of the last round leaves open, all others where that round accepted one, and of what was
        accepted and is needless."""
        last, price = self.rounds[-1], self.rung.frame.price()
        if last.winner is not None:
            return set(self.by_name) - set(self.accepted) | self.needless
        return self.needless | {name for name, gain in zip(last.names, last.gain) if gain > len(self.by_name[name].sizes) * price}

    def _sizes(self) -> list[exp.Size]:
        """All that is fitted: what is free, and of the accepted effects that are needed sizes and shapes."""
        kept = [name for name in self.accepted if name not in self.needless]
        return [*self.rung.experiment.free, *(size for name in kept for size in own_sizes(self.by_name[name], self.shaped))]

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

    def _sooner(self) -> tuple[Experiment, Mapping[int, np.ndarray]]:
        """The experiment of the rung in longer steps, and its residuals."""
        return probe.coarsely(self.rung.experiment, self.rung.fit.values, self.rung.fit.residuals)

    def _probe(self) -> dict[Job, Raw]:
        """Change of the residuals in longer steps per probe of every size of every candidate and shape, in single precision."""
        jobs = [(name, shape) for name, candidate in self.by_name.items() for shape in range(len(candidate.shapes))]
        unknown, frame = [job for job in jobs if job not in self.probed], self.rung.frame
        sooner, residuals = self.sooner
        borrowing = [job for job in unknown if job[0] in self.alike]
        lenders = exemplar.exemplars(frame, self.rung.raw) if borrowing else {}
        asked = sorted(set(lenders.values()))
        own = probe.Probe(sooner, self.rung.fit.values, residuals)
        self.borrowed = set(borrowing) if len(asked) < len(lenders) else set()
        simulated = [job for job in unknown if job not in self.borrowed]
        self.probed = {**self.probed, **dict(zip(simulated, self.each(own, simulated)))}
        some = replace(own, residuals={index: residuals[index] for index in asked})
        lent = dict(zip(borrowing, self.each(some, borrowing))) if self.borrowed else {}
        # What an exemplar does not meet, others may: a stop that only a faster one reaches, a place that only a longer one comes to.
        unmet = [job for job, raw in lent.items() if len(raw) < len(self.by_name[job[0]].sizes)]
        self.probed |= dict(zip(unmet, self.each(own, unmet)))
        self.borrowed -= {*unmet}
        found = {**self.probed, **{job: exemplar.borrowed(sooner, lenders, lent[job]) for job in self.borrowed}}
        silent = [name for name in self.by_name if not any(found[job] for job in jobs if job[0] == name)]
        refusals = zip(silent, self.each(own.refusal, [(name, 0) for name in silent]))
        self.refused |= {name: f"{UNDRIVEN}: {why}" for name, why in refusals if why}
        least = lambda name: ALIAS if self.by_name[name].is_aligned else LEAST_OWN
        shares = lambda job: frame.own_shares(list(found[job].values()), asked if job in self.borrowed else frame.indices)
        return {job: found[job] for job in jobs if found[job] and shares(job).max() > least(job[0])}

    def _remaining(self, first: Fit, last: Fit) -> tuple[Shared, float, float, float, float, float]:
        """What all repeats still share, the share of it that is gone, the z that it had at first and that of more than half being left; of what
        is faster than a driver the share that is gone and the z, too."""
        left, before = shared_error(self.rung.frame, last.residuals), shared_error(self.rung.frame, first.residuals)
        gone = lambda now, then: 1.0 - now / then if then > 0 else float("nan")
        return left, gone(left.power, before.power), before.z, left.left_z(before, 1.0 - ENOUGH), gone(left.faster, before.faster), before.faster_z
