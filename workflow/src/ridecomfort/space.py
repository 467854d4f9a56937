"""From time to space: records of each drive at equal steps along the road (sec:th_methdology)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numba import njit

from .drive import sampling
from .errors import InputError
from .vocabulary import SIGNALS


def places(start: float, end: float, *, spacing: float, run_in: float, run_out: float, file=None) -> np.ndarray:
    """Distances in m along the road at which drives are evaluated, ``spacing`` apart.

    They cover the road from ``run_in`` behind its start to ``run_out`` before its end.
    Raises InputError, naming the ``file`` of the road, where nothing is left.
    """
    first, last = start + run_in, end - run_out
    count = int(np.floor((last - first) / spacing + 1e-9)) + 1
    if count < 2:
        raise InputError(
            f"a road of {end - start:g} m, expected more than run_in {run_in:g} m and run_out {run_out:g} m together "
            "(`space` in config/study.yaml)",
            file=file,
            place="u",
        )
    return first + spacing * np.arange(count)


def along(drives: xr.Dataset, s: np.ndarray, variables: Sequence[str]) -> xr.Dataset:
    """The variables of drives over ``time`` at the distances ``s`` [m].

    ``drives`` has dims run and time (uniform, s), padded with NaN at the end of shorter runs, and holds
    the distance ``s``. Each record stands where the body was at that moment. Distances
    must not fall; a place at which the body stands is that of the first record there.
    Signals of an inertial instrument hold all frequencies up to half the rate and are read between records by a windowed sinc: straight
    lines would lower their peaks, at 20 Hz by up to 19 %. What else there is (speed, running means) is interpolated linearly.

    Returns float32 variables with dims run and s. Raises InputError, naming the run, where
    a drive does not cover ``s``, runs backwards or holds a gap.
    """
    s = np.asarray(s, dtype=np.float64)
    distance = drives["s"].transpose("run", "time").values
    lengths = _lengths(distance)
    require_cover(drives, s)
    index = _indices(distance, lengths, s)
    interval = 1.0 / sampling.rate_of(drives["time"].values)
    result = xr.Dataset(coords={"run": drives["run"].values, "s": s})
    table = {name: drives[name].transpose("run", "time").values for name in variables}
    for name, values in table.items():
        _check_values(drives["run"].values, values, lengths, name)
        result[name] = (("run", "s"), np.empty(index.shape, dtype=np.float32))
    waves = [name for name in variables if name in SIGNALS]
    for run, (length, at) in enumerate(zip(lengths, index)):
        own = {name: values[run, :length].astype(np.float64) for name, values in table.items()}
        if waves:
            read = sampling.resampled(np.stack([own[name] for name in waves]), interval, at, 0.5 / interval)
            own.update(zip(waves, read))
        for name, values in own.items():
            result[name].values[run] = values if name in waves else np.interp(at, np.arange(length), values)
    result.attrs = {"evaluated": f"{s[0]:g} to {s[-1]:g} m in steps of {s[1] - s[0]:g} m"}
    return result


def require_cover(drives: xr.Dataset, s: np.ndarray) -> None:
    """Raise InputError, naming the run, where one of the drives (as for ``along``) does not cover ``s`` (m), runs backwards or holds a gap."""
    distance = drives["s"].transpose("run", "time").values
    for run, row, length in zip(drives["run"].values, distance, _lengths(distance)):
        _check(run, row[:length], s)


def _lengths(distance: np.ndarray) -> np.ndarray:
    """Records of each run before its padding."""
    known = np.isfinite(distance)
    return np.where(known.any(axis=1), distance.shape[1] - np.argmax(known[:, ::-1], axis=1), 0)


def _check_values(runs: np.ndarray, values: np.ndarray, lengths: np.ndarray, name: str) -> None:
    for run, row, length in zip(runs, values, lengths):
        if not np.isfinite(row[:length]).all():
            raise InputError(f"{name} has a gap", place=f"run {run}")


def _check(run, distance: np.ndarray, s: np.ndarray) -> None:
    place = f"run {run}"
    if not len(distance):
        raise InputError("holds no records", place=place)
    if not np.isfinite(distance).all():
        raise InputError("distance s has a gap", place=place)
    step = np.diff(distance)
    if (step < 0).any():
        where = distance[int(np.argmax(step < 0))]
        raise InputError(f"distance s falls at {where:.1f} m, expected a drive that never runs backwards", place=place)
    if distance[0] > s[0] or distance[-1] < s[-1]:
        raise InputError(
            f"covers {distance[0]:.1f} to {distance[-1]:.1f} m, expected {s[0]:.1f} to {s[-1]:.1f} m; "
            "the vehicle stopped or left the road",
            place=place,
        )


@njit(cache=True)
def _indices(distance, lengths, s):
    """Fractional index of the record at every place, (run, place)."""
    result = np.empty((len(distance), len(s)))
    for run in range(len(distance)):
        right = 1
        for place in range(len(s)):
            while right < lengths[run] - 1 and distance[run, right] < s[place]:
                right += 1
            before = float(distance[run, right - 1])
            step = float(distance[run, right]) - before
            share = (s[place] - before) / step if step > 0.0 else (1.0 if s[place] > before else 0.0)
            result[run, place] = right - 1 + share
    return result
