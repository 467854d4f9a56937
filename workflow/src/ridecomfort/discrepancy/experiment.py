"""What the search for a missing effect needs to know of a model and its measurements, be it a car or one mass.

An Experiment hands out residuals (simulated minus measured) for any values of its
parameters. Everything else, which effect, how sure, how large, is done with those.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from . import spectrum
from .span import Rows, Span, taken_apart
from .spectrum import Spectrum, Whitening


@dataclass(frozen=True)
class Record:
    """One measured drive: what a test has to know beside its residual.

    ``condition``: records of one condition (stretch of road and speed) share a ``band`` and a spectrum of errors and may repeat one
    another at equal ``place`` (sample,), in the unit of ``block`` lengths. Samples of one ``site`` and block depend
    on one another, over all records: ``block`` is the same for all of a site.
    """

    name: str
    role: str
    site: str
    condition: str
    rate: float
    band: tuple[float, float]
    place: np.ndarray
    block: float
    lowest: tuple[float, ...] = ()
    """Hz by channel below which an error of it says nothing, where that is above the band's lower end."""
    noise: tuple[float, ...] = ()
    """Density of the noise by channel (unit/sqrt(Hz), one-sided) where it is known beforehand."""

    def blocks(self, finer: float = 1.0) -> np.ndarray:
        """Number of the block that every sample lies in, (sample,)."""
        return np.floor(self.place * finer / self.block).astype(np.int64)


@dataclass(frozen=True)
class Size:
    """A number that may be fitted: its unit, where it starts or changes nothing, what is plausible, a step to probe with; ``shaping``:
    whether it only shapes an effect, so that it means nothing where that is switched off; ``held``: whether calibration holds it."""

    key: str
    unit: str
    neutral: float
    lower: float
    upper: float
    probe: float
    shaping: bool = False
    held: bool = False

    def holds(self, value: float) -> bool:
        """Whether a value is plausible, to a thousandth of the range."""
        room = 1e-3 * (self.upper - self.lower)
        return bool(self.lower - room <= value <= self.upper + room)

    @property
    def is_one_sided(self) -> bool:
        """Whether only amounts above (or, with a negative probe, below) the neutral one are plausible."""
        return self.neutral in (self.lower, self.upper)


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing: its sizes; ``shapes``, the settings of what only shapes it to try it with; and ``shaping``,
    the same to be fitted where that is worth it."""

    name: str
    sizes: tuple[Size, ...]
    shapes: tuple[Mapping[str, float], ...] = ({},)
    shaping: tuple[Size, ...] = ()
    sentence: str = ""
    instrument: bool = False
    """Whether it is an error of the measurement, not of the model."""
    port: str = ""
    """Where it acts; two at one port may stand in for one another."""
    is_aligned: bool = False
    """Whether it is what alignment takes out of every drive."""
    reaches: tuple[float, ...] = ()
    """Probes that its sizes are tried over in each of the ``shapes``, where that is not one in all of them."""

    def reach(self, shape: int) -> float:
        """Probes that its sizes are tried over in a shape."""
        return self.reaches[shape] if self.reaches else 1.0

    def at(self, shares: Mapping[str, float], shape: int = 0) -> dict[str, float]:
        """Values with each size at this many probes from neutral, the others neutral."""
        values = {size.key: size.neutral + shares.get(size.key, 0.0) * size.probe for size in self.sizes}
        return {**values, **self.shapes[shape]}


class Experiment(Protocol):
    """A model beside its measurements. ``values`` maps the keys of ``free`` and of candidates to SI values; a candidate
    none of whose keys is there is switched off."""

    records: Sequence[Record]
    channels: Sequence[str]
    free: Sequence[Size]
    candidates: Sequence[Candidate]
    each_record: Callable
    """A ``map`` over records, whose residuals may be asked for side by side."""
    inexact: Mapping[int, np.ndarray]
    """By record, by how much a residual (channel, sample) may differ for no better reason than the step of integration, where that is known."""

    def residual(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """Simulated minus measured, (channel, sample), of a record."""

    def nuisances(self, values: Mapping[str, float], index: int) -> np.ndarray:
        """What the alignment of a record may still get wrong, (direction, channel, sample)."""

    def retuned(
        self, values: Mapping[str, float], indices: Sequence[int], exactly: bool = False
    ) -> tuple[Experiment, dict[int, np.ndarray]]:
        """The same with these records driven along the measured path at these values to start with, and their residuals; ``exactly``:
        with what integration makes wrong at these values made good from now on."""

    def realigned(self, amounts: Mapping[int, np.ndarray]) -> Experiment:
        """The same with these amounts of the nuisances (direction,) taken out of its records."""

    def would_differ(self, one: Mapping[str, float], other: Mapping[str, float], index: int) -> Mapping[str, np.ndarray]:
        """By how much the model at ``one`` of two sets of values differs from that at the ``other``, (channel, sample), on drives like that of a record
        which were not made, by what they would have otherwise; none where there are no such drives."""

    def taking(self, other: Experiment, indices: Collection[int]) -> Experiment:
        """The same with these records as ``other`` has them."""

    def coarser(
        self, values: Mapping[str, float], residuals: Mapping[int, np.ndarray]
    ) -> tuple[Experiment, Mapping[int, np.ndarray]]:
        """The same with records in steps twice as long, which are simulated sooner, corrected so that at these values it gives these residuals; and
        those that it gives there, equal to these but for rounding (what is subtracted from a probe, so that a size without effect has a column of
        zeros)."""


def by_record(experiment: Experiment, function: Callable, indices: Iterable[int]) -> dict:
    """What a function of the number of a record returns, by that number."""
    indices = list(indices)
    return dict(zip(indices, experiment.each_record(function, indices)))


@dataclass
class Frame:
    """Records made white and free of their nuisances, as one long vector for least squares."""

    experiment: Experiment
    indices: list[int]
    whitening: dict[int, Whitening]
    nuisances: dict[int, Rows]
    spans: dict[int, Span] = field(init=False)

    def __post_init__(self):
        self.spans = by_record(self.experiment, lambda i: Span(self.nuisances[i], self.whitening[i]), self.indices)

    def flat(self, parts: Mapping[int, np.ndarray]) -> np.ndarray:
        """White vector of a residual or column per record, nuisances projected out."""
        return self.flats([parts])[0]

    def flats(self, columns: Sequence[Mapping[int, np.ndarray]]) -> np.ndarray:
        """``flat`` of several columns at once, (column, element): one product of matrices instead of many with vectors."""
        without = lambda i: self.spans[i].without(self._white(i, columns)).reshape(len(columns), -1)
        return np.concatenate(list(self.experiment.each_record(without, self.indices)), axis=1)

    def flat_of(self, index: int, residual: np.ndarray) -> np.ndarray:
        """``flat`` of one record."""
        return self.spans[index].without(self.whitening[index](residual)).ravel()

    def own_shares(self, columns: Sequence[Mapping[int, np.ndarray]], among: Sequence[int] | None = None) -> np.ndarray:
        """Share of the power of each column that its nuisances leave, (column,); ``among`` some of the records, or all."""
        shares = lambda i: np.array(self.spans[i].shares(self._white(i, columns)))
        left, whole = sum(self.experiment.each_record(shares, self.indices if among is None else among))
        return left / np.where(whole > 0, whole, 1.0)

    def _white(self, index: int, columns: Sequence[Mapping[int, np.ndarray]]) -> np.ndarray:
        return self.whitening[index](np.stack([parts[index] for parts in columns]))

    def amounts(self, index: int, residual: np.ndarray) -> np.ndarray:
        """Amounts (direction,) of its nuisances that a residual (channel, sample) holds."""
        return self.spans[index].amounts(self.whitening[index](residual))

    def all_amounts(self, residuals: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
        """``amounts`` of several records."""
        return by_record(self.experiment, lambda index: self.amounts(index, residuals[index]), residuals)

    def cleaned(self, index: int, residual: np.ndarray) -> np.ndarray:
        """A residual (channel, sample) less what its nuisances explain of it."""
        return self.spans[index].cleaned(residual)

    def all_cleaned(self, residuals: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
        """``cleaned`` of several records."""
        return by_record(self.experiment, lambda index: self.cleaned(index, residuals[index]), residuals)

    def parts(self, rows: np.ndarray) -> list[np.ndarray]:
        """Vectors (..., element) taken apart by record, each (..., channel, sample)."""
        counts = [len(self.experiment.channels) * len(self.experiment.records[index].place) for index in self.indices]
        pieces = np.split(rows, np.cumsum(counts)[:-1], axis=-1)
        return [piece.reshape(*rows.shape[:-1], len(self.experiment.channels), -1) for piece in pieces]

    def blocks(self, finer: float = 1.0) -> np.ndarray:
        """Number of the block of every element of ``flat``; equal places of one site have the same in all its records."""
        sites = sorted({self.experiment.records[index].site for index in self.indices})
        numbers = []
        for index in self.indices:
            record = self.experiment.records[index]
            own = record.blocks(finer) + 10**7 * sites.index(record.site)
            numbers.append(np.tile(own, len(self.experiment.channels)))
        return np.concatenate(numbers)

    def price(self) -> float:
        """Fall of the white loss that one more number must make up for (BIC): a block of the road counts as one observation."""
        return float(np.log(len(np.unique(self.blocks()))))

    def drives(self) -> np.ndarray:
        """Number of the record of every element of ``flat``."""
        channels = len(self.experiment.channels)
        counts = [channels * len(self.experiment.records[index].place) for index in self.indices]
        return np.repeat(np.arange(len(counts)), counts)


def frame(
    experiment: Experiment,
    residuals: Mapping[int, np.ndarray],
    nuisances: Mapping[int, Rows],
    cleaned: Mapping[int, np.ndarray] | None = None,
    least: Frame | None = None,
) -> Frame:
    """The frame in which these residuals, less their nuisances, are white.

    ``cleaned``: the residuals less their nuisances where that is known from an earlier frame. ``least``: a frame whose power no
    channel exceeds at any frequency: a fit in the frame of its own residuals alone may trade a large error of one signal for a small one of
    another, as what grew weighs less then.
    """
    indices = sorted(residuals)
    found, inexact = condition_spectra(experiment, residuals if cleaned is None else cleaned), experiment.inexact

    def whitening(index: int) -> Whitening:
        record = experiment.records[index]
        own = found[record.condition]
        own = own if least is None else own.no_larger(least.whitening[index].spectrum)
        plain = Whitening(own, record.rate, record.band)
        scale = spectrum.local_scale(plain((cleaned or residuals)[index]), record.rate)
        wrong = inexact.get(index)
        return replace(plain, scale=scale if wrong is None else spectrum.beside(scale, plain(wrong), record.rate))

    made = Frame(experiment, indices, by_record(experiment, whitening, indices), dict(nuisances))
    if cleaned is not None:
        return made
    return frame(experiment, residuals, nuisances, made.all_cleaned(residuals), least)


def condition_spectra(experiment: Experiment, residuals: Mapping[int, np.ndarray]) -> dict[str, Spectrum]:
    """Cross-spectrum of the residuals of every condition."""
    found: dict[str, list[int]] = {}
    for index in sorted(residuals):
        found.setdefault(experiment.records[index].condition, []).append(index)
    return {
        condition: spectrum.cross_spectrum(
            [residuals[i] for i in own], experiment.records[own[0]].rate, experiment.records[own[0]].lowest
        )
        for condition, own in found.items()
    }


def simulate(experiment: Experiment, values: Mapping[str, float], indices: Iterable[int]) -> dict[int, np.ndarray]:
    """Residuals of several records."""
    return by_record(experiment, lambda index: experiment.residual(values, index), indices)


def nuisances(experiment: Experiment, values: Mapping[str, float], indices: Iterable[int]) -> dict[int, Rows]:
    """Nuisances of several records."""
    return by_record(experiment, lambda index: taken_apart(experiment.nuisances(values, index)), indices)


def secant(
    experiment: Experiment, values: Mapping[str, float], base: Mapping[int, np.ndarray], size: Size, step: float
) -> dict[int, np.ndarray]:
    """Change of the residuals per probe of a size, from the value it has (or its neutral one) by ``step`` probes, in
    single precision."""
    start = values.get(size.key, size.neutral)
    moved = simulate(experiment, {**values, size.key: start + step * size.probe}, base)
    return {index: ((moved[index] - base[index]) / step).astype(np.float32) for index in base}
