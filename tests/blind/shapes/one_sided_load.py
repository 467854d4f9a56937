"""A load on one side of the car."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

SPAN = 0.02
"""s over which the change of the speed is taken."""

HARDEST = 6.0
"""m/s2; no car brakes or drives harder on such a road."""

effect = Effect(
    name="one_sided_load",
    sentence=(
        "A driver alone, a full tank or a load on one side shift the centre of gravity aside: the car leans, and every "
        "bounce of the body also rolls it, every roll lifts it, and braking turns it."
    ),
    source=(
        "Gillespie (1992), Fundamentals of Vehicle Dynamics; Wong (2008), Theory of Ground Vehicles; parallel-axis terms as in "
        "any textbook of mechanics; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("shift", "kg m", 0.0, 45.0, (-150.0, 150.0), "mass times its place to the left of the middle of the car"),
    ),
    states=("speed",),
    symmetric=False,
)


def act(motion, past, shift):
    slope = (motion.speed - past) / SPAN
    change = min(max(slope, -HARDEST), HARDEST) if past > 0.99 * motion.speed else 0.0  # the state begins at rest
    lean = -shift * (STANDARD_GRAVITY + motion.vertical_acceleration)
    lift = -shift * motion.roll_acceleration
    return 0.0, 0.0, lift, lean, 0.0, shift * change, slope
