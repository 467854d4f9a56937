"""Where a sensor sits: told as it is measured at the car, and relative to the centre of gravity of a vehicle."""

from __future__ import annotations

from collections.abc import Mapping

from ..vocabulary import STANDARD_GRAVITY

TOLD_OF = (
    "cg_to_front_axle", "cg_height", "sprung_mass", "unsprung_mass_front", "unsprung_mass_rear", "tyre_radius", "tyre_radial_stiffness",
)  # fmt: skip
"""Parameters of a vehicle's file that turn a place which is measured at the car into one relative to the centre of gravity. As attributes of a
drive they have the values by which that was done with the place of its sensor and its ``s``; a drive without them is told of any vehicle's own."""


def sensor_place(vehicle, *, behind_front_axle: float, above_wheel_centres: float, left: float = 0.0):
    """Place of a sensor in m relative to the centre of gravity of the sprung mass at rest: (x, y, z)."""
    mass = vehicle["sprung_mass"] + 2 * (vehicle["unsprung_mass_front"] + vehicle["unsprung_mass_rear"])
    deflection = STANDARD_GRAVITY * mass / 4 / vehicle["tyre_radial_stiffness"]
    wheel_centre = vehicle["tyre_radius"] - deflection
    return (
        vehicle["cg_to_front_axle"] - behind_front_axle,
        float(left),
        wheel_centre + above_wheel_centres - vehicle["cg_height"],
    )


def displacement(told_of: Mapping[str, float], vehicle) -> tuple[float, float]:
    """How much farther forward and up, in m, a point of the car lies from the centre of gravity of ``vehicle`` than from that of the one by which
    places were told (TOLD_OF; what is not told is as ``vehicle`` has it)."""
    names = [name for name in TOLD_OF if name in told_of]
    if all(told_of[name] == vehicle[name] for name in names):
        return 0.0, 0.0
    before = {name: told_of[name] if name in names else vehicle[name] for name in TOLD_OF}
    at_axle = {"behind_front_axle": 0.0, "above_wheel_centres": 0.0}
    (x, _, z), (x_before, _, z_before) = (sensor_place(one, **at_axle) for one in (vehicle, before))
    return x - x_before, z - z_before
