"""A measured drive as a site file describes it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..errors import InputError
from . import readers
from .sensor import TOLD_OF, sensor_place

PASSED_ON = ("name", "role", "gravity", "lateral_position", "road_friction", "distance_start")
"""Keys of a drive's entry that ``record.from_arrays`` knows by the same name."""

SPEED_SCALE = 0.05
"""Largest share by which a recorded speed may be off; speedometers and wheel sizes explain less."""


def read(path, entry: Mapping, vehicle, *, rate: float = 100.0) -> xr.Dataset:
    """The drive in the file, by the entry of a site file (workflow/schemas/site.yaml, ``drive``).

    ``vehicle`` turns places that are measured at the car (behind the front axle, above the
    wheel centres) into places relative to the centre of gravity, and where that lies stands among the attributes (TOLD_OF). A sensor
    without a place is taken to sit there. ``rate`` in Hz. Raises InputError naming the file.
    """
    attributes = {key: entry[key] for key in PASSED_ON if key in entry}
    place = entry.get("sensor") or {}
    if place:
        missing = [key for key in ("behind_front_axle", "above_wheel_centres") if key not in place]
        if missing:
            raise InputError(f"no {missing[0]} (expected with a sensor's place)", file=path, place="sensor")
        attributes["sensor"] = sensor_place(vehicle, **place)
    drive = readers.read(path, entry.get("columns"), rate=rate, **attributes)
    for key, quantity, is_there in (("distance_start", "s", drive.attrs["place_measured"]), ("lateral_position", "e", bool(np.isfinite(drive["e"]).all()))):
        if entry.get(key) and is_there:
            raise InputError(f"{entry[key]!r} beside {quantity} in the file, which says so itself, expected one of them", file=path, place=key)
    if entry.get("distance_of", "body") == "front_axle":
        drive = _of_the_body(drive, vehicle["cg_to_front_axle"])
    return drive.assign_attrs({name: float(vehicle[name]) for name in TOLD_OF})


def _of_the_body(drive: xr.Dataset, ahead: float) -> xr.Dataset:
    """A drive told of an axle so many m ahead, told of the centre of gravity, which comes where the axle was.

    In a bend it runs some millimetres farther inside, which is left out.
    """
    front = drive["s"].values
    place = front - ahead
    aside = np.interp(place, np.maximum.accumulate(front), drive["e"].values)
    return drive.assign(s=drive["s"].copy(data=place), e=drive["e"].copy(data=aside))


def check_speed(aligned: xr.Dataset, path) -> xr.Dataset:
    """The aligned drive, or InputError where its speed had to be scaled by more than SPEED_SCALE to fit the road."""
    if said := speed_words(float(aligned.attrs["speed_scale"])):
        raise InputError(said, file=path, place="v_x")
    return aligned


def speed_words(scale: float) -> str:
    """Words on a speed that has to be scaled by more than SPEED_SCALE to fit the road; empty where it has not."""
    if abs(scale - 1.0) <= SPEED_SCALE:
        return ""
    return (
        f"recorded speed times {scale:.4g} fits the road (expected {1 - SPEED_SCALE:g} to {1 + SPEED_SCALE:g}; "
        "are the units of v_x and s right, is it the road of this drive?)"
    )
