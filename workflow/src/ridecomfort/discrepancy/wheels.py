"""What suspension and tyres do in a drive, and the road under them, by a wheel that moves linearly between body and road.

The simulated motion of the body and the road under each wheel determine how the wheel moves; no wheel is recorded. Good
enough to sort errors by, not to compute forces from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..road import surface

LOWEST = 0.3
"""Hz below which the motion of the body, which is integrated from its acceleration, is left out."""


@dataclass(frozen=True)
class Wheels:
    """Vertical motion over time, each (time,) but ``road`` (wheel, time) in m under front left, front right, rear left, rear right.

    ``suspension_velocity`` and ``tyre_velocity`` in m/s are root mean squares over the wheels of compression per second.
    """

    road: np.ndarray
    suspension_velocity: np.ndarray
    tyre_velocity: np.ndarray

    def heave(self) -> np.ndarray:
        """Mean height of the road under the front wheels, m."""
        return self.road[:2].mean(axis=0)

    def tilt(self) -> np.ndarray:
        """Height of the road under the front left wheel above that under the right one, m."""
        return self.road[0] - self.road[1]


def wheels(road, vehicle, place, lateral, rate: float, a_z, roll_rate, pitch_rate, sensor) -> Wheels:
    """How the wheels of ``vehicle`` move at the places (m along and to the left of the reference line) of a drive.

    ``a_z`` (m/s2), ``roll_rate`` and ``pitch_rate`` (rad/s) are those of a simulated drive at equal times, ``rate`` in
    Hz, recorded at ``sensor`` (m from the centre of gravity). All arrays have the shape (time,).
    """
    ahead = {"front": vehicle["cg_to_front_axle"], "rear": vehicle["cg_to_front_axle"] - vehicle["wheelbase"]}
    corners = [(x, side * 0.5 * vehicle[f"track_{axle}"], axle) for axle, x in ahead.items() for side in (1, -1)]
    frequency = np.fft.rfftfreq(2 * len(place), 1.0 / rate)
    omega = 2j * np.pi * frequency
    kept = frequency > LOWEST
    heights = np.stack([_known(surface.height(road, place + x, lateral + y)) for x, y, _ in corners])
    sensed = np.where(kept, _transform(a_z) / np.where(kept, omega, 1.0), 0.0)
    roll, pitch = _transform(roll_rate), _transform(pitch_rate)
    suspension, tyre = [], []
    for (x, y, axle), height in zip(corners, heights):
        ground = np.where(kept, omega * _transform(height), 0.0)
        body = np.where(kept, sensed + roll * (y - sensor[1]) - pitch * (x - sensor[0]), 0.0)
        mass, spring = vehicle[f"unsprung_mass_{axle}"], vehicle[f"spring_stiffness_{axle}"]
        strut = spring + omega * vehicle[f"damping_{axle}"]
        contact = vehicle["tyre_radial_stiffness"] + omega * vehicle["tyre_radial_damping"]
        wheel = (contact * ground + strut * body) / (contact + strut + mass * omega**2)
        suspension.append(np.fft.irfft(wheel - body)[: len(place)])
        tyre.append(np.fft.irfft(ground - wheel)[: len(place)])
    return Wheels(heights, *(np.sqrt(np.mean(np.square(each), axis=0)) for each in (suspension, tyre)))


def _known(heights: np.ndarray) -> np.ndarray:
    """Heights with those beyond the road's edges taken from the nearest place that has one."""
    there = np.flatnonzero(np.isfinite(heights))
    return np.interp(np.arange(len(heights)), there, heights[there]) if there.size else np.zeros(len(heights))


def _transform(series: np.ndarray) -> np.ndarray:
    """Spectrum of a series mirrored at its end, so that its ends do not leap."""
    series = np.asarray(series, dtype=float)
    return np.fft.rfft(np.concatenate([series, series[::-1]]))
