"""Wheels that are turned as they rise."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="bump_steer",
    sentence=(
        "Tie rods and links turn a wheel as it rises, so that each bump under one side steers the car a little, and so "
        "does its roll in a bend."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics; Reimpell, Stoll and Betzler (2001), The Automotive Chassis",
    port="kinematics",
    parameters=(
        Parameter("front", "rad/m", 0.0, 0.1, (-0.6, 0.6), "angle per compression by which a front wheel is turned out"),
        Parameter("rear", "rad/m", 0.0, 0.1, (-0.6, 0.6), "angle per compression by which a rear wheel is turned out"),
    ),
)


def act(wheel, deflection, front, rear):
    angle = deflection * (front if wheel < 2 else rear)
    return 0.0, angle if wheel % 2 == 0 else -angle, 0.0
