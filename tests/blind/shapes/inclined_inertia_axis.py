"""A body whose long axis of inertia is not level."""

from ridecomfort.effects.contract import Effect, Parameter

SPAN = 0.005
"""s over which the change of the yaw rate is taken."""

FASTEST = 2.0
"""rad/s2; no car begins to turn faster on such a road."""

effect = Effect(
    name="inclined_inertia_axis",
    sentence=(
        "The engine lies low in front and the boot high behind, so that the axis about which the body likes to roll is "
        "inclined: whenever a road rolls the body, it also yaws, and a yawing body rolls."
    ),
    source=(
        "Bixel, Heydinger, Durisek and Guenther (1995), Developments in vehicle center of gravity and inertial parameter "
        "estimation and measurement, SAE 950356: products of inertia; Gillespie (1992), Fundamentals of Vehicle Dynamics; "
        "made for blind trials"
    ),
    port="body",
    parameters=(Parameter("product", "kg m2", 0.0, 120.0, (-400.0, 500.0), "product of inertia of roll and yaw"),),
    states=("yaw_rate",),
)


def act(motion, past, product):
    change = (motion.yaw_rate - past) / SPAN
    turning = min(max(change, -FASTEST), FASTEST)  # the state begins at rest
    return 0.0, 0.0, 0.0, product * turning, 0.0, product * motion.roll_acceleration, change
