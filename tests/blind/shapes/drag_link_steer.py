"""A drag link across the car that steers when the axle goes up."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="drag_link_steer",
    sentence=(
        "On a beam axle with a drag link from one side, or with a tie rod bolted at a wrong height on a lifted car, both front wheels are "
        "turned to the same side when the axle goes up: bumps under both wheels, and braking, steer the car."
    ),
    source=(
        "Gillespie (1992), Fundamentals of Vehicle Dynamics: steering geometry error of solid axles; Reimpell, Stoll and Betzler "
        "(2001), The Automotive Chassis: steering rod on rigid axles; sizes made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("front", "rad/m", 0.0, 0.15, (-0.6, 0.6), "angle per compression by which either front wheel is turned to the left"),
    ),
    symmetric=False,
)


def act(wheel, deflection, front):
    return 0.0, front * deflection if wheel < 2 else 0.0, 0.0
