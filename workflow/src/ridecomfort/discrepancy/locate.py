"""Where the error sits: by place and frequency, by condition, by signal, and in words, largest first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy.signal import coherence, csd, stft, welch

BANDS = ((0.3, 1.0), (1.0, 2.5), (2.5, 5.0), (5.0, 8.0), (8.0, 14.0), (14.0, 25.0), (25.0, 40.0))
"""Hz; body modes lie in the second, seat and hands feel the next two, wheels hop in the fifth."""

STRETCH = 100.0
"""m of road that are told apart in words."""

CLASSES = 4
"""Classes of equal length that a condition is divided into."""

NAMED = 0.02
"""Share of the error below which a finding is not worth a sentence."""


def locate(comparison: xr.Dataset, state: str | None = None) -> xr.Dataset:
    """Power of the residuals of a comparison (``compare.compare``) by place, frequency and condition.

    ``state``: whose residuals, by default the last. All powers are mean squares in the unit of the signal squared, averaged over
    drives: ``power(signal, stretch, band)``, ``share(signal, stretch, band)`` of the signal's
    measured power in all, ``by_condition(condition, class_, signal)`` with edges in ``condition_edge``, ``gain``,
    ``phase`` and ``coherence(signal, frequency)`` of measured over simulated. Conditions: speed, curvature of the path,
    lateral acceleration, and the vertical speeds of body and wheels as the simulated signals show them.
    """
    chosen = comparison.sel(state=state) if state else comparison.isel(state=-1)
    drives = [_drive(chosen, name) for name in comparison["drive"].values]
    rate = drives[0]["rate"]
    bands = [band for band in BANDS if band[0] < 0.4 * rate]
    start = min(drive["s"].min() for drive in drives)
    end = max(drive["s"].max() for drive in drives)
    edges = start + STRETCH * np.arange(max(1, int(np.ceil((end - start) / STRETCH))) + 1)
    signals = list(comparison["signal"].values)
    power = np.zeros((len(signals), len(edges) - 1, len(bands)))
    seconds = np.zeros(len(edges) - 1)
    for drive in drives:
        where = np.clip(np.digitize(drive["s"], edges) - 1, 0, len(edges) - 2)
        seconds += np.bincount(where, minlength=len(edges) - 1) / rate
        for k, band in enumerate(bands):
            squares = _band(drive["residual"], rate, band) ** 2
            for i in range(len(signals)):
                power[i, :, k] += np.bincount(where, squares[i], minlength=len(edges) - 1) / rate
    measured = np.mean([np.var(_band(drive["measured"], rate, (BANDS[0][0], BANDS[-1][1])), axis=1) for drive in drives], axis=0)
    names, condition_edges, by_condition = _conditions(drives, len(signals), rate)
    frequency, gain, phase, coherent = _transfer(drives, rate)
    total = seconds.sum()
    return xr.Dataset(
        {
            "power": (("signal", "stretch", "band"), power / np.maximum(seconds, 1e-9)[None, :, None]),
            "share": (("signal", "stretch", "band"), power / total / np.maximum(measured, 1e-30)[:, None, None]),
            "by_condition": (("condition", "class_", "signal"), by_condition),
            "condition_edge": (("condition", "edge"), condition_edges),
            "gain": (("signal", "frequency"), gain),
            "phase": (("signal", "frequency"), phase, {"units": "rad"}),
            "coherence": (("signal", "frequency"), coherent, {"units": "1"}),
            "stretch_start": ("stretch", edges[:-1], {"units": "m"}),
            "stretch_end": ("stretch", edges[1:], {"units": "m"}),
            "band_lower": ("band", [band[0] for band in bands], {"units": "Hz"}),
            "band_upper": ("band", [band[1] for band in bands], {"units": "Hz"}),
        },
        {"signal": signals, "condition": names, "frequency": ("frequency", frequency, {"units": "Hz"})},
    )


def spectrogram(comparison: xr.Dataset, signal: str, state: str | None = None, seconds: float = 2.0) -> xr.DataArray:
    """Residual power density of a signal over place and frequency, mean over the drives: the first figure to look at."""
    chosen = comparison.sel(state=state) if state else comparison.isel(state=-1)
    drives = [_drive(chosen, name) for name in comparison["drive"].values]
    index = list(comparison["signal"].values).index(signal)
    grid = np.arange(min(d["s"].min() for d in drives), max(d["s"].max() for d in drives), 10.0)
    rows = []
    for drive in drives:
        length = int(seconds * drive["rate"])
        frequency, time, bins = stft(drive["residual"][index], drive["rate"], nperseg=length, scaling="psd")
        place = np.interp(time, np.arange(len(drive["s"])) / drive["rate"], drive["s"])
        rows.append(np.stack([np.interp(grid, place, row, np.nan, np.nan) for row in np.abs(bins) ** 2], axis=1))
    return xr.DataArray(np.nanmean(rows, axis=0), {"s": grid, "frequency": frequency}, ("s", "frequency"), name=signal)


def words(located: xr.Dataset, count: int = 5) -> list[str]:
    """The largest errors in words, such as "a_z, 8-14 Hz, 1.2-1.5 km, mostly at speeds above 70 km/h: 12 % of its power"."""
    sentences = []
    share = located["share"].values
    for signal, band in sorted(np.ndindex(share.shape[0], share.shape[2]), key=lambda key: -share[key[0], :, key[1]].sum()):
        whole = share[signal, :, band].sum()
        if whole < NAMED or len(sentences) == count:
            break
        name = str(located["signal"].values[signal])
        lower, upper = (float(located[f"band_{end}"][band]) for end in ("lower", "upper"))
        where = _stretches(located, share[signal, :, band])
        when = _prevailing(located, signal)
        sentences.append(f"{name}, {lower:g}-{upper:g} Hz, {where}{when}: {100 * whole:.1f} % of the signal's power")
    return sentences


def _stretches(located: xr.Dataset, share: np.ndarray) -> str:
    """The shortest run of stretches that holds half of an error, or all of the road where it is even."""
    for length in range(1, len(share)):
        sums = np.convolve(share, np.ones(length), "valid")
        if sums.max() >= 0.5 * share.sum():
            if length > 0.35 * len(share):
                break
            first = int(sums.argmax())
            start, end = float(located["stretch_start"][first]), float(located["stretch_end"][first + length - 1])
            return f"half of it at {start / 1000:.2f}-{end / 1000:.2f} km"
    return "all along the road"


def _prevailing(located: xr.Dataset, signal: int) -> str:
    """The condition whose highest class has most of the error, where that is twice the mean."""
    power = located["by_condition"].values[:, :, signal]
    ratio = power[:, -1] / np.maximum(power.mean(axis=1), 1e-30)
    best = int(np.argmax(ratio))
    if ratio[best] < 2.0:
        return ""
    name = str(located["condition"].values[best])
    edge = float(located["condition_edge"][best, -2])
    text = {"speed": f"speeds above {3.6 * edge:.0f} km/h", "curvature": f"radii below {1 / max(edge, 1e-6):.0f} m"}
    return f", mostly at {text.get(name, f'{name} above {edge:.2g}')}"


def _drive(chosen: xr.Dataset, name) -> dict:
    row = chosen.sel(drive=name)
    kept = np.isfinite(row["residual"].values).all(axis=0) & np.isfinite(row["s"].values)
    time = row["time"].values
    return {
        "rate": float((len(time) - 1) / (time[-1] - time[0])),
        **{key: row[key].values[..., kept] for key in ("residual", "measured", "simulated", "s", "v_x")},
        "signals": list(chosen["signal"].values),
    }


def _band(series: np.ndarray, rate: float, band: tuple[float, float]) -> np.ndarray:
    bins = np.fft.rfft(series, axis=-1)
    frequency = np.fft.rfftfreq(series.shape[-1], 1.0 / rate)
    return np.fft.irfft(np.where((frequency >= band[0]) & (frequency < band[1]), bins, 0.0), series.shape[-1], axis=-1)


def _conditions(drives: Sequence[dict], count: int, rate: float):
    """Mean squares of the residuals by classes of equal length of every condition, with their edges."""
    known: dict[str, list[np.ndarray]] = {}
    for drive in drives:
        signal = {name: drive["simulated"][k] for k, name in enumerate(drive["signals"])}
        body = _band(signal["a_z"], rate, (0.5, 2.5))
        wheel = _band(signal["a_z"], rate, (8.0, 16.0))
        envelope = lambda values: np.sqrt(np.convolve(values**2, np.ones(int(rate)) / int(rate), "same"))
        for name, values in {
            "speed": drive["v_x"],
            "curvature": np.abs(signal["yaw_rate"]) / np.maximum(drive["v_x"], 1.0),
            "lateral acceleration": envelope(_band(signal["a_y"], rate, (0.05, 1.0))),
            "vertical speed of the body": envelope(np.cumsum(body - body.mean()) / rate),
            "wheel hop": envelope(wheel),
        }.items():
            known.setdefault(name, []).append(values)
    edges, powers = [], []
    for values in known.values():
        edge = np.quantile(np.concatenate(values), np.linspace(0, 1, CLASSES + 1))
        power, samples = np.zeros((CLASSES, count)), np.zeros(CLASSES)
        for drive, own in zip(drives, values):
            which = np.clip(np.searchsorted(edge, own, "right") - 1, 0, CLASSES - 1)
            samples += np.bincount(which, minlength=CLASSES)
            for i in range(count):
                power[:, i] += np.bincount(which, drive["residual"][i] ** 2, minlength=CLASSES)
        edges.append(edge)
        powers.append(power / np.maximum(samples, 1)[:, None])
    return list(known), np.stack(edges), np.stack(powers)


def _transfer(drives: Sequence[dict], rate: float):
    """Gain and phase of measured over simulated signals and their coherence, means over the drives."""
    length = int(4 * rate)
    gains, coherent = [], []
    for drive in drives:
        segment = min(length, drive["measured"].shape[1])
        frequency, cross = csd(drive["simulated"], drive["measured"], rate, nperseg=segment)
        _, own = welch(drive["simulated"], rate, nperseg=segment)
        gains.append(cross / np.maximum(own, 1e-30))
        coherent.append(coherence(drive["simulated"], drive["measured"], rate, nperseg=segment)[1])
    shortest = min(gain.shape[1] for gain in gains)
    ratio = np.mean([gain[:, :shortest] for gain in gains], axis=0)
    return frequency[:shortest], np.abs(ratio), np.angle(ratio), np.mean([c[:, :shortest] for c in coherent], axis=0)
