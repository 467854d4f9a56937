"""What an effect is: a name, a sentence, a source, parameters, a port and a function.

An effect is one file with two names in it: ``effect``, an Effect, and ``act``, a function
of plain numbers. ``act`` takes what its port sees (``PORTS``), then its own states, then its
parameters in the order declared, and returns what the port returns, followed by the time
derivatives of its states. It must be a function that numba can compile, except at the
ports ``vehicle`` and ``sensor``, which work on whole vehicles and drives in Python.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Port:
    """A place where physics can be missing: what it sees, what it returns, how effects join there."""

    sees: tuple[str, ...]
    returns: tuple[str, ...]
    joined: str
    """``sum``: results of all effects add up; ``chain``: each changes what the one before returned."""
    per_wheel: bool
    meaning: str


PORTS: Mapping[str, Port] = MappingProxyType(
    {
        "road": Port(
            ("wheel", "u", "v", "height", "surface", "elevation"),
            ("height",),
            "chain",
            True,
            "height in m that a tyre feels; `vehicle.ground.height(surface, elevation, u, v)` looks around it",
        ),
        "suspension": Port(
            ("wheel", "deflection", "velocity", "force_x", "force_y"),
            ("force",),
            "sum",
            True,
            "extra force in N between body and wheel, positive pushing apart; deflection from rest and velocity "
            "(m, m/s) positive in compression; force_x, force_y of the tyre (N)",
        ),
        "tyre_vertical": Port(
            ("wheel", "deflection", "velocity", "rotation"),
            ("force",),
            "sum",
            True,
            "extra radial force in N, positive pushing the wheel up; deflection and its rate, turn of the wheel in rad",
        ),
        "tyre_planar": Port(
            ("wheel", "slip_x", "slip_y", "load", "speed"),
            ("slip_x", "slip_y"),
            "chain",
            True,
            "longitudinal slip and tangent of the slip angle that the tyre answers to; load in N, speed in m/s",
        ),
        "body": Port(
            ("motion",),
            ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"),
            "sum",
            False,
            "extra force (N) and moment (N m) on the sprung mass about its centre of gravity; `motion`: vehicle.motion.BodyMotion",
        ),
        "drive": Port(
            ("force", "speed"), ("force",), "chain", False,
            "driving force in N that reaches the wheels for the force asked for",
        ),
        "steer": Port(
            ("angle", "speed", "force_y"), ("angle",), "chain", False,
            "angle in rad of the front wheels for the angle asked for; force_y: of the front tyres in N",
        ),
        "vehicle": Port(
            ("vehicle",), ("vehicle",), "chain", False,
            "a vehicle with changed parameters (in Python; `vehicle.parameters.Vehicle`)",
        ),
        "sensor": Port(
            ("drive",), ("drive",), "chain", False,
            "what the instrument records of a simulated drive (in Python; an xarray Dataset over time)",
        ),
    }
)  # fmt: skip

COMPILED = tuple(name for name in PORTS if name not in ("vehicle", "sensor"))
"""Ports inside the compiled kernel, in the order of its imports."""


@dataclass(frozen=True)
class Parameter:
    """A size of an effect: unit, the value at which it changes nothing, a usual one, what is plausible."""

    name: str
    unit: str
    neutral: float
    typical: float
    plausible: tuple[float, float]
    meaning: str


@dataclass(frozen=True)
class Effect:
    """A physical effect that a real car has and the base model lacks."""

    name: str
    sentence: str
    source: str
    port: str
    parameters: tuple[Parameter, ...]
    states: tuple[str, ...] = ()
    """Names of its own states (for each wheel, at a wheel's port), all zero at the start."""
    dissipative: bool = False
    """Whether it can only take energy out of the car."""

    def values(self, sizes: Mapping[str, float] | None = None) -> dict[str, float]:
        """A value for every parameter: those given, and the typical one for the rest."""
        values = {parameter.name: parameter.typical for parameter in self.parameters}
        values.update(sizes or {})
        return values

    @property
    def neutral(self) -> dict[str, float]:
        """The values at which the effect changes nothing."""
        return {parameter.name: parameter.neutral for parameter in self.parameters}
