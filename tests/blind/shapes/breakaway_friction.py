"""Friction that holds harder before it slides."""

from math import exp

from ridecomfort.effects.contract import Effect, Parameter

EDGE = 0.002
"""m/s over which the force turns with the direction of motion."""

STICKING = 20000.0
"""N s/m; what does not slide is no stiffer damper than this, which a wheel can follow at a step of 1 ms."""

effect = Effect(
    name="breakaway_friction",
    sentence=(
        "Seals and ball joints that have come to rest break away at a high force, which falls with the speed of "
        "sliding as the oil film builds up (Stribeck): slow motion is held, fast motion hardly."
    ),
    source=(
        "Armstrong-Helouvry, Dupont and Canudas de Wit (1994), A survey of models, analysis tools and compensation "
        "methods for the control of machines with friction, Automatica 30; Dixon (2007), The Shock Absorber Handbook; "
        "made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "N", 0.0, 180.0, (0.0, 900.0), "breakaway force of one front suspension"),
        Parameter("rear", "N", 0.0, 150.0, (0.0, 900.0), "breakaway force of one rear suspension"),
        Parameter("sliding", "1", 0.2, 0.2, (0.0, 0.5), "share of the breakaway force that is left in fast sliding"),
        Parameter("film", "m/s", 0.05, 0.05, (0.02, 0.15), "speed over which the oil film builds up"),
    ),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, sliding, film):
    breakaway = front if wheel < 2 else rear
    edge = EDGE + breakaway / STICKING
    left = sliding + (1.0 - sliding) * exp(-max(abs(velocity) - edge, 0.0) / film)
    return breakaway * left * min(max(velocity / edge, -1.0), 1.0)
