"""Small made-up results in the schema of the study's files, for tests of the report."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort.report import published
from ridecomfort.report.study import Site, Study
from ridecomfort.vocabulary import CALIBRATED, SIGNALS

STYLES = ("PT", "ND", "AG")
AXES = ("a_x", "a_y", "a_z")
BANDS = ("NU", "LU", "FU", "U", "VU", "EU")
QUALITIES = ("VG", "G", "F", "M", "P")
LENGTH = 600.0
SPACING = 0.25


def study(names=("ts1", "ts2", "ts3"), *, drives=True, standin=True) -> Study:
    """A study of the named sites; without ``drives`` nothing is compared or calibrated."""
    rng = np.random.default_rng(7)
    calibrated_on = names[0] if drives else None
    sites = tuple(site(name, rng, drives, standin, calibrated_on) for name in names)
    calibrations = {names[0]: calibration()} if drives else {}
    return Study(
        sites,
        calibrations,
        {names[0]: f"{names[0]}/base/calibration.nc"} if drives else {},
        settings=settings(sites),
        software={"ridecomfort": "0.1.0", "numpy": np.__version__},
    )


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
        "model": "base",
        "effects": {},
        "runs": 40,
        "seed": 2021,
        "comfort": {"critical_length": 5, "iri": iri_settings},
        "calibration": {},
    }


def site(name, rng, drives=True, standin=True, calibrated_on=None) -> Site:
    """One site with every dataset that the report reads."""
    files = {key: f"{name}/{key}.nc" for key in ("road", "samples")}
    files |= {key: f"{name}/base/comfort/{key}.nc" for key in ("thresholds", "iso2631", "iri")}
    if drives:
        files["comparison"] = f"{name}/base/comparison.nc"
    return Site(
        name,
        road=road(rng),
        samples=samples(rng),
        thresholds=thresholds(rng),
        iso2631=iso2631(rng),
        iri=iri(rng),
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


def samples(rng, runs=40) -> xr.Dataset:
    return xr.Dataset(
        {
            "speed_deviation": ("run", rng.normal(0, 0.2, runs)),
            "lateral_position": ("run", rng.normal(0, 0.2, runs)),
            "road_friction": ("run", rng.uniform(0.6, 1.0, runs)),
        }
    )


def _grid(**coords) -> xr.Dataset:
    s = 50.0 + np.arange(0.0, LENGTH, SPACING)
    start = np.arange(50.0, 50.0 + LENGTH, 5.0)
    return xr.Dataset(
        {"window_start": ("window", start)},
        {"s": s, "window": np.arange(start.size), **coords},
        {"critical_length": 5.0, "runs": 40},
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
    return dataset


def thresholds(rng) -> xr.Dataset:
    dataset = _grid(axis=list(AXES), style=list(STYLES))
    limits = published.figures()["acceleration_thresholds"]
    bands = np.array([[limits[axis][style] for style in STYLES] for axis in AXES], float)
    critical = []
    for axis, scale, length in zip(AXES, (0.6, 1.6, 0.12), (400, 300, 40)):
        dataset[axis] = ("s", _smooth(rng, dataset.sizes["s"], scale, length))
        values = dataset[axis].values
        critical.append([_windows((values < low) | (values > high)) for low, high in bands[AXES.index(axis)]])
    dataset["lower"] = (("axis", "style"), bands[..., 0])
    dataset["upper"] = (("axis", "style"), bands[..., 1])
    return _finish(dataset, ("axis", "style"), critical, rng)


def iso2631(rng) -> xr.Dataset:
    dataset = _grid(band=list(BANDS))
    limits = np.array([published.figures()["iso2631_bands"][band] for band in BANDS], float)
    dataset["a_v"] = ("s", 0.1 + np.abs(_smooth(rng, dataset.sizes["s"], 0.35, 120)))
    values = dataset["a_v"].values
    critical = [_windows((values >= low) & (values < high)) for low, high in limits]
    dataset["band_lower"] = ("band", limits[:, 0])
    dataset["band_upper"] = ("band", limits[:, 1])
    return _finish(dataset, ("band",), critical, rng)


def iri(rng) -> xr.Dataset:
    dataset = _grid(quality=list(QUALITIES))
    s = dataset["s"].values
    nodes = np.arange(50.0, 50.0 + LENGTH + 50.0, 50.0)
    dataset["iri"] = ("s", np.interp(s, nodes, rng.uniform(0.6, 3.0, nodes.size)))
    dataset["iri_full"] = ("s", dataset["iri"].values + 0.3 * _smooth(rng, s.size, 1.0, 60))
    dataset["v_x"] = ("s", 22.0 + 3.0 * np.sin(2 * np.pi * s / 500))
    edges = np.array([1.14, 1.79, 2.27, 3.24])[:, None] * (100 / 3.6) / dataset["v_x"].values
    dataset["threshold"] = (("quality", "s"), np.vstack([edges, np.full(s.size, np.inf)]))
    values, lower = dataset["iri"].values, np.vstack([np.zeros(s.size), edges])
    upper = dataset["threshold"].values
    critical = [_windows((values >= lower[k]) & (values < upper[k])) for k in range(5)]
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
            "iterations": ("step", [5, 4, 3, 6, 4, 7]),
            "step_value": (("step", "parameter"), after),
        },
        {"parameter": list(CALIBRATED), "step": steps},
        {"applied": "joint", "stopping_rule": "relative change of cost or step below 1e-06", "remarks": "none"},
    )
