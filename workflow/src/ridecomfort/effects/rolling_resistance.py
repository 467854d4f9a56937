"""Tyres that resist rolling."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="rolling_resistance",
    sentence="A rolling tyre loses energy in its rubber and holds its axle back in proportion to its load.",
    source="Wong (2008), Theory of Ground Vehicles; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="tyre_planar",
    parameters=(Parameter("coefficient", "1", 0.0, 0.012, (0.0, 0.04), "resistance over load"),),
    dissipative=True,
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, coefficient):
    return slip_x, slip_y, -coefficient * load * min(max(speed, -1.0), 1.0)
