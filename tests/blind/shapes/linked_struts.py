"""Struts of a side that a pipe joins, through which fluid is pressed."""

from math import sqrt

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="linked_struts",
    sentence=(
        "Fluid springs of the front and rear strut of a side are joined by a pipe: what one takes up flows to the other, the more "
        "slowly for its quantity the faster it has to, so that quick bumps find each strut alone and slow pitch finds them joined."
    ),
    source="Moulton and Best (1979), From Hydrolastic to Hydragas suspension, Proc. IMechE 193:15; sizes made for blind trials",
    port="interconnection",
    parameters=(
        Parameter("share", "1", 0.0, 0.25, (0.0, 0.7), "part of the springs that is fluid"),
        Parameter("flow", "m/s", 0.05, 0.05, (0.01, 0.3), "flow, as velocity of a strut, at a difference of deflections of 10 mm"),
    ),
    states=("taken",),
)


def act(
    wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across, deflection_opposite,
    velocity_opposite, taken, share, flow,
):  # fmt: skip
    difference = (deflection - deflection_along - 2.0 * taken) / 0.010
    return -share * 28000.0 * taken, flow * difference / sqrt(0.05 + abs(difference))
