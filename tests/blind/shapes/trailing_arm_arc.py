"""Wheels that rise on an arc."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="trailing_arm_arc",
    sentence=(
        "A wheel on a short arm rises on an arc, seen from the side: the further it is from the middle of its travel, the more "
        "a bump throws it fore or aft and the more its longitudinal forces lift or lower the body."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: longitudinal pole; Milliken and Milliken (1995), Race Car "
        "Vehicle Dynamics: side view swing arm; made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("front", "1/m", 0.0, 2.0, (-6.0, 6.0), "one over the length of a front wheel's arm, seen from the side"),
        Parameter("rear", "1/m", 0.0, 3.0, (-6.0, 6.0), "one over the length of a rear wheel's arm, seen from the side"),
    ),
)


def act(wheel, deflection, front, rear):
    slope = (front if wheel < 2 else rear) * deflection
    return min(max(slope, -0.4), 0.4), 0.0, 0.0
