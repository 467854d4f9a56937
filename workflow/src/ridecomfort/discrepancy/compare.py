"""Where model and measurement differ: residuals and errors of every signal of every drive.

NRMSE is RMSE over the range (max - min) of the measured signal; the paper does not
state its normalisation, and this is the reading that fits its figures (docs/method.md).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..drive import pedals
from ..drive.record import completed, require_one_rate
from ..drive.replay import CLOCK_LEFT, MARGIN, Replay, replay
from ..drive.sampling import rate_of
from ..vehicle.driver import SPEED_PREVIEW_TIME
from ..vocabulary import SIGNALS
from .explain import SENSOR, explain
from .wheels import wheels

CLOCK_STEPS = 2
"""Gauss-Newton steps; the second changes a clock within CLOCK_LEFT by less than 0.01 ms."""

RUN_OUT = 1.0
"""s at the end of a drive that are not compared: filters end there without knowing what comes, and a driver who is brought to a speed that changes, by
what is heard of his foot, rings there (by 0.1 to 0.4 m/s2 of a_x, where it is within 0.03 before)."""

DRIVEN = ("v_x", "s", "e")
BELOW = ("suspension_velocity", "tyre_velocity", "road_heave", "road_tilt")
"""Series of a comparison over drive and time beside the signals: how the drive went, and what went on below the body."""


def rmse(residual: np.ndarray) -> np.ndarray:
    """Root mean square over the last axis, in the unit of the residual; NaN samples do not count."""
    return np.sqrt(np.nanmean(np.square(residual), axis=-1))


def nrmse(residual: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """RMSE over the range of the measured signal, along the last axis; NaN residuals do not count in either. NaN of a constant signal."""
    measured = np.where(np.isfinite(residual), measured, np.nan)
    span = np.nanmax(measured, axis=-1) - np.nanmin(measured, axis=-1)
    return rmse(residual) / np.where(span > 0, span, np.nan)


def compare(
    drives: xr.Dataset | Sequence[xr.Dataset],
    road,
    states: Mapping[str, tuple],
    *,
    simulate: Callable[..., xr.Dataset],
    options: Mapping | None = None,
    noise_density: Mapping[str, Mapping[str, float]] | None = None,
    elsewhere: tuple[str, xr.Dataset] | None = None,
    each: Callable = map,
) -> xr.Dataset:
    """The model driven over every measured path, state by state, beside what was measured there.

    ``drives`` are aligned, fitted and checked ones alike; ``states`` maps a name ("reference",
    "calibrated") to (vehicle, effects). Each state is compared at its own best clock within
    what alignment may be off by (CLOCK_LEFT), kept as ``clock_correction``: a state that turns phases
    right would else be judged with the clock that suits the wrong one. What the accelerometer tells of a driver's foot, heard with the last
    state (``pedals.listening``), every state drives; attribute ``driver`` says so.

    Returns over drive, time, signal, state: ``measured`` and ``simulated`` (unit by signal in
    ``signal_unit``), ``residual`` = simulated - measured (NaN in the run-in and in the last RUN_OUT), where gravity was
    recorded with the attitude of the simulation in both, ``rmse``, ``nrmse``, ``v_x``, ``s`` (by ``replay.fused_place``), ``e``, ``role``, ``cut_off``,
    ``sensor_x/y/z``, of the last state ``suspension_velocity``, ``tyre_velocity``, ``road_heave`` and ``road_tilt`` (``wheels.wheels``), and
    the floor and the explainable error (``explain.explain``, which ``noise_density`` and ``elsewhere`` are for). ``each`` maps a function over drives
    (``map``, or that of threads).
    """
    drives = completed(drives)
    require_one_rate(drives)
    length = max(drive.sizes["time"] for drive in drives)
    shape = len(drives), len(SIGNALS), length
    measured = np.full(shape, np.nan)
    simulated = np.full((len(states), *shape), np.nan)
    residual = np.full((len(states), *shape), np.nan)
    clock, by_foot = np.zeros((len(states), len(drives))), [None] * len(drives)
    series = {name: np.full((len(drives), length), np.nan) for name in (*DRIVEN, *BELOW)}

    def fill(i: int) -> None:
        drive = drives[i]
        count = drive.sizes["time"]
        ahead = MARGIN + SPEED_PREVIEW_TIME * float(drive["v_x"][-1])  # as far as the driver looks
        again = pedals.listening(replay(drive, road, simulate, margin=ahead, options=options), *list(states.values())[-1]).replay
        again = _without_end(again)
        measured[i, :, :count], by_foot[i] = again.measured(), again.by_foot
        for name, values in zip(DRIVEN, (drive["v_x"].values, again.place, drive["e"].values)):  # a recorded distance may stand and leap
            series[name][i, :count] = values
        for j, (vehicle, effects) in enumerate(states.values()):
            clock[j, i], difference = _at_best_clock(again, vehicle, effects)
            residual[j, i, :, :count] = difference
            simulated[j, i, :, :count] = again.measured() + difference
        for name, values in zip(BELOW, _below(again, vehicle, simulated[-1, i, :, :count])):
            series[name][i, :count] = values

    for _ in each(fill, range(len(drives))):
        pass
    longest = max(drives, key=lambda drive: drive.sizes["time"])
    result = xr.Dataset(
        {
            "measured": (("drive", "signal", "time"), measured),
            "simulated": (("state", "drive", "signal", "time"), simulated),
            "residual": (("state", "drive", "signal", "time"), residual),
            "rmse": (("state", "drive", "signal"), rmse(residual)),
            "nrmse": (("state", "drive", "signal"), nrmse(residual, measured), {"units": "1"}),
            "clock_correction": (("state", "drive"), clock, {"units": "s"}),
            "role": ("drive", np.array([drive.attrs.get("role", "fit") for drive in drives])),
            "cut_off": ("drive", np.array([float(drive.attrs["cut_off"]) for drive in drives]), {"units": "Hz"}),
            **{name: ("drive", [float(drive.attrs[name]) for drive in drives], {"units": "m"}) for name in SENSOR},
            "signal_unit": ("signal", np.array(["m/s2"] * 3 + ["rad/s"] * 3)),
            **{name: (("drive", "time"), values) for name, values in series.items()},
        },
        {
            "state": list(states),
            "drive": [drive.attrs["name"] for drive in drives],
            "signal": list(SIGNALS),
            "time": longest["time"].values,
        },
    )
    result = result.assign_attrs(normalisation="RMSE / (max - min) of the measured signal", driver=pedals.words(by_foot))
    return explain(result, noise_density, elsewhere)


def _without_end(again: Replay) -> Replay:
    """The same with its last RUN_OUT not compared, or, of a drive that has no more than that, half of what is."""
    time = again.time[again.compared]
    return replace(again, compared=again.compared & (again.time <= max(again.time[-1] - RUN_OUT, 0.5 * (time[0] + time[-1]))))


def _below(again: Replay, vehicle, simulated: np.ndarray) -> np.ndarray:
    """The series BELOW of a drive, (4, time), from its simulated signals (6, time); NaN in the run-in."""
    kept = again.compared
    drive = again.drive
    rate = rate_of(again.time)
    aside = drive["e"].values
    if not np.isfinite(aside).all():
        aside = np.full(len(again.time), np.nan_to_num(float(drive.attrs.get("lateral_position", 0.0))))
    signal = {name: values[kept] for name, values in zip(SIGNALS, simulated)}
    found = wheels(
        getattr(again.road, "road", again.road), vehicle, again.place[kept], aside[kept], rate,
        signal["a_z"], signal["roll_rate"], signal["pitch_rate"], again.demand["sensor"],
    )  # fmt: skip
    series = np.full((len(BELOW), len(kept)), np.nan)
    series[:, kept] = found.suspension_velocity, found.tyre_velocity, found.heave(), found.tilt()
    return series


def _at_best_clock(again: Replay, vehicle, effects) -> tuple[float, np.ndarray]:
    """Clock offset (s) that is left in this state, by Gauss-Newton, and the residual with it taken out."""
    again = again.tuned(vehicle, effects)
    run = again.run(vehicle, effects)
    kept = again.compared
    scale = np.ptp(again.measured()[:, kept], axis=1, keepdims=True)
    scale = np.where(scale > 0, scale, np.inf)
    clock = 0.0
    for _ in range(CLOCK_STEPS):
        simulated = again.sample(run, clock)
        slope = simulated.slopes[:, kept] / scale
        clock += np.sum(slope * again.residual(simulated)[:, kept] / scale) / np.sum(slope**2)
        clock = np.clip(clock, -CLOCK_LEFT, CLOCK_LEFT)
    return float(clock), again.residual(again.sample(run, clock))
