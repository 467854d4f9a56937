"""What repeats have in common of their errors at equal place, which a better model of road and car could explain."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.signal.windows import tukey

from .experiment import Frame, Record
from .floor import denser, repeats
from .judged import band

FINER = 10.0
"""Parts of a block within which white errors that repeats share depend on one another: they may be those of a single place."""

WIDTH = 2.0
"""Hz; a shaft or a mode shakes within such a band, and is lost among all others where only the whole is asked."""

OF_DRIVER = 3.0
"""Hz below which a band begins in which foot and hands of a driver show, which a driver model moves otherwise: on roads and drives
without any other error that is up to 2.5 % of the power of a_x in the band, 3 % of pitch rate, 0.7 % of yaw rate, 0.4 % of a_y, 0.1 % of
roll rate, and less than 0.1 % of any signal above."""

OF_DRIVEN, OF_BAND = {"a_x": 0.06, "pitch_rate": 0.06, "yaw_rate": 0.02, "a_y": 0.01}, 0.002
"""Shares of the measured power within a band below that, by signal, and in all other bands, up to which an error is not worth explaining."""

OF_SLOW = 0.005
"""The same of other signals below OF_DRIVER."""

FOOT = 0.01
"""m/s2 (rms) of a_x below OF_DRIVER up to which an error is a foot's, however little else the signal holds there: on two cars and roads whose models
were right 0.006 were left, 2 % of the power of one, whose instrument stood on the roof, and 29 % of the other."""

LIKELY = 4.0
"""z of what repeats share in a band from which on it may be worth explaining: of some hundred and fifty bands one has 3 by chance in every fifth
trial, and of a signal that hardly is there, yaw rate at 20 Hz, such a one was 2e-5 rad/s."""

PATCH, FEW_PATCHES, PLACED = 20.0, 0.1, 5.0
"""m of road whose errors are taken together, share of the road that may hold half of an error for its places to be told, and z from which on
they are: a vehicle that is modelled wrongly errs all along a road, one that is blown at, or wades, at places."""

FADING = 0.2
"""Share of a record over which it fades in and out before its spectrum is taken."""


@dataclass(frozen=True)
class Band:
    """A band (Hz) of a signal, and how surely repeats share an error in it, as a z; ``places``: the stretches (site, start and end in m) that
    hold half of that, where they are FEW_PATCHES."""

    signal: str
    lower: float
    upper: float
    z: float
    places: tuple[tuple[str, float, float], ...] = ()

    def __str__(self) -> str:
        stretches: dict[str, list[str]] = {}
        for site, start, end in self.places:
            stretches.setdefault(site, []).append(f"{start / 1000:.2f}-{end / 1000:.2f}")
        told = " and ".join(f"{', '.join(own)} km of {site}" for site, own in stretches.items())
        where = f", half of it at {told}" if told else ""
        return f"{self.signal}, {self.lower:.0f}-{self.upper:.0f} Hz (z = {self.z:.1f}){where}"


@dataclass(frozen=True)
class Shared:
    """White power that repeats share: its ``share`` of all, ``z`` (0 where they share nothing), the ``power``, and the band where
    that is surest; ``faster``, ``faster_z``: the power above OF_DRIVER, and its z. nan and None where no drive was repeated."""

    share: float
    z: float
    power: float
    band: Band | None
    faster: float = float("nan")
    faster_z: float = float("nan")
    by_block: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """The power by parts of blocks."""

    def left_z(self, first: Shared, share: float) -> float:
        """How surely more than this share of what they shared at ``first`` is shared, as a z; nil where no drive was repeated."""
        return _z(self.by_block - share * first.by_block)

    def __str__(self) -> str:
        return f"{100 * self.share:.0f} % of what is left, all frequencies weighing alike (z = {self.z:.1f}), most surely {self.band}"


def shared_error(frame: Frame, residuals: Mapping[int, np.ndarray]) -> Shared:
    """What repeats share of their residuals."""
    cleaned = frame.all_cleaned({index: residuals[index] for index in frame.indices})
    pairs = _white_pairs(frame, cleaned)
    if not pairs:
        return Shared(float("nan"), float("nan"), float("nan"), None)
    by_block = _by_block(pairs)
    total = float(by_block.sum())
    power = sum(np.sqrt(np.sum(one**2) * np.sum(other**2)) for _, one, other in pairs)
    faster = [(record, *(band(part, record.rate, (OF_DRIVER, np.inf)) for part in both)) for record, *both in pairs]
    # Equally loud all along the road: were rough places the same ones in all repeats, neighbouring frequencies would not be independent.
    even = {index: part / frame.whitening[index].scale for index, part in cleaned.items()}
    pairs = list(_pairs(frame, even))
    surest = _surest(frame.experiment.channels, pairs)
    if surest.z > PLACED:
        places = _places(pairs, frame.experiment.channels.index(surest.signal), (surest.lower, surest.upper))
        surest = replace(surest, places=places)
    return Shared(float(total / power), _z(by_block), total, surest, *_in_common(faster), by_block)


def shared_power(frame: Frame, residuals: Mapping[int, np.ndarray]) -> tuple[float, float]:
    """``Shared.power`` of residuals and its z; nil where no drive was repeated."""
    return _in_common(_white_pairs(frame, frame.all_cleaned({index: residuals[index] for index in frame.indices})))


def _white_pairs(frame: Frame, cleaned: Mapping[int, np.ndarray]) -> list[tuple[Record, np.ndarray, np.ndarray]]:
    """``_pairs`` of residuals less their nuisances, made white."""
    return list(_pairs(frame, {index: frame.whitening[index](part) for index, part in cleaned.items()}))


def _in_common(pairs: Sequence[tuple[Record, np.ndarray, np.ndarray]]) -> tuple[float, float]:
    """Sum of the products of white repeats, and its z."""
    total = _by_block(pairs)
    return float(total.sum()), _z(total)


def _z(total: np.ndarray) -> float:
    """z of the sum of what differs by block; 0 where that is nothing."""
    chance = float(np.sqrt(np.sum(total**2)))
    return float(total.sum() / chance) if chance > 0 else 0.0


def _by_block(pairs: Sequence[tuple[Record, np.ndarray, np.ndarray]]) -> np.ndarray:
    """Sums of the products of white repeats over parts of blocks, all pairs of a condition together, (block,)."""
    by_block: dict[tuple[str, int], float] = {}
    for record, one, other in pairs:
        blocks, numbers = np.unique(record.blocks(FINER), return_inverse=True)
        for block, product in zip(blocks.tolist(), np.bincount(numbers, (one * other).sum(axis=0)).tolist()):
            by_block[record.condition, block] = by_block.get((record.condition, block), 0.0) + product
    return np.array(list(by_block.values()))


def _pairs(frame: Frame, series: Mapping[int, np.ndarray]) -> Iterator[tuple[Record, np.ndarray, np.ndarray]]:
    """Every two records of a condition, as far as both were driven: the first, and the series (channel, sample) of both at its places."""
    for own in repeats(frame.experiment, frame.indices).values():
        records = [frame.experiment.records[i] for i in own]
        place, finer = zip(*(denser(record.place, series[i]) for record, i in zip(records, own)))
        for a in range(len(own)):
            for b in range(a):
                inside = (records[a].place >= place[b][0]) & (records[a].place <= place[b][-1])
                record = replace(records[a], place=records[a].place[inside])
                other = np.stack([np.interp(record.place, place[b], row) for row in finer[b]])
                yield record, series[own[a]][:, inside], other


@dataclass(frozen=True)
class Worth:
    """What repeats share by (channel, band): its ``share`` of the measured power there, and whether it is worth explaining."""

    share: np.ndarray
    is_worth_it: np.ndarray

    @property
    def matters(self) -> bool:
        """Whether it is in any band."""
        return bool(self.is_worth_it.any())

    def left_of(self, first: Worth) -> float:
        """Share that this is of the ``first``, in the bands where that was worth explaining; nan where it was in none."""
        where = first.is_worth_it
        return float(self.share[where].sum() / first.share[where].sum()) if first.matters else float("nan")


def worth(frame: Frame, residuals: Mapping[int, np.ndarray], measured: Mapping[int, np.ndarray]) -> Worth:
    """What repeats share of their residuals, and where it is worth explaining.

    ``measured``: the signals (channel, sample) of every record. The quieter the instruments, the smaller an error that is sure.
    """
    pairs = list(_pairs(frame, frame.all_cleaned({index: residuals[index] for index in frame.indices})))
    edges, agreement, variance = _bands(frame.experiment.channels, pairs)
    power = _bands(frame.experiment.channels, list(_pairs(frame, measured)))[1]
    slow = np.array([OF_DRIVEN.get(channel, OF_SLOW) for channel in frame.experiment.channels])
    is_slow = edges[:-1] < OF_DRIVER
    least = np.where(is_slow, slow[:, None], OF_BAND) * power
    foot = np.array([FOOT if channel == "a_x" else 0.0 for channel in frame.experiment.channels])
    least = np.maximum(least, np.where(is_slow, foot[:, None] ** 2 * _of_one(pairs), 0.0))
    is_worth_it = (agreement > least) & (agreement > LIKELY * np.sqrt(variance))
    return Worth(agreement / np.where(power > 0.0, power, np.inf), is_worth_it)


def _of_one(pairs) -> float:
    """What ``_bands`` would sum up of errors that all repeats share, of a mean square of one."""
    return sum(0.5 * one.shape[1] ** 2 * np.mean(_fading(one) ** 2) for _, one, _ in pairs)


def _fading(series: np.ndarray) -> np.ndarray:
    """A window (sample,): slow errors, which are not judged, would leak into what is."""
    return tukey(series.shape[1], FADING)


def _surest(channels, pairs) -> Band:
    """The band of WIDTH in which the spectra of repeats agree best: the sum of their products over its standard deviation, had
    each the same powers and phases of its own."""
    edges, agreement, variance = _bands(channels, pairs)
    z = agreement / np.sqrt(np.where(variance > 0, variance, np.inf))
    c, k = np.unravel_index(np.argmax(z), z.shape)
    return Band(channels[c], float(edges[k]), float(edges[k + 1]), float(z[c, k]))


def _places(pairs, channel: int, edges: tuple[float, float]) -> tuple[tuple[str, float, float], ...]:
    """The fewest stretches that hold half of what repeats share of a channel between ``edges`` (Hz), in order; none where they are more than
    FEW_PATCHES."""
    held: dict[tuple[str, int], float] = {}
    for record, *both in pairs:
        one, other = (band(series[channel], record.rate, edges) for series in both)
        numbers, where = np.unique(np.floor(record.place / PATCH).astype(int), return_inverse=True)
        for number, product in zip(numbers.tolist(), np.bincount(where, one * other).tolist()):
            held[record.site, number] = held.get((record.site, number), 0.0) + product
    largest = sorted(held, key=lambda key: -held[key])
    count = int(np.searchsorted(np.cumsum([held[key] for key in largest]), 0.5 * sum(held.values()))) + 1
    if count > FEW_PATCHES * len(held):
        return ()
    found: list[tuple[str, float, float]] = []
    for site, number in sorted(largest[:count]):
        start, end = PATCH * number, PATCH * (number + 1)
        if found and found[-1][0] == site and found[-1][2] == start:
            found[-1] = (site, found[-1][1], end)
        else:
            found.append((site, start, end))
    return tuple(found)


def _bands(channels, pairs) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges of the bands, and over (channel, band) the sum of products of the spectra of repeats and its variance by chance."""
    lower, upper = min(record.band[0] for record, *_ in pairs), max(record.band[1] for record, *_ in pairs)
    edges = np.arange(lower, upper + 0.5 * WIDTH, WIDTH)
    edges[-1] = max(edges[-1], np.nextafter(upper, np.inf))  # the last one reaches up to the end of what is judged
    agreement, variance = np.zeros((2, len(channels), len(edges) + 1))
    for record, one, other in pairs:
        fading = _fading(one)
        spectra = np.fft.rfft(fading * one), np.fft.rfft(fading * other)
        frequency = np.fft.rfftfreq(one.shape[1], 1.0 / record.rate)
        numbers, count = np.searchsorted(edges, frequency, side="right"), len(edges) + 1
        lowest = np.maximum(record.band[0], record.lowest or np.zeros(len(channels)))
        for c, (left, right) in enumerate(zip(*spectra)):
            products = np.where((frequency >= lowest[c]) & (frequency <= record.band[1]), left * right.conj(), 0.0)
            agreement[c] += np.bincount(numbers, products.real, count)
            variance[c] += np.bincount(numbers, 0.5 * np.abs(products) ** 2, count)
    return edges, agreement[:, 1:-1], variance[:, 1:-1]
