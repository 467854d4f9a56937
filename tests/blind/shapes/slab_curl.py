"""Concrete slabs that have curled since the road was scanned."""

from math import floor

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="slab_curl",
    sentence=(
        "Slabs of concrete curl with the warmth of the day: by night their joints stand higher than their middles, "
        "so that a road scanned at another hour is one bowl after another."
    ),
    source=(
        "Karamihas and Senn (2012), Curl and warp analysis of the LTPP SPS-2 site in Arizona, FHWA-HRT-12-068; "
        "Westergaard (1927), Analysis of stresses in concrete pavements due to variations of temperature; made for "
        "blind trials"
    ),
    port="road",
    parameters=(
        Parameter("curl", "m", 0.0, 0.0015, (-0.0075, 0.0075), "height of the joints above the middles of the slabs"),
        Parameter("length", "m", 4.6, 4.6, (3.5, 9.0), "length of a slab"),
    ),
)


def act(wheel, u, v, height, rotation, surface, elevation, curl, length):
    slabs = u / length
    place = 2.0 * (slabs - floor(slabs)) - 1.0
    return curl * (place * place - 1.0 / 3.0)
