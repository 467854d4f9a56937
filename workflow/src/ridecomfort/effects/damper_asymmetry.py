"""Dampers that resist rebound more than bump."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_asymmetry",
    sentence=(
        "Dampers resist rebound more than bump, mostly about 70 to 30, so that the body is drawn down on rough road "
        "and bumps pass with less force than the holes behind them."
    ),
    source="Dixon (2007), The Shock Absorber Handbook, 2nd ed., chapter 1; Reimpell, Stoll and Betzler (2001), chapter 5",
    port="suspension",
    parameters=(
        Parameter("front", "N s/m", 0.0, 800.0, (0.0, 2000.0), "half the difference of rebound and bump damping, front"),
        Parameter("rear", "N s/m", 0.0, 800.0, (0.0, 2000.0), "half the difference of rebound and bump damping, rear"),
    ),
)


def act(wheel, deflection, velocity, force_x, force_y, front, rear):
    half = front if wheel < 2 else rear
    return -half * abs(velocity)
