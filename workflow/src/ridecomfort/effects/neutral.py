"""The ports of the kernel with nothing connected: each hands back what it was given.

The kernel imports its ports from a module of this form. For a set of effects
``effects.compose`` writes one that calls them; this one is its empty case.

``parameters`` are the effects' values in the order of the set, ``states`` their
states and ``slopes`` where their time slopes are put.
"""

from __future__ import annotations

from numba import njit


@njit(forceinline=True, error_model="numpy", _nrt=False)
def road_port(wheel, u, v, height, rotation, surface, elevation, parameters, states, slopes):
    """Extra height in m that the tyre feels."""
    return 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def kinematics_port(wheel, deflection, parameters, states, slopes):
    """How far the wheel moves back per compression, in m/m, the angle in rad by which the links turn it to the left, and how far to the
    left it moves per compression, in m/m."""
    return 0.0, 0.0, 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def suspension_port(wheel, deflection, velocity, stiffness, damping, force_x, force_y, damper, parameters, states, slopes):
    """Extra force in N between body and wheel, positive pushing them apart, and the force in N of the damper, which starts as ``damper``."""
    return 0.0, damper


@njit(forceinline=True, error_model="numpy", _nrt=False)
def interconnection_port(
    wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across, deflection_opposite,
    velocity_opposite, parameters, states, slopes,
):  # fmt: skip
    """Extra force in N between body and wheel, positive pushing them apart, that other struts take part in."""
    return 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def tyre_vertical_port(wheel, deflection, velocity, stiffness, rest, rotation, spin, parameters, states, slopes):
    """Extra radial force in N of the tyre, positive pushing the wheel up, and one that is no part of its load."""
    return 0.0, 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def tyre_planar_port(wheel, slip_x, slip_y, load, speed, slope, force_x, surge, parameters, states, slopes):
    """Longitudinal slip and tangent of the slip angle that the tyre's force answers to, extra force in N forward."""
    return slip_x, slip_y, 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def body_port(motion, parameters, states, slopes):
    """Extra force (N) and moment (N m) on the sprung mass about its centre of gravity: x, y, z, x, y, z."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def flexing_port(motion, x, y, z, parameters, states, slopes):
    """Acceleration in m/s2 of the place (x, y, z) in m of the sensor against the rigid body."""
    return 0.0, 0.0, 0.0


@njit(forceinline=True, error_model="numpy", _nrt=False)
def drive_port(force, speed, parameters, states, slopes):
    """Driving force in N at the wheels for the force that the driver asks for."""
    return force


@njit(forceinline=True, error_model="numpy", _nrt=False)
def steer_port(angle, speed, force_y, parameters, states, slopes):
    """Angle in rad of the front wheels for the angle that the driver asks for."""
    return angle
