"""Tyres that hold against being pressed: a truth that the library does not hold."""

from math import tanh

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_hysteresis",
    sentence="The rubber of a tyre resists every change of its deflection with a force that hardly depends on the rate.",
    source="Pacejka (2012), Tire and Vehicle Dynamics; made for blind trials",
    port="tyre_vertical",
    parameters=(Parameter("force", "N", 0.0, 120.0, (0.0, 1000.0), "force that it levels off at"),),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, force):
    return force * tanh(velocity / 0.03)
