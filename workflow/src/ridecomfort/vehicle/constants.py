"""What the compiled kernel needs of a vehicle, worked out once per drive."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..vocabulary import STANDARD_GRAVITY
from .parameters import Vehicle

(X, Y, MASS, SPRING, DAMPING, ANTI_ROLL, ROLL_CENTRE, ROLL_ARM, SCRUB, STATIC_FORCE, STATIC_DEFLECTION, OVERTURNING) = range(12)
"""Rows of the table of wheels (`wheel_table`). ANTI_ROLL: N per metre of difference between the sides. ROLL_ARM: height
of the centre of gravity above the roll centre. SCRUB: how far the contact moves sideways per travel.
OVERTURNING: kg; what lifts a wheel per acceleration of its mass aside, which acts at its centre."""


class Constants(NamedTuple):
    """Scalars of a vehicle in SI units; ``per_`` marks a reciprocal, ``inverse_`` an entry of an inverse mass matrix."""

    sprung_mass: float
    total_mass: float
    unsprung_mass: float
    unsprung_x: float
    unsprung_roll: float
    pitch_arm: float
    cg_height: float
    wheelbase: float
    per_wheelbase: float
    per_track_front: float
    per_track_rear: float
    tyre_radius: float
    tyre_stiffness: float
    tyre_damping: float
    tyre_friction: float
    cornering_per_load: float
    slip_per_load: float
    spin_inertia: float
    drive_share_front: float
    brake_share_front: float
    inverse_yy: float
    inverse_yr: float
    inverse_yp: float
    inverse_rr: float
    inverse_rp: float
    inverse_pp: float
    inverse_xx: float
    inverse_xq: float
    inverse_qq: float


def wheel_table(vehicle: Vehicle) -> np.ndarray:
    """Constants of each wheel, shape (12, 4): front left, front right, rear left, rear right."""
    axles = lambda name: np.repeat([vehicle[f"{name}_front"], vehicle[f"{name}_rear"]], 2)
    front = vehicle["cg_to_front_axle"]
    rear = front - vehicle["wheelbase"]
    track, mass = axles("track"), axles("unsprung_mass")
    load = static_loads(vehicle)
    table = np.empty((12, 4))
    table[X] = [front, front, rear, rear]
    table[Y] = np.array([1, -1, 1, -1]) * track / 2
    table[MASS] = mass
    table[SPRING] = axles("spring_stiffness")
    table[DAMPING] = axles("damping")
    table[ANTI_ROLL] = axles("anti_roll_stiffness") / track**2
    table[ROLL_CENTRE] = axles("roll_centre_height")
    table[ROLL_ARM] = vehicle["cg_height"] - axles("roll_centre_height")
    table[SCRUB] = axles("roll_centre_height") / table[Y]
    table[STATIC_FORCE] = load
    table[STATIC_DEFLECTION] = (load + mass * STANDARD_GRAVITY) / vehicle["tyre_radial_stiffness"]
    table[OVERTURNING] = mass * vehicle["tyre_radius"] / table[Y]
    return table


def static_loads(vehicle: Vehicle) -> np.ndarray:
    """Force in N that each suspension carries at rest on level ground, shape (4,)."""
    rear = vehicle["cg_to_front_axle"] / vehicle["wheelbase"]
    share = np.array([1 - rear, 1 - rear, rear, rear]) / 2
    return vehicle["sprung_mass"] * STANDARD_GRAVITY * share


def pitch_arm(vehicle: Vehicle) -> float:
    """Height in m of the centre of gravity of the sprung mass above the wheel centres, tyres not pressed in: 1 to 2 cm less than at rest."""
    return vehicle["cg_height"] - vehicle["tyre_radius"]


def lateral_mass_matrix(vehicle: Vehicle) -> np.ndarray:
    """Mass matrix of lateral speed, yaw rate and roll rate, shape (3, 3).

    The wheels follow the body sideways at their roll centre, so rolling moves them.
    """
    wheels = wheel_table(vehicle)
    coupling = np.stack([np.ones(4), wheels[X], wheels[ROLL_ARM]])
    matrix = (coupling * wheels[MASS]) @ coupling.T
    matrix[0, 0] += vehicle["sprung_mass"]
    matrix[1, 1] += vehicle["yaw_inertia"] + np.sum(wheels[MASS] * wheels[Y] ** 2)
    matrix[2, 2] += vehicle["roll_inertia"]
    return matrix


def longitudinal_mass_matrix(vehicle: Vehicle) -> np.ndarray:
    """Mass matrix of forward speed and pitch rate, shape (2, 2).

    The wheels follow the body forward at the height of their centres.
    """
    mass, arm = wheel_table(vehicle)[MASS].sum(), pitch_arm(vehicle)
    return np.array(
        [
            [vehicle["sprung_mass"] + mass, -mass * arm],
            [-mass * arm, vehicle["pitch_inertia"] + mass * arm**2],
        ]
    )


def constants(vehicle: Vehicle) -> Constants:
    """The vehicle's scalars as the kernel takes them."""
    wheels = wheel_table(vehicle)
    mass = wheels[MASS]
    lateral = np.linalg.inv(lateral_mass_matrix(vehicle))
    longitudinal = np.linalg.inv(longitudinal_mass_matrix(vehicle))
    return Constants(
        sprung_mass=vehicle["sprung_mass"],
        total_mass=float(vehicle["sprung_mass"] + mass.sum()),
        unsprung_mass=float(mass.sum()),
        unsprung_x=float(mass @ wheels[X]),
        unsprung_roll=float(mass @ wheels[ROLL_ARM]),
        pitch_arm=pitch_arm(vehicle),
        cg_height=vehicle["cg_height"],
        wheelbase=vehicle["wheelbase"],
        per_wheelbase=1.0 / vehicle["wheelbase"],
        per_track_front=1.0 / vehicle["track_front"],
        per_track_rear=1.0 / vehicle["track_rear"],
        tyre_radius=vehicle["tyre_radius"],
        tyre_stiffness=vehicle["tyre_radial_stiffness"],
        tyre_damping=vehicle["tyre_radial_damping"],
        tyre_friction=vehicle["tyre_friction"],
        cornering_per_load=vehicle["cornering_stiffness"] / vehicle["tyre_reference_load"],
        slip_per_load=vehicle["longitudinal_slip_stiffness"] / vehicle["tyre_reference_load"],
        spin_inertia=vehicle["wheel_spin_inertia"],
        drive_share_front=vehicle["drive_share_front"],
        brake_share_front=vehicle["brake_share_front"],
        inverse_yy=float(lateral[0, 0]),
        inverse_yr=float(lateral[0, 1]),
        inverse_yp=float(lateral[0, 2]),
        inverse_rr=float(lateral[1, 1]),
        inverse_rp=float(lateral[1, 2]),
        inverse_pp=float(lateral[2, 2]),
        inverse_xx=float(longitudinal[0, 0]),
        inverse_xq=float(longitudinal[0, 1]),
        inverse_qq=float(longitudinal[1, 1]),
    )
