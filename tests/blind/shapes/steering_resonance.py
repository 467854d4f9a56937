"""Front wheels that swing about their steering axes."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="steering_resonance",
    sentence=(
        "Front wheels, tie rods and rack are masses on the stiffness of linkage and column: side forces at the trail of the "
        "tyres let them swing about their steering axes (wheel fight)."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: steering system dynamics, shimmy; sizes made for blind trials",
    port="steer",
    parameters=(
        Parameter("compliance", "rad/N", 0.0, 7e-7, (0.0, 6e-6), "angle of the front wheels per steady side force of the axle"),
        Parameter("frequency", "Hz", 8.0, 8.0, (3.0, 15.0), "natural frequency of the swing"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.03, 0.6), "damping ratio of the swing"),
    ),
    states=("turned", "rate"),
)


def act(angle, speed, force_y, turned, rate, compliance, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    acceleration = turns * (turns * (compliance * force_y - turned) - 2.0 * damping_ratio * rate)
    return angle - turned, rate, acceleration
