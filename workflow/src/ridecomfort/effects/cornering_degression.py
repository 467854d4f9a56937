"""Cornering stiffness that grows less than the load."""

from ridecomfort.effects.contract import Effect, Parameter

LEAST = 0.2
"""Share of the stiffness that is left however large the load."""

effect = Effect(
    name="cornering_degression",
    sentence=(
        "The cornering stiffness of a tyre grows less than its load, so that an axle loses side force when load "
        "moves from one wheel to the other."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: cornering stiffness over load",
    port="tyre_planar",
    parameters=(
        Parameter("degression", "1", 0.0, 0.35, (0.0, 0.7), "fall of stiffness per load over one reference load"),
        Parameter("reference_load", "N", 4000.0, 4000.0, (2000.0, 10000.0), "load at which nothing changes"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, degression, reference_load):
    share = 1.0 - degression * (load / reference_load - 1.0)
    return slip_x, slip_y * max(share, LEAST), 0.0
