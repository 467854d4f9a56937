"""A roll bar that its bushes hold, felt by the wheels."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="antiroll_bar_friction",
    sentence=(
        "The bushes of the front roll bar grip it until they slip, so that a wheel which rises alone drags the other along; both wheels "
        "together do not know of it."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: anti-roll bar bushes; Dahl (1976), Solid friction damping of mechanical vibrations, "
        "AIAA Journal 14:1675; sizes made for blind trials"
    ),
    port="interconnection",
    parameters=(
        Parameter("friction", "N", 0.0, 60.0, (0.0, 400.0), "force at a wheel at which the bushes slip"),
        Parameter("grip", "m", 0.004, 0.004, (0.001, 0.02), "difference of the struts over which the force turns"),
    ),
    states=("held",),
)


def act(
    wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across, deflection_opposite,
    velocity_opposite, held, friction, grip,
):  # fmt: skip
    sliding = velocity - velocity_across
    return friction * held if wheel < 2 else 0.0, (sliding - abs(sliding) * held) / grip
