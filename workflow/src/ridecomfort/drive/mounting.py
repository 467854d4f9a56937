"""How an inertial unit sits in the vehicle: tilt, gain of its accelerometers, bias of its gyroscopes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from ..vocabulary import SIGNALS, STANDARD_GRAVITY
from . import record
from .replay import Replay, Simulated

EXPECTED = np.array([0.01, 0.03, 0.03, 0.03, 0.02, 0.02, 0.02])
"""Usual size of gain error, tilt (rad) and bias (rad/s): what the data do not show stays near zero."""

LEFT = np.array([0.002, 0.002, 0.002, 0.005, 5e-4, 5e-4, 5e-4])
"""Usual size of what is left of them after alignment."""

TURNED = np.radians(1.0)
"""rad by which an instrument sits otherwise than on the other drives from which on it was moved: a load tilts a body by half of that."""

LARGE = np.radians(25.0)
"""rad of yaw from which on an instrument may sit the other way round, or its axes be exchanged: gravity does not tell, and little turning does."""

FAR = np.radians(5.0)
"""rad from which on an instrument is told that is not turned back. One step of ``fit`` finds up to 0.6 deg of one that sits right, with a car whose springs
and dampers are 30 % wrong as well, 4 to 5 deg of one that is turned by 5, 6 to 8 of 10, and 10 to 13 of 15 to 40."""

INDEPENDENT = 0.5
"""s; residuals closer than this count as one observation against EXPECTED."""


@dataclass(frozen=True)
class Mounting:
    """Gain of the accelerometers, rotation of the instrument against the body (its axis times its angle in rad), bias of its rates (rad/s).

    What it reads of a vector of the body is that turned back by the rotation, times gain, for rates without gain, plus bias.
    """

    gain: float = 1.0
    rotation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    bias: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def then(self, step: Mounting) -> Mounting:
        """This mounting and a further one found behind it."""
        own = Rotation.from_rotvec(self.rotation)
        return Mounting(
            self.gain * step.gain,
            tuple((Rotation.from_rotvec(step.rotation) * own).as_rotvec()),
            tuple(self.bias + own.inv().apply(step.bias)),
        )

    def attributes(self) -> dict[str, float]:
        """Names of the vocabulary for a drive's attributes."""
        axes = ("roll", "pitch", "yaw")
        return {
            "acceleration_gain": float(self.gain),
            **{f"mounting_{axis}": float(angle) for axis, angle in zip(axes, self.rotation)},
            **{f"{axis}_rate_bias": float(value) for axis, value in zip(axes, self.bias)},
        }


def level(drive: xr.Dataset) -> xr.Dataset:
    """The drive with gravity, where it holds any, taken out as if it were level (roll = pitch = 0)."""
    result = drive.assign(a_z=drive["a_z"] - STANDARD_GRAVITY * int(drive.attrs["gravity"]))
    zero = xr.zeros_like(drive["a_z"])
    return result.assign(roll=zero, pitch=zero).assign_attrs(drive.attrs)


def fit(again: Replay, simulated: Simulated) -> Mounting:
    """Gain, rotation and bias that explain most of the difference between record and simulation.

    Linear least squares, every signal weighted by the variance of its residual; gravity
    dominates gain, roll and pitch, so that they hardly depend on the vehicle.
    """
    kept = again.compared
    difference = -again.residual(simulated)[:, kept]
    weights = 1 / (difference.var(axis=1) + 1e-8)
    columns = responses(simulated, bool(again.drive.attrs["gravity"]))[:, :, kept]
    weighted = columns * weights[:, None]
    normal = np.einsum("ist,jst->ij", weighted, columns)
    interval = again.time[1] - again.time[0]
    normal += np.diag(INDEPENDENT / interval / EXPECTED**2)
    solution = np.linalg.solve(normal, np.einsum("ist,st->i", weighted, difference))
    return Mounting(1 + solution[0], tuple(solution[1:4]), tuple(solution[4:]))


def responses(simulated: Simulated, gravity: bool = True) -> np.ndarray:
    """Change of what is measured, (7, 6, time), per gain, rotation (rad) and bias (rad/s) of the mounting; accelerations hold ``gravity`` or not."""
    force = simulated.signals[:3]
    if gravity:
        force = record.specific_force(force, simulated.roll, simulated.pitch)
    rates = simulated.signals[3:]
    columns = np.zeros((7, 6, force.shape[1]))
    columns[0, :3] = force
    for axis in range(3):
        unit = np.zeros((3, 1))
        unit[axis] = 1.0
        columns[1 + axis, :3] = -np.cross(np.broadcast_to(unit, force.shape), force, axis=0)
        columns[1 + axis, 3:] = -np.cross(np.broadcast_to(unit, rates.shape), rates, axis=0)
        columns[4 + axis, 3 + axis] = 1.0
    return columns


def corrected(drive: xr.Dataset, mounting: Mounting) -> xr.Dataset:
    """The drive as the same instrument would have recorded it without this mounting, gain and bias."""
    force = record.felt(drive) / mounting.gain
    rates = np.stack([drive[name].values for name in SIGNALS[3:]]) - np.array(mounting.bias)[:, None]
    turn = Rotation.from_rotvec(mounting.rotation).as_matrix()
    values = np.concatenate([record.acceleration(turn @ force, drive["roll"].values, drive["pitch"].values), turn @ rates])
    return drive.assign({name: drive[name].copy(data=row) for name, row in zip(SIGNALS, values)})


def words(mounting: Mounting) -> str:
    """Words on an instrument that is turned by a LARGE yaw; empty where it is not."""
    yaw = mounting.rotation[2]
    return f"the instrument is turned by {np.degrees(yaw):+.0f} deg in yaw: are a_x and a_y, roll_rate and pitch_rate right?" if abs(yaw) > LARGE else ""


def words_not_turned_back(again: Replay, simulated: Simulated) -> str:
    """Words on an instrument that looks turned by more than FAR though gravity is not in its accelerations, so that nothing turns it back; empty
    where it does not. How far it is turned one step of ``fit`` does not tell."""
    found = fit(again, simulated).rotation
    about = [axis for axis, angle in zip(("roll", "pitch", "yaw"), found) if abs(angle) > FAR]
    if not about:
        return ""
    return f"the instrument looks turned in {' and '.join(about)} by 8 deg or more, and is not turned back where accelerations hold no gravity: are its axes right?"


def moved(measured: xr.Dataset) -> list[str]:
    """Which of three aligned drives or more (``record.stack``) had its instrument mounted otherwise than the most of them, in words. Those whose
    accelerations hold no gravity are left out: their mounting is not sought."""
    axes = ("roll", "pitch", "yaw")
    if "gravity" in measured:
        measured = measured.isel(drive=measured["gravity"].values == 1)
    angles = np.stack([measured[f"mounting_{axis}"].values for axis in axes], axis=1)
    if len(angles) <= 2:
        return []
    said = []
    for name, off in zip(measured["drive"].values, angles - np.median(angles, axis=0)):
        if np.max(np.abs(off)) > TURNED:
            turned = ", ".join(f"{angle:+.1f} deg in {axis}" for axis, angle in zip(axes, np.degrees(off)))
            said.append(f"{name}: the instrument is turned by {turned} against the other drives: was it moved? (alignment turns it back)")
    return said
