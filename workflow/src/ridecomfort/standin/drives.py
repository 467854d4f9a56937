"""Stand-in measured drives: a car that is not the model's, driven and recorded as a test car would be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from .. import simulate
from ..drive import units
from ..effects import library
from ..errors import InputError
from ..vehicle.parameters import Vehicle
from ..vocabulary import STANDARD_GRAVITY
from . import instrument
from .site import generators, usual_speed
from .texture import smooth_noise

RATE = 100.0
"""Hz of the records."""

DIGITS = {"time": 4, "s": 4, "v_x": 5}
"""Decimals in the file; of the inertial signals six."""


def hidden_car(seed: int, settings: Mapping, vehicle: Vehicle) -> tuple[Vehicle, dict[str, dict[str, float]]]:
    """The car that makes the drives of every site, and the sizes of its effects that the model lacks.

    ``settings`` is the block ``measurement`` of ``config/standin.yaml``: ``calibrated`` parameters
    are drawn evenly from their interval, the ``unsure`` ones lognormally about the nominal value.
    Each entry of ``effects`` names the candidates of which one is drawn, and the range of its size
    in units of the typical one. Raises InputError when there is no effect to draw.
    """
    car_rng, effect_rng = generators(seed, "all sites", "car", "effects")
    values = {name: float(car_rng.uniform(*interval)) for name, interval in settings["calibrated"].items()}
    unsure = settings["unsure"]
    for name in unsure["parameters"]:
        values[name] = vehicle[name] * float(np.exp(unsure["spread"] * car_rng.standard_normal()))
    known = library.find()
    sizes: dict[str, dict[str, float]] = {}
    for entry in settings["effects"]:
        candidates = [name for name in entry["among"] if name in known and name not in sizes]
        if not candidates:
            raise InputError(f"none of {', '.join(entry['among'])} is an effect", place="measurement.effects.among")
        effect = known[candidates[effect_rng.integers(len(candidates))]].effect
        share = effect_rng.uniform(*entry["size"])
        sizes[effect.name] = {
            parameter.name: float(parameter.neutral + share * (parameter.typical - parameter.neutral))
            for parameter in effect.parameters
        }
    return vehicle.replace(**values), sizes


def make_drives(site: str, settings: Mapping, road: xr.Dataset, vehicle: Vehicle, entries: Sequence[Mapping]):
    """Records of the drives of a site, each a mapping of column header to values, and the truth about them.

    ``settings`` is ``config/standin.yaml``, ``entries`` the ``drives`` of the site file: columns and
    units, place of the sensor, friction, known lateral position, and ``role``, where a drive to
    check with is the slower one.
    """
    block = settings["measurement"]
    car, effects = hidden_car(settings["seed"], block, vehicle)
    course = simulate.prepare(road, "cubic")
    usual = usual_speed(road.u.values, road.curvature.values, settings["sites"][site]["speed"])
    mounting_rng, *rngs = generators(settings["seed"], site, "mounting", *(entry["file"] for entry in entries))
    mounting = np.radians(block["mounting_deg"]) * mounting_rng.standard_normal(3)
    records, truths = [], []
    for entry, rng in zip(entries, rngs, strict=True):
        target, lateral, driver = how_driven(rng, road.u.values, usual, entry, block)
        place = sensor_place(car, entry["sensor"])
        drive = simulate.run(
            course, car, speed=target, lateral=lateral, friction=entry.get("road_friction", 1.0), effects=effects,
            sensor=place, step=block["step"], rate=1.0 / (block["step"] * instrument.STEPS_PER_SAMPLE),
        )  # fmt: skip
        quantities, errors = instrument.record(rng, drive, RATE, block["instrument"], mounting)
        records.append(columns(quantities, entry["columns"]))
        truths.append({"file": entry["file"], **driver, **errors})
    truth = {
        "site": site,
        "seed": settings["seed"],
        "vehicle": {name: float(car[name]) for name in car.values if car[name] != vehicle[name]},
        "effects": effects,
        "mounting_rad": mounting.tolist(),
        "drives": truths,
    }
    return records, truth


def how_driven(rng, u: np.ndarray, usual: np.ndarray, entry: Mapping, block: Mapping):
    """Speed and lateral position over u that the driver of one drive aims for, and what was drawn for them."""
    spacing = u[1] - u[0]
    slower = block["slower"] if entry["role"] == "check" else 1.0
    deviation = block["speed_deviation"] * rng.standard_normal()
    wander = block["speed_wander"] * smooth_noise(rng, len(u), spacing, block["wander_length"])
    speed = np.maximum(slower * usual + deviation + wander, 3.0)
    known = entry.get("lateral_position", 0.0)
    offset = known + block["lateral_deviation"] * rng.standard_normal()
    path = offset + block["lateral_wander"] * smooth_noise(rng, len(u), spacing, block["wander_length"])
    drawn = {"slower": slower, "speed_deviation": float(deviation), "lateral_position": float(offset)}
    over_u = {"coords": {"u": u}, "dims": "u"}
    return xr.DataArray(speed, **over_u), xr.DataArray(path, **over_u), drawn


def sensor_place(vehicle: Vehicle, sensor: Mapping) -> tuple[float, float, float]:
    """Place of the sensor in m from the centre of gravity of the sprung mass, the car at rest.

    ``sensor`` says it as the site file does: ``behind_front_axle``, ``left``, ``above_wheel_centres``.
    """
    front_share = 1.0 - vehicle["cg_to_front_axle"] / vehicle["wheelbase"]
    load = STANDARD_GRAVITY * (0.5 * vehicle["sprung_mass"] * front_share + vehicle["unsprung_mass_front"])
    centre = vehicle["tyre_radius"] - load / vehicle["tyre_radial_stiffness"]
    return (
        vehicle["cg_to_front_axle"] - sensor["behind_front_axle"],
        sensor["left"],
        sensor["above_wheel_centres"] + centre - vehicle["cg_height"],
    )


def columns(quantities: Mapping[str, np.ndarray], named: Mapping[str, Mapping]) -> dict[str, np.ndarray]:
    """Columns of a file, by header: the quantities that the site file names, in its units, rounded."""
    return {
        entry["column"]: np.round(
            quantities[name] / units.factor(name, entry["unit"]) / entry.get("factor", 1.0), DIGITS.get(name, 6)
        )
        for name, entry in named.items()
    }
