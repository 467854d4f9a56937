"""Local defects of a stand-in road: patches, potholes, joints and settlements."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

WHEEL_TRACK = 0.75
"""m from the middle of the lane to either wheel track (EN 13036-5 measures there)."""

EDGE = 0.2
"""m over which the edge of a patch or joint rises or falls."""


@dataclass(frozen=True)
class Defect:
    """One defect: ``u`` and ``v`` of its middle, length along u, width along v, height (negative: a dip); all in m."""

    kind: str
    u: float
    v: float
    length: float
    width: float
    height: float

    def record(self) -> dict:
        """The defect as a plain dict, rounded to a tenth of a millimetre."""
        return {name: value if isinstance(value, str) else round(value, 4) for name, value in asdict(self).items()}


def draw(rng: np.random.Generator, kind: str, u: float, width: float) -> Defect:
    """A defect of a kind at ``u`` on a road ``width`` m wide.

    Orders of size: potholes 150 to 750 mm across and 13 to 50 mm deep (ASTM D6433, low and medium
    severity). The others are judgement: patches of a repair or trench 3 to 10 mm proud or low, transverse
    joints and sealed cracks 1.5 to 4 mm, settlements over culverts 5 to 20 mm in 8 to 20 m.
    """
    side = rng.choice([-1.0, 1.0])
    if kind == "pothole":
        across = rng.uniform(0.35, 0.75)
        v = side * WHEEL_TRACK + rng.normal(0.0, 0.15)
        return Defect(kind, u, v, across * rng.uniform(0.9, 1.4), across, -rng.uniform(0.013, 0.05))
    if kind == "patch":
        broad = rng.uniform(0.9, 2.0)
        v = side * (0.5 * width - 0.5 * broad - rng.uniform(0.0, 0.3))
        return Defect(kind, u, v, rng.uniform(1.5, 8.0), broad, side_of(rng) * rng.uniform(0.003, 0.010))
    if kind == "joint":
        return Defect(kind, u, 0.0, 0.3, 2.0 * width, side_of(rng) * rng.uniform(0.0015, 0.004))
    if kind == "settlement":
        v = rng.normal(0.0, 0.5)
        return Defect(kind, u, v, rng.uniform(8.0, 20.0), rng.uniform(1.2, 2.0) * width, -rng.uniform(0.005, 0.02))
    raise ValueError(f"no defect of kind {kind!r}, expected pothole, patch, joint or settlement")


def side_of(rng) -> float:
    """-1 or 1, drawn evenly."""
    return float(rng.choice([-1.0, 1.0]))


def add(elevation: np.ndarray, u: np.ndarray, v: np.ndarray, defect: Defect) -> None:
    """Add a defect to ``elevation`` (u, v) in place."""
    reach = 0.5 * defect.length + EDGE
    first, last = np.searchsorted(u, [defect.u - reach, defect.u + reach])
    along = u[first:last] - defect.u
    across = v - defect.v
    if defect.kind in ("pothole", "settlement"):
        r = np.hypot(2.0 * along[:, None] / defect.length, 2.0 * across[None, :] / defect.width)
        shape = np.where(r < 1.0, 0.5 * (1.0 + np.cos(np.pi * np.minimum(r, 1.0))), 0.0)
    else:
        shape = plateau(along, defect.length)[:, None] * plateau(across, defect.width)[None, :]
    elevation[first:last] += defect.height * shape


def plateau(distance: np.ndarray, length: float) -> np.ndarray:
    """1 inside ``length`` (centred), 0 outside, with a raised cosine of width EDGE about either border."""
    inside = np.clip((0.5 * length + 0.5 * EDGE - np.abs(distance)) / EDGE, 0.0, 1.0)
    return 0.5 * (1.0 - np.cos(np.pi * inside))
