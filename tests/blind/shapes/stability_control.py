"""A stability control that damps quick yawing."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="stability_control",
    sentence=(
        "A controller brakes single wheels against quick changes of the yaw rate and leaves steady bends alone: the car turns in "
        "and out more calmly."
    ),
    source="van Zanten, Erhardt and Pfaff (1995), VDC, the vehicle dynamics control system of Bosch, SAE 950759; made for blind trials",
    port="body",
    parameters=(
        Parameter("gain", "N m s", 0.0, 6000.0, (0.0, 40000.0), "yaw moment over what the yaw rate is quicker than the one that is followed"),
        Parameter("time", "s", 0.5, 0.5, (0.1, 2.0), "time in which the yaw rate is followed"),
    ),
    states=("followed",),
)


def act(motion, followed, gain, time):
    return 0.0, 0.0, 0.0, 0.0, 0.0, -gain * (motion.yaw_rate - followed), (motion.yaw_rate - followed) / time
