"""Tyres that roll on a smaller radius the more they carry."""

from ridecomfort.effects.contract import Effect, Parameter

USUAL = 4000.0
"""N of a load at which a tyre has the radius of the vehicle file. Another one would only turn all wheels at another speed."""

effect = Effect(
    name="tyre_rolling_radius",
    sentence=(
        "The more a tyre carries, the smaller is the radius that it rolls on: with every bump the road speeds its wheel up or "
        "brakes it, which jolts the car fore and aft."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: effective rolling radius as a function of load",
    port="tyre_planar",
    parameters=(
        Parameter("per_load", "1/N", 0.0, 4e-6, (0.0, 2e-5), "share of the rolling radius lost per load; 4e-6: a third of the deflection"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, per_load):
    forward = min(max(speed, -1.0), 1.0)  # slip is over the amount of the speed
    return slip_x - forward * per_load * (load - USUAL), slip_y, 0.0
