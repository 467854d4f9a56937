"""Tyres whose stiffness is uneven twice a turn: a truth that the library does not hold."""

from math import cos

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_oval",
    sentence="Tyres that press harder twice a turn, each at an angle of its own.",
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics: tyre non-uniformity; made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("front", "N", 0.0, 60.0, (0.0, 400.0), "amplitude of the radial force of a front tyre"),
        Parameter("rear", "N", 0.0, 60.0, (0.0, 400.0), "amplitude of the radial force of a rear tyre"),
    ),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, front, rear):
    return (front if wheel < 2 else rear) * cos(2.0 * rotation + 2.4 * wheel)
