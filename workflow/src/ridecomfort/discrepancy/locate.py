"""Where the error sits: by place and frequency, by condition, by signal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.signal import stft

from ..drive import axes
from ..drive.sampling import rate_of
from . import bursts, classes, explain, judged
from .response import responses

BANDS = ((judged.LOWEST, 2.5), (2.5, 5.0), (5.0, 8.0), (8.0, 14.0), (14.0, 25.0), (25.0, 40.0))
"""Hz; body modes lie in the first, seat and hands feel the next two, wheels hop in the fourth."""

STEP = 20.0
"""m between the places of the map of the error."""

WINDOW = 2.0
"""s of a spectrum of that map."""

CONSTANT = 1e-12
"""Share of its mean square below which the power of a signal is that of rounding."""


@dataclass(frozen=True)
class Drive:
    """One drive's samples that are compared: ``rate`` in Hz, series (signal, sample) and (sample,), own noise where known.

    ``error`` and ``signal`` are what is judged of ``residual`` and ``measured``.
    """

    rate: float
    residual: np.ndarray
    measured: np.ndarray
    simulated: np.ndarray
    error: np.ndarray
    signal: np.ndarray
    series: Mapping[str, np.ndarray]
    own: explain.OwnNoise | None

    @property
    def place(self) -> np.ndarray:
        """Distance along the reference line in m, (sample,)."""
        return self.series["s"]


def locate(comparison: xr.Dataset, state: str | None = None, elsewhere: xr.Dataset | None = None) -> xr.Dataset:
    """Power of the residuals of a comparison (``compare.compare``) by place, frequency and condition.

    ``state``: whose residuals, by default the last. ``elsewhere``: what this function returned on the site whose repeats the floor is known from, if it is
    known from another's: by frequency it is taken as there as far as drives record here, one that is assumed as white. Powers are mean squares, in the unit of the signal squared and over all
    drives, of what is judged (``judged.judged``):
    ``error_power(signal, stretch, band)`` and ``floor_power`` of the floor there; ``power_share``, the error above the
    floor over the signal's measured power in all bands, and ``explainable_share``, over its own in all bands above the floor; ``error_map(signal, s_map,
    frequency_map)``, power density of the error, and ``floor_density(signal, frequency_map)``; what ``classes.by_condition`` says of
    conditions, the floor of which is ``band_floor(signal, band)``; ``correlation(signal)`` of measured and simulated, the ``ratio(signal)`` of their rms, what of the
    first speaks for a wrong sign, ``against(signal)`` (``judged.against``), and another signal that it goes with instead,
    ``goes_with(signal)`` (``axes.taken_for``); ``floor_time_share(signal)``, the least share of the time that holds half of what repeats differ by
    (``bursts.time_share``), nan without repeats; and what ``response.responses`` says of transfer functions.
    Attribute ``located_state`` names the state, ``floor`` where the floor is known from.
    """
    name = str(comparison["state"].values[-1] if state is None else state)
    noise = explain.own_noise(comparison, name)
    rows = comparison.sel(state=name)
    drives = [_drive(rows.isel(drive=k), noise.get(k)) for k in range(comparison.sizes["drive"])]
    rate = drives[0].rate
    bands = [band for band in BANDS if band[0] < 0.4 * rate]
    lengths = [len(drive.place) for drive in drives]
    there = elsewhere if str(comparison.attrs.get("floor", "")).startswith(explain.FROM_ELSEWHERE.partition("{")[0]) else None
    told = _told(rows, bands)
    if there is None:
        even_floor = _white_floor(rows, bands, lengths)
    else:
        even_floor = there["band_floor"].sel(signal=rows["signal"]).transpose("signal", "band").values * _mean_of(told, lengths)
    edges = _stretches(drives)
    errors, own_noises = [(d.place, d.error) for d in drives], [(d.own.place, d.own.noise) for d in drives if d.own]
    power, seconds = _by_stretch(errors, edges, bands, rate)
    floor = np.broadcast_to(even_floor[:, None, :], power.shape).copy()
    time_share = np.full(comparison.sizes["signal"], np.nan)
    if noise:
        time_share = bursts.time_share([own for _, own in own_noises], rate)
        own, length = _by_stretch(own_noises, edges, bands, rate)
        mean = np.sum(own * length[:, None], axis=1, keepdims=True) / length.sum()
        floor = _more_of_all(told, lengths, noise) * np.where(length[:, None] > 0, own, mean)
    powers = [[np.var(judged.band(d.signal, rate, band), axis=1) for band in bands] for d in drives]
    measured = np.average(powers, axis=0, weights=lengths).T
    above = (power - floor) * (seconds / seconds.sum())[:, None]
    whole = np.maximum(above.sum(axis=1, keepdims=True), 0.0).sum(axis=2, keepdims=True)  # bands below the floor take nothing off
    by_condition = classes.by_condition(drives, bands)
    window = min(int(WINDOW * rate), min(len(place) for place, _ in (*errors, *own_noises)) // 2)
    places, frequency, density = _map(errors, rate, window)
    is_told = frequency <= explain.highest(rows)[:, None]
    if noise:
        floor_density = _more_of_all(is_told, lengths, noise) * np.nanmean(_map(own_noises, rate, window)[2], axis=1)
    elif there is not None:
        known = there["floor_density"].sel(signal=rows["signal"]).transpose("signal", "frequency_map").values
        floor_density = _mean_of(is_told, lengths) * np.stack([np.interp(frequency, there["frequency_map"].values, own) for own in known])
    else:
        floor_density = _mean_of(is_told[:, None] * _density(rows)[:, :, None], lengths)
    joined = lambda part: np.concatenate([getattr(drive, part) for drive in drives], axis=1)
    signal, error = joined("signal"), joined("error")
    recorded, names = joined("measured"), comparison["signal"].values
    driven = recorded + joined("residual")
    result = xr.Dataset(
        {
            "error_power": (("signal", "stretch", "band"), power),
            "floor_power": (("signal", "stretch", "band"), floor),
            "measured_power": (("signal", "band"), measured),
            "power_share": (("signal", "stretch", "band"), above / _power(measured.sum(axis=1), recorded)[:, None, None]),
            "explainable_share": (("signal", "stretch", "band"), above / np.where(whole > 0, whole, np.nan)),
            "error_map": (("signal", "s_map", "frequency_map"), density),
            "floor_density": (("signal", "frequency_map"), floor_density),
            "correlation": ("signal", axes.correlation(signal, signal + error), {"units": "1", "long_name": "correlation of the measured signal with the model"}),
            "ratio": ("signal", judged.ratio(signal, signal + error), {"units": "1"}),
            "against": ("signal", judged.against(recorded, driven, rate, names), {"units": "1"}),
            "goes_with": ("signal", np.array(axes.taken_for(recorded, driven, names.tolist()))),
            "stretch_start": ("stretch", edges[:-1], {"units": "m"}),
            "stretch_end": ("stretch", edges[1:], {"units": "m"}),
            "band_lower": ("band", [band[0] for band in bands], {"units": "Hz"}),
            "band_upper": ("band", [band[1] for band in bands], {"units": "Hz"}),
            "band_floor": (("signal", "band"), np.average(floor, axis=1, weights=seconds)),
            "floor_time_share": ("signal", time_share, {"units": "1"}),
        },
        {
            "signal": comparison["signal"].values,
            "s_map": ("s_map", places, {"units": "m"}),
            "frequency_map": ("frequency_map", frequency, {"units": "Hz"}),
        },
    )
    result = result.merge(by_condition).merge(responses(drives, list(comparison["signal"].values)))
    return result.assign_attrs(located_state=name, floor=comparison.attrs.get("floor", explain.NIL))


def _drive(row: xr.Dataset, own: explain.OwnNoise | None) -> Drive:
    residual = row["residual"].transpose("signal", "time").values
    kept = np.isfinite(residual).all(axis=0) & np.isfinite(row["s"].values)
    time = row["time"].values
    series = {str(name): row[name].values[kept] for name in row.data_vars if row[name].dims == ("time",)}
    signals = [row[name].transpose("signal", "time").values[:, kept] for name in ("measured", "simulated")]
    series |= {str(name): values for name, values in zip(row["signal"].values, signals[1])}
    rate = rate_of(time)
    both = (judged.judged(each, rate, row["signal"].values) for each in (residual[:, kept], signals[0]))
    return Drive(rate, residual[:, kept], *signals, *both, series, own)


def _stretches(drives: Sequence[Drive]) -> np.ndarray:
    """Edges in m of the stretches that the drives cover."""
    start = np.floor(min(drive.place.min() for drive in drives) / explain.STRETCH) * explain.STRETCH
    end = max(drive.place.max() for drive in drives)
    return start + explain.STRETCH * np.arange(max(1, int(np.ceil((end - start) / explain.STRETCH))) + 1)


def _by_stretch(parts, edges: np.ndarray, bands, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean squares (signal, stretch, band) of parts (place, series), and their seconds (stretch,)."""
    count = len(edges) - 1
    power, seconds = np.zeros((len(parts[0][1]), count, len(bands))), np.zeros(count)
    for place, series in parts:
        where = np.clip(np.digitize(place, edges) - 1, 0, count - 1)
        seconds += np.bincount(where, minlength=count) / rate
        for k, band in enumerate(bands):
            for i, row in enumerate(judged.band(series, rate, band) ** 2):
                power[i, :, k] += np.bincount(where, row, minlength=count) / rate
    return power / np.maximum(seconds, 1e-9)[None, :, None], seconds


def _told(rows: xr.Dataset, bands) -> np.ndarray:
    """Share (drive, band) of every band that the record of each drive holds anything of."""
    lower, upper = np.array(bands).T
    return np.clip((explain.highest(rows)[:, None] - lower) / (upper - lower), 0.0, 1.0)


def _mean_of(told: np.ndarray, lengths: Sequence[int]) -> np.ndarray:
    """Mean over drives (drive, ...) of so many samples."""
    return np.average(told, axis=0, weights=lengths)


def _more_of_all(told: np.ndarray, lengths: Sequence[int], repeated: Mapping[int, object]) -> np.ndarray:
    """How much more of what is told (drive, ...) all drives hold in the mean than those that are repeated; 1 where these hold nothing."""
    among = sorted(repeated)
    known = _mean_of(told[among], np.array(lengths)[among])
    return np.divide(_mean_of(told, lengths), known, out=np.ones_like(known), where=known > 0)


def _density(rows: xr.Dataset) -> np.ndarray:
    """One-sided power density (drive, signal) of a white floor, from the ``floor_rmse`` of the comparison; nil without one."""
    if "floor_rmse" not in rows:
        return np.zeros((rows.sizes["drive"], rows.sizes["signal"]))
    width = explain.highest(rows)[:, None] - judged.lowest(rows["signal"].values)
    return rows["floor_rmse"].transpose("drive", "signal").values ** 2 / width


def _white_floor(rows: xr.Dataset, bands, weights: Sequence[float]) -> np.ndarray:
    """Power (signal, band) of a white floor, of what is judged and not low-passed away, mean over drives of these ``weights``."""
    lower, upper = np.array(bands).T
    lowest = judged.lowest(rows["signal"].values)[:, None]
    widths = np.minimum(upper, explain.highest(rows)[:, None, None]) - np.maximum(lower, lowest)
    return _mean_of(_density(rows)[:, :, None] * np.maximum(widths, 0.0), weights)


def _map(parts, rate: float, window: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places in m, frequencies in Hz, and one-sided power density (signal, place, frequency) in windows of so many samples, mean over parts;
    nan nearer to an end than half a window."""
    start, end = min(place.min() for place, _ in parts), max(place.max() for place, _ in parts)
    grid = np.arange(start, end, STEP)
    rows = []
    for place, series in parts:
        frequency, time, bins = stft(series, rate, nperseg=window, scaling="psd", boundary=None, padded=False)
        at = np.interp(time, np.arange(len(place)) / rate, place)
        density = 2.0 * np.abs(bins) ** 2
        one = [[np.interp(grid, at, line, np.nan, np.nan) for line in signal] for signal in density]
        rows.append(np.array(one).transpose(0, 2, 1))
    known = np.isfinite(rows)
    total = np.where(known, rows, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    inside = (frequency >= BANDS[0][0]) & (frequency <= BANDS[-1][1])
    return grid, frequency[inside], np.where(known.any(axis=0), total, np.nan)[:, :, inside]


def _power(power: np.ndarray, recorded: np.ndarray) -> np.ndarray:
    """The power (signal,) of recorded signals, nan of one that is constant but for rounding."""
    return np.where(power > CONSTANT * np.mean(recorded**2, axis=1), power, np.nan)
