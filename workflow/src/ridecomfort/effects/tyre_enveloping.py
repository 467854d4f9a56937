"""Tyres that feel the mean height under their contact."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vehicle.ground import height as height_at

PLACE = 0.5 / 3.0**0.5
"""Of the two points, in lengths from the middle: by Gauss and Legendre the mean of any cubic profile."""

effect = Effect(
    name="tyre_enveloping",
    sentence=(
        "A tyre rests on a contact of some length and feels the mean height under it: unevenness shorter than the "
        "contact is swallowed."
    ),
    source="Captain, Boghani and Wormley (1979), Analytical tire models for dynamic vehicle simulation, Vehicle System Dynamics 8",
    port="road",
    parameters=(Parameter("length", "m", 0.0, 0.12, (0.0, 0.2), "length of the contact"),),
)


def act(wheel, u, v, height, rotation, surface, elevation, length):
    aside = PLACE * length
    behind = height_at(surface, elevation, u - aside, v)
    return 0.5 * (behind + height_at(surface, elevation, u + aside, v))
