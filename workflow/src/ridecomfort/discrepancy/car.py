"""Measured drives and the vehicle that is meant to explain them, as an Experiment."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .. import simulate as simulator
from ..calibrated import with_values
from ..drive import pedals
from ..drive.paced import Paced
from ..drive.replay import ASTRAY, CORRECTED, Following, Replay, Simulated, slowly
from ..drive.sampling import rate_of
from ..drive.steered import Steered
from ..effects import library
from ..effects.contract import COMPILED
from ..vocabulary import SIGNALS
from . import elsewhere, floor, nuisances
from .experiment import Candidate, Record, Size, by_record

LONGEST = 0.002
"""s; in such steps most changes of a drive differ by less than half a percent from those in steps of 1 ms."""

COARSER = 8.0
"""Times an error of the integration that is made good is smaller than one in steps twice as long which is not: by its order four, where a
wheel meets an edge or leaves the ground up to eight."""


@dataclass
class Car:
    """Drives on one or several sites beside a vehicle with ``effects`` (those the model already has)."""

    records: list[Record]
    replays: list[Replay]
    vehicle: object
    effects: Mapping[str, Mapping[str, float]]
    free: tuple[Size, ...]
    candidates: tuple[Candidate, ...]
    quiet: Mapping[str, Mapping[str, float]]
    """Effects that are in every simulation at neutral values, so that one compiled kernel serves for all of them."""
    channels: tuple[str, ...] = SIGNALS
    each_record: Callable = map
    exactness: Mapping[int, np.ndarray] = field(default_factory=dict)
    """By record, what a residual (6, sample) lacks because the step of integration is not nil."""
    steered: Mapping[int, Steered | None] = field(default_factory=dict)
    """By record, how it answers to the path that its driver is asked for..."""
    paced: Mapping[int, Paced | None] = field(default_factory=dict)
    """...and to its speed, where what his foot does to that is known."""
    driven: Mapping[int, tuple[Mapping[str, float], Simulated]] = field(default_factory=dict)
    """By record, the values at which its replay was driven last, and what the model did."""

    set_aside: tuple[str, ...] = ()
    """Words on drives that were left out, since they are too short."""

    @property
    def inexact(self) -> dict[int, np.ndarray]:
        """By record, what a residual lacks in steps twice as long, in which fits are made: other values meet an edge of the road, or the ground
        after a jump, at another moment of a step, and what is made good at some is not at others."""
        return {index: COARSER * wrong for index, wrong in self.exactness.items() if np.ndim(wrong)}

    def looking_for(self, candidates: Sequence[Candidate], folder) -> Car:
        """The same with these candidates, whose effects are in the files of a folder."""
        known = library.find(folder)
        names = {size.key.partition(".")[0] for candidate in candidates for size in candidate.sizes}
        quiet = {name: known[name].effect.neutral for name in names if known[name].effect.port in COMPILED}
        replays = [replace(again, options={**again.options, "effects_folder": folder}) for again in self.replays]
        return replace(self, candidates=tuple(candidates), quiet=quiet, replays=replays)

    def measured(self, index: int) -> np.ndarray:
        """The measured signals (6, sample) of a record behind the run-in of the model."""
        again = self.replays[index]
        return again.measured()[:, again.compared]

    def residual(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """Simulated minus measured signals (6, sample) behind the run-in of the model. What is missing of the path is made good without
        driving again."""
        found = self._following(values, index)
        return self._on_path(index, found) + self.exactness.get(index, 0.0)

    def _on_path(self, index: int, found: Following) -> np.ndarray:
        """A residual (6, sample) as it would be had the driver kept to the measured path to the last millimetre, and to its speed."""
        residual, steered, paced = found.residual()[:, found.replay.compared], self.steered.get(index), self.paced.get(index)
        if steered and "lateral" in found.astray:
            residual = residual + steered.made_good(found.astray["lateral"] + found.replay.left)
        if paced and "speed" in found.astray:
            residual = residual + paced.made_good(found.astray["speed"])
        return residual

    def simulated(self, values: Mapping[str, float], index: int) -> Simulated:
        """What the model does on a drive."""
        known, simulated = self.driven.get(index, (None, None))
        if known == dict(values):
            return simulated
        return self._following(values, index).simulated

    def _following(self, values: Mapping[str, float], index: int) -> Following:
        """A drive along the measured path at the measured speed, as far as while values are fitted.

        An effect that moves a vehicle aside makes it meet another road, unless its driver makes up for it as the measured one did.
        """
        again = self.replays[index]
        return self._led(again, values, ASTRAY if self.paced.get(index) else again.strictly(ASTRAY), CORRECTED)

    def _led(self, again: Replay, values: Mapping[str, float], *limits) -> Following:
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        return again.following(vehicle, {**self.quiet, **effects}, *limits)

    def nuisances(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """What alignment and the road's file leave open of a record, (direction, 6, sample)."""
        again = self.replays[index]
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        aside = again.aside(vehicle, {**self.quiet, **effects})
        simulated = self.simulated(values, index)
        return nuisances.directions(again, simulated, aside, self._otherwise(again, vehicle, effects))

    def _otherwise(self, again: Replay, vehicle, effects) -> np.ndarray:
        """The signals (6, time) on a road that is interpolated the other way, or as they are where there is only one."""
        if isinstance(again.road, simulator.Course):
            again = replace(again, road=again.road.otherwise())
        return again(vehicle, {**self.quiet, **effects}).signals

    def shifts(self, other: Car, index: int) -> np.ndarray:
        """By how many seconds this puts the samples of a record later against their place than ``other`` does, (sample,)."""
        mine, its = self.replays[index], other.replays[index]
        shift = np.interp(its.place, mine.place, mine.time) - mine.time
        return shift[mine.compared]

    def retuned(
        self, values: Mapping[str, float], indices: Sequence[int], exactly: bool = False
    ) -> tuple[Car, dict[int, np.ndarray]]:
        """The same with drivers who bring the model to the measured speed and path at these values, and the residuals then. They are held to
        what they drive then at all other values: each correction follows what is fast in a recorded path a little farther, so that of two
        models the one that was corrected once more would be on another road. Where drives were repeated they are asked for no more of their foot
        than is likely theirs; else the floor is no noise, and what a model lacks would pass for that of the accelerometer.

        ``exactly``: with what the step makes wrong at these values made good in the residuals from now on. The error falls with the
        square of the step: half a step takes three quarters of it, and four thirds of that change are all of it. On a quiet record,
        0.05 percent of the power of a_y is enough to pass for tyres that envelop 6 cm.
        """

        is_repeated = bool(floor.repeats(self, range(len(self.records))))

        def driven(index: int) -> tuple[Replay, Simulated, np.ndarray, np.ndarray | float]:
            again = replace(self.replays[index], kept_to={})
            if is_repeated and again.by_foot is not None:
                again = pedals.without_noise(again, self.simulated(values, index))
            following = self._led(again, values)
            again, residual = following.replay, self._on_path(index, following)
            missing = self._missing(values, index, again, residual) if exactly else self.exactness.get(index, 0.0)
            return again.keeping(following.run, following.astray.get("speed")), following.simulated, residual, missing

        found = by_record(self, driven, indices)
        retuned = replace(
            self,
            replays=[found[index][0] if index in found else again for index, again in enumerate(self.replays)],
            exactness={**self.exactness, **{index: missing for index, (*_, missing) in found.items()}},
            driven={**self.driven, **{index: (dict(values), simulated) for index, (_, simulated, *_) in found.items()}},
        )
        return retuned, {index: residual + missing for index, (_, _, residual, missing) in found.items()}

    def _missing(self, values: Mapping[str, float], index: int, again: Replay, residual: np.ndarray) -> np.ndarray | float:
        """What a ``residual`` (6, sample) lacks because the step of integration is not nil."""
        fine = _stepped(again, 0.5)
        if fine is again:
            return 0.0
        vehicle, effects = with_values(self.vehicle, self.effects, values)
        found = fine.following(vehicle, {**self.quiet, **effects}, corrections=0)
        return 4.0 / 3.0 * (self._on_path(index, found) - residual)

    def would_differ(self, one: Mapping[str, float], other: Mapping[str, float], index: int) -> dict[str, np.ndarray]:
        """``Experiment.would_differ``: at other speeds."""
        models = (with_values(self.vehicle, self.effects, values) for values in (one, other))
        complete = ((vehicle, {**self.quiet, **effects}) for vehicle, effects in models)
        return elsewhere.differences(self.replays[index], *complete, self.records[index].rate)

    def taking(self, other: Car, indices: Collection[int]) -> Car:
        """The same with these records as ``other`` has them."""
        mixed = lambda mine, its: [its[i] if i in indices else one for i, one in enumerate(mine)]
        driven = {i: known for i, known in self.driven.items() if i not in indices}
        driven |= {i: known for i, known in other.driven.items() if i in indices}
        return replace(
            self, replays=mixed(self.replays, other.replays), records=mixed(self.records, other.records), driven=driven
        )

    def coarser(
        self, values: Mapping[str, float], residuals: Mapping[int, np.ndarray]
    ) -> tuple[Car, Mapping[int, np.ndarray]]:
        """``Experiment.coarser``; itself where the simulator is not the study's own, or such steps are longer than LONGEST."""
        stepped = {index: _stepped(self.replays[index], 2.0) for index in residuals}
        if any(one is self.replays[index] or one.options["step"] > LONGEST for index, one in stepped.items()):
            return self, residuals
        longer = replace(self, replays=[stepped.get(index, again) for index, again in enumerate(self.replays)], exactness={}, driven={})
        plain = by_record(self, lambda index: longer.residual(values, index), residuals)
        wrong = {index: residuals[index] - own for index, own in plain.items()}
        return replace(longer, exactness={**self.exactness, **wrong}), {index: own + wrong[index] for index, own in plain.items()}

    def realigned(self, amounts: Mapping[int, np.ndarray]) -> Car:
        """The same with slow errors of the clock (s) and of the path (m) taken out; biases, gains and tilts stay linear."""
        replays, records = list(self.replays), list(self.records)
        for index, found in amounts.items():
            again = replays[index]
            kept = again.compared
            later, left = nuisances.slow(found, again.place[kept])
            shift = np.interp(again.time, again.time[kept], later)
            place = np.interp(again.time - shift, again.time, again.place)
            aside = np.interp(again.time, again.time[kept], left)
            drive = again.drive.assign(e=again.drive["e"] - aside)
            nearer = replace(again, drive=drive, place=place, kept_to={})
            replays[index] = nearer.corrected({"lateral": -slowly(aside, rate_of(again.time))})
            records[index] = replace(records[index], place=place[kept])
        driven = {index: known for index, known in self.driven.items() if index not in amounts}
        return replace(self, replays=replays, records=records, driven=driven)


def _stepped(again: Replay, longer: float) -> Replay:
    """The same in steps so many times as long, recorded as seldom as that where they are longer; where the simulator is the study's own."""
    if again.simulate is not simulator.run:
        return again
    step, rate = longer * again.options.get("step", simulator.STEP), again.options["rate"] / max(longer, 1.0)
    return replace(again, options={**again.options, "step": step, "rate": rate})
