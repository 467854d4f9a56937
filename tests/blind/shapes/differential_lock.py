"""A differential that locks."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="differential_lock",
    sentence=(
        "Preloaded clutches in the differential hold back the outer wheel of a bend and push the inner one, until they slip: the "
        "car is slower to turn in, and to turn out."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics: limited slip differentials; made for blind trials",
    port="body",
    parameters=(
        Parameter("moment", "N m", 0.0, 250.0, (0.0, 1200.0), "yaw moment of the clutches while they slip"),
        Parameter("rate", "rad/s", 0.01, 0.01, (0.002, 0.05), "yaw rate at which they begin to slip"),
    ),
    dissipative=True,
)


def act(motion, moment, rate):
    slipping = min(max(motion.yaw_rate / rate, -1.0), 1.0)
    return 0.0, 0.0, 0.0, 0.0, 0.0, -moment * slipping
