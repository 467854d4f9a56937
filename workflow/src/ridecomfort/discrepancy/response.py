"""How measured and simulated signals answer to the road and to one another, over frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
import xarray as xr
from scipy.signal import csd, welch

SEGMENT = 4.0
"""s of a segment of the spectra."""

INPUT = {
    "a_x": "road_heave", "a_y": "road_tilt", "a_z": "road_heave",
    "roll_rate": "road_tilt", "pitch_rate": "road_heave", "yaw_rate": "road_tilt",
}  # fmt: skip
"""The movement of the road that moves each signal most: up and down, or left against right."""


class Driven(Protocol):
    """A drive with ``rate`` in Hz, ``measured``, ``simulated``, ``residual`` (signal, sample) and ``series`` by name."""

    rate: float
    measured: np.ndarray
    simulated: np.ndarray
    residual: np.ndarray
    series: Mapping[str, np.ndarray]


def responses(drives: Sequence[Driven], signals: Sequence[str]) -> xr.Dataset:
    """Spectra and transfer functions, cross-spectra averaged over segments and drives (H1 estimates).

    Over ``signal`` and ``frequency`` (Hz): ``measured_density``, ``simulated_density`` and ``error_density`` (unit of the
    signal squared per Hz), ``model_gain`` and ``model_phase`` (rad) of measured over simulated and
    ``model_coherence`` of both; where the road under the wheels is known, over ``source`` (measured,
    simulated), ``road_gain`` (unit of the signal per m/s that the road moves under the front wheels, see INPUT)
    and ``road_coherence``.
    """
    rate = drives[0].rate
    length = min([int(SEGMENT * rate), *(drive.measured.shape[1] for drive in drives)])

    def cross(pairs) -> np.ndarray:
        """One-sided cross-spectral density, mean over pairs of series with a weight by their length."""
        weights = [first.shape[-1] for first, _ in pairs]
        return np.average([csd(first, second, rate, nperseg=length)[1] for first, second in pairs], axis=0, weights=weights)

    frequency = welch(drives[0].measured, rate, nperseg=length)[0]
    over = ("signal", "frequency")
    density = {
        key: cross([(getattr(drive, attribute),) * 2 for drive in drives]).real
        for key, attribute in (("measured", "measured"), ("simulated", "simulated"), ("error", "residual"))
    }
    between = cross([(drive.simulated, drive.measured) for drive in drives])
    ratio = between / _positive(density["simulated"])
    data = {
        **{f"{key}_density": (over, values) for key, values in density.items()},
        "model_gain": (over, np.abs(ratio), {"units": "1"}),
        "model_phase": (over, np.angle(ratio), {"units": "rad"}),
        "model_coherence": (over, np.abs(between) ** 2 / _positive(density["simulated"] * density["measured"]), {"units": "1"}),
    }
    if all(name in drive.series for drive in drives for name in ("road_heave", "road_tilt")):
        gains, coherent = [], []
        for source in ("measured", "simulated"):
            gain, share = np.full((2, len(signals), frequency.size), np.nan)
            for i, signal in enumerate(signals):
                moves = [np.gradient(drive.series[INPUT[str(signal)]], 1.0 / rate) for drive in drives]
                answers = [getattr(drive, source)[i] for drive in drives]
                own = cross(list(zip(moves, moves))).real
                both = cross(list(zip(moves, answers)))
                gain[i] = np.abs(both) / _positive(own)
                share[i] = np.abs(both) ** 2 / _positive(own * cross(list(zip(answers, answers))).real)
            gains.append(gain)
            coherent.append(share)
        data["road_gain"] = (("source", *over), np.stack(gains))
        data["road_coherence"] = (("source", *over), np.stack(coherent), {"units": "1"})
    return xr.Dataset(data, {"signal": list(signals), "source": ["measured", "simulated"], "frequency": frequency})


def _positive(values: np.ndarray) -> np.ndarray:
    return np.where(values > 0, values, np.nan)
