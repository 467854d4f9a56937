"""Tyre rubber that relaxes: stiffer to fast than to slow deflection."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_relaxing_rubber",
    sentence=(
        "The rubber of a tyre is a standard linear solid: fast deflection meets a spring more, whose force relaxes within "
        "some hundredths of a second."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: dynamic radial stiffness; standard linear solid as in any textbook of viscoelasticity; sizes made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("share", "1", 0.0, 0.3, (0.0, 0.8), "stiffness that relaxes over the static radial stiffness"),
        Parameter("time", "s", 0.02, 0.02, (0.006, 0.1), "time in which its force relaxes"),
    ),
    states=("relaxed",),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, relaxed, share, time):
    stretched = deflection - rest - relaxed
    return share * stiffness * stretched, stretched / time
