"""Where on the road a sample was taken: clock offset, speed scale, odometer without a fix."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr
from scipy.signal import butter, correlate, sosfiltfilt
from scipy.stats import theilslopes

from ..vocabulary import CALIBRATED, SIGNALS
from .replay import Replay, Simulated, replay

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

FARTHEST = 20.0
"""s around the expected clock at which a record is looked for, beyond what is accepted: GPS runs 18 s ahead of UTC."""

ODOMETER_WINDOW = 8.0
"""s of record that are looked for on the road at a time, where place was not measured."""

ODOMETER_REACH = 15.0
"""m around the expected place."""


def moved(drive: xr.Dataset, *, clock: float = 0.0, scale: float = 1.0, offset: float = 0.0) -> xr.Dataset:
    """The drive with place and speed moved back by ``clock`` (s), onto the clock of its inertial signals.

    Where place is an integral of speed it is scaled and offset (m) with it, else speed alone is scaled.
    """
    time = drive["time"].values

    def earlier(name: str) -> np.ndarray:
        values = drive[name].values
        shifted = np.interp(time - clock, time, values)
        for outside, end in ((time - clock < time[0], time < time[0] + END), (time - clock > time[-1], time > time[-1] - END)):
            if outside.any():
                shifted[outside] = np.polyval(np.polyfit(time[end], values[end], 1), time[outside] - clock)
        return shifted

    integrated = not drive.attrs["place_measured"]
    placed = earlier("s") if not integrated else offset + scale * drive["s"].values
    series = {"s": placed, "v_x": scale * earlier("v_x"), "e": np.interp(time - clock, time, drive["e"].values)}
    return drive.assign({name: drive[name].copy(data=values) for name, values in series.items()})


def speed_scale(drive: xr.Dataset, road) -> float:
    """True over recorded v_x: the way driven over the integral of the recorded speed.

    The way of the body differs from the distance along the reference line in curves, where it is
    shorter inside by 1 - curvature e, and on slopes, since ``s`` lies in the horizontal plane.
    """
    time, s = drive["time"].values, drive["s"].values
    offset = np.where(np.isfinite(drive["e"].values), drive["e"].values, np.nan_to_num(drive.attrs["lateral_position"]))
    stretch = np.ones(len(s))
    road = getattr(road, "road", road)
    if "curvature" in road:
        stretch -= np.interp(s, road["u"], road["curvature"]) * offset
    if "slope" in road:
        stretch *= np.sqrt(1 + np.interp(s, road["u"], road["slope"]) ** 2)
    way = np.sum(0.5 * (stretch[1:] + stretch[:-1]) * np.diff(s))
    return float(way / np.trapezoid(drive["v_x"].values, time))


def coarse_clock(again: Replay, simulated: Simulated, search: float) -> float:
    """s that the inertial signals lag behind the place, to a sample, within ``search`` (s)."""
    interval = again.time[1] - again.time[0]
    reach = int(round(search / interval))
    measured, model = again.measured()[:, again.compared], simulated.signals[:, again.compared]
    return interval * (int(np.argmax(_agreement(measured, model, reach))) - reach)


def shaken(again: Replay, simulated: Simulated, farthest: float) -> tuple[np.ndarray, np.ndarray]:
    """How well model and record agree in what the road makes of them, at lags within ``farthest`` (s) and half the record.

    Returns the lags (s) of the inertial signals behind the place, and the mean square of the correlations of SHAKEN at
    each: 1 for a perfect model.
    """
    interval = again.time[1] - again.time[0]
    lower, upper = SHAKEN_BAND
    band = butter(2, (lower, min(upper, 0.4 / interval)), "bandpass", fs=1 / interval, output="sos")
    rows = [SIGNALS.index(name) for name in SHAKEN]
    measured, model = (
        sosfiltfilt(band, signals[rows][:, again.compared], axis=1, padlen=0) for signals in (again.measured(), simulated.signals)
    )
    reach = min(int(round(farthest / interval)), measured.shape[1] // 2)
    return interval * np.arange(-reach, reach + 1), _agreement(measured, model, reach) / len(rows)


def _agreement(measured: np.ndarray, model: np.ndarray, reach: int) -> np.ndarray:
    """Sum over the signals of their correlation, at lags -reach ... reach of the measurement behind the model.

    Signals count by how well they correlate at their best, so one that the model misses adds nothing.
    """
    total = np.zeros(2 * reach + 1)
    centre = measured.shape[1] - 1
    for one, other in zip(_standardised(measured), _standardised(model)):
        lags = correlate(one, other, mode="full", method="fft") / one.size
        lags = lags[max(centre - reach, 0) : centre + reach + 1]
        total += max(lags.max(), 0.0) * lags
    return total


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
    drive: xr.Dataset, road, vehicle, simulate: Callable[..., xr.Dataset], options: Mapping
) -> tuple[float, float]:
    """Scale and offset (m) of a place that was integrated from speed, found by what the road feels like.

    Windows of the record are looked for on the simulated road, each around the place that the ones
    before it predict; a line through what they say (Theil-Sen, robust against false finds).
    """
    high = butter(2, 0.5, "highpass", fs=1 / float(drive["time"][1] - drive["time"][0]), output="sos")
    scale, offset = 1.0, 0.0
    for _ in range(2):
        again = replay(moved(drive, scale=scale, offset=offset), road, simulate, margin=ODOMETER_REACH, options=options)
        simulated = again(vehicle)
        measured = sosfiltfilt(high, again.measured(), axis=1)
        model = sosfiltfilt(high, simulated.signals, axis=1)
        step_scale, step_offset = _track(again, measured, model)
        scale, offset = scale * step_scale, offset * step_scale + step_offset
    return scale, offset


def _track(again: Replay, measured: np.ndarray, model: np.ndarray) -> tuple[float, float]:
    interval = again.time[1] - again.time[0]
    window = int(ODOMETER_WINDOW / interval)
    places, errors = [], []
    for first in range(0, measured.shape[1] - window + 1, window // 2):
        part = slice(first, first + window)
        middle = again.place[first + window // 2]
        speed = (again.place[part.stop - 1] - again.place[first]) / (window * interval)
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


def refine(again: Replay, simulated: Simulated) -> tuple[float, float]:
    """Scale and offset (m) of the place that are left, by one Gauss-Newton step."""
    kept = again.compared
    residual = _centred(again.residual(simulated)[:, kept])
    speed = np.gradient(again.place, again.time)[kept]
    along = simulated.slopes[:, kept] / speed
    root = np.sqrt(_weights(residual))
    columns = np.stack([(_centred(along * again.place[kept]) * root).ravel(), (_centred(along) * root).ravel()], axis=1)
    size = np.linalg.norm(columns, axis=0)
    scale, offset = -np.linalg.lstsq(columns / size, (residual * root).ravel(), rcond=1e-9)[0] / size
    return 1.0 + float(scale), float(offset)
