"""What a road is like, and what repairing and smoothing it changes: spectra, IRI and the acceleration of a drive."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from scipy import signal

from .. import simulate
from ..errors import InputError
from ..road import clean, defects, roughness, smoothing, wheeltracks
from ..road.prepare import Prepared
from ..vehicle import driver
from ..vehicle.parameters import Vehicle
from ..vocabulary import describe
from . import iri

STAGES = ("measured", "repaired", "smoothed")
"""Of a road on its way into the study; whether the study smooths it or not, all three are looked at."""

SEGMENT = 1024
"""Records that spectra of the acceleration are averaged over: 10 s, 0.1 Hz."""


def inspect(
    prepared: Prepared,
    vehicle: Vehicle,
    *,
    speed: Mapping[str, float],
    step: float,
    rate: float,
    tracks: Sequence[float] = wheeltracks.WHEEL_TRACKS,
    lateral: float = 0.0,
) -> xr.Dataset:
    """Roughness, IRI and defects of a road (`prepare.prepare` with smoothing), and a drive with and without smoothing.

    Over ``stage`` (`STAGES`) and the wheel tracks ``track`` (``tracks`` in m to the left of the reference line): what `roughness.analyse`
    gives, and ``iri_track`` in m/km of the whole length; NaN where the road is too
    short, or has holes or none of it in a track. Over ``stage``: root mean square ``a_z_rms`` and
    largest ``a_z_peak`` in m/s2, and ``acceleration_psd`` (stage, frequency) of the
    vertical acceleration of one drive of the vehicle at the site's speed profile, ``lateral``
    m to the left of the reference line, NaN as measured; that profile as ``speed`` (u) in m/s. ``trial_cutoff`` (direction, trial): the cut-offs tried in m, with the error ``held_out_error``
    (direction, trial) of each against held-out points, and ``cutoff`` (direction) in m
    with its ``penalty`` in m4. Over ``defect``: `defects.find`. Attributes give
    counts and shares of treated cells, and the largest change.
    """
    stages = dict(zip(STAGES, (prepared.measured, prepared.repaired, prepared.smoothed)))
    found = xr.concat([_roughness(road, tracks) for road in stages.values()], xr.Variable("stage", list(stages)))
    found = xr.merge([found, _drives(stages, vehicle, speed, lateral, step, rate), _cutoffs(prepared.cutoffs)])
    found = found.merge(defects.find(prepared.repaired))
    found.attrs = {"standard": "ISO 8608:2016", "segment": roughness.SEGMENT, **_treated(prepared)}
    return describe(found)


def _roughness(road: xr.Dataset, tracks: Sequence[float]) -> xr.Dataset:
    """Spectra, class and IRI of the wheel tracks; NaN and no class where they cannot be known."""
    try:
        found = roughness.analyse(road, tracks=tracks).rename(v="track")
    except ValueError:
        found = xr.Dataset(
            {
                **{name: ("track", np.full(len(tracks), np.nan)) for name in ("unevenness", "waviness")},
                "class": ("track", [""] * len(tracks)),
            },
            coords={"track": np.asarray(tracks, dtype=float)},
        )
    spacing = float(road.u[-1] - road.u[0]) / (road.sizes["u"] - 1)
    try:
        values = iri.iri(wheeltracks.tracks(road, tracks), spacing)
    except InputError:
        values = np.full(len(tracks), np.nan)
    found["iri_track"] = ("track", values)
    found.attrs = {}
    return found


def _drives(stages: Mapping[str, xr.Dataset], vehicle, speed, lateral, step, rate) -> xr.Dataset:
    """One drive on the repaired and one on the smoothed road, at the same speed profile."""
    profile = driver.speed_profile(
        stages["repaired"],
        limit=speed["limit_km_h"] / 3.6,
        **{name: speed[name] for name in ("lateral_acceleration", "acceleration", "deceleration")},
    )
    driven = {
        stage: simulate.run(stages[stage], vehicle, speed=profile, lateral=lateral, step=step, rate=rate)["a_z"].values
        for stage in ("repaired", "smoothed")
    }
    length = min(SEGMENT, *(a_z.size for a_z in driven.values()))
    rows = {}
    for stage, a_z in driven.items():
        frequency, density = signal.welch(a_z, rate, nperseg=length)
        rows[stage] = (np.sqrt(np.mean(a_z**2)), np.abs(a_z).max(), density)
    unknown = (np.nan, np.nan, np.full(frequency.size, np.nan))
    rms, peak, density = zip(*(rows.get(stage, unknown) for stage in STAGES))
    return xr.Dataset(
        {
            "a_z_rms": ("stage", np.array(rms)),
            "a_z_peak": ("stage", np.array(peak)),
            "acceleration_psd": (("stage", "frequency"), np.array(density)),
            "speed": profile,
        },
        coords={"stage": list(STAGES), "frequency": frequency},
    )


def _cutoffs(choices: Mapping[str, smoothing.Choice]) -> xr.Dataset:
    directions = list(choices)
    return xr.Dataset(
        {
            "trial_cutoff": (("direction", "trial"), np.array([choices[name].wavelengths for name in directions])),
            "held_out_error": (("direction", "trial"), np.array([choices[name].errors for name in directions])),
            "cutoff": ("direction", np.array([choices[name].wavelength for name in directions])),
            "penalty": ("direction", np.array([choices[name].penalty for name in directions])),
        },
        coords={"direction": directions},
    )


def _treated(prepared: Prepared) -> dict:
    """Counts of cells by what was done to them, and the largest change of a repaired one with its place."""
    treated = prepared.repaired.treated.values
    inside = np.isfinite(prepared.repaired.elevation.values)
    counts = {name: int((treated == flag).sum()) for name, flag in
              (("repaired", clean.OUTLIER), ("filled", clean.FILLED), ("kept", clean.KEPT))}  # fmt: skip
    change = np.abs(prepared.repaired.elevation.values - prepared.measured.elevation.values)
    change = np.where(treated == clean.OUTLIER, np.nan_to_num(change), 0.0)
    i, j = np.unravel_index(change.argmax(), change.shape)
    place = {"u": prepared.repaired.u.values[i], "v": prepared.repaired.v.values[j]} if change.max() > 0 else {}
    return {
        "cells": int(inside.sum()),
        **{f"cells_{name}": count for name, count in counts.items()},
        "share_changed": (counts["repaired"] + counts["filled"]) / max(int(inside.sum()), 1),
        "largest_change": float(change.max()),
        **{f"largest_change_{axis}": float(value) for axis, value in place.items()},
    }
