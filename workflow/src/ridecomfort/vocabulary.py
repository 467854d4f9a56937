"""Names, units and long names of every variable: written once, used by all.

SI units inside. Axes follow ISO 8855 (x forward, y left, z up); ``u`` runs along
the reference line of the road and ``v`` to its left, as in OpenCRG. Roll is
positive with the left side up, pitch with the nose down, yaw to the left.

Accelerations are those of a point of the body resolved along its own axes,
without gravity: ``a_z`` is zero at rest. What an accelerometer reads instead
(specific force) is made from them by ``drive.record.specific_force``.
"""

from __future__ import annotations

from dataclasses import dataclass

import xarray as xr


@dataclass(frozen=True)
class Variable:
    """A quantity of the study: its name in every file, its unit and its meaning."""

    name: str
    unit: str
    long_name: str
    standard_name: str | None = None


def _table(*rows) -> dict[str, Variable]:
    return {row[0]: Variable(*row) for row in rows}


VARIABLES = _table(
    ("time", "s", "time since the start of the drive"),
    ("run", "1", "index of the simulated drive"),
    ("drive", "1", "name of the measured drive"),
    ("u", "m", "distance along the reference line of the road"),
    ("v", "m", "distance to the left of the reference line"),
    ("elevation", "m", "height of the road surface", "surface_altitude"),
    ("x", "m", "easting of the reference line"),
    ("y", "m", "northing of the reference line"),
    ("heading", "rad", "heading of the reference line, counterclockwise from x"),
    ("curvature", "1/m", "curvature of the reference line, positive to the left"),
    ("slope", "1", "slope of the reference line, positive uphill"),
    ("bank", "1", "cross slope of the road, positive with the left side up"),
    ("v_x", "m/s", "speed of the body along its x axis"),
    ("a_x", "m/s2", "acceleration of the body along its x axis"),
    ("a_y", "m/s2", "acceleration of the body along its y axis"),
    ("a_z", "m/s2", "acceleration of the body along its z axis"),
    ("roll_rate", "rad/s", "roll rate of the body"),
    ("pitch_rate", "rad/s", "pitch rate of the body"),
    ("yaw_rate", "rad/s", "yaw rate of the body"),
    ("roll", "rad", "roll angle of the body against the horizontal"),
    ("pitch", "rad", "pitch angle of the body against the horizontal"),
    ("s", "m", "distance of the body along the reference line"),
    ("e", "m", "lateral offset of the body from the reference line, positive to the left"),
    ("speed", "m/s", "speed that the driver aims for"),
    ("speed_deviation", "m/s", "deviation of a run from the speed profile of the site"),
    ("lateral_position", "m", "lateral position in the lane that a run holds"),
    ("road_friction", "1", "friction of the road surface, relative to the tyre's dry friction"),
    ("a_wx", "m/s2", "running rms of the frequency-weighted acceleration along x"),
    ("a_wy", "m/s2", "running rms of the frequency-weighted acceleration along y"),
    ("a_wz", "m/s2", "running rms of the frequency-weighted acceleration along z"),
    ("a_v", "m/s2", "vibration total value of the frequency-weighted accelerations"),
    ("iri", "m/km", "International Roughness Index"),
    ("window", "1", "index of the section along the road"),
    ("window_start", "m", "start of the section along the reference line"),
    ("critical", "1", "whether the section is critical"),
    ("exceedance_probability", "1", "share of the runs in which the section is critical"),
)

SIGNALS = ("a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate")
"""The signals that model and measurement are compared in (tab:quantities)."""

DRIVE = ("v_x", *SIGNALS, "s", "e")
"""What every drive holds, measured or simulated, over ``time``."""

CALIBRATED = (
    "spring_stiffness_front",
    "spring_stiffness_rear",
    "tyre_friction",
    "tyre_radial_stiffness",
    "tyre_radial_damping",
)
"""The five parameters of the paper's calibration, in the order OP_1 to OP_5 (tab:constraints)."""

STANDARD_GRAVITY = 9.80665
"""m/s2; ISO 80000-3."""


def describe(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with unit and long name written on every variable that the study knows.

    Attributes that a variable already carries stay as they are.
    """
    for name, variable in dataset.variables.items():
        known = VARIABLES.get(name)
        if known is None:
            continue
        if variable.dtype.kind not in "USO":
            variable.attrs.setdefault("units", known.unit)
        variable.attrs.setdefault("long_name", known.long_name)
        if known.standard_name:
            variable.attrs.setdefault("standard_name", known.standard_name)
    return dataset
