"""An effect of a user that two struts take part in: dampers of front and rear that are joined by a pipe."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="joined_dampers",
    sentence="Oil that dampers of front and rear press into one pipe resists pitch and warp, and leaves bounce and roll alone.",
    source="Smith and Walker (2005), Interconnected vehicle suspension, Proc. IMechE 219:295",
    port="interconnection",
    parameters=(Parameter("damping", "N s/m", 0.0, 300.0, (0.0, 1500.0), "damping of the difference of both struts' velocities"),),
    dissipative=True,
)


def act(
    wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across, deflection_opposite,
    velocity_opposite, damping,
):  # fmt: skip
    return damping * (velocity - velocity_along)
