"""Dampers that resist rebound more than bump."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_asymmetry",
    sentence=(
        "Dampers resist rebound more than bump, mostly about 70 to 30, so that the body is drawn down on rough road "
        "and bumps pass with less force than the holes behind them."
    ),
    source="Dixon (2007), The Shock Absorber Handbook; Reimpell, Stoll and Betzler (2001), The Automotive Chassis",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.4, (0.0, 0.7), "share of the damping that moves from bump to rebound, front"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 0.7), "share of the damping that moves from bump to rebound, rear"),
    ),
    order=1,
    also_sees=("damper",),
    also_returns=("damper",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, damper, front, rear):
    share = front if wheel < 2 else rear
    return 0.0, damper - share * abs(damper)
