"""Wheels that give way fore and aft."""

from math import sqrt

from ridecomfort.effects.contract import Effect, Parameter

FASTEST = 210.0
"""rad/s; the fastest swing, if undamped, that is integrated in steps of up to 2 ms while the slip of the tyre damps it, too. A stiffer wheel does
that share of what one does that swings so."""

SLIPPING = 0.13
"""kg m/s per N; a wheel lighter than this times its load over its speed answers to the slip of its tyre faster than steps of 2 ms can follow, and
is taken for as heavy."""

effect = Effect(
    name="wheel_compliance",
    sentence=(
        "Bushings let a wheel move fore and aft under the longitudinal force of its tyre: the body feels that force "
        "through a spring and a mass, and the tyre slips less."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook; Pacejka (2012), Tire and Vehicle Dynamics",
    port="tyre_planar",
    parameters=(
        Parameter("front", "m/N", 0.0, 2e-6, (0.0, 6e-6), "longitudinal compliance of one front wheel"),
        Parameter("rear", "m/N", 0.0, 2e-6, (0.0, 6e-6), "longitudinal compliance of one rear wheel"),
        Parameter("mass", "kg", 45.0, 45.0, (15.0, 120.0), "mass that moves fore and aft with one wheel"),
        Parameter("damping_ratio", "1", 0.1, 0.1, (0.02, 0.4), "damping ratio of the bushings with that mass"),
    ),
    states=("place", "rate"),
    order=1,
    also_sees=("surge", "pull"),
    also_probed=(1.0, 2.0),  # where a wheel swings goes by its compliance: at 33 Hz with a quarter of what is typical, at 12 Hz with twice as much
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, surge, pull, place, rate, front, rear, mass, damping_ratio):
    compliance = front if wheel < 2 else rear
    integrated = max(compliance, (1.0 + damping_ratio) ** 2 / (mass * FASTEST * FASTEST))
    share = compliance / integrated
    stiffness = 1.0 / integrated
    damping = 2.0 * damping_ratio * sqrt(stiffness * mass)
    pace = max(abs(speed), 1.0)
    acceleration = (force_x + pull - mass * surge - stiffness * place - damping * rate) / max(mass, SLIPPING * load / pace)
    slip_x -= share * rate / pace
    return slip_x, slip_y, -share * mass * acceleration, rate, acceleration
