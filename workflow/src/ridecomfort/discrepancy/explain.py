"""Explainable error: what of the error lies above the floor that repeats of a drive show, and how much of it is left."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .experiment import Record
from .floor import deviations

SAME_SPEED = 0.05
"""Relative difference of mean speeds within which drives repeat one another."""


def explain(comparison: xr.Dataset) -> xr.Dataset:
    """A comparison (``compare.compare``) with its floor and its explainable error.

    Added, in the unit of the signal: ``floor_rmse(drive, signal)``, what no model of this road and car could explain, from
    the differences of repeats at equal place in the best state; ``explainable_rmse(state, drive, signal)``, the root of mean
    square less floor; and ``explained_share(state, drive, signal)``, the share of the first
    state's explainable mean square that is gone.
    Without repeats the floor is taken as nil; attribute ``floor`` says which.
    """
    states, signals = comparison.sizes["state"], comparison.sizes["signal"]
    floors = np.full((states, comparison.sizes["drive"], signals), np.nan)
    for group in _repeats(comparison):
        for state in range(states):
            records, residuals = [], []
            for drive in group:
                row = comparison.isel(state=state, drive=drive)
                kept = np.isfinite(row["residual"].values).all(axis=0)
                place = row["s"].values[kept]
                records.append(Record(str(drive), "fit", "", "", 1.0, (0.0, 1.0), place, 1.0))
                part = row["residual"].values[:, kept]
                residuals.append(part - part.mean(axis=1, keepdims=True))
            parts = deviations(records, residuals)
            floors[state, group] = np.mean([np.mean(part**2, axis=1) for part in parts], axis=0)
    repeated = np.isfinite(floors).any()
    ground = np.nanmin(floors, axis=0) if repeated else np.zeros(floors.shape[1:])
    # A drive of its own speed has no repeats: its floor is taken from those that have.
    alone = ~np.isfinite(ground).all(axis=1)
    ground[alone] = ground[~alone].mean(axis=0) if (~alone).any() else 0.0
    square = comparison["residual"].var("time").transpose("state", "drive", "signal").values
    ground = np.minimum(ground, square.min(axis=0))
    above = square - ground
    share = 1.0 - above / np.where(above[:1] > 0, above[:1], np.nan)
    return comparison.assign(
        floor_rmse=(("drive", "signal"), np.sqrt(ground)),
        explainable_rmse=(("state", "drive", "signal"), np.sqrt(above)),
        explained_share=(("state", "drive", "signal"), share, {"units": "1"}),
    ).assign_attrs(floor="from repeats" if repeated else "taken as nil: no drive was repeated")


def _repeats(comparison: xr.Dataset) -> list[list[int]]:
    """Numbers of the drives that repeat one another, at least two in each list."""
    groups: list[tuple[float, list[int]]] = []
    for number, speed in enumerate(comparison["v_x"].mean("time").values):
        for known, own in groups:
            if abs(known - speed) < SAME_SPEED * known:
                own.append(number)
                break
        else:
            groups.append((float(speed), [number]))
    return [own for _, own in groups if len(own) > 1]
