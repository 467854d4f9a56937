"""Jerk of the driver's manoeuvres against what standing and seated passengers accept (sec:back_motivation)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import xarray as xr
from scipy import fft

from . import runs, sections, signals
from .limits import JERK, Band
from .thresholds import detect

AXES = {"jerk_x": "a_x", "jerk_y": "a_y"}

CUTOFF = 2.0
"""Hz; the thresholds are meant for manoeuvres, and vibration above would drown them."""

HALF_AMPLITUDE = np.sqrt(2 * np.log(2)) / (2 * np.pi)
"""Standard deviation in s of a Gaussian whose spectrum is a half at 1 Hz."""


def of_drive(acceleration, rate: float, cutoff: float = CUTOFF):
    """Jerk in m/s3 of an acceleration in m/s2 at ``rate`` Hz, last axis time; NaN padding at the end stays.

    The derivative of the signal behind a Gaussian low-pass of half amplitude at ``cutoff`` Hz.
    """
    rate = signals.check_rate(rate)
    values, restore = signals.time_last(acceleration, rate, "m/s2")
    table, lengths = signals.rows(values)
    answer = np.full(table.shape, np.nan, table.dtype)
    for row, length in enumerate(lengths):
        if length > 1:
            answer[row, :length] = rate * _slope(table[row : row + 1, :length], HALF_AMPLITUDE / cutoff * rate)[0]
    return restore(answer.reshape(values.shape), name="jerk", unit="m/s3")


def along(acceleration: np.ndarray, speed: np.ndarray, spacing: float, cutoff: float = CUTOFF) -> np.ndarray:
    """Jerk (run, s) in m/s3 of accelerations (run, s) in m/s2, places ``spacing`` m apart, ``speed`` (run, s).

    The slope along the road times speed; the low-pass of each run is that of ``of_drive`` at the run's mean speed.
    """
    answer = np.empty_like(acceleration)
    for row, mean in enumerate(speed.mean(axis=1, dtype=float)):
        spread = HALF_AMPLITUDE / cutoff * mean / spacing
        answer[row] = _slope(acceleration[row : row + 1], spread)[0] / spacing
    return answer * speed


def evaluate(
    shards: Iterable[xr.Dataset],
    limits: Mapping[str, Band] = JERK,
    length: float = sections.LENGTH,
    *,
    sliding: bool = False,
) -> xr.Dataset:
    """Sections whose jerk passes its bands: as ``thresholds.evaluate``, over dims jerk and jerk_style.

    ``shards`` hold v_x in m/s, a_x and a_y in m/s2. Names that ``thresholds`` has too begin with ``jerk_``.
    """

    def stream():
        for number, s, (speed, *values) in runs.checked(shards, ["v_x", *AXES.values()]):
            yield number, s, [along(value, speed, float(s[1] - s[0])) for value in values]

    found = detect(stream(), {name: dict(limits) for name in AXES}, length, "m/s3", sliding)
    own = [name for name in found.data_vars if name not in (*AXES, "window_start")]
    found = found.rename({name: f"jerk_{name}" for name in own} | {"quantity": "jerk", "style": "jerk_style"})
    for name in AXES:
        found[name].attrs = {"units": "m/s3", "long_name": f"jerk of manoeuvres along {name[-1]}"}
    return found


def _slope(rows: np.ndarray, spread: float) -> np.ndarray:
    """Derivative per sample of rows behind a Gaussian of ``spread`` samples; both ends go on as point reflections."""
    reach = min(int(np.ceil(5 * spread)) + 1, rows.shape[1] - 1)
    before = 2 * rows[:, :1] - rows[:, reach:0:-1]
    behind = 2 * rows[:, -1:] - rows[:, -2 : -reach - 2 : -1]
    data = np.concatenate([before, rows, behind], axis=1)
    # The straight line from end to end has a known slope; without it the transform meets no jump.
    steps = data.shape[1] - 1
    tilt = (data[:, -1:] - data[:, :1]) / steps
    level = data - data[:, :1] - tilt * np.arange(steps + 1, dtype=data.dtype)
    length = fft.next_fast_len(data.shape[1], real=True)
    angle = 2 * np.pi * fft.rfftfreq(length)
    gain = (1j * angle * np.exp(-0.5 * (angle * spread) ** 2)).astype(np.result_type(rows.dtype, np.complex64))
    found = fft.irfft(fft.rfft(level, length) * gain, length)[:, reach : reach + rows.shape[1]]
    return found + tilt
