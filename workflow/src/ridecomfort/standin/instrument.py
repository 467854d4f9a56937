"""The instrument of the stand-in drives: an inertial unit on the roof beside satellite positioning."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline
from scipy.signal import fftconvolve, firwin, lfilter

from ..drive.record import specific_force
from ..vocabulary import SIGNALS, STANDARD_GRAVITY
from .texture import smooth_noise

STEPS_PER_SAMPLE = 4
"""Steps of the simulation from one sample of the truth to the next."""


def record(rng: np.random.Generator, drive: xr.Dataset, rate: float, settings: Mapping, mounting: np.ndarray):
    """What the instrument writes of a finely sampled drive, in SI units, and the errors that were drawn.

    ``settings`` is the block ``measurement.instrument`` of ``config/standin.yaml``, ``mounting`` the
    small rotation (rad, 3) of the unit against the body. Accelerations are specific force; inertial
    signals pass an anti-alias filter and stand ``clock_offset`` seconds later in the record than
    distance and speed.
    """
    fine = drive["time"].values
    motion = np.stack([drive[name].values for name in SIGNALS])
    motion[:3] = specific_force(motion[:3], drive["roll"].values, drive["pitch"].values)
    motion = low_pass(motion, 1.0 / (fine[1] - fine[0]), rate)
    motion[:3] -= np.cross(mounting[:, None], motion[:3], axis=0)
    motion[3:] -= np.cross(mounting[:, None], motion[3:], axis=0)

    offset = float(settings["clock_offset"] * rng.standard_normal())
    margin = np.ceil(abs(offset) * rate) / rate
    time = np.arange(margin, fine[-1] - margin, 1.0 / rate)
    inertial = CubicSpline(fine, motion, axis=1)(time - offset)
    drawn = {"clock_offset": offset}
    for first, kind, unit in ((0, "accelerometer", STANDARD_GRAVITY * 1e-6), (3, "gyroscope", np.radians(1.0))):
        sensor = settings[kind]
        bias = sensor["bias"] * unit * rng.standard_normal(3)
        drift = np.stack([wander(rng, len(time), rate, sensor["time"]) for _ in range(3)])
        white = sensor["density"] * unit * np.sqrt(0.5 * rate) * rng.standard_normal((3, len(time)))
        inertial[first : first + 3] += bias[:, None] + sensor["instability"] * unit * drift + white
        drawn[f"{kind}_bias"] = bias.tolist()

    position, speed = settings["distance"], settings["speed"]
    scale = 1.0 + speed["scale"] * rng.standard_normal()
    quantities = {
        "time": time - time[0],
        "s": np.interp(time, fine, drive["s"].values)
        + position["drift"] * smooth_noise(rng, len(time), 1.0 / rate, position["time"]),
        "v_x": scale * np.interp(time, fine, drive["v_x"].values) + speed["noise"] * rng.standard_normal(len(time)),
        **dict(zip(SIGNALS, inertial, strict=True)),
    }
    return quantities, {**drawn, "speed_scale": float(scale), "time_of_first_row": float(time[0])}


def low_pass(values: np.ndarray, fine_rate: float, rate: float) -> np.ndarray:
    """Signals (channel, time) without what a record at ``rate`` cannot hold; no delay, ends held.

    Gain above 0.94 up to 0.4 of the rate, one half at half of it, below 0.06 from 0.6 on, as in ``simulate.run``.
    """
    half = round(5.0 * fine_rate / rate)
    taps = firwin(2 * half + 1, rate / fine_rate, window=("kaiser", 4.0))
    padded = np.pad(values, ((0, 0), (half, half)), mode="edge")
    return fftconvolve(padded, taps[None] / taps.sum(), mode="valid", axes=1)


def wander(rng: np.random.Generator, count: int, rate: float, time: float) -> np.ndarray:
    """A first-order Gauss-Markov process of unit variance and correlation time ``time`` s (IEEE 952-2020, annex B)."""
    keep = np.exp(-1.0 / (rate * time))
    noise = rng.standard_normal(count) * np.sqrt(1.0 - keep**2)
    noise[0] = rng.standard_normal()
    return lfilter([1.0], [1.0, -keep], noise)
