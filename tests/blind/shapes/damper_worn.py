"""One damper that has lost its oil: a truth that the library does not hold."""

from ridecomfort.effects.contract import Effect, Parameter

WORN = 1
"""The wheel whose damper it is: front right."""

effect = Effect(
    name="damper_worn",
    sentence="The damper of a single wheel has lost a part of its force.",
    source="Dixon (2007), The Shock Absorber Handbook; made for blind trials",
    port="suspension",
    parameters=(Parameter("lost", "1", 0.0, 0.4, (0.0, 0.9), "share of the damping of the front right wheel that is lost"),),
    symmetric=False,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, lost):
    return -lost * damping * velocity if wheel == WORN else 0.0
