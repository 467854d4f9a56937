"""Rear wheels that steer along."""

from ridecomfort.effects.contract import Effect, Parameter

SLOWEST = 3.0
"""m/s below which the yaw rate no longer tells the curvature."""

LIMIT = 0.05
"""rad; the most that the rear wheels turn."""

effect = Effect(
    name="rear_axle_steering",
    sentence=(
        "An actuator turns the rear wheels with the bend at speed and against it when slow, in proportion to the "
        "curvature that the yaw rate tells: the car enters a bend with less slip of the body and yaws otherwise."
    ),
    source=(
        "Sano, Furukawa and Shiraishi (1986), Four wheel steering system with rear wheel steer angle controlled as a "
        "function of steering wheel angle, SAE 860625; Heissing and Ersoy (2011), Chassis Handbook: rear-axle steering; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("ratio", "1", 0.0, 0.2, (0.0, 0.4), "rear angle over the angle of the bend, far from the change of sign"),
        Parameter("change", "m/s", 16.0, 16.0, (10.0, 25.0), "speed at which the sign changes"),
        Parameter("time", "s", 0.08, 0.08, (0.03, 0.3), "time constant of the actuator"),
        Parameter("stiffness", "N/rad", 180000.0, 180000.0, (60000.0, 350000.0), "cornering stiffness of the rear axle"),
        Parameter("height", "m", 0.516, 0.516, (0.3, 0.9), "height of the centre of gravity above the road"),
    ),
    states=("angle",),
)


def act(motion, angle, ratio, change, time, stiffness, height):
    bend = (motion.front - motion.rear) * motion.yaw_rate / max(motion.speed, SLOWEST)
    asked = ratio * bend * min(max((motion.speed - change) / (0.5 * change), -1.0), 1.0)
    side = stiffness * angle
    return 0.0, side, 0.0, height * side, 0.0, motion.rear * side, (min(max(asked, -LIMIT), LIMIT) - angle) / time
