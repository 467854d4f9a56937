"""Dampers whose blow-off valve pops open and stays so."""

from ridecomfort.effects.contract import Effect, Parameter

MOVING = 0.01
"""s in which the plate of the valve moves."""

EDGE = 0.4
"""Share of the opening speed over which the pressure moves the plate."""

effect = Effect(
    name="latching_valve",
    sentence=(
        "The plate of a blow-off valve pops open at some pressure and offers it more area from then on: it closes only when the damper "
        "has almost come to rest, and the rest of a fast stroke is damped less on its way down than on its way up."
    ),
    source=(
        "Dixon (2007), The Shock Absorber Handbook: valve areas open and closed, poppet hysteresis; Lang (1977), A study of the "
        "characteristics of automotive hydraulic dampers at high stroking frequencies, University of Michigan; sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.5, (0.0, 0.9), "share of the damping that an open front valve takes"),
        Parameter("rear", "1", 0.0, 0.5, (0.0, 0.9), "share of the damping that an open rear valve takes"),
        Parameter("opening", "m/s", 0.06, 0.06, (0.02, 0.4), "speed at which a valve opens"),
        Parameter("closing", "1", 0.3, 0.3, (0.1, 0.8), "speed at which it closes, over that at which it opens"),
    ),
    states=("opened",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, opened, front, rear, opening, closing):
    limit = opening * (1.0 - (1.0 - closing) * opened)
    wanted = min(max((abs(velocity) - limit) / (EDGE * opening) + 0.5, 0.0), 1.0)
    return -(front if wheel < 2 else rear) * damping * opened * velocity, (wanted - opened) / MOVING
