"""What a force may depend on, as curves that are straight between knots, written as effect files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..effects.contract import PORTS
from .experiment import Candidate, Size
from .places import FORCE
from .terms import AXLES, SIDE

LINE, REST, LEVEL = "line", "rest", "level"
"""What of a curve no drive knows: its value at rest and a line through it, its value at rest alone, or, of what has no rest, its level."""

USUAL = 500.0
"""N; usual size of a missing force, which is probed with FORCE."""


@dataclass(frozen=True)
class Seen:
    """What something that the model lacks at a wheel may depend on.

    ``expression``: in what the ``port`` sees, with its ``unit``, and ``axis``, what that means; ``knots`` of the curve; ``lacks``: what the
    model lacks there, in ``lacks_unit``, with its ``usual`` size. ``returns``: what the port returns, by the value ``y`` of the curve of the
    wheel's axle. ``open``: LINE, REST or LEVEL.
    """

    port: str
    expression: str
    unit: str
    axis: str
    knots: tuple[float, ...]
    returns: tuple[str, ...] = ("y",)
    lacks: str = "missing force, pushing apart"
    lacks_unit: str = "N"
    usual: float = USUAL
    open: str = LINE

    @property
    def probe(self) -> float:
        """What the curve is probed with at each knot."""
        return self.usual * FORCE / USUAL


SEEN: Mapping[str, Seen] = {
    "strut velocity": Seen(
        "suspension", "velocity", "m/s", "strut velocity, in compression",
        (-0.6, -0.3, -0.12, -0.04, -0.01, 0.0, 0.01, 0.04, 0.12, 0.3, 0.6),
    ),
    "strut deflection": Seen(
        "suspension", "deflection", "m", "strut deflection, in compression",
        (-0.05, -0.03, -0.015, -0.005, 0.0, 0.005, 0.015, 0.03, 0.05),
    ),
    **{
        f"strut against {other}": Seen(
            "interconnection", f"velocity - velocity_{which}", "m/s", f"velocity against {other}",
            (-0.6, -0.3, -0.12, -0.04, 0.0, 0.04, 0.12, 0.3, 0.6), open=REST,
        )
        for which, other in (("along", "other axle"), ("across", "other side"), ("opposite", "diagonal"))
    },
    "tyre deflection": Seen(
        "tyre_vertical", "deflection - rest", "m", "tyre deflection, in compression",
        (-0.015, -0.008, -0.004, 0.0, 0.004, 0.008, 0.015),
    ),
    "slip angle": Seen(
        "tyre_planar", "slip_y", "rad", "slip angle, pushing left", (-0.04, -0.02, -0.01, -0.004, 0.0, 0.004, 0.01, 0.02, 0.04),
        ("slip_x", "slip_y + y", "0.0"), "missing slip angle", "rad", 0.006,
    ),
    "tyre load": Seen(
        "tyre_planar", "load", "N", "tyre load", (1500.0, 2500.0, 3500.0, 4500.0, 5500.0, 6500.0),
        ("slip_x", "slip_y * (1.0 + y)", "0.0"), "missing cornering stiffness", "1", 0.3, LEVEL,
    ),
    "wheel travel": Seen(
        "kinematics", "deflection", "m", "wheel travel, in compression", (-0.05, -0.03, -0.015, 0.0, 0.015, 0.03, 0.05),
        ("0.0", f"y * {SIDE}", "0.0"), "missing toe-out", "rad", 0.006, LEVEL,
    ),
}  # fmt: skip

ALWAYS = ("suspension", "tyre_vertical")
"""Ports whose curves are estimated whatever is named: that of nearly all that shakes a body."""


def at(ports: Sequence[str]) -> dict[str, Seen]:
    """What may be drawn where effects act at these ports."""
    return {label: seen for label, seen in SEEN.items() if seen.port in (*ALWAYS, *ports)}


def candidate(name: str, seen: Seen) -> Candidate:
    """A curve as what a search may probe: its sizes are its values at the knots."""
    keys = (f"{name}.{axle}_{knot}" for axle in AXLES for knot in range(len(seen.knots)))
    reach = 10.0 * seen.usual
    return Candidate(name, tuple(Size(key, seen.lacks_unit, 0.0, -reach, reach, seen.probe) for key in keys))


def row(key: str, seen: Seen) -> int:
    """Where the value at a knot, by the key of its size, stands among those of both axles."""
    axle, _, knot = key.partition(".")[2].partition("_")
    return AXLES.index(axle) * len(seen.knots) + int(knot)


def source(name: str, seen: Seen) -> str:
    """Text of an effect file (``effects.contract``) that is a curve over knots for each axle."""
    own = [f"{axle}_{knot}" for axle in AXLES for knot in range(len(seen.knots))]
    unit, reach = seen.lacks_unit, 10.0 * seen.usual
    parameters = "\n".join(
        f'        Parameter("{one}", "{unit}", 0.0, {seen.probe}, ({-reach}, {reach}), "value at a knot of the curve"),' for one in own
    )
    lines = [line for axle in AXLES for line in _along(axle, seen.knots)]
    return (
        f'"""A curve over {seen.expression}."""\n\nfrom ridecomfort.effects.contract import Effect, Parameter\n\n'
        f'effect = Effect(\n    name="{name}",\n    sentence="A curve that is looked for.",\n    source="none",\n'
        f'    port="{seen.port}",\n    parameters=(\n{parameters}\n    ),\n)\n\n\n'
        f"def act({', '.join((*PORTS[seen.port].sees, *own))}):\n    x = {seen.expression}\n" + "\n".join(lines)
        + f"\n    y = front if wheel < 2 else rear\n    return {', '.join(seen.returns)}\n"
    )


def _along(axle: str, knots: Sequence[float]) -> list[str]:
    """Lines that put the value of an axle's curve at ``x`` into the name of the axle; flat beyond the last knots."""
    lines = [f"    {axle} = {axle}_0"]
    for k, (low, high) in enumerate(zip(knots[:-1], knots[1:])):
        value = f"{axle}_{k} + (min(x, {high}) - ({low})) / ({high - low}) * ({axle}_{k + 1} - {axle}_{k})"
        lines += [f"    if x > {low}:", f"        {axle} = {value}"]
    return lines
