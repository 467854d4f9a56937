"""Sealant that creeps round inside tyres."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

THROWN = 25.0
"""rad/s; spin at which half of the pool is carried round."""

effect = Effect(
    name="tyre_sealant",
    sentence=(
        "A pool of sealant or water in the tyres of the right side is carried round once they turn fast, slower than the "
        "tyres by some percent, and shakes them at a little less than once a turn."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics: tyre and wheel nonuniformities; made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("front", "kg m", 0.0, 0.012, (0.0, 0.15), "mass of the pool in the front right tyre times its radius"),
        Parameter("rear", "kg m", 0.0, 0.008, (0.0, 0.15), "mass of the pool in the rear right tyre times its radius"),
        Parameter("creep", "1", 0.08, 0.08, (0.0, 0.3), "share by which the pool turns slower than the tyre"),
    ),
    states=("behind",),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, behind, front, rear, creep):
    if wheel == 0 or wheel == 2:
        return 0.0, 0.0
    thrown = spin * spin / (spin * spin + THROWN * THROWN)
    force = (front if wheel == 1 else rear) * spin * spin * thrown * wave(rotation - behind)
    return force, creep * spin
