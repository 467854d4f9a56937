"""Tyres that feel the mean height under their contact."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vehicle.ground import height as height_at

PLACE, WEIGHT = 0.5 * 0.6**0.5, 5 / 18
"""Of the outer of three points, in lengths: by Gauss and Legendre the mean of any profile of fifth degree."""

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
    ahead = height_at(surface, elevation, u + aside, v)
    return WEIGHT * (behind + ahead - 2.0 * height)
