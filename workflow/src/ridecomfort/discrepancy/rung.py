"""A model beside drives that are aligned for it, its free sizes fitted: where a search begins, and where every accepted effect leads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from . import experiment as exp
from . import floor, probe, realign, refit
from .experiment import Experiment, Frame, Size
from .probe import Raw
from .refit import Fit

ASLEEP, WAKING = 0.05, 6
"""Share of what is plausible within which a size counts as one that ended where it starts, and steps of a fit from far off."""

MOVED, CARRIED, DOUBLINGS = 4.0, 6, 6
"""Fall of the white loss for every size from which on a fit has moved since its drives were aligned (by chance each takes one), how often
at most it is carried on then, and how often at most its way is doubled."""

REACH, LEAST_REACH = 10.0, 0.05
"""Standard errors over which columns of the last fit are taken, and probes at least: over a whole probe the column of a relaxation length
can be so bent that no step along it makes drives likelier."""

CLIMBS, CLIMBED = 4, 0.02
"""How often at most, in all, drives are aligned and all is fitted for one more effect, and gain of a fit per independent value of the records
below which not again."""

NEAR = 1.0
"""Probes that every size of a fit has moved at most for its columns not to be made anew. What columns from elsewhere leave of the parameters
passes for evidence, and a refit with them comes to a stand: of a tyre that progresses, from a file with other springs, after a fortieth of
its gain."""

FITS = 2
"""Fits from one alignment, each in the frame of the residuals of the one before: an error in what makes it white comes out too small."""


@dataclass(frozen=True)
class Rung:
    """``experiment``: its records aligned for the model. Of the fitted records ``frame``, ``fit`` and the ``raw`` columns of what is
    fitted; of those held out ``check`` (residuals) and ``check_frame``, empty and None without any. ``floor_squares``,
    ``held_out_floor_squares``: of the floor, mean squares (record, channel); ``has_repeats``: whether a fitted drive was repeated by
    another, ``is_floor_known``: whether any drive was, so that it is known from repeats."""

    experiment: Experiment
    frame: Frame
    fit: Fit
    raw: Raw
    check: Mapping[int, np.ndarray]
    check_frame: Frame | None
    floor_squares: np.ndarray
    held_out_floor_squares: np.ndarray
    has_repeats: bool
    is_floor_known: bool

    def squares(self, fit: Fit, check: Mapping[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Mean squares (record, channel) of the fitted records of a fit, and of residuals ``check`` of those held out; without any of
        these the floor, which has no records either."""
        squares = floor.squares(self.experiment, self.frame.all_cleaned(fit.residuals))
        held_out = floor.squares(self.experiment, self.check_frame.all_cleaned(check)) if check else self.held_out_floor_squares
        return squares, held_out


def roles(experiment: Experiment) -> tuple[list[int], list[int]]:
    """Indices of the records that are fitted, and of those held out. Raises InputError when none is fitted."""
    fitted = [i for i, record in enumerate(experiment.records) if record.role == "fit"]
    if not fitted:
        raise InputError("no drive has the role 'fit' (expected at least one)", place="drives")
    return fitted, [i for i, record in enumerate(experiment.records) if record.role != "fit"]


def begin(experiment: Experiment, start: Mapping[str, float], each: Callable = map) -> Rung:
    """The calibrated model at ``start`` as a rung, its drives aligned a second time for what the first fit found."""
    experiment, _, fit, raw, _ = _fitted(experiment, start, experiment.free, each)
    return climb(experiment, fit.values, experiment.free, each, raw=raw if _is_near(fit, start, experiment.free) else None)


def climb(
    experiment: Experiment, values: Mapping[str, float], sizes: Sequence[Size], each: Callable = map, *, raw: Raw | None = None,
    before: Rung | None = None,
) -> Rung:  # fmt: skip
    """The rung of a model from ``values``, its ``sizes`` fitted; ``raw``: columns of these where they are known, ``before``: the rung
    below it, above whose floor none can lie, and than whose frame those that it is fitted in have no more power (``experiment.frame``).

    Above another, drives are aligned and all is fitted anew while that gains much: sizes that go together come but a part of their way in
    one alignment, and what is looked for next may stand in for the rest.
    """
    least = None if before is None else before.frame
    experiment, frame, fit, raw, gained = _fitted(experiment, values, sizes, each, raw, least)
    for _ in range(CLIMBS - 1):
        if before is None or gained < CLIMBED * independent(experiment):
            break
        try:
            farther = _fitted(experiment, fit.values, sizes, each, None, least)
        except (InputError, ValueError):  # where it came to some vehicle may not be probed
            break
        values, (experiment, frame, fit, raw, gained) = fit.values, farther
    raw = raw if _is_near(fit, values, sizes) else _anew(experiment, fit, sizes, each, raw)
    held_out, check, check_frame = roles(experiment)[1], {}, None
    if held_out:
        check, check_frame, experiment = realign.aligned(experiment, fit.values, held_out, None if before is None else before.check_frame)
        if before is not None:  # aligned it is judged by its own spectrum
            check_frame = exp.frame(experiment, check, check_frame.nuisances, check_frame.all_cleaned(check))
    has_repeats = bool(floor.repeats(experiment, frame.indices))
    is_floor_known, floor_squares, held_out_floor_squares = _floor_squares(experiment, frame, fit, check, check_frame)
    if before is not None:
        floor_squares = np.minimum(before.floor_squares, floor_squares)
        held_out_floor_squares = np.minimum(before.held_out_floor_squares, held_out_floor_squares)
    return Rung(experiment, frame, fit, raw, check, check_frame, floor_squares, held_out_floor_squares, has_repeats, is_floor_known)


def independent(experiment: Experiment) -> float:
    """Independent values in the band of the fitted records and channels."""
    records = [experiment.records[index] for index in roles(experiment)[0]]
    seconds = [len(record.place) / record.rate for record in records]
    return len(experiment.channels) * sum(2 * t * (r.band[1] - r.band[0]) for t, r in zip(seconds, records))


@dataclass(frozen=True)
class _Aligned:
    """Records ``aligned`` for a model at ``values``: residuals, their frame and the experiment."""

    values: Mapping[str, float]
    residuals: Mapping[int, np.ndarray]
    frame: Frame
    experiment: Experiment

    @classmethod
    def at(cls, experiment: Experiment, values: Mapping[str, float], indices: Sequence[int]) -> _Aligned:
        return cls(values, *realign.aligned(experiment, values, indices))


def final_fit(rung: Rung, sizes: Sequence[Size], each: Callable = map) -> tuple[Fit, Frame]:
    """The fit whose sizes are told, with its frame: the drives aligned anew for what was found, as often as that moves the sizes.

    A size of an effect that ended where it starts, and can be larger only, may do better far off (a lag of some milliseconds is none): it is
    fitted from the middle of what is plausible, too.
    """
    start = _Aligned.at(rung.experiment, rung.fit.values, rung.frame.indices)
    raw = _near(start, sizes, rung.raw, each)
    fit, frame = _at_own_spectrum(start, sizes, raw)
    for _ in range(CARRIED):
        farther = _carried_on(rung.experiment, start, fit, frame, sizes)
        if farther is None:
            break
        start = farther
        raw = _near(start, sizes, raw, each)
        fit, frame = _at_own_spectrum(start, sizes, raw)
    free = {size.key for size in rung.experiment.free}
    for size in _asleep(fit, (size for size in sizes if size.key not in free)):
        fit = min(fit, _woken(start.experiment, frame, fit, sizes, size, raw), key=lambda one: one.loss)
    return fit, frame


def awake(rung: Rung, sizes: Sequence[Size], newest: Sequence[Size], each: Callable = map) -> Rung:
    """The rung with all ``sizes`` fitted from far off one of the ``newest`` that ended where it starts, where that is better; else the same.

    Before the next effect is looked for: what such a size would do, another effect stands in for (for the longitudinal relaxation of tyres,
    wheels that recede).
    """
    for size in _asleep(rung.fit, newest):
        fit = _woken(rung.experiment, rung.frame, rung.fit, sizes, size, rung.raw)
        if fit.loss < rung.fit.loss - MOVED * len(sizes):
            rung = climb(rung.experiment, fit.values, sizes, each, before=rung)
    return rung


def _asleep(fit: Fit, sizes: Iterable[Size]) -> list[Size]:
    """The sizes that can be larger only and ended where they start."""
    way = lambda size: abs(fit.values.get(size.key, size.neutral) - size.neutral)
    return [size for size in sizes if size.is_one_sided and not size.shaping and way(size) < ASLEEP * (size.upper - size.lower)]


def _near(start: _Aligned, sizes: Sequence[Size], raw: Raw, each: Callable) -> Raw:
    """Columns of ``sizes`` over as few probes as a fit may still move; ``raw``: those known before, which tell standard errors."""
    norm = {key: float(np.linalg.norm(column)) for key, column in probe.white(start.frame, raw).items()}
    steps = {size.key: float(np.clip(REACH / max(norm[size.key], 1e-9), LEAST_REACH, 1.0)) for size in sizes}
    return {**raw, **probe.secants(start.experiment, start.values, start.residuals, sizes, each, steps)}


def _at_own_spectrum(start: _Aligned, sizes: Sequence[Size], raw: Raw) -> tuple[Fit, Frame]:
    """The fit of ``sizes`` to drives as they are aligned, in the frame of the residuals that it nearly leaves."""
    values, residuals, frame = start.values, start.residuals, start.frame
    for number in range(FITS):
        if number:
            frame = exp.frame(start.experiment, residuals, frame.nuisances, frame.all_cleaned(residuals))
        columns = probe.white(frame, raw)
        fit = refit.refit(start.experiment, frame, values, sizes, columns, iterations=2, residuals=residuals)
        values, residuals = fit.values, fit.residuals
    return fit, frame


def _carried_on(experiment: Experiment, start: _Aligned, fit: Fit, frame: Frame, sizes: Sequence[Size]) -> _Aligned | None:
    """Where the way from what drives were aligned for to a ``fit`` leads, doubled while the drives of ``experiment``, aligned anew, become
    more likely; None where it leads nowhere.

    Drives that are aligned for a model, their driver tuned to it, hold its sizes back: a payload, with which all masses, springs
    and dampers grow, came but a twentieth of its way from one alignment to the next.
    """
    if float(np.sum(frame.flat(start.residuals) ** 2)) - fit.loss < MOVED * len(sizes):
        return None
    value = lambda size: start.values.get(size.key, size.neutral)
    way = {size: fit.values[size.key] - value(size) for size in sizes}
    likely, farthest = refit.information(start.frame, start.residuals), None
    for doubling in range(DOUBLINGS):
        reached = {size.key: float(np.clip(value(size) + 2**doubling * own, size.lower, size.upper)) for size, own in way.items()}
        try:
            found = _Aligned.at(experiment, {**start.values, **reached}, frame.indices)
        except (InputError, ValueError):
            break
        now = refit.information(found.frame, found.residuals)
        if now < likely + refit.WORTHWHILE:
            break
        likely, farthest = now, found
    return farthest


def _woken(experiment: Experiment, frame: Frame, fit: Fit, sizes: Sequence[Size], size: Size, raw: Raw) -> Fit:
    """A fit again, from the middle of what is plausible of one size; the same where that cannot be simulated."""
    start = {**fit.values, size.key: 0.5 * (size.lower + size.upper)}
    try:
        residuals = exp.simulate(experiment, start, frame.indices)
        own = probe.secants(experiment, start, residuals, [size])
        columns = probe.white(frame, {**raw, **own})
        return refit.refit(experiment, frame, start, sizes, columns, renewed=[size.key], iterations=WAKING, residuals=residuals)
    except (InputError, ValueError):
        return fit


def _fitted(experiment, values, sizes, each, raw: Raw | None = None, least: Frame | None = None) -> tuple[Experiment, Frame, Fit, Raw, float]:
    """The fitted records aligned for a model, the model fitted to them, at its own spectrum, in frames with no more power than ``least``, and
    what the fit gains in twice the log-likelihood. Its drivers are brought to the path once more at the end: what a fit changes leads a model
    a millimetre off it in bends, in every repeat, which lift and wind imitate."""
    residuals, frame, experiment = realign.aligned(experiment, values, roles(experiment)[0], least)
    sooner, base = probe.coarsely(experiment, values, residuals)
    raw, first = raw or probe.secants(sooner, values, base, sizes, each), (frame, residuals)
    for number in range(FITS):
        if number:
            frame = exp.frame(experiment, residuals, frame.nuisances, frame.all_cleaned(residuals), least)
        columns = probe.white(frame, raw)
        fit = refit.refit(sooner, frame, values, sizes, columns, iterations=3, residuals=residuals)
        values, residuals = fit.values, fit.residuals
    experiment, residuals = experiment.retuned(values, list(residuals), exactly=True)
    gained = refit.information(first[0], residuals) - refit.information(*first)
    frame = exp.frame(experiment, residuals, frame.nuisances, frame.all_cleaned(residuals))
    fit = replace(fit, residuals=residuals, loss=float(np.sum(frame.flat(residuals) ** 2)))
    return experiment, frame, fit, raw, gained


def _is_near(fit: Fit, start: Mapping[str, float], sizes: Sequence[Size]) -> bool:
    """Whether the columns of ``sizes`` at the values ``start`` are nearly those of where a fit ended."""
    value = lambda size: start.get(size.key, size.neutral)
    return all(abs(fit.values[size.key] - value(size)) < NEAR * abs(size.probe) for size in sizes)


def _anew(experiment: Experiment, fit: Fit, sizes: Sequence[Size], each: Callable, raw: Raw) -> Raw:
    """Columns where a fit ended; the same where some vehicle there may not be probed."""
    try:
        sooner, base = probe.coarsely(experiment, fit.values, fit.residuals)
        return {**raw, **probe.secants(sooner, fit.values, base, sizes, each)}
    except (InputError, ValueError):
        return raw


def _floor_squares(experiment, frame: Frame, fit: Fit, check, check_frame) -> tuple[bool, np.ndarray, np.ndarray]:
    """Whether the floor is known from repeats, and its mean squares on fitted and held-out records; of a condition without repeats, the mean
    of the others that are known as far; without any, that of instruments whose noise is told, of others the mean of these. Repeats differ in their path, so what the
    model lacks differs too: the floor sinks as the model improves."""
    cleaned = frame.all_cleaned(fit.residuals)
    held_out = check_frame.all_cleaned(check) if check else {}
    known = floor.floor(experiment, {**cleaned, **held_out})
    highest = {record.condition: record.band[1] for record in experiment.records}
    told = [np.square(record.noise) for record in experiment.records if record.noise]
    usual = tuple(np.sqrt(np.mean(told, axis=0))) if told else ()
    assumed = lambda record: floor.assumed(record if record.noise else replace(record, noise=usual))
    reached: dict[str, list[np.ndarray]] = {}
    for parts in (cleaned, held_out):
        for index, row in zip(sorted(parts), floor.squares(experiment, parts) if parts else ()):
            reached.setdefault(experiment.records[index].condition, []).append(row)
    floors = []
    for indices in roles(experiment):
        rows = np.zeros((len(indices), len(experiment.channels)))
        for row, index in zip(rows, indices):
            record = experiment.records[index]
            found = [known[record.condition]] if record.condition in known else [own for name, own in known.items() if highest[name] >= record.band[1]]
            row[:] = np.mean([one.power(record.band, record.rate) for one in found], axis=0) if found else assumed(record)
            # No floor lies above what a model has reached, in the mean over a condition: drive by drive, a quiet one would lower it for all.
            if record.condition in reached:
                row[:] = np.minimum(row, np.mean(reached[record.condition], axis=0))
        floors.append(rows)
    return bool(known), *floors
