"""A tiny simulator of another kind: four independent linear quarter cars on the road, with the door of ``simulate.run``.

It shares nothing with the study's vehicle but the names of its parameters, so that what is
built around the simulator can be tested without it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import xarray as xr
from scipy.interpolate import RegularGridInterpolator
from scipy.signal import bilinear, lfilter, ss2tf
from scipy.spatial.transform import Rotation

from ridecomfort.drive import align, record, sampling
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS

INNER_RATE = 1000.0

LATERAL = 0.13
"""m; lateral position of ``driven``."""


def vehicle(repository):
    """The mid-size car of the study."""
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def other(vehicle):
    """A car that a nominal one does not fit."""
    return vehicle.replace(
        spring_stiffness_front=24000.0, spring_stiffness_rear=35000.0, tyre_radial_stiffness=320000.0, damping_front=1700.0
    )


def road(length=800.0, seed=1, bend=0.004, slope=0.02, width=4.0):
    """A rough, bending, rising road: independent random roughness every 0.5 m across, smooth in between."""
    rng = np.random.default_rng(seed)
    u, v = np.arange(0.0, length + 0.05, 0.1), np.arange(-width / 2, width / 2 + 0.01, 0.1)
    frequency = np.fft.rfftfreq(u.size, 0.1)
    amplitude = np.where(frequency > 0.01, 1 / np.maximum(frequency, 0.01), 0.0)
    place = np.arange(-width / 2, width / 2 + 0.01, 0.5)
    tracks = rng.standard_normal((place.size, u.size))
    tracks = np.fft.irfft(np.fft.rfft(tracks, axis=1) * amplitude, u.size, axis=1)
    tracks *= 0.006 / tracks.std()
    weight = np.clip(1 - np.abs(v[:, None] - place) / 0.5, 0, 1)
    curvature = bend * np.sin(2 * np.pi * u / 300)
    elevation = (weight @ tracks).T + slope * (u[:, None] + 30 * np.sin(2 * np.pi * u / 400)[:, None])
    return xr.Dataset(
        {
            "elevation": (("u", "v"), elevation),
            "curvature": ("u", curvature),
            "bank": ("u", 0 * u),
            "slope": ("u", np.gradient(elevation[:, 20] - (weight @ tracks)[v.size // 2], u)),
        },
        {"u": u, "v": v},
    )


def run(road, vehicle, *, speed, lateral=0.0, friction=1.0, effects=(), sensor=(0, 0, 0), start=0.0, end=None, rate=100.0):
    """One drive; every wheel rides on its own corner of the car."""
    end = float(road.u[-1]) if end is None else end
    u = np.arange(start, end, 0.05)
    pace = np.interp(u, speed.u, speed) if isinstance(speed, xr.DataArray) else np.full(u.size, float(speed))
    clock = np.concatenate([[0], np.cumsum(0.1 / (pace[1:] + pace[:-1]))])
    time = np.arange(0, clock[-1], 1 / INNER_RATE)
    s, v_x = np.interp(time, clock, u), np.interp(time, clock, pace)
    e = np.interp(s, lateral.u, lateral) if isinstance(lateral, xr.DataArray) else np.full(s.size, float(lateral))
    surface = RegularGridInterpolator((road.u.values, road.v.values), road.elevation.values)
    corners = {}
    for axle, along in (("front", vehicle["cg_to_front_axle"]), ("rear", vehicle["cg_to_front_axle"] - vehicle["wheelbase"])):
        for side, across in (("left", 0.75), ("right", -0.75)):
            place = np.clip(s + along, road.u.values[0], road.u.values[-1])
            corners[axle, side] = _corner(vehicle, axle, surface(np.stack([place, e + across], axis=1)), time[1])
    mean = lambda key, which: np.mean([c[key] for name, c in corners.items() if which in name], axis=0)
    curvature = np.interp(s, road.u, road.curvature)
    drive = {
        "v_x": v_x,
        "a_x": np.gradient(v_x, time),
        "a_y": v_x**2 * curvature,
        "a_z": 0.5 * (mean("acceleration", "front") + mean("acceleration", "rear")),
        "roll_rate": (mean("velocity", "left") - mean("velocity", "right")) / 1.5,
        "pitch_rate": (mean("velocity", "rear") - mean("velocity", "front")) / vehicle["wheelbase"],
        "yaw_rate": v_x * curvature,
        "s": s,
        "e": e,
        "roll": (mean("height", "left") - mean("height", "right")) / 1.5,
        "pitch": (mean("height", "rear") - mean("height", "front")) / vehicle["wheelbase"],
    }
    result = xr.Dataset({name: ("time", values) for name, values in drive.items()}, {"time": time})
    result.attrs.update(sensor_x=0.0, sensor_y=0.0, sensor_z=0.0, gravity=0)
    if any(sensor):
        result = record.transfer(result, sensor)
    names = ["a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate"]
    fine = np.stack([result[name].values for name in names], axis=1)
    for name, values in zip(names, sampling.low_pass(fine, 1 / INNER_RATE, 0.5 * rate).T):
        result[name] = "time", values
    return result.isel(time=slice(None, None, round(INNER_RATE / rate)))


def driven(road, vehicle, *, aside=0.0, along=0.0):
    """A drive over most of a ``road`` of 560 m with changing speed, once the start has died away; ``aside`` and ``along`` wander (m)."""
    u = road["u"].values
    speed = xr.DataArray(20 + 2 * np.sin(2 * np.pi * u / 250), {"u": u}, "u")
    lateral = xr.DataArray(LATERAL + aside * np.sin(2 * np.pi * u / 200), {"u": u}, "u")
    found = run(road, vehicle, speed=speed, lateral=lateral, end=550.0)
    found = found.isel(time=(found["s"] > 60).values)
    found["s"] = found["s"] + along * np.sin(2 * np.pi * found["s"] / 300)
    return found.assign_coords(time=found["time"] - found["time"][0])


def _corner(vehicle, axle, road, interval):
    """Body height, velocity and acceleration of a quarter car over a road height."""
    bz, az = _filter(
        vehicle["sprung_mass"] / 4,
        vehicle[f"unsprung_mass_{axle}"],
        vehicle[f"spring_stiffness_{axle}"],
        vehicle[f"damping_{axle}"],
        vehicle["tyre_radial_stiffness"],
        vehicle["tyre_radial_damping"],
        interval,
    )
    slope = (road[1] - road[0]) / interval
    ramp = road[0] + slope * interval * np.arange(road.size)
    height = ramp + lfilter(bz, az, road - ramp)
    velocity = np.gradient(height, interval)
    return {"height": height, "velocity": velocity, "acceleration": np.gradient(velocity, interval)}


@lru_cache
def _filter(mass, wheel, k, c, kt, ct, interval):
    """Coefficients from road height to body height; they take longer than to filter, and drives differ mostly in other things."""
    a = np.array(  # states: body height, body velocity less what the road's rate adds, wheel height, the same
        [
            [0, 1, 0, 0],
            [-k / mass, -c / mass, k / mass, c / mass],
            [0, 0, 0, 1],
            [k / wheel, c / wheel, -(k + kt) / wheel, -(c + ct) / wheel],
        ]
    )
    gain = ct / wheel  # the tyre's damper passes the rate of the road, moved into the input by a change of state
    b = np.array([[0], [c * gain / mass], [gain], [kt / wheel - (c + ct) * gain / wheel]])
    numerator, denominator = ss2tf(a, b, np.array([[1, 0, 0, 0]]), np.zeros((1, 1)))
    return bilinear(numerator[0], denominator, 1 / interval)


def recorded(simulated, *, clock=0.0, gain=1.0, rotation=(0.0, 0.0, 0.0), bias=(0.0, 0.0, 0.0), speed_scale=1.0,
             noise=0.0, seed=0, **attributes):
    """The simulated drive as an inertial unit with these errors would have recorded it, gravity included.

    ``noise`` scales white noise of 0.02 m/s2 and 0.001 rad/s; ``speed_scale`` is true over recorded speed.
    """
    rng = np.random.default_rng(seed)
    time = simulated["time"].values
    names = ("a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate")
    values = np.stack([simulated[name].values for name in names])
    values[:3] = record.specific_force(values[:3], simulated["roll"].values, simulated["pitch"].values)
    turn = lambda w: np.cross(np.broadcast_to(np.array(rotation)[:, None], w.shape), w, axis=0)
    values = np.concatenate(
        [gain * (values[:3] - turn(values[:3])), values[3:] - turn(values[3:]) + np.array(bias)[:, None]]
    )
    values += noise * np.array([0.02] * 3 + [0.001] * 3)[:, None] * rng.standard_normal(values.shape)
    quantities = {name: (time + clock, row) for name, row in zip(names, values)}
    quantities["v_x"] = time, simulated["v_x"].values / speed_scale
    if attributes.pop("place", True):
        quantities["s"] = time, simulated["s"].values
    return record.from_arrays(quantities, **attributes)


def turned(drive, degrees):
    """A record of a drive by an instrument that is turned about the vertical."""
    told = recorded(drive, noise=1.0, lateral_position=LATERAL, name="own")
    back = Rotation.from_rotvec([0.0, 0.0, np.radians(degrees)]).inv().as_matrix()
    rows = [back @ np.stack([told[name].values for name in part]) for part in (SIGNALS[:3], SIGNALS[3:])]
    return told.assign({name: ("time", row) for name, row in zip(SIGNALS, np.concatenate(rows))})


def aligned(told, road, vehicle):
    """A record brought into line with the road by these cars."""
    return align.align(told, road, vehicle, simulate=run)
