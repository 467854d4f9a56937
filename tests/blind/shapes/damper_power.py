"""A damper whose force grows with a power of speed: a truth shaped otherwise than the library's damper_knee."""

from ridecomfort.effects.contract import Effect, Parameter

MATCHED = 0.1
"""m/s at which it is as strong as the linear damper."""

effect = Effect(
    name="damper_power",
    sentence="Dampers are degressive throughout: strong when slow, weak when fast.",
    source="Dixon (2007), The Shock Absorber Handbook; made for blind trials",
    port="suspension",
    parameters=(Parameter("share", "1", 0.0, 0.6, (0.0, 1.0), "share of the damping that follows the power of speed"),),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, share):
    speed = abs(velocity)
    return share * damping * velocity * ((MATCHED / (speed + 0.002)) ** 0.4 - 1.0)
