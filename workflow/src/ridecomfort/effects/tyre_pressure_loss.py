"""A tyre that has lost pressure."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_pressure_loss",
    sentence="A tyre that has lost pressure has lost a share of its radial stiffness; the car leans on it.",
    source="Besselink, Schmeitz and Pacejka (2010), An improved Magic Formula/Swift tyre model that can handle inflation pressure changes, Vehicle System Dynamics 48",
    port="tyre_vertical",
    parameters=(
        Parameter("front_left", "1", 0.0, 0.3, (0.0, 0.7), "share of the radial stiffness that is lost, front left"),
        Parameter("front_right", "1", 0.0, 0.0, (0.0, 0.7), "share of the radial stiffness that is lost, front right"),
        Parameter("rear_left", "1", 0.0, 0.0, (0.0, 0.7), "share of the radial stiffness that is lost, rear left"),
        Parameter("rear_right", "1", 0.0, 0.0, (0.0, 0.7), "share of the radial stiffness that is lost, rear right"),
    ),
    symmetric=False,
)


def act(
    wheel, deflection, velocity, stiffness, rest, rotation, spin, front_left, front_right, rear_left, rear_right
):
    if wheel < 2:
        share = front_left if wheel == 0 else front_right
    else:
        share = rear_left if wheel == 2 else rear_right
    return -share * stiffness * deflection
