"""Explainable error: what of the error lies above the floor that repeats of a drive show, and how much of it is left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import dist
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..drive.sampling import rate_of
from ..vocabulary import VARIABLES
from .experiment import Record
from .floor import apart
from .judged import band, judged, lowest

SAME_SPEED, SAME_PACE, COMMON, SAME_PATH, SAME_SENSOR = 0.05, 0.08, 0.5, 0.3, 0.05
"""Relative difference of mean speeds where both drove, and of those over stretches (rms), within which drives repeat one another, share of the shorter
that both must have driven, m (rms) that their paths may lie apart, and m that their instruments may. At other speeds, or on other tracks, where wheels
meet another road, errors of the model differ, too, and pass for noise: up to 15 % of them at 0.3 m, half at 0.6 m; with speeds 13 % apart an eighth of
a_z and half of the pitch rate, with 36 % half of one and all of the other. Elsewhere on a body that rolls and pitches all accelerations are others."""

NEAR = 0.15
"""Relative difference (rms over stretches) of the speeds of two drives within which one that repeats none was meant to, perhaps."""

SENSOR = ("sensor_x", "sensor_y", "sensor_z")
"""Where the instrument of a drive was, in m from the centre of gravity, as a comparison has it over drives and a drive among its attributes."""

REPEATS = "from repeats"
NIL = "taken as nil: no drive was repeated"
ASSUMED = "assumed from the noise densities of the instruments: no drive was repeated; errors of path and road are not in it"
FROM_ELSEWHERE = "from repeats on {site}, on whose drives the vehicle is calibrated: no drive was repeated here"
"""What a floor is known from, as in the attribute ``floor``."""

STRETCH = 100.0
"""m of road over which errors are taken together, and told apart in words: longer than an axle or a body swings on after what it met."""

REACHED = 1.0
"""m from the end of a stretch at which a drive has come through it: its last sample lies a little before."""

HIGHEST = 0.85
"""Share of the cut-off up to which a diagnosis judges errors, and repeats of different cut-offs are compared."""

SHORTEST = 10.0
"""s of a drive that are judged at least: one of less holds too few spectra of 4 s to tell how the errors of six signals go together."""

SAME_CUT_OFF = 0.01
"""Relative difference of cut-offs up to which they are the same: each is told from the times of its record."""

INSTRUMENT = {"m/s2": "accelerometer", "rad/s": "gyroscope"}
"""Instrument that a signal of this unit is recorded with."""


class Passage(NamedTuple):
    """What drives that repeat one another drove: ``place`` (m), ``lateral`` position (m) and ``time`` (s) of the first, (sample,), where its
    ``sensor`` was, in m from the centre of gravity, and the ``others``."""

    place: np.ndarray
    lateral: np.ndarray
    time: np.ndarray
    sensor: Sequence[float] = (0.0, 0.0, 0.0)
    others: tuple[Passage, ...] = ()

    @property
    def start(self) -> float:
        """Place (m) from which on all drove."""
        return max(float(one.place.min()) for one in (self, *self.others))

    @property
    def end(self) -> float:
        """Place (m) up to which all did."""
        return min(float(one.place.max()) for one in (self, *self.others))

    @property
    def speed(self) -> float:
        """Mean speed (m/s) of the whole of the first."""
        return float(np.ptp(self.place) / np.ptp(self.time))

    def paces(self, places: np.ndarray) -> np.ndarray:
        """Mean speeds (m/s) of the first between ``places`` in a row, (place - 1,)."""
        return np.diff(places) / np.diff(np.interp(places, self.place, self.time))

    def is_along(self, other: Passage) -> bool:
        """Whether both drove COMMON of the shorter."""
        common = min(self.end, other.end) - max(self.start, other.start)
        return common > COMMON * min(self.end - self.start, other.end - other.start)

    def is_repeated_by(self, other: Passage) -> bool:
        """Whether the first is, wherever both drove: at its speed, on the whole and stretch by stretch, on its path, with the sensor at its place."""
        return not self.apart(other)

    def pace_apart(self, other: Passage) -> float:
        """Relative difference (rms) of the speeds over stretches where both drove."""
        places = self._common(other, STRETCH)
        return float(np.sqrt(np.mean(_relative(self.paces(places), other.paces(places)) ** 2)))

    def apart(self, other: Passage) -> list[str]:
        """By what another is too far from the first, where both drove, to repeat it, in words."""
        ends, places = self._common(other, np.inf), self._common(other, 0.0)
        speed = abs(float(_relative(self.paces(ends), other.paces(ends))[0]))
        aside = np.interp(places, other.place, other.lateral) - np.interp(places, self.place, self.lateral)
        path, sensor = float(np.sqrt(np.mean(aside**2))), dist(self.sensor, other.sensor)
        found = (
            (speed, SAME_SPEED, "mean speeds {:.1f} % apart ({:g} % at most)", 100.0),
            (self.pace_apart(other), SAME_PACE, "speeds over stretches of the road {:.1f} % apart ({:g} % at most)", 100.0),
            (path, SAME_PATH, "paths {:.3f} m apart ({:g} m at most)", 1.0),
            (sensor, SAME_SENSOR, "sensors {:.3f} m apart ({:g} m at most)", 1.0),
        )
        return [words.format(factor * own, factor * most) for own, most, words, factor in found if own >= most]

    def _common(self, other: Passage, length: float) -> np.ndarray:
        """Places (m) from end to end of what both drove, about a ``length`` from one another; 200 where that is nil."""
        start, end = max(self.place.min(), other.place.min()), min(self.place.max(), other.place.max())
        return np.linspace(start, end, max(1, round((end - start) / length)) + 1 if length else 200)


def _relative(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Difference of two speeds over their mean."""
    return 2.0 * (other - one) / (other + one)


@dataclass(frozen=True)
class OwnNoise:
    """What a repeat has of its own, of what is judged: ``noise`` (signal, sample) in the units of the signals, ``place`` in m; the mean squares
    (signal,) of all of its error there, ``square``, and of what repeats share of it, ``common``; and how far they are known, ``highest`` (Hz)."""

    place: np.ndarray
    noise: np.ndarray
    square: np.ndarray
    common: np.ndarray
    highest: float


def explain(
    comparison: xr.Dataset, noise_density: Mapping[str, Mapping[str, float]] | None = None, elsewhere: tuple[str, xr.Dataset] | None = None
) -> xr.Dataset:
    """A comparison (``compare.compare``) with its floor and its explainable error.

    Added, of what is judged (``judged.judged``) and in the unit of the signal: ``floor_rmse(drive, signal)``, what no
    model of this road and car could explain, from the differences of repeats at equal place in the best state, of a drive that repeats none the
    mean of theirs up to its own cut-off, of those that tell as much as it does or, where none does, most;
    ``explainable_rmse(state, drive, signal)``, the root of mean square less floor;
    ``explained_share(state, drive, signal)``, the share of the first state's explainable mean square that is gone; and
    ``square_by_stretch(state, drive, signal, stretch_of_road)``, mean squares of the error over STRETCH each, the same for all drives, nan where
    one does not cover a stretch. Without
    repeats the floor is that of the instruments alone, ``noise_density`` by drive ({"accelerometer": m/s2/sqrt(Hz),
    "gyroscope": rad/s/sqrt(Hz)}, one-sided); else the mean of those of ``elsewhere`` up to the same, the site that the vehicle is calibrated on and
    what this function and ``locate.locate`` returned there, if drives were repeated on it; else nil. Attribute ``floor`` says which, ``near_repeats`` what keeps drives from
    repeating others (``near_repeats``).
    """
    floors = np.full((comparison.sizes["state"], comparison.sizes["drive"], comparison.sizes["signal"]), np.nan)
    groups, cut_offs, rate = repeats(comparison), highest(comparison), rate_of(comparison["time"].values)
    for state, name in enumerate(comparison["state"].values):
        own = own_noise(comparison, name)
        for group in groups:
            # Noise of a quiet and of a loud repeat is known as their mean; what they share is the same for both, and the rest of either its own.
            floors[state, group] = [np.maximum(own[drive].square - np.maximum(own[drive].common, 0.0), 0.0) for drive in group]
        most = max((one.highest for one in own.values()), default=0.0)
        for drive in {*range(len(cut_offs))} - {*own} if own else ():
            upper = cut_offs[drive]
            telling = {k: one for k, one in own.items() if one.highest >= (1.0 - SAME_CUT_OFF) * min(upper, most)}
            others = [floors[state, k] * (_share_below(one.noise, rate, upper) if upper < one.highest else 1.0) for k, one in telling.items()]
            floors[state, drive] = np.mean(others, axis=0)
    square, by_stretch, starts = _squares(comparison)
    if np.isfinite(floors).any():
        floor_squares, known_from = np.fmin.reduce(floors, axis=0), REPEATS
    elif noise_density and np.isfinite(densities := _squared_densities(comparison, noise_density)).any():
        floor_squares, known_from = _filled(densities) * _widths(comparison), ASSUMED
    elif elsewhere is not None and elsewhere[1].attrs["floor"] == REPEATS:
        site, repeated = elsewhere
        floor_squares, known_from = _as_there(repeated.sel(signal=comparison["signal"]), cut_offs), FROM_ELSEWHERE.format(site=site)
    else:
        floor_squares, known_from = np.zeros(floors.shape[1:]), NIL
    floor_squares = np.minimum(floor_squares, square.min(axis=0))
    above = square - floor_squares
    share = 1.0 - above / np.where(above[:1] > 0, above[:1], np.nan)
    return comparison.assign(
        floor_rmse=(("drive", "signal"), np.sqrt(floor_squares)),
        explainable_rmse=(("state", "drive", "signal"), np.sqrt(above)),
        explained_share=(("state", "drive", "signal"), share, {"units": "1"}),
        square_by_stretch=(("state", "drive", "signal", "stretch_of_road"), by_stretch),
        stretch_of_road=starts,
    ).assign_attrs(floor=known_from, near_repeats="; ".join(near_repeats(comparison)))


def own_noise(comparison: xr.Dataset, state: str) -> dict[int, OwnNoise]:
    """By number of the drive, for drives that were repeated: what each has of its own, of the power of its noise, wherever another drove as well: beside
    those that tell as much as it does, else beside those that tell most, as far as they do."""
    found: dict[int, OwnNoise] = {}
    for group in repeats(comparison):
        cut_offs = dict(zip(group, highest(comparison)[group]))
        shared = {drive: min(cut_offs[drive], max(cut_offs[other] for other in group if other != drive)) for drive in group}
        beside = {drive: tuple(other for other in group if cut_offs[other] >= (1.0 - SAME_CUT_OFF) * shared[drive]) for drive in group}
        for among in dict.fromkeys(beside.values()):
            own = _own_noise_among(comparison, state, among)
            found |= {drive: own[drive] for drive in group if beside[drive] == among and drive in own}
    return found


def _own_noise_among(comparison: xr.Dataset, state: str, group: Sequence[int]) -> dict[int, OwnNoise]:
    """``own_noise`` of drives that repeat one another, up to the frequency to which all of them hold it."""
    found, signals = {}, comparison["signal"].values
    rate = rate_of(comparison["time"].values)
    records, residuals = [], []
    cut_offs = highest(comparison)[list(group)]
    upper = _known_to_all(cut_offs)
    for drive in group:
        row = comparison.sel(state=state).isel(drive=drive)
        residual = row["residual"].transpose("signal", "time").values
        kept = np.isfinite(residual).all(axis=0)
        place = row["s"].values[kept]
        records.append(Record(str(drive), "fit", "", "", 1.0, (0.0, 1.0), place, 1.0))
        residuals.append(band(judged(residual[:, kept], rate, signals), rate, (0.0, upper)))
    for drive, record, residual, own in zip(group, records, residuals, apart(records, residuals)):
        square = np.mean(residual[:, own.inside] ** 2, axis=1)
        found[drive] = OwnNoise(record.place[own.inside], own.noise, square, own.common, min(upper, float(cut_offs.min())))
    return found


def _as_there(repeated: xr.Dataset, cut_offs: np.ndarray) -> np.ndarray:
    """Mean squares (drive, signal) of the floor of another site's drives, the mean of these, as far as drives of such cut-offs record it."""
    density, frequency = repeated["floor_density"].transpose("signal", "frequency_map").values, repeated["frequency_map"].values
    recorded, whole = np.stack([density[:, frequency <= cut_off].sum(axis=1) for cut_off in cut_offs]), density.sum(axis=1)
    return (repeated["floor_rmse"] ** 2).mean("drive").values * recorded / np.where(whole > 0, whole, 1.0)


def _share_below(noise: np.ndarray, rate: float, upper: float) -> np.ndarray:
    """Share (signal,) of the power of a series (signal, sample) at ``rate`` Hz below a frequency (Hz)."""
    whole = np.mean(noise**2, axis=1)
    return np.mean(band(noise, rate, (0.0, upper)) ** 2, axis=1) / np.where(whole > 0, whole, 1.0)


def _known_to_all(cut_offs: np.ndarray) -> float:
    """Hz up to which drives of these cut-offs tell what each has of its own: above what one holds, half of another's error is no noise."""
    least, most = cut_offs.min(), cut_offs.max()
    return np.inf if most - least <= SAME_CUT_OFF * most else HIGHEST * least


def repeats(comparison: xr.Dataset) -> list[list[int]]:
    """Numbers of the drives that repeat one another where they are compared, at least two in each list."""
    passages: list[Passage] = []
    groups: list[list[int]] = []
    for number, own in enumerate(_passages(comparison)):
        group = joined(passages, own.place, own.time, own.lateral, own.sensor)
        groups += [[]] * (len(passages) - len(groups))
        groups[group] = [*groups[group], number]
    return [own for own in groups if len(own) > 1]


def near_repeats(comparison: xr.Dataset) -> list[str]:
    """Of every drive that repeats none but nearly does, as fast but for NEAR, what keeps it from repeating the one which it is nearest to, in words."""
    passages, names = _passages(comparison), comparison["drive"].values
    group_of = {number: group for group in repeats(comparison) for number in group}
    said = []
    for number in sorted({*range(len(passages))} - {*group_of}):
        others = [other for other in range(len(passages)) if (other < number or other in group_of) and passages[other].is_along(passages[number])]
        why = {other: passages[other].apart(passages[number]) for other in others}
        # Whoever it repeats is the one that it was meant to, and those that repeat that one.
        mates = {mate for other in others if not why[other] for mate in group_of.get(other, [other])}
        why = {other: own for other, own in why.items() if not mates or other in mates}
        pace = {other: passages[other].pace_apart(passages[number]) for other in why if why[other]}
        nearest = min(pace, key=lambda other: pace[other], default=None)
        if nearest is not None and pace[nearest] < NEAR:
            said.append(f"{names[number]} is no repeat of {names[nearest]}: {' and '.join(why[nearest])}")
        elif any(not own for own in why.values()):
            alike = next(other for other, own in why.items() if not own)
            said.append(f"{names[number]} repeats {names[alike]}, but hardly any of the way that all of its repeats drove: it counts as no repeat")
    return said


def too_short(comparison: xr.Dataset) -> list[str]:
    """Drives that are compared for less than SHORTEST, in words."""
    seconds = [own.place.size / rate_of(comparison["time"].values) for own in _passages(comparison)]
    names = comparison["drive"].values
    return [f"{name} is compared for {own:.1f} s only, which tells little (expected {SHORTEST:g} s at least)" for name, own in zip(names, seconds) if own < SHORTEST]


def _passages(comparison: xr.Dataset) -> list[Passage]:
    """What every drive drove where it is compared."""
    found = []
    compared = np.isfinite(comparison["residual"].isel(state=-1)).all("signal").transpose("drive", "time").values
    for number, place in enumerate(comparison["s"].transpose("drive", "time").values):
        known = np.isfinite(place) & compared[number]
        aside = np.nan_to_num(comparison["e"].isel(drive=number).values[known])
        sensor = [float(comparison[name][number]) for name in SENSOR if name in comparison]
        found.append(Passage(place[known], aside, comparison["time"].values[known], sensor))
    return found


def joined(
    passages: list[Passage], place: np.ndarray, time: np.ndarray, lateral: np.ndarray, sensor: Sequence[float] = (0.0, 0.0, 0.0)
) -> int:
    """Number of the first of ``passages`` of which a drive (place and lateral position in m over time in s, place of its sensor in m) repeats all
    drives, and which it joins; of a passage of its own, which is added, where there is none. A lateral position that nobody knows is nan."""
    own = Passage(place, np.nan_to_num(lateral), time, sensor)
    for number, known in enumerate(passages):
        # Beside a short one two may differ where only they drove.
        if known.is_along(own) and all(one.is_repeated_by(own) for one in (known, *known.others)):
            passages[number] = known._replace(others=(*known.others, own))
            return number
    passages.append(own)
    return len(passages) - 1


def _squares(comparison: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean squares (state, drive, signal) of what is judged of the residuals, the same by whole stretches of road (..., stretch), and where
    these begin (m)."""
    residual = comparison["residual"].transpose("state", "drive", "signal", "time").values
    place = comparison["s"].transpose("drive", "time").values
    rate = rate_of(comparison["time"].values)
    first, last = (int(end // STRETCH) for end in (np.nanmin(place), np.nanmax(place)))
    found = np.empty(residual.shape[:-1])
    starts = STRETCH * np.arange(first, last + 1)
    by_stretch = np.full((*residual.shape[:-1], starts.size), np.nan)
    for state, drive in np.ndindex(found.shape[:2]):
        kept = np.isfinite(residual[state, drive]).all(axis=0)
        square = judged(residual[state, drive][:, kept], rate, comparison["signal"].values) ** 2
        found[state, drive] = np.mean(square, axis=1)
        own = place[drive, kept]
        number = (own // STRETCH).astype(int) - first
        count = np.bincount(number, minlength=starts.size)
        covered = (starts >= own.min() - REACHED) & (starts + STRETCH <= own.max() + REACHED) & (count > 0)
        for signal, values in enumerate(square):
            by_stretch[state, drive, signal, covered] = np.bincount(number, values, count.size)[covered] / count[covered]
    return found, by_stretch, starts


def highest(comparison: xr.Dataset) -> np.ndarray:
    """Hz up to which the records of each drive hold anything, (drive,)."""
    half = np.full(comparison.sizes["drive"], 0.5 * rate_of(comparison["time"].values))
    return np.minimum(half, comparison["cut_off"].values) if "cut_off" in comparison else half


def _widths(comparison: xr.Dataset) -> np.ndarray:
    """Hz (drive, signal) of what is judged and not low-passed away."""
    return np.maximum(highest(comparison)[:, None] - lowest(comparison["signal"].values), 0.0)


def _squared_densities(comparison: xr.Dataset, density: Mapping[str, Mapping[str, float]]) -> np.ndarray:
    """Squared densities (drive, signal) of the noise of the instruments, nan where none is told."""
    instruments = [INSTRUMENT[VARIABLES[str(signal)].unit] for signal in comparison["signal"].values]
    return np.array(
        [
            [density.get(str(drive), {}).get(instrument, np.nan) ** 2 for instrument in instruments]
            for drive in comparison["drive"].values
        ]
    )


def _filled(values: np.ndarray) -> np.ndarray:
    """Values (drive, signal) of every drive: one that is not known is the mean of those that are, else nil."""
    known = np.isfinite(values)
    mean = np.where(known.any(axis=0), np.where(known, values, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1), 0.0)
    return np.where(known, values, mean)
