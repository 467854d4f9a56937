"""Small made-up results in the schema of the study's files, for tests of the report."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort.comfort import assessment
from ridecomfort.comfort.limits import JERK
from ridecomfort.report import published
from ridecomfort.report.study import Site, Study
from ridecomfort.road import clean, defects, roughness, smoothing
from ridecomfort.sample import latin_hypercube
from ridecomfort.vocabulary import CALIBRATED, SIGNALS

STYLES = ("PT", "ND", "AG")
AXES = ("a_x", "a_y", "a_z")
BANDS = ("NU", "LU", "FU", "U", "VU", "EU")
QUALITIES = ("VG", "G", "F", "M", "P")
LENGTH = 600.0
SPACING = 0.25


def study(names=("ts1", "ts2", "ts3"), *, drives=True, standin=True, runs=200) -> Study:
    """A study of the named sites; without ``drives`` nothing is compared or calibrated."""
    rng = np.random.default_rng(7)
    calibrated_on = names[0] if drives else None
    sites = tuple(site(name, rng, drives, standin, calibrated_on, runs) for name in names)
    calibrations = {names[0]: calibration()} if drives else {}
    return Study(
        sites,
        calibrations,
        {names[0]: f"{names[0]}/base/calibration.nc"} if drives else {},
        assessment=assessed(sites),
        assessment_file="comfort/base/agreement.nc",
        settings=settings(sites),
        software={"ridecomfort": "0.1.0", "numpy": np.__version__},
    )


def assessed(sites) -> xr.Dataset:
    """What the step agreement makes of the sites."""
    results = {
        each.name: assessment.SiteResults(each.thresholds, each.iso2631, each.iri, each.samples) for each in sites
    }
    return assessment.gather(results, repetitions=50)


def settings(sites) -> dict:
    """The configuration as the steps get it, with the paper's values."""
    paper = published.figures()
    edges = {key: paper["iri_thresholds"][key] for key in QUALITIES[:-1]}
    iri_settings = {"segment": 50, "speed_km_h": paper["iri_thresholds"]["kmh"], "thresholds": edges}
    return {
        "sites": {
            each.name: {
                "title": each.title,
                "standin": each.standin,
                "has_drives": each.comparison is not None,
                "calibrated_on": each.calibrated_on,
                "speed": {"limit_km_h": each.speed_limit_km_h},
                "sampling": dict(each.sampling),
            }
            for each in sites
        },
        "standin_calibrations": [each.name for each in sites if each.standin and each.calibrated_on == each.name],
        "model": "base",
        "effects": {},
        "runs": sites[0].samples.sizes["run"],
        "seed": 2021,
        "comfort": {"critical_length": 5, "iri": iri_settings, "exposure": {"trip": 3600}},
        "calibration": {},
    }


def site(name, rng, drives=True, standin=True, calibrated_on=None, runs=200) -> Site:
    """One site with every dataset that the report reads."""
    files = {key: f"{name}/{key}.nc" for key in ("road", "samples", "inspection")}
    files |= {key: f"{name}/base/comfort/{key}.nc" for key in ("thresholds", "iso2631", "iri")}
    if drives:
        files["comparison"] = f"{name}/base/comparison.nc"
    surface = road(rng)
    return Site(
        name,
        road=surface,
        inspection=inspection(surface),
        samples=samples(rng, runs),
        thresholds=thresholds(rng, runs),
        iso2631=iso2631(rng, runs),
        iri=iri(rng, runs),
        comparison=comparison(rng) if drives else None,
        standin=standin,
        title="minor road",
        calibrated_on=calibrated_on,
        speed_limit_km_h=100.0,
        sampling={
            "speed_deviation": {"normal": [0, 0.2]},
            "lateral_position": {"normal": [0, 0.2]},
            "road_friction": {"uniform": [0.6, 1.0]},
        },
        files=files,
    )


def road(rng) -> xr.Dataset:
    u = np.arange(0.0, LENGTH + 75.0, 0.1)
    v = np.linspace(-2.0, 2.0, 9)
    curvature = 0.004 * np.sin(2 * np.pi * u / 280) * np.clip(np.sin(2 * np.pi * u / 900), 0, 1)
    heading = np.cumsum(curvature) * 0.1
    slope = 0.02 * np.sin(2 * np.pi * u / 700 + rng.uniform(0, 6))
    height = np.cumsum(slope) * 0.1
    texture = np.cumsum(rng.normal(0, 2e-4, (u.size, v.size)), axis=0)
    texture -= np.linspace(0, 1, u.size)[:, None] * texture[-1]
    return xr.Dataset(
        {
            "elevation": (("u", "v"), height[:, None] + texture),
            "x": ("u", np.cumsum(np.cos(heading)) * 0.1),
            "y": ("u", np.cumsum(np.sin(heading)) * 0.1),
            "heading": ("u", heading),
            "curvature": ("u", curvature),
            "slope": ("u", slope),
            "bank": ("u", 5.0 * curvature),
        },
        {"u": u, "v": v},
    )


def inspection(surface) -> xr.Dataset:
    """What the step inspect makes of a road, with a made-up drive; the road gets a pothole and an outlier for it."""
    rng = np.random.default_rng(8)
    measured = surface.copy(deep=True)
    measured["elevation"][2000:2004, 1:3] -= 0.03
    measured["elevation"][4000, 6] += 0.04
    repaired, _ = clean.clean(measured, outliers="repair")
    _, choices = smoothing.smooth_surface(repaired.isel(u=slice(1000)))  # 100 m are enough of a made-up road to find cut-offs on
    smoothed, _ = smoothing.smooth_surface(repaired, **{name: choice.wavelength for name, choice in choices.items()})
    stages = [roughness.analyse(each).rename(v="track") for each in (measured, repaired, smoothed)]
    found = xr.concat(stages, xr.Variable("stage", ["measured", "repaired", "smoothed"]))
    frequency = np.arange(0.0, 50.1, 0.5)
    density = rng.uniform(0.5, 1.0, (3, frequency.size)) * 1e-2 / (1 + frequency)
    density[0] = np.nan
    found["iri_track"] = (("stage", "track"), rng.uniform(1.0, 2.0, (3, 2)))
    found["acceleration_psd"] = (("stage", "frequency"), density)
    found["a_z_rms"] = ("stage", [np.nan, 0.31, 0.30])
    found["a_z_peak"] = ("stage", [np.nan, 1.9, 1.8])
    for name in ("wavelength", "penalty"):
        values = [getattr(choice, name) for choice in choices.values()]
        found["cutoff" if name == "wavelength" else name] = ("direction", values)
    found["trial_cutoff"] = (("direction", "trial"), [choice.wavelengths for choice in choices.values()])
    found["held_out_error"] = (("direction", "trial"), [choice.errors for choice in choices.values()])
    found = found.assign_coords(direction=list(choices), frequency=frequency).merge(defects.find(repaired))
    found.attrs = {"used": "repaired", "cells": 60_000, "cells_repaired": 1, "cells_filled": 0, "cells_kept": 0}
    found.attrs |= {"share_changed": 1 / 60_000, "largest_change": 0.04}
    return found.assign_attrs(largest_change_u=400.0, largest_change_v=1.0)


def samples(rng, runs) -> xr.Dataset:
    unit = latin_hypercube(runs, 3, rng).T
    return xr.Dataset(
        {
            "speed_deviation": ("run", 0.4 * unit[0] - 0.2),
            "lateral_position": ("run", 0.4 * unit[1] - 0.2),
            "road_friction": ("run", 0.6 + 0.4 * unit[2]),
        }
    )


def _grid(runs, **coords) -> xr.Dataset:
    s = 50.0 + np.arange(0.0, LENGTH, SPACING)
    start = np.arange(50.0, 50.0 + LENGTH, 5.0)
    return xr.Dataset(
        {"window_start": ("window", start)},
        {"s": s, "window": np.arange(start.size), "run": np.arange(runs), **coords},
        {"critical_length": 5.0, "runs": runs},
    )


def _smooth(rng, count, scale, length):
    kernel = np.hanning(length)
    noise = np.convolve(rng.normal(size=count + length), kernel / np.sqrt((kernel**2).sum()), "valid")[:count]
    return scale * noise


def _windows(outside) -> np.ndarray:
    return outside.reshape(-1, int(5.0 / SPACING)).all(axis=1)


def _finish(dataset, dims, critical, rng) -> xr.Dataset:
    critical = np.asarray(critical)
    dataset["critical"] = ((*dims, "window"), critical.astype(np.int8))
    chance = np.clip(0.8 * critical + rng.uniform(0, 0.1, critical.shape), 0, 1)
    dataset["exceedance_probability"] = ((*dims, "window"), np.where(chance < 0.05, 0.0, chance))
    dataset["critical_count"] = (dims, critical.sum(-1))
    dataset["critical_share"] = (dims, 100.0 * critical.mean(-1))
    share = dataset["critical_share"].values[..., None] + rng.uniform(0, 2, (*critical.shape[:-1], dataset.sizes["run"]))
    dataset["run_share"] = ((*dims, "run"), share)
    return dataset


def thresholds(rng, runs) -> xr.Dataset:
    dataset = _grid(runs, axis=list(AXES), style=list(STYLES))
    limits = published.figures()["acceleration_thresholds"]
    bands = np.array([[limits[axis][style] for style in STYLES] for axis in AXES], float)
    critical = []
    for axis, scale, length in zip(AXES, (0.6, 1.6, 0.12), (400, 300, 40)):
        dataset[axis] = ("s", _smooth(rng, dataset.sizes["s"], scale, length))
        values = dataset[axis].values
        critical.append([_windows((values < low) | (values > high)) for low, high in bands[AXES.index(axis)]])
    dataset["lower"] = (("axis", "style"), bands[..., 0])
    dataset["upper"] = (("axis", "style"), bands[..., 1])
    dataset["source"] = (("axis", "style"), np.full((3, 3), "tab:thresholds_manual"))
    dims = ("jerk", "jerk_style")
    dataset = dataset.assign_coords(jerk=["jerk_x", "jerk_y"], jerk_style=list(JERK))
    for name in ("lower", "upper", "source"):
        dataset[f"jerk_{name}"] = dims, [[getattr(band, name) for band in JERK.values()]] * 2
    dataset["jerk_critical_count"] = dims, np.array([[12, 7, 0], [9, 4, 1]])
    dataset["jerk_critical_share"] = dims, dataset["jerk_critical_count"].values / 1.2
    dataset["jerk_run_share"] = (*dims, "run"), rng.uniform(0, 8, (2, 3, runs))
    return _finish(dataset, ("axis", "style"), critical, rng)


def iso2631(rng, runs) -> xr.Dataset:
    dataset = _grid(runs, band=list(BANDS))
    limits = np.array([published.figures()["iso2631_bands"][band] for band in BANDS], float)
    dataset["a_v"] = ("s", 0.1 + np.abs(_smooth(rng, dataset.sizes["s"], 0.35, 120)))
    values = dataset["a_v"].values
    critical = [_windows((values >= low) & (values < high)) for low, high in limits]
    dataset["band_lower"] = ("band", limits[:, 0])
    dataset["band_upper"] = ("band", limits[:, 1])
    mean = values.reshape(-1, int(5.0 / SPACING)).mean(axis=1)
    dataset["window_mean"] = ("run", "window"), mean * (1 + 0.1 * rng.standard_normal((runs, 1)))
    dataset = dataset.assign_coords(axis=list(AXES))
    dataset["weighted_rms"] = ("run", "axis"), rng.uniform(0.2, 0.5, (runs, 3))
    dataset["mtvv"] = ("run", "axis"), 2.0 * dataset["weighted_rms"].values
    dataset["crest_factor"] = ("run", "axis"), rng.uniform(4.0, 11.0, (runs, 3))
    dataset["vdv"] = ("run", "axis"), rng.uniform(1.0, 3.0, (runs, 3))
    dataset["msdv_z"] = "run", rng.uniform(0.5, 1.5, runs)
    dataset["duration"] = "run", rng.uniform(24.0, 26.0, runs)
    return _finish(dataset, ("band",), critical, rng)


def iri(rng, runs) -> xr.Dataset:
    dataset = _grid(runs, quality=list(QUALITIES))
    s = dataset["s"].values
    nodes = np.arange(50.0, 50.0 + LENGTH + 50.0, 50.0)
    dataset["iri"] = ("s", np.interp(s, nodes, rng.uniform(0.6, 3.0, nodes.size)))
    dataset["iri_full"] = ("s", dataset["iri"].values + 0.3 * _smooth(rng, s.size, 1.0, 60))
    dataset = dataset.assign_coords(track=[-0.75, 0.75])
    dataset["iri_track"] = ("track", "s"), dataset["iri"].values * np.array([[1.1], [0.9]])
    dataset["hri"] = "s", 0.9 * dataset["iri"].values
    dataset["v_x"] = ("s", 22.0 + 3.0 * np.sin(2 * np.pi * s / 500))
    edges = np.array([1.14, 1.79, 2.27, 3.24])[:, None] * (100 / 3.6) / dataset["v_x"].values
    dataset["threshold"] = (("quality", "s"), np.vstack([edges, np.full(s.size, np.inf)]))
    values, lower = dataset["iri"].values, np.vstack([np.zeros(s.size), edges])
    upper = dataset["threshold"].values
    full = dataset["iri_full"].values
    critical, in_full = (
        [_windows((each >= lower[k]) & (each < upper[k])) for k in range(5)] for each in (values, full)
    )
    dataset["critical_count_full"] = "quality", np.sum(in_full, axis=1)
    return _finish(dataset, ("quality",), critical, rng)


def comparison(rng, seconds=30.0, rate=100.0) -> xr.Dataset:
    time = np.arange(0.0, seconds, 1 / rate)
    names, roles = ["repeat_1", "repeat_2", "slower"], ["fit", "fit", "check"]
    scale = {"a_x": 0.6, "a_y": 1.5, "a_z": 0.5, "roll_rate": 0.03, "pitch_rate": 0.02, "yaw_rate": 0.1}
    shape = (len(SIGNALS), len(names), time.size)
    measured, simulated = np.empty(shape), np.empty((2, *shape))
    for i, signal in enumerate(SIGNALS):
        for j in range(len(names)):
            truth = _smooth(rng, time.size, scale[signal], 30)
            measured[i, j] = truth
            for k, error in enumerate((0.4, 0.3)):
                simulated[k, i, j] = truth + _smooth(rng, time.size, error * scale[signal], 20)
    measured[:, 2, -300:] = np.nan
    simulated[:, :, 2, -300:] = np.nan
    residual = simulated - measured
    rmse = np.sqrt(np.nanmean(residual**2, axis=-1))
    span = np.nanmax(measured, axis=-1) - np.nanmin(measured, axis=-1)
    return xr.Dataset(
        {
            "measured": (("signal", "drive", "time"), measured),
            "simulated": (("state", "signal", "drive", "time"), simulated),
            "residual": (("state", "signal", "drive", "time"), residual),
            "rmse": (("state", "signal", "drive"), rmse),
            "nrmse": (("state", "signal", "drive"), rmse / span),
            "role": ("drive", roles),
        },
        {"drive": names, "time": time, "signal": list(SIGNALS), "state": ["reference", "calibrated"]},
    )


def calibration_with_effect() -> xr.Dataset:
    """A calibration of six parameters, the last one the size of an effect."""
    base = calibration()
    one = base.isel(parameter=[0]).assign_coords(parameter=["suspension_friction.front"])
    found = xr.concat([base, one], "parameter", data_vars="minimal").isel(step=[0, 1, 2, 3, 4, 4, 5])
    return found.assign_coords(step=[*(f"OP_{k}" for k in range(1, 7)), "joint"])


def calibration() -> xr.Dataset:
    limits = [list(map(float, edges)) for edges in published.figures()["calibration_bounds"].values()]
    lower, upper = np.array(limits).T
    initial = np.array([25000.0, 24000.0, 1.0, 220000.0 + 30000.0, 4500.0])
    value = np.array([28100.0, 22300.0, 0.93, 312000.0, 4800.0])
    steps = ["OP_1", "OP_2", "OP_3", "OP_4", "OP_5", "joint"]
    after = np.array([np.where(np.arange(5) <= k, value, initial) for k in range(6)])
    return xr.Dataset(
        {
            "value": ("parameter", value),
            "initial": ("parameter", initial),
            "lower": ("parameter", lower),
            "upper": ("parameter", upper),
            "interval_lower": ("parameter", 0.97 * value),
            "interval_upper": ("parameter", 1.03 * value),
            "unit": ("parameter", ["N/m", "N/m", "1", "N/m", "N s/m"]),
            "cost": ("step", [0.034, 0.033, 0.032, 0.030, 0.029, 0.028]),
            "initial_nrmse": (("drive", "signal"), np.full((2, 6), 0.11)),
            "value_sequence": ("parameter", value),
            "verdict": ("parameter", ["well determined"] * 5),
            "correlation": (("parameter", "other"), np.eye(5)),
            "iterations": ("step", [5, 4, 3, 6, 4, 7]),
            "step_value": (("step", "parameter"), after),
        },
        {"parameter": list(CALIBRATED), "other": list(CALIBRATED), "step": steps},
        {"applied": "joint", "stopping_rule": "relative change of cost or step below 1e-06", "remarks": "none"},
    )
