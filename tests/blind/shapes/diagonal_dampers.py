"""Dampers that share their oil across the car."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="diagonal_dampers",
    sentence=(
        "The dampers of a diagonal are joined at a valve that only sees the difference of their motions: bounce, pitch and roll of "
        "the body are damped otherwise than one wheel that meets a bump, and a valve blows off when that is quick."
    ),
    source="Zapletal (2000), Balanced suspension, SAE 2000-01-3572; Wilde et al. (2005), SAE 2005-01-3593; sizes made for blind trials",
    port="interconnection",
    parameters=(
        Parameter("damping", "N s/m", 0.0, 300.0, (0.0, 1200.0), "damping of the difference of a diagonal's velocities"),
        Parameter("knee", "m/s", 0.3, 0.3, (0.05, 1.0), "difference at which the valve has blown off half"),
    ),
    dissipative=True,
)


def act(
    wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across, deflection_opposite,
    velocity_opposite, damping, knee,
):  # fmt: skip
    difference = velocity - velocity_opposite
    return damping * difference / (1.0 + abs(difference) / knee)
