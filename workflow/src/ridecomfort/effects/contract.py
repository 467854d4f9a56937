"""What an effect is: a name, a sentence, a source, parameters, a port and a function.

An effect is one file with two names in it: ``effect``, an Effect, and ``act``, a function
of plain numbers. ``act`` takes what its port sees (``PORTS``), then its own states, then its
parameters in the order declared, and returns what the port returns, followed by the time
derivatives of its states. It must be a function that numba can compile, except at the
ports of ``IN_PYTHON``, which work on whole vehicles, paths and drives. What a port returns
under a name that it also sees is handed from effect to effect, each changing what the one
before returned, in their ``order`` and within that by name; what it does not see is added up over the effects.

Some ports have more to see and to return than most effects ask for (``may_see``, ``may_return``). An effect that does names it in
``also_sees`` and ``also_returns``; ``act`` takes it behind what its port sees and returns it behind what its port returns. What is added
up over the effects is seen as the sum so far.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType


@dataclass(frozen=True)
class Port:
    """A place where physics can be missing: what it sees and what it returns."""

    sees: tuple[str, ...]
    returns: tuple[str, ...]
    per_wheel: bool
    meaning: str
    may_see: tuple[str, ...] = ()
    may_return: tuple[str, ...] = ()


PORTS: Mapping[str, Port] = MappingProxyType(
    {
        "road": Port(
            ("wheel", "u", "v", "height", "rotation", "surface", "elevation"),
            ("rise",),
            True,
            "extra height in m that a tyre feels; height of the road at (u, v), which "
            "`vehicle.ground.height(surface, elevation, u, v)` gives elsewhere; turn of the wheel in rad",
        ),
        "kinematics": Port(
            ("wheel", "deflection"),
            ("recession", "toe", "scrub"),
            True,
            "how the links lead a wheel that is compressed by `deflection` from rest (m): `recession`, how far it moves back per "
            "compression (m/m), `toe`, the angle in rad by which it is turned to the left, and `scrub`, how far to the left it "
            "moves per compression (m/m; beside that of its roll centre)",
        ),
        "suspension": Port(
            ("wheel", "deflection", "velocity", "stiffness", "damping", "force_x", "force_y"),
            ("force",),
            True,
            "extra force in N between body and wheel, positive pushing apart; deflection from rest and velocity "
            "(m, m/s) positive in compression; stiffness and damping of this corner's spring and damper (N/m, N s/m); "
            "force_x, force_y of the tyre (N). Handed on where asked for: `damper`, the force in N of the damper, damping times velocity to "
            "begin with",
            ("damper",),
            ("damper",),
        ),
        "interconnection": Port(
            (
                "wheel", "deflection", "velocity", "deflection_along", "velocity_along", "deflection_across", "velocity_across",
                "deflection_opposite", "velocity_opposite",
            ),
            ("force",),
            True,
            "extra force in N between body and wheel, positive pushing apart, that other struts take part in; deflection from rest and "
            "velocity (m, m/s), positive in compression, of this strut, of that `along` the car on its side, of that `across` on its axle, "
            "and of that `opposite` to it in both",
        ),  # fmt: skip
        "tyre_vertical": Port(
            ("wheel", "deflection", "velocity", "stiffness", "rest", "rotation", "spin"),
            ("force",),
            True,
            "extra radial force in N, positive pushing the wheel up; deflection and velocity (m, m/s), positive pressed; radial stiffness (N/m), "
            "deflection at rest (m); turn (rad) and spin (rad/s) of the wheel. Where asked for: `shake`, a force in N that lifts the wheel "
            "without the tyre, as its inertia does, and is no part of its load",
            may_return=("shake",),
        ),
        "tyre_planar": Port(
            ("wheel", "slip_x", "slip_y", "load", "speed", "slope", "force_x"),
            ("slip_x", "slip_y", "pull"),
            True,
            "longitudinal slip and tangent of the slip angle that the tyre answers to, and extra force in N that pulls "
            "the axle forward; load in N, speed in m/s, slope of the road under this wheel against the plane under "
            "all four, force_x that the tyre had the step before (N). Where asked for: `surge`, the acceleration forward of the body where "
            "the wheel is (m/s2), and the `pull` so far",
            ("surge", "pull"),
        ),
        "body": Port(
            ("motion",),
            ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"),
            False,
            "extra force (N) and moment (N m) on the sprung mass about its centre of gravity; `motion`: vehicle.motion.BodyMotion",
        ),
        "flexing": Port(
            ("motion", "x", "y", "z"),
            ("a_x", "a_y", "a_z"),
            False,
            "acceleration in m/s2 of the place (x, y, z) of the sensor against the rigid body; places in m from the "
            "centre of gravity",
        ),
        "drive": Port(
            ("force", "speed"),
            ("force",),
            False,
            "driving force in N that reaches the wheels for the force asked for, negative when braking; speed in m/s",
        ),
        "steer": Port(
            ("angle", "speed", "force_y"),
            ("angle",),
            False,
            "angle in rad of the front wheels, positive to the left, for the angle asked for; speed in m/s; force_y: of both front tyres in N, "
            "positive to the left",
        ),
        "vehicle": Port(
            ("vehicle",),
            ("vehicle",),
            False,
            "a vehicle with changed parameters (in Python; `vehicle.parameters.Vehicle`)",
        ),
        "path": Port(
            ("lateral", "u"),
            ("lateral",),
            False,
            "lateral position in m that is really driven where the record says `lateral` (in Python; arrays over u)",
        ),
        "sensor": Port(
            ("drive",),
            ("drive",),
            False,
            "what the instrument records of a simulated drive (in Python; an xarray Dataset over time)",
        ),
    }
)

IN_PYTHON = ("vehicle", "path", "sensor")
"""Ports outside the compiled kernel."""

COMPILED = tuple(name for name in PORTS if name not in IN_PYTHON)
"""Ports inside the compiled kernel."""


@dataclass(frozen=True)
class Parameter:
    """A size of an effect: unit, the value at which it changes nothing, a usual one, what is plausible.

    Where ``neutral`` equals ``typical`` the parameter is no size: it only shapes the effect. But beside a size of the same unit and the same
    ``neutral`` it is a size, too, one that is typically nil.
    """

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
    symmetric: bool = True
    """Whether left and right are alike to it, so that a mirrored road gives a mirrored drive."""
    order: int = 0
    """Place among the effects of its port where values are handed on: a greater one comes later, as a lag behind what it delays."""
    also_sees: tuple[str, ...] = ()
    """What it takes of what its port may see."""
    also_returns: tuple[str, ...] = ()
    """What it returns of what its port may return."""
    also_probed: tuple[float, ...] = ()
    """Times its typical sizes that it is looked for with beside a quarter of these, where large ones do something else than small ones."""

    @property
    def rank(self) -> tuple[int, str]:
        """What effects are sorted by: order, then name."""
        return self.order, self.name

    def values(self, sizes: Mapping[str, float] | None = None) -> dict[str, float]:
        """A value for every parameter: those given, and the typical one for the rest."""
        values = {parameter.name: parameter.typical for parameter in self.parameters}
        values.update(sizes or {})
        return values

    @cached_property
    def neutral(self) -> Mapping[str, float]:
        """The values at which the effect changes nothing."""
        return {parameter.name: parameter.neutral for parameter in self.parameters}
