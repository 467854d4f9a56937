"""Running rms and the single figures of ISO 2631-1 for a weighted signal."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numba import njit

from ..errors import InputError
from . import signals


SETTLED = {"linear": 1.0, "exponential": 3.0}
"""Time constants from the beginning of a record until a running rms knows enough of what came before: all of it, or 95 % of its power."""


def running_rms(weighted, rate: float, time_constant: float = 1.0, method: str = "linear"):
    """Running rms in m/s2 of a weighted signal, of its shape; NaN padding at the end stays.

    "linear": over the last ``time_constant`` seconds (ISO 2631-1:1997 eq. 2);
    "exponential": averaged with that time constant (eq. 3). Before the first
    sample the signal is zero.
    """
    rate = signals.check_rate(rate)
    values, restore = signals.time_last(weighted, rate, "m/s2")
    table, lengths = signals.rows(values)
    answer = np.square(table)
    running_root(answer, lengths, rate, time_constant, method)
    return restore(answer.reshape(values.shape))


def running_root(squares: np.ndarray, lengths: np.ndarray, rate: float, time_constant: float, method: str) -> None:
    """Replace rows of squared values by the root of their running mean, in place."""
    if not time_constant * rate >= 1.0:
        raise InputError(f"{time_constant} s is shorter than one sample at {rate:g} Hz", place="time_constant")
    if method == "linear":
        _linear(squares, lengths, time_constant * rate)
    elif method == "exponential":
        _exponential(squares, lengths, -np.expm1(-1.0 / (time_constant * rate)))
    else:
        raise InputError(f"{method!r} is unknown; expected 'linear' or 'exponential'", place="method")


@njit(cache=True)
def _linear(squares, lengths, window):
    """A window of ``window`` samples; of the oldest sample only the fraction inside it counts."""
    count, samples = squares.shape
    whole = int(window)
    fraction = window - whole
    recent = np.empty(whole + 1)
    for row in range(count):
        recent[:] = 0.0
        total = 0.0
        place = 0
        for sample in range(lengths[row]):
            value = float(squares[row, sample])
            # ``recent`` is a ring: at ``place`` lies the value ``whole + 1`` samples ago.
            oldest = recent[place]
            recent[place] = value
            place = place + 1 if place < whole else 0
            leaving = recent[place]
            total += value - fraction * oldest - (1.0 - fraction) * leaving
            squares[row, sample] = np.sqrt(max(total, 0.0) / window)
        squares[row, lengths[row] :] = np.nan


@njit(cache=True)
def _exponential(squares, lengths, share):
    for row in range(squares.shape[0]):
        mean = 0.0
        for sample in range(lengths[row]):
            mean += share * (float(squares[row, sample]) - mean)
            squares[row, sample] = np.sqrt(mean)
        squares[row, lengths[row] :] = np.nan


CREST_LIMIT, MTVV_LIMIT, VDV_LIMIT = 9.0, 1.5, 1.75
"""Where the rms alone may underrate a vibration: crest factor (ISO 2631-1:1997 6.2.2), MTVV / a_w and
VDV / (a_w T^1/4) (6.3.3)."""

UNFELT = 1e-6
"""m/s2 of weighted rms below which nobody feels anything: the ratios to such an rms are those of rounding."""

UNITS = {
    "rms": ("m/s2", "root mean square of the weighted acceleration"),
    "mtvv": ("m/s2", "maximum transient vibration value, the largest running rms"),
    "vdv": ("m/s1.75", "fourth-power vibration dose value"),
    "evdv": ("m/s1.75", "estimated vibration dose value, 1.4 a_w T^1/4"),
    "msdv": ("m/s1.5", "motion sickness dose value, a_w T^1/2"),
    "crest_factor": ("1", "largest absolute value over rms"),
    "mtvv_ratio": ("1", "MTVV over rms"),
    "vdv_ratio": ("1", "VDV over a_w T^1/4"),
    "duration": ("s", "duration of the signal"),
}


def metrics(weighted, rate: float, *, time_constant: float = 1.0, method: str = "linear") -> xr.Dataset:
    """The quantities of ISO 2631-1 of a weighted acceleration in m/s2 at ``rate`` Hz, last axis time.

    Returns a dataset over the axes before time: ``rms``, ``mtvv``, ``vdv``, ``evdv``,
    ``msdv``, ``crest_factor``, ``mtvv_ratio``, ``vdv_ratio``, ``duration`` and
    ``rms_suffices``, which is False where the standard asks for more than the rms;
    over time ``running_rms``, as in ``running_rms``. Units are in the attributes. Crest factor and ratios
    are NaN where the rms is ``UNFELT``.
    MSDV is a dose of motion sickness only where the weighting is Wf. Padding with NaN
    at the end is no part of a signal.

    Source: ISO 2631-1:1997 eq. 1 to 6, 6.2 and 6.3, 9.2.1 (MSDV).
    """
    rate = signals.check_rate(rate)
    values, restore = signals.time_last(weighted, rate, "m/s2")
    table, lengths = signals.rows(values)
    running = np.square(table, dtype=np.float64)
    running_root(running, lengths, rate, time_constant, method)
    second, fourth, peak, mtvv = _sums(table, lengths, running)
    duration = np.where(lengths > 0, lengths / rate, np.nan)
    rms = np.sqrt(second / rate / duration)
    found = {
        "rms": rms,
        "mtvv": mtvv,
        "vdv": np.where(lengths > 0, (fourth / rate) ** 0.25, np.nan),
        "evdv": 1.4 * rms * duration**0.25,
        "msdv": rms * duration**0.5,
        "duration": duration,
    }
    felt = np.where(rms >= UNFELT, rms, np.nan)
    found["crest_factor"] = peak / felt
    found["mtvv_ratio"] = found["mtvv"] / felt
    found["vdv_ratio"] = found["vdv"] / (felt * duration**0.25)
    running = restore(running.reshape(values.shape))
    if not isinstance(running, xr.DataArray):
        dims = (*(f"dim_{axis}" for axis in range(values.ndim - 1)), "time")
        running = xr.DataArray(running, dims=dims, attrs={"units": "m/s2"})
    time = "time" if "time" in running.dims else running.dims[-1]
    running.attrs["long_name"] = f"running rms, {method} over {time_constant:g} s"
    frame = running.isel({time: 0}, drop=True)
    answer = xr.Dataset({"running_rms": running})
    for name, (unit, meaning) in UNITS.items():
        answer[name] = frame.copy(data=found[name].reshape(frame.shape))
        answer[name].attrs = {"units": unit, "long_name": meaning}
    asks_for_more = (answer.crest_factor > CREST_LIMIT) | (answer.mtvv_ratio > MTVV_LIMIT) | (answer.vdv_ratio > VDV_LIMIT)
    answer["rms_suffices"] = answer.rms.notnull() & ~asks_for_more
    answer.rms_suffices.attrs["long_name"] = "whether the basic evaluation by rms is enough (ISO 2631-1, 6.2 and 6.3)"
    return answer


def advice(found: xr.Dataset) -> list[str]:
    """What the standard says of the metrics of one signal, a sentence each; empty where the rms is enough."""
    answer = []
    crest, mtvv, vdv = (float(found[name]) for name in ("crest_factor", "mtvv_ratio", "vdv_ratio"))
    if crest > CREST_LIMIT:
        answer.append(f"crest factor {crest:.1f} > {CREST_LIMIT:g}: the rms may underrate it; report MTVV or VDV too (6.2.2)")
    if mtvv > MTVV_LIMIT:
        answer.append(f"MTVV / a_w = {mtvv:.2f} > {MTVV_LIMIT:g}: single shocks matter; report MTVV too (6.3.3)")
    if vdv > VDV_LIMIT:
        answer.append(f"VDV / (a_w T^1/4) = {vdv:.2f} > {VDV_LIMIT:g}: shocks matter; report VDV too (6.3.3)")
    return answer


@njit(cache=True)
def _sums(table, lengths, running):
    count = table.shape[0]
    second, fourth, peak, highest = np.zeros(count), np.zeros(count), np.zeros(count), np.full(count, np.nan)
    for row in range(count):
        for sample in range(lengths[row]):
            square = float(table[row, sample]) ** 2
            second[row] += square
            fourth[row] += square * square
            peak[row] = max(peak[row], square)
            if not running[row, sample] <= highest[row]:
                highest[row] = running[row, sample]
    return second, fourth, np.sqrt(peak), highest
