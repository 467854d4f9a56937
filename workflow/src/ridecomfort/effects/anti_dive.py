"""Links that hold the body up against braking."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="anti_dive",
    sentence=(
        "Inclined links turn part of the braking force of a wheel into a vertical one, which pushes the nose up and "
        "draws the tail down, so that the body pitches less when it brakes."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.08, (0.0, 0.3), "tangent of the angle at which front braking forces are held"),
        Parameter("rear", "1", 0.0, 0.15, (0.0, 0.4), "tangent of the angle at which rear braking forces are held"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    braking = max(-force_x, 0.0)
    return front * braking if wheel < 2 else -rear * braking
