"""Dampers that work harder away from the middle of their travel: a truth that the library does not hold."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_by_travel",
    sentence="Dampers with a groove in their tube: weak around the middle of the travel, stronger away from it.",
    source="Dixon (2007), The Shock Absorber Handbook; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1/m", 0.0, 30.0, (0.0, 200.0), "relative growth of the damping per metre of travel, front"),
        Parameter("rear", "1/m", 0.0, 30.0, (0.0, 200.0), "relative growth of the damping per metre of travel, rear"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    return (front if wheel < 2 else rear) * damping * abs(deflection) * velocity
