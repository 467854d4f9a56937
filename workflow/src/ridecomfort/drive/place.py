"""Where on the road a sample was taken: clock offset, speed scale, odometer without a fix."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.signal import butter, correlate, sosfiltfilt
from scipy.stats import theilslopes

from ..vocabulary import CALIBRATED, SIGNALS
from .configured import SPEED_SCALE
from .replay import Replay, Simulated, replay
from .sampling import integral

NUISANCE = (*CALIBRATED[:2], *CALIBRATED[3:], "damping_front", "damping_rear")
"""Parameters of the vehicle whose error must not pass for a clock offset."""

SECANT = 0.05
"""Share of its value that a nuisance parameter is changed by."""

TRUST = 0.3
"""Largest change of a nuisance parameter in one step, as a share of its value."""

BLOCK = 1.0
"""s; residuals farther apart are independent in the error of the clock offset."""

END = 0.5
"""s at an end of a record whose straight line continues it: from sample to sample its noise would be a trend."""

SHAKEN, SHAKEN_BAND = ("a_z", "roll_rate", "pitch_rate"), (0.5, 20.0)
"""Signals that the road makes, and Hz in which it does: by them one stretch of it, and one path, is told from another."""

STANDS_STILL = 1e-4
"""Times the standard deviation of a measured signal below which what the model does is rounding: rolling on a road that is even across."""

FARTHEST = 20.0
"""s around the expected clock at which a record is looked for, beyond what is accepted: GPS runs 18 s ahead of UTC."""

ODOMETER_WINDOW = 8.0
"""s of record that are looked for on the road at a time, where place was not measured."""

SHORTEST = 1.5 * ODOMETER_WINDOW
"""s that such a record lasts at least: two windows, which overlap by half, tell a scale; of a shorter one places 4 to 8 m off were taken for right."""

BASE = 3.0
"""m of road that a slope is taken over: about a wheelbase, so that a body follows it."""

ODOMETER_REACH = 15.0
"""m around the expected place."""


@dataclass(frozen=True)
class Way:
    """How far a body has driven, ``driven`` (m), where it is at ``u`` (m) of the reference line; both rise, and go on alike beyond their ends."""

    u: np.ndarray
    driven: np.ndarray

    def __call__(self, s) -> np.ndarray:
        """Way in m to places along the reference line."""
        return s + np.interp(s, self.u, self.driven - self.u)

    def place(self, driven) -> np.ndarray:
        """Distance along the reference line in m after so many m of way."""
        return driven - np.interp(driven, self.driven, self.driven - self.u)


def way(drive: xr.Dataset, road, start: float = 0.0) -> Way:
    """The way of a drive's path on the road, equal to the distance along the reference line at ``start`` (m).

    The two differ in curves, where the way is shorter inside by 1 - curvature e, and on slopes, since ``s`` lies in the
    horizontal plane. The slope is that of the heights that the path meets, over BASE: some roads have them without a slope.
    """
    road = getattr(road, "road", road)
    u = road["u"].values
    known = np.isfinite(drive["e"].values)
    aside = np.full(len(u), np.nan_to_num(float(drive.attrs["lateral_position"])))
    if known.any():
        aside = np.interp(u, drive["s"].values[known], drive["e"].values[known])
    stretch = np.sqrt(1 + _slope(road, aside) ** 2)
    if "curvature" in road:
        stretch *= 1 - road["curvature"].values * aside
    driven = integral(stretch, u)
    return Way(u, driven - np.interp(start, u, driven - u))


def _slope(road: xr.Dataset, aside: np.ndarray) -> np.ndarray:
    """Slope over u of the heights ``aside`` (u, in m) of the reference line, over BASE; 0 where none is known."""
    u, v, heights = road["u"].values, road["v"].values, road["elevation"].values
    across = np.clip((aside - v[0]) / (v[1] - v[0]), 0, len(v) - 1)
    right = np.minimum(across.astype(int), len(v) - 2)
    row = np.arange(len(u))
    met = heights[row, right] + (across - right) * (heights[row, right + 1] - heights[row, right])
    known = np.isfinite(met)
    if not known.any():
        return np.zeros(len(u))
    ahead, behind = (np.interp(np.clip(u + step, u[0], u[-1]), u[known], met[known]) for step in (0.5 * BASE, -0.5 * BASE))
    return (ahead - behind) / (np.minimum(u + 0.5 * BASE, u[-1]) - np.maximum(u - 0.5 * BASE, u[0]))


def cut(drive: xr.Dataset, kept: np.ndarray) -> xr.Dataset:
    """The drive from the first to the last sample that is ``kept`` (time,); its time counts from nought again."""
    if kept.all():
        return drive
    first, last = np.flatnonzero(kept)[[0, -1]]
    time = drive["time"].values
    short = drive.isel(time=slice(first, last + 1)).assign_coords(time=drive["time"][: last + 1 - first])
    way = float(drive.attrs.get("way_before", 0.0)) + float(drive["s"][first] - drive["s"][0])
    return short.assign_attrs(start_time=float(drive.attrs["start_time"]) + float(time[first] - time[0]), way_before=way)


def on_road(drive: xr.Dataset, road, before: float = np.inf, behind: float = np.inf) -> np.ndarray:
    """Which samples of the drive lie on the road, (time,); all where some lie farther ``before`` or ``behind`` it (m), or none on it."""
    u, s = getattr(road, "road", road)["u"].values, drive["s"].values
    kept = (s >= u[0]) & (s <= u[-1])
    return kept if kept.any() and s.min() >= u[0] - before and s.max() <= u[-1] + behind else np.full(s.size, True)


def moved(drive: xr.Dataset, *, clock: float = 0.0, scale: float = 1.0) -> xr.Dataset:
    """The drive with place and speed later by ``clock`` (s), which puts them on the clock of its inertial signals, and its speed scaled."""
    time = drive["time"].values

    def earlier(name: str) -> np.ndarray:
        values = drive[name].values
        shifted = np.interp(time - clock, time, values)
        for outside, end in ((time - clock < time[0], time < time[0] + END), (time - clock > time[-1], time > time[-1] - END)):
            if outside.any():
                shifted[outside] = np.polyval(np.polyfit(time[end], values[end], 1), time[outside] - clock)
        return shifted

    series = {"s": earlier("s"), "v_x": scale * earlier("v_x"), "e": np.interp(time - clock, time, drive["e"].values)}
    return drive.assign({name: drive[name].copy(data=values) for name, values in series.items()})


def driven(work: xr.Dataset, recorded: xr.Dataset, along: Way, scale: float, offset: float) -> xr.Dataset:
    """The drive where its way was integrated from speed, with the ``recorded`` speed and way scaled, and the way offset (m)."""
    place = along.place(offset + scale * recorded["s"].values)
    return work.assign(s=work["s"].copy(data=place), v_x=work["v_x"].copy(data=scale * recorded["v_x"].values))


def speed_scale(drive: xr.Dataset, along: Way) -> float:
    """True over recorded v_x: the slope of the way driven over the integral of the recorded speed, of all samples."""
    return float(np.polyfit(integral(drive["v_x"].values, drive["time"].values), along(drive["s"].values), 1)[0])


def coarse_clock(again: Replay, simulated: Simulated, search: float) -> float:
    """s that the inertial signals lag behind the place, to a sample, within ``search`` (s)."""
    interval = again.time[1] - again.time[0]
    measured, model = again.measured()[:, again.compared], simulated.signals[:, again.compared]
    reach = min(int(round(search / interval)), measured.shape[1] - 1)
    return interval * (int(np.argmax(_agreement(measured, model, reach))) - reach)


def shaken(again: Replay, simulated: Simulated, farthest: float) -> tuple[np.ndarray, np.ndarray]:
    """How well model and record agree in what the road makes of them, at lags within ``farthest`` (s) and half the record.

    Returns the lags (s) of the inertial signals behind the place, and the mean square of the correlations of SHAKEN at
    each: 1 for a perfect model.
    """
    interval = again.time[1] - again.time[0]
    rows = [SIGNALS.index(name) for name in SHAKEN]
    measured, model = (as_shaken(signals[rows][:, again.compared], interval) for signals in (again.measured(), simulated.signals))
    reach = min(int(round(farthest / interval)), measured.shape[1] // 2)
    return interval * np.arange(-reach, reach + 1), _agreement(measured, model, reach) / len(rows)


def as_shaken(signals: np.ndarray, interval: float) -> np.ndarray:
    """What of signals (signal, sample), ``interval`` (s) apart, lies in SHAKEN_BAND."""
    lower, upper = SHAKEN_BAND
    band = butter(2, (lower, min(upper, 0.4 / interval)), "bandpass", fs=1 / interval, output="sos")
    return sosfiltfilt(band, signals, axis=1, padlen=0)


def _agreement(measured: np.ndarray, model: np.ndarray, reach: int) -> np.ndarray:
    """Sum over the signals of their correlation, at lags -reach ... reach of the measurement behind the model.

    Signals count by how well they correlate at their best, so one that the model misses adds nothing; nor does one in which it stands still.
    """
    found = correlations(measured, model, reach)
    return np.maximum(found.max(axis=1), 0.0) @ found


def correlations(measured: np.ndarray, model: np.ndarray, reach: int) -> np.ndarray:
    """Correlation of every signal of (signal, sample) with the model's, at lags -reach ... reach of the measurement behind the model, (signal, lag);
    nil of what the model does not move."""
    found, middle = np.zeros((len(measured), 2 * reach + 1)), measured.shape[1] - 1
    moves = np.flatnonzero(model.std(axis=1) > STANDS_STILL * measured.std(axis=1))
    for row, one, other in zip(moves, _standardised(measured[moves]), _standardised(model[moves])):
        found[row] = correlate(one, other, mode="full", method="fft")[middle - reach : middle + reach + 1] / one.size
    return found


def _standardised(signals: np.ndarray) -> np.ndarray:
    centred = signals - signals.mean(axis=1, keepdims=True)
    return centred / (centred.std(axis=1, keepdims=True) + 1e-12)


def _weights(residual: np.ndarray) -> np.ndarray:
    return 1 / (residual.var(axis=1, keepdims=True) + 1e-10)


def _centred(rows: np.ndarray) -> np.ndarray:
    return rows - rows.mean(axis=-1, keepdims=True)


def clock(again: Replay, simulated: Simulated, vehicle) -> tuple[float, float, dict[str, float]]:
    """Clock offset in s that is left, its standard error, and values of the vehicle's parameters that fit better.

    One Gauss-Newton step, solved together with the vehicle's parameters (NUISANCE, as far as it has
    them) and the means of all signals. The error is that of a sum of independent blocks of
    the residual's score.
    """
    kept = again.compared
    base = again.residual(simulated)[:, kept]
    residual = _centred(base)
    columns, names = [-simulated.slopes[:, kept]], []
    for name in NUISANCE:
        try:
            changed = vehicle.replace(**{name: vehicle[name] * (1 + SECANT)})
        except (KeyError, ValueError):  # a vehicle of another simulator need not have it
            continue
        columns.append((again.residual(again(changed))[:, kept] - base) / SECANT)
        names.append(name)
    columns = [_centred(column) for column in columns]
    weight = _weights(residual)
    for _ in range(3):
        flat = np.stack([(column * np.sqrt(weight)).ravel() for column in columns], axis=1)
        size = np.linalg.norm(flat, axis=0) + 1e-300
        solution = -np.linalg.lstsq(flat / size, (residual * np.sqrt(weight)).ravel(), rcond=1e-6)[0] / size
        left = residual + np.tensordot(solution, columns, axes=1)
        weight = _weights(left)
    projected = _orthogonal(columns, np.sqrt(weight))
    information = np.sum(projected**2)
    score = np.sum(projected * left * np.sqrt(weight), axis=0)
    length = max(1, int(round(BLOCK / (again.time[1] - again.time[0]))))
    blocks = np.add.reduceat(score, np.arange(0, score.size, length))
    better = {name: vehicle[name] * (1 + np.clip(step, -TRUST, TRUST)) for name, step in zip(names, solution[1:])}
    return float(solution[0]), float(np.sqrt(np.sum(blocks**2)) / information), better


def _orthogonal(columns: list[np.ndarray], root_weight: np.ndarray) -> np.ndarray:
    """The first column, weighted, less what the others explain of it."""
    first, *others = [column * root_weight for column in columns]
    if not others:
        return first
    basis = np.stack([other.ravel() for other in others], axis=1)
    return first - (basis @ np.linalg.lstsq(basis, first.ravel(), rcond=1e-6)[0]).reshape(first.shape)


def misfit(again: Replay, simulated: Simulated) -> float:
    """Share of the signals' variance that the model leaves, each signal alike, at the best clock and means."""
    kept = again.compared
    residual = _centred(again.residual(simulated)[:, kept])
    slope = _centred(simulated.slopes[:, kept])
    scale = again.measured()[:, kept].var(axis=1, keepdims=True) + 1e-10
    step = np.sum(slope * residual / scale) / np.sum(slope**2 / scale)
    return float(np.mean((residual - step * slope) ** 2 / scale))


def odometer(
    drive: xr.Dataset, along: Way, road, vehicle, simulate: Callable[..., xr.Dataset], options: Mapping
) -> tuple[float, float]:
    """Scale and offset (m) of a way that was integrated from speed, found by what the road feels like.

    Windows of the record are looked for on the simulated road, each around the place that the ones
    before it predict; a line through what they say (Theil-Sen, robust against false finds). What lies beyond the road only because
    the speed was off is left out until that is known.
    """
    beyond = ODOMETER_REACH, ODOMETER_REACH + SPEED_SCALE * float(np.ptp(drive["s"].values))
    high = butter(2, 0.5, "highpass", fs=1 / float(drive["time"][1] - drive["time"][0]), output="sos")
    scale, offset = 1.0, 0.0
    for _ in range(2):
        placed = driven(drive, drive, along, scale, offset)
        again = replay(cut(placed, on_road(placed, road, *beyond)), road, simulate, margin=ODOMETER_REACH, options=options)
        simulated = again(vehicle)
        measured = sosfiltfilt(high, again.measured(), axis=1)
        model = sosfiltfilt(high, simulated.signals, axis=1)
        step_scale, step_offset = _track(again, along, measured, model)
        scale, offset = scale * step_scale, offset * step_scale + step_offset
    return scale, offset


def _track(again: Replay, along: Way, measured: np.ndarray, model: np.ndarray) -> tuple[float, float]:
    ways, interval = along(again.place), again.time[1] - again.time[0]
    window = int(ODOMETER_WINDOW / interval)
    places, errors = [], []
    for first in range(0, measured.shape[1] - window + 1, window // 2):
        part = slice(first, first + window)
        middle = ways[first + window // 2]
        speed = (ways[part.stop - 1] - ways[first]) / (window * interval)
        reach = min(int(ODOMETER_REACH / speed / interval), window // 2)
        expected = np.polyval(np.polyfit(places, errors, 1), middle) if len(places) > 3 else (errors or [0.0])[-1]
        shift = int(round(expected / speed / interval))
        shifted = np.clip(np.arange(first, first + window) + shift, 0, measured.shape[1] - 1)
        lags = _agreement(measured[:, part], model[:, shifted], reach)
        lag = int(np.argmax(lags)) - reach
        places.append(middle)
        errors.append((shift - lag) * interval * speed)
    if len(places) < 2:
        return 1.0, errors[0] if errors else 0.0
    slope, intercept, *_ = theilslopes(errors, places)
    return 1.0 + slope, intercept


def refine(again: Replay, simulated: Simulated, along: Way) -> tuple[float, float]:
    """Scale and offset (m) of the way that are left, by one Gauss-Newton step."""
    kept = again.compared
    residual = _centred(again.residual(simulated)[:, kept])
    ways = along(again.place)
    farther = simulated.slopes[:, kept] / np.gradient(ways, again.time)[kept]
    root = np.sqrt(_weights(residual))
    columns = np.stack([(_centred(farther * ways[kept]) * root).ravel(), (_centred(farther) * root).ravel()], axis=1)
    size = np.linalg.norm(columns, axis=0)
    scale, offset = -np.linalg.lstsq(columns / size, (residual * root).ravel(), rcond=1e-9)[0] / size
    return 1.0 + float(scale), float(offset)
