"""A candidate tried: its sizes fitted together with all that is free, settled while the error falls by much, and its shape fitted."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from . import evidence, floor, probe, refit
from . import experiment as exp
from .candidates import PROBE
from .experiment import Candidate, Experiment, Frame, Size
from .probe import Job, Raw
from .refit import Fit
from .rung import WAKING, Rung, independent
from .selection import Trial

CONTENT = 0.98
"""Share of the gain of a size that is not plausible at which a plausible one does as well."""

CHANCE = 3.84
"""Fall of the white loss that one free size reaches by chance in one of twenty fits: so little is no sign of an implausible one."""

TYPICAL = 1.0 / PROBE
"""Probes that make the typical size of an effect."""

REACHED = 0.5
"""Share of the fall of the loss that its columns foresee below which a fit from nothing may have stopped on its way."""

LARGE = 0.02
"""Gain per independent value of the records above which a refit is repeated with the spectrum of its own residuals."""

HUGE = 0.2
"""The same, above which the columns of all parameters are made anew."""

CYCLES = 8
"""Most such repetitions."""

DOUBLINGS = 4
"""Most times that the way of a first refit is doubled."""

SCALES = 0.05
"""Share of the power of a shape's column that sizes must leave: below it a shape is a size under another name."""

LEAST_MOVED = 0.1
"""Probes that a shape must move by to be another."""


@dataclass(frozen=True)
class Tries:
    """Refits of ``candidates`` (by name) from a ``rung``, together with the sizes of it that are ``fitted`` anyway; ``columns``: raw
    change of the residuals per probe of every size, by job and key; ``sooner``: the experiment of the rung in longer steps
    (``probe.coarsely``); ``likely``: the information of the rung; ``each``: a map over sizes that are probed."""

    rung: Rung
    candidates: Mapping[str, Candidate]
    fitted: Sequence[Size]
    columns: Mapping[Job, Raw]
    sooner: Experiment
    likely: float
    each: Callable = map

    def first(self, job: Job) -> Trial | None:
        """The refit of a candidate in one shape; None where it cannot be simulated."""
        rung, base = self.rung, self.rung.fit
        candidate, raw = self.candidates[job[0]], {**rung.raw, **self.columns[job]}
        shape = candidate.shapes[job[1]]
        sizes = [size for size in (*self.fitted, *candidate.sizes) if size.key in raw]
        columns = probe.white(rung.frame, {size.key: raw[size.key] for size in sizes})
        start, own = {**base.values, **candidate.at({}), **shape}, list(self.columns[job])
        settings = {"renewed": own, "residuals": base.residuals}
        try:
            fit = refit.refit_sooner(rung.experiment, self.sooner, rung.frame, start, sizes, columns, **settings)
            if implausible(candidate, fit.values):
                inside = refit.refit_sooner(rung.experiment, self.sooner, rung.frame, start, sizes, columns, **settings, beyond=0.0)
                before = float(np.sum(rung.frame.flat(base.residuals) ** 2))
                does = inside.loss - fit.loss < CHANCE or before - inside.loss > CONTENT * (before - fit.loss)
                fit = inside if does else fit
            fit = self._begun(fit, [size for size in candidate.sizes if size.key in columns], columns)
            fit = self._from_far(fit, start, sizes, columns, own, candidate.reach(job[1]))
            fit = self._from_plausible(fit, start, sizes, columns, candidate.sizes)
            return self._trial(candidate, shape, self._lengthened(fit, sizes))
        except (InputError, ValueError):
            return None

    def _begun(self, fit: Fit, own: Sequence[Size], columns: Mapping[str, np.ndarray]) -> Fit:
        """A fit that ended where it began, with the candidate's ``own`` sizes taken as far as their columns foresee, all others as they were,
        where that is likelier and the error falls.

        Where nearly all of a signal is explained the white loss weighs most: a step of all sizes together, some of whose columns bend, makes
        it larger there, though the candidate takes away what is large elsewhere.
        """
        frame, before = self.rung.frame, self.rung.fit
        if before.loss - fit.loss > refit.WORTHWHILE:
            return fit
        reached, _ = refit.stepped(fit.values, own, np.stack([columns[size.key] for size in own]), frame.flat(before.residuals))
        try:
            residuals = exp.simulate(self.rung.experiment, reached, frame.indices)
        except (InputError, ValueError):
            return fit
        if refit.information(frame, residuals) < self.likely + refit.WORTHWHILE or self._error(residuals) > self._error(before.residuals):
            return fit
        return replace(fit, values=reached, residuals=residuals, loss=float(np.sum(frame.flat(residuals) ** 2)))

    def _from_far(
        self, fit: Fit, start: Mapping[str, float], sizes: Sequence[Size], columns: Mapping[str, np.ndarray], own: Sequence[str], reach: float
    ) -> Fit:
        """A fit from ``start`` that reached less than its columns foresee, or the one from typical sizes of the candidate where drives are
        likelier with these; ``own``: their keys. Of a candidate that is tried over more than a probe, ``reach``, whatever the first reached, from
        sizes of as much.

        Wheels on their bushings shake at 50 Hz where these hardly give way and at 17 Hz as they do: between nothing and what is missing
        lies what is much worse than both, for each axle alone, too.
        """
        rung, frame, before = self.rung, self.rung.frame, self.rung.fit
        matrix, flat = np.stack([columns[size.key] for size in sizes]), frame.flat(before.residuals)
        _, foreseen = refit.stepped(before.values, sizes, matrix, flat)
        if reach == 1.0 and before.loss - fit.loss > REACHED * foreseen:
            return fit
        sought = [size for size in sizes if size.key in own]
        typical = {**start, **_typical(sought, probes=TYPICAL if reach == 1.0 else reach)}
        try:
            residuals = exp.simulate(rung.experiment, typical, frame.indices)
            likely = max(self.likely, refit.information(frame, fit.residuals))
            if reach == 1.0 and refit.information(frame, residuals) < likely + refit.WORTHWHILE:
                return fit
            raw = probe.secants(rung.experiment, typical, residuals, sought, self.each)
            there = {**columns, **probe.white(frame, raw)}
            found = refit.refit(rung.experiment, frame, typical, sizes, there, renewed=own, residuals=residuals, beyond=0.0)
        except (InputError, ValueError):
            return fit
        return found if self._error(found.residuals) < self._error(fit.residuals) else fit

    def _from_plausible(
        self, fit: Fit, start: Mapping[str, float], sizes: Sequence[Size], columns: Mapping[str, np.ndarray], own: Sequence[Size]
    ) -> Fit:
        """A fit beside accepted effects whose sizes are no longer plausible, or the one from typical sizes of these and of the candidate where
        that fits better.

        What is missing yet may have driven them there, and lie behind a wall: without a rolling radius that goes by the load no force along
        the wheels was better than any, and their relaxation lengths went to twice what is plausible.
        """
        rung, free = self.rung, {size.key for size in self.rung.experiment.free}
        far = [size for size in sizes if size.key not in free and size not in own and size.key in start and not size.holds(start[size.key])]
        if not far:
            return fit
        sought = [*far, *(size for size in sizes if size in own)]
        typical = {**start, **_typical(sought, start)}
        try:
            residuals = exp.simulate(rung.experiment, typical, rung.frame.indices)
            there = {**columns, **probe.white(rung.frame, probe.secants(rung.experiment, typical, residuals, sought, self.each))}
            found = refit.refit(
                rung.experiment, rung.frame, typical, sizes, there, renewed=[size.key for size in sought], iterations=WAKING,
                residuals=residuals, beyond=0.0,
            )  # fmt: skip
        except (InputError, ValueError):
            return fit
        return min(fit, found, key=lambda one: one.loss)

    def _lengthened(self, fit: Fit, sizes: Sequence[Size]) -> Fit:
        """A fit whose way from the rung is doubled while that is foreseen to be more likely, is so, and the error falls.

        The loss is white by the error of before. Where that was large it weighs little, and elsewhere much, so that the
        fit of an effect that makes other signals worse until parameters follow stops at a tenth of its size.
        """
        frame, before = self.rung.frame, self.rung.fit
        reached = refit.information(frame, fit.residuals)
        for _ in range(DOUBLINGS):
            foreseen = {i: 2.0 * part - before.residuals[i] for i, part in fit.residuals.items()}
            if refit.information(frame, foreseen) < reached + refit.WORTHWHILE:
                break
            way = {size: fit.values[size.key] - before.values.get(size.key, size.neutral) for size in sizes}
            longer = {size.key: float(np.clip(fit.values[size.key] + way[size], size.lower, size.upper)) for size in sizes}
            values = {**fit.values, **longer}
            try:
                residuals = exp.simulate(self.rung.experiment, values, frame.indices)
            except (InputError, ValueError):
                break
            likely = refit.information(frame, residuals)
            if likely < reached + refit.WORTHWHILE or self._error(residuals) > self._error(fit.residuals):
                break
            fit = replace(fit, values=values, residuals=residuals, loss=float(np.sum(frame.flat(residuals) ** 2)))
            reached = likely
        return fit

    def _error(self, residuals: Mapping[int, np.ndarray]) -> float:
        """Mean squares of the channels over those of the rung, summed."""
        squares = lambda parts: floor.squares(self.rung.experiment, self.rung.frame.all_cleaned(parts)).mean(axis=0)
        return float(np.sum(squares(residuals) / squares(self.rung.fit.residuals)))

    def settled(self, trial: Trial, gained: float | None = None) -> Trial:
        """A refit that gains much repeated in the frame of its own residuals while the error falls by much; ``gained``: since its
        columns were made, if that is less than all.

        A large error makes itself white: what is missing weighs least where it is largest.
        """
        rung, candidate, fit = self.rung, self.candidates[trial.name], trial.fit
        gained = trial.gain if gained is None else gained
        if not self.is_large(gained):
            return trial
        own = [size for size in own_sizes(candidate, fit.keys) if size.key in fit.keys]
        every = [*self.fitted, *own]
        beyond = refit.BEYOND if implausible(candidate, fit.values) else 0.0
        try:
            for _ in range(CYCLES):
                frame, anew = self._own_frame(fit), own if not self._is_huge(gained) else every
                sooner, base = probe.coarsely(rung.experiment, fit.values, fit.residuals)
                raw = {**rung.raw, **probe.secants(sooner, fit.values, base, anew, self.each)}
                columns = probe.white(frame, raw)
                sizes = [size for size in every if size.key in columns]
                fit = refit.refit_sooner(
                    rung.experiment, sooner, frame, fit.values, sizes, columns, renewed=[size.key for size in own],
                    residuals=fit.residuals, beyond=beyond,
                )  # fmt: skip
                shape = {key: fit.values[key] for key in trial.shape}
                found = self._trial(candidate, shape, fit, sum(size.shaping for size in own))
                gained = found.gain - trial.gain
                trial = found if gained > 0 else trial
                if not self.is_large(gained):
                    break
        except (InputError, ValueError):
            pass
        return trial

    def shaped(self, trial: Trial) -> Trial:
        """The refit repeated with what shapes the effect fitted, too, where that is worth its parameters.

        One that gains much is fitted on in the frame of its own residuals: in that of the rung, whose error it is that made itself white,
        an engine on its mounts went to half of its mass and another frequency, and was likelier by its own spectra where it had been.
        """
        rung, candidate, fit = self.rung, self.candidates[trial.name], trial.fit
        sizes = [size for size in (*self.fitted, *candidate.sizes) if size.key in fit.keys]
        own = [size for size in candidate.sizes if size.key in fit.keys]
        try:
            frame = self._own_frame(fit) if self.is_large(trial.gain) else rung.frame
            sooner, base = probe.coarsely(rung.experiment, fit.values, fit.residuals)
            anew = own if not self._is_huge(trial.gain) else sizes
            raw = probe.secants(sooner, fit.values, base, [*anew, *candidate.shaping], self.each)
            columns = probe.white(frame, {**rung.raw, **raw})
            sizes = [size for size in sizes if size.key in columns]
            apart = _apart(candidate.shaping, columns, own)
            if not self._is_promising(frame, fit, columns, sizes, apart):
                return trial
            rest = [size for size in sizes if size.key not in raw]
            if rest:
                # Columns from where the effect was not there yet leave of a shape what parameters make good beside it.
                columns |= probe.white(frame, probe.secants(sooner, fit.values, base, rest, self.each))
                if not self._is_promising(frame, fit, columns, sizes, apart):
                    return trial
            fitted = refit.refit_sooner(
                rung.experiment, sooner, frame, fit.values, [*sizes, *apart], columns,
                renewed=[size.key for size in (*own, *apart)], residuals=fit.residuals, beyond=0.0,
            )  # fmt: skip
            if all(abs(fitted.values[size.key] - fit.values[size.key]) < LEAST_MOVED * size.probe for size in apart):
                return trial
            found = self._trial(candidate, {key: fitted.values[key] for key in trial.shape}, fitted, len(apart))
        except (InputError, ValueError):
            return trial
        return self.settled(found, found.gain - trial.gain) if found.bic > trial.bic else trial

    def is_large(self, gain: float) -> bool:
        """Whether a gain is so large that the error changes its colour by it."""
        return gain > LARGE * independent(self.rung.experiment)

    def _is_huge(self, gain: float) -> bool:
        """Whether a gain is so large that the columns of all parameters change by it."""
        return gain >= HUGE * independent(self.rung.experiment)

    def _own_frame(self, fit: Fit) -> Frame:
        """The frame in which the residuals of a fit are white; what has grown weighs by its power in that of the rung."""
        frame = self.rung.frame
        return exp.frame(self.rung.experiment, fit.residuals, frame.nuisances, frame.all_cleaned(fit.residuals), frame)

    def _is_promising(
        self, frame: Frame, fit: Fit, columns: Mapping[str, np.ndarray], fitted: Sequence[Size], more: Sequence[Size]
    ) -> bool:
        """Whether ``more`` than what is ``fitted`` would be worth its parameters in a frame, were all linear."""
        if not more:
            return False
        free = evidence.basis(np.stack([columns[size.key] for size in fitted]))
        extra = evidence.basis(evidence.without(np.stack([columns[size.key] for size in more]), free))
        return bool(np.sum((extra @ frame.flat(fit.residuals)) ** 2) > len(more) * self.rung.frame.price())

    def _trial(self, candidate: Candidate, shape: Mapping[str, float], fit: Fit, more: int = 0) -> Trial:
        """What a refit gains on the drives that it was fitted to, ``more`` parameters than sizes fitted; the others have not been asked."""
        frame = self.rung.frame
        gain = refit.information(frame, fit.residuals) - self.likely
        bic = gain - (len(candidate.sizes) + more) * frame.price()
        unknown = (float("nan"),) * 4
        return Trial(candidate.name, shape, replace(fit, columns=np.zeros((0, 0))), gain, bic, *unknown, "")


def _typical(sizes: Sequence[Size], values: Mapping[str, float] = {}, probes: float = TYPICAL) -> dict[str, float]:
    """Typical values of ``sizes``, so many ``probes`` from neutral, that are plausible, by key; on the side of the neutral one on which they lie, of
    those that have ``values``."""
    way = {size.key: -1.0 if (values.get(size.key, size.neutral) - size.neutral) * size.probe < 0 else 1.0 for size in sizes}
    return {size.key: float(np.clip(size.neutral + way[size.key] * probes * size.probe, size.lower, size.upper)) for size in sizes}


def own_sizes(candidate: Candidate, fitted: Collection[str]) -> list[Size]:
    """The sizes of a candidate, and of what shapes it those that are ``fitted``."""
    return [*candidate.sizes, *(size for size in candidate.shaping if size.key in fitted)]


def implausible(candidate: Candidate, values: Mapping[str, float]) -> str:
    """The first size that lies outside its plausible range, in words; empty where all lie within."""
    for size in candidate.sizes:
        value = values.get(size.key, size.neutral)
        if not size.holds(value):
            return f"{size.key} = {value:.3g} {size.unit} lies outside what is plausible ({size.lower:g} to {size.upper:g})"
    return ""


def _apart(shaping: Sequence[Size], columns: Mapping[str, np.ndarray], own: Sequence[Size]) -> list[Size]:
    """Those of what shapes an effect whose columns are no sum of those of its ``own`` sizes."""
    span = evidence.basis(np.stack([columns[size.key] for size in own]))
    left = lambda row: float(np.sum(evidence.without(row, span) ** 2))
    return [size for size in shaping if left(columns[size.key]) > SCALES * float(np.sum(columns[size.key] ** 2))]
