"""Roll centres that sink as the body does."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="roll_centre_migration",
    sentence=(
        "The line along which the links hold the side force of a tyre tilts with the travel of its wheel: in a bend the "
        "compressed outer corner is jacked less and the drawn-out inner one held down more."
    ),
    source=(
        "Milliken and Milliken (1995), Race Car Vehicle Dynamics: jacking and roll centre migration; Heissing and Ersoy "
        "(2011), Chassis Handbook; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1/m", 0.0, 1.5, (-2.0, 8.0), "change of the tangent of a front force line per travel"),
        Parameter("rear", "1/m", 0.0, 1.2, (-2.0, 8.0), "change of the tangent of a rear force line per travel"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    tilt = (front if wheel < 2 else rear) * deflection
    return tilt * force_y if wheel == 0 or wheel == 2 else -tilt * force_y
