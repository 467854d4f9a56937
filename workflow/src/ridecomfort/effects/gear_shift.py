"""Shifts of gear that interrupt the drive."""

from math import ceil, floor, log

from ridecomfort.effects.contract import Effect, Parameter

HYSTERESIS = 0.3
"""Gears; how far the speed falls below that of shifting up before the driver shifts down."""

BEGUN = 0.02
"""Gears from which on a shift up has begun: the car, slowed by it, does not take it back."""

GEARS = 6.0
"""Gears of the box; the state ``gear`` counts shifts up, from the first gear on."""

effect = Effect(
    name="gear_shift",
    sentence=(
        "While the gear is changed the engine drives less or not at all. Shifts come at speeds that grow by the same "
        "ratio from gear to gear."
    ),
    source="Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge; Kiencke and Nielsen (2005), Automotive Control Systems",
    port="drive",
    parameters=(
        Parameter("depth", "1", 0.0, 0.8, (0.0, 1.0), "share of the driving force that is lost during a shift"),
        Parameter("duration", "s", 0.4, 0.4, (0.05, 1.5), "time that a shift takes"),
        Parameter("first", "m/s", 5.0, 5.0, (2.0, 15.0), "speed of the first shift up"),
        Parameter("ratio", "1", 1.45, 1.45, (1.15, 2.0), "speed of a shift up over that of the one before"),
    ),
    states=("gear",),
)


def act(force, speed, gear, depth, duration, first, ratio):
    place = min(log(max(speed, 1.0) / first) / log(ratio) + 1.0, GEARS - 1.0)
    wanted = ceil(gear - BEGUN)
    if place >= wanted + 1.0 or place < wanted - HYSTERESIS:
        wanted = max(floor(place), 0.0)
    # The clutch is open until half a gear is left, then closes; a shift of one gear is over after its duration.
    missing = abs(wanted - gear)
    open_share = min(2.0 * missing, 1.0)
    return force - depth * open_share * max(force, 0.0), 3.0 / duration * (wanted - gear)
