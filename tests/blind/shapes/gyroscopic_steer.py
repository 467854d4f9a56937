"""Spinning front wheels that turn when their axle tilts."""

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.006
"""s in which tie rods and bushes follow the moment; the travel's speed is taken over it."""

effect = Effect(
    name="gyroscopic_steer",
    sentence=(
        "A front wheel that goes up on a beam axle or a short arm is tilted, and as it spins it is a gyroscope: it turns about its "
        "steering axis against the springs of the tie rods, by the speed of its travel and not by its place."
    ),
    source=(
        "Den Hartog (1956), Mechanical Vibrations: shimmy of front wheels on an axle, gyroscopic coupling; Pacejka (2012), Tire and "
        "Vehicle Dynamics: tramp and shimmy; made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("front", "rad s/m", 0.0, 0.01, (-0.04, 0.04), "angle by which a front wheel is turned in per speed of compression"),
    ),
    states=("followed",),
)


def act(wheel, deflection, followed, front):
    if wheel > 1:
        return 0.0, 0.0, 0.0, 0.0
    rising = (deflection - followed) / TIME
    return 0.0, -front * rising if wheel == 0 else front * rising, 0.0, rising
