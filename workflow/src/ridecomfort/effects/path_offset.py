"""A path that lies elsewhere than it was recorded."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="path_offset",
    sentence=(
        "The car drives to the left of where its record says, as with an antenna off its known place or a road "
        "scanned in other coordinates, and so meets other heights."
    ),
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: errors of satellite positions",
    port="path",
    parameters=(
        Parameter("offset", "m", 0.0, 0.1, (-1.0, 1.0), "how far to the left of the recorded path the car drives"),
    ),
    symmetric=False,
)


def act(lateral, u, offset):
    return lateral + offset
