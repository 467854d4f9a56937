"""Active struts that hold the front end still."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="front_axle_skyhook",
    sentence=(
        "Actuators over the front wheels hold the nose of the body against its own vertical speed, as if it hung on a damper to "
        "the sky; the tail is left to its springs."
    ),
    source=(
        "Karnopp, Crosby and Harwood (1974), Vibration control using semi-active force generators, Journal of Engineering for "
        "Industry 96:619; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("damping", "N s/m", 0.0, 1200.0, (0.0, 6000.0), "force on the nose over its vertical speed"),
        Parameter("time", "s", 0.02, 0.02, (0.005, 0.1), "time in which the actuators follow"),
    ),
    states=("followed",),
)


def act(motion, followed, damping, time):
    nose = motion.vertical_speed - motion.front * motion.pitch_rate
    force = -damping * followed
    return 0.0, 0.0, force, 0.0, -motion.front * force, 0.0, (nose - followed) / time
