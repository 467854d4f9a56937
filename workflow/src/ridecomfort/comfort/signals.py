"""What every comfort function does with a signal first: units, axis, padding."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr
from numba import njit

from ..drive import units
from ..errors import InputError


def check_units(signal, unit: str) -> None:
    """Raise InputError when a DataArray says that it is in another unit than ``unit``.

    A plain array, or a DataArray that names no unit, is taken to be in ``unit``.
    """
    if not isinstance(signal, xr.DataArray) or "units" not in signal.attrs:
        return
    found = str(signal.attrs["units"]).strip()
    if units.spelled(found) != unit:
        raise InputError(f"is in {found!r}; expected {unit}", place=str(signal.name or "signal"))


def check_rate(rate) -> float:
    """The sampling rate in Hz as a float; InputError when it is not positive and finite."""
    try:
        value = float(rate)
    except (TypeError, ValueError):
        value = np.nan
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{rate!r} is not a sampling rate; expected a positive number of Hz", place="rate")
    return value


def time_last(signal, rate: float, unit: str) -> tuple[np.ndarray, Callable]:
    """The signal as a floating array whose last axis is time, and what turns a result of that shape back.

    float32 stays float32, everything else becomes float64. A DataArray is
    checked for its unit and, where it has a coordinate ``time``, for its rate;
    its axis of time is the dimension ``time`` or, without one, the last.
    """
    check_units(signal, unit)
    if not isinstance(signal, xr.DataArray):
        values = np.asarray(signal)
        return _floating(_filled(values)), lambda result, **_: result
    dim = "time" if "time" in signal.dims else signal.dims[-1]
    ordered = signal.transpose(..., dim)
    if dim in signal.coords and signal.sizes[dim] > 1 and signal[dim].dtype.kind == "f":
        found = (signal.sizes[dim] - 1) / float(signal[dim][-1] - signal[dim][0])
        if abs(found / rate - 1.0) > 1e-3:
            raise InputError(
                f"time steps at {found:.6g} Hz, but rate is {rate:.6g} Hz", place=str(signal.name or "signal")
            )

    def restore(result, name=signal.name, unit=unit, **attributes):
        answer = ordered.copy(data=result).transpose(*signal.dims).rename(name)
        answer.attrs = {"units": unit, **attributes}
        return answer

    return _floating(_filled(ordered.values)), restore


def _filled(values: np.ndarray) -> np.ndarray:
    if values.ndim == 0 or values.shape[-1] == 0:
        raise InputError("holds no samples; expected a signal over time", place="signal")
    return values


def _floating(values: np.ndarray) -> np.ndarray:
    return values if values.dtype in (np.float32, np.float64) else values.astype(np.float64)


def rows(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The signals as rows of a contiguous 2-D array, and how many samples of each row hold data.

    Runs of different length are padded with NaN at their end. Raises InputError
    for any other value that is not finite: a gap cannot be weighted.
    """
    table = np.ascontiguousarray(values.reshape(-1, values.shape[-1]))
    lengths = data_lengths(table)
    bad = np.flatnonzero(lengths < 0)
    if bad.size:
        row, sample = bad[0], -lengths[bad[0]] - 1
        where = f"sample {sample}" if len(table) == 1 else f"signal {row}, sample {sample}"
        raise InputError(
            f"value {table[row, sample]} is not finite; only padding with NaN at the end is allowed", place=where
        )
    return table, lengths


@njit(cache=True)
def data_lengths(table):
    """Samples before the padding with NaN; ``-(index + 1)`` of the first bad sample where there is one."""
    count, samples = table.shape
    lengths = np.empty(count, np.int64)
    for row in range(count):
        length = samples
        while length > 0 and np.isnan(table[row, length - 1]):
            length -= 1
        lengths[row] = length
        for sample in range(length):
            if not np.isfinite(table[row, sample]):
                lengths[row] = -(sample + 1)
                break
    return lengths
