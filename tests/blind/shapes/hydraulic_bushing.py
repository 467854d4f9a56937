"""A bushing filled with fluid whose column resonates."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="hydraulic_bushing",
    sentence=(
        "Hydraulic bushings of the links: rubber chambers bulge against a column of fluid in a narrow channel. Slow motion "
        "only pushes the fluid to and fro, fast motion meets the stiffness of the chambers, in between the column resonates."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook: hydraulically damped bushings; sizes made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "N/m", 0.0, 9000.0, (0.0, 40000.0), "stiffness of the chambers of one front bushing, at the wheel"),
        Parameter("rear", "N/m", 0.0, 9000.0, (0.0, 40000.0), "stiffness of the chambers of one rear bushing, at the wheel"),
        Parameter("frequency", "Hz", 7.0, 7.0, (3.0, 15.0), "natural frequency of the column on the chambers"),
        Parameter("damping_ratio", "1", 0.2, 0.2, (0.05, 0.6), "damping ratio of the column"),
    ),
    states=("place", "rate"),
)


def act(
    wheel, deflection, velocity, stiffness, damping, force_x, force_y, place, rate, front, rear, frequency, damping_ratio
):
    chambers = front if wheel < 2 else rear
    turns = 2.0 * pi * frequency
    acceleration = turns * (turns * (deflection - place) - 2.0 * damping_ratio * rate)
    return chambers * (deflection - place), rate, acceleration
