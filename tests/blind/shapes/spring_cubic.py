"""Springs that stiffen alike in bump and rebound: a truth that the library does not hold."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="spring_cubic",
    sentence="Springs and their bushings stiffen with the square of the travel, in bump as in rebound.",
    source="Kovacic and Brennan (2011), The Duffing Equation; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "N/m3", 0.0, 3e7, (0.0, 1.5e8), "factor of the cubed deflection of a front suspension"),
        Parameter("rear", "N/m3", 0.0, 2e7, (0.0, 1.5e8), "factor of the cubed deflection of a rear suspension"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    return (front if wheel < 2 else rear) * deflection**3
