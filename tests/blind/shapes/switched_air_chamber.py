"""Air springs whose further chamber is shut off on a rough stretch."""

from ridecomfort.effects.contract import Effect, Parameter

VALVE = 0.03
"""s in which the valve of a chamber moves."""

OPEN = 0.02
"""s in which the pressures come to equal while the chamber is open."""

LEAK = 4.0
"""s in which a shut valve lets them."""

effect = Effect(
    name="switched_air_chamber",
    sentence=(
        "An air spring of several chambers is soft while all are open; the controller shuts one off when its wheel has been "
        "moving fast for a moment, and the spring is harder, about the place where the wheel then is, until it has come to rest."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: air springs with switched volumes; multi-chamber springs as in cars of "
        "Mercedes-Benz and Porsche since 2016; law and sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.4, (0.0, 1.5), "stiffness that a front spring gains with the chamber shut, over that when open"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 1.5), "stiffness that a rear spring gains with the chamber shut, over that when open"),
        Parameter("threshold", "m/s", 0.1, 0.1, (0.03, 0.4), "rms speed of travel at which the chamber is half shut"),
        Parameter("memory", "s", 0.4, 0.4, (0.1, 2.0), "time over which the controller takes the speed"),
    ),
    states=("moved", "shut", "place"),
)


def act(
    wheel, deflection, velocity, stiffness, damping, force_x, force_y, moved, shut, place, front, rear, threshold, memory
):
    square = threshold * threshold
    wanted = min(max(1.5 * moved / square - 1.0, 0.0), 1.0)
    away = deflection - place
    gain = front if wheel < 2 else rear
    slope = away * ((1.0 - shut) / OPEN + 1.0 / LEAK)
    return gain * shut * stiffness * away, (velocity * velocity - moved) / memory, (wanted - shut) / VALVE, slope
