"""Tie rods that are too long or too short for their arms."""

from ridecomfort.effects.contract import Effect, Parameter

FURTHEST = 0.1
"""m of travel beyond which the arc goes on straight."""

effect = Effect(
    name="tie_rod_length",
    sentence=(
        "A tie rod or toe link of another length than the arms beside it swings on another arc: a wheel is turned the same way in "
        "bump and in rebound, with the square of its travel, and a wheel at rest knows nothing of it."
    ),
    source=(
        "Milliken and Milliken (1995), Race Car Vehicle Dynamics: curved ride toe from the length of the tie rod; Reimpell, Stoll and "
        "Betzler (2001), The Automotive Chassis; sizes made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("front", "rad/m2", 0.0, 2.0, (-15.0, 15.0), "angle per square of travel by which a front wheel is turned out"),
        Parameter("rear", "rad/m2", 0.0, -2.0, (-15.0, 15.0), "angle per square of travel by which a rear wheel is turned out"),
    ),
)


def act(wheel, deflection, front, rear):
    travel = min(abs(deflection), FURTHEST)
    out = (front if wheel < 2 else rear) * travel * travel
    return 0.0, out if wheel % 2 == 0 else -out, 0.0
