"""Wheels that swing about their steering axes."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

LOAD = 4000.0
"""N; load at which a tyre turns its wheel as the sizes say."""

effect = Effect(
    name="wheel_wobble",
    sentence=(
        "The aligning moment of a tyre turns its wheel against the springs of track rod and bushings; the wheel swings "
        "back about its steering axis at its own frequency, hard when it is loaded and hardly when it is light."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: shimmy, steering vibrations; Gillespie (1992), Fundamentals of Vehicle Dynamics; made for blind trials",
    port="tyre_planar",
    parameters=(
        Parameter("front", "1", 0.0, 0.2, (0.0, 1.2), "angle that a front wheel gives way over its slip angle, at rest"),
        Parameter("rear", "1", 0.0, 0.08, (0.0, 1.2), "angle that a rear wheel gives way over its slip angle, at rest"),
        Parameter("frequency", "Hz", 9.0, 9.0, (5.0, 20.0), "natural frequency of a wheel about its steering axis"),
        Parameter("damping_ratio", "1", 0.06, 0.06, (0.02, 0.4), "damping ratio of that motion"),
    ),
    states=("angle", "rate"),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, angle, rate, front, rear, frequency, damping_ratio):
    gain = (front if wheel < 2 else rear) * max(load, 0.0) / LOAD
    turns = 2.0 * pi * frequency
    slips = slip_y - angle
    return slip_x, slips, 0.0, rate, turns * (turns * (gain * slips - angle) - 2.0 * damping_ratio * rate)
