"""Tyres that bridge short holes but climb short bumps."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vehicle.ground import height as height_at

effect = Effect(
    name="tyre_bridging",
    sentence=(
        "A tyre spans a hole that is shorter than its contact like a beam and does not fall to its bottom; a bump of the same "
        "length it climbs in full."
    ),
    source="Wong (2008), Theory of Ground Vehicles, and Captain, Boghani and Wormley (1979): geometric filtering by the tyre; form and sizes made for blind trials",
    port="road",
    parameters=(
        Parameter("share", "1", 0.0, 0.8, (0.0, 1.0), "share of the depth under the chord that is bridged"),
        Parameter("length", "m", 0.16, 0.16, (0.06, 0.3), "length of the chord"),
    ),
)


def act(wheel, u, v, height, rotation, surface, elevation, share, length):
    behind = height_at(surface, elevation, u - 0.5 * length, v)
    ahead = height_at(surface, elevation, u + 0.5 * length, v)
    return share * max(0.5 * (behind + ahead) - height, 0.0)
