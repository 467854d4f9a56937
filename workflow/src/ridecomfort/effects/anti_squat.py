"""Links that hold the body up against driving."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="anti_squat",
    sentence=(
        "Inclined links turn part of the driving force of a wheel into a vertical one, which pushes the tail up and "
        "draws the nose down, so that the body pitches less when it accelerates."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.05, (0.0, 0.3), "tangent of the angle at which front driving forces are held"),
        Parameter("rear", "1", 0.0, 0.1, (0.0, 0.4), "tangent of the angle at which rear driving forces are held"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    driving = max(force_x, 0.0)
    return -front * driving if wheel < 2 else rear * driving
