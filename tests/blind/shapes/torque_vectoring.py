"""Motors that turn a car into its bends."""

from ridecomfort.effects.contract import Effect, Parameter

MOST = 1500.0
"""N m; all that the motors of an axle can do."""

effect = Effect(
    name="torque_vectoring",
    sentence=(
        "Two motors drive the wheels of an axle each for itself, and push the outer one harder the more the car is pulled to the "
        "side: it turns into bends more willingly, a little late."
    ),
    source=(
        "De Novellis, Sorniotti, Gruber, Orus, Rodriguez Fortun, Theunissen and De Smet (2015), Direct yaw moment control actuated "
        "through electric drivetrains and friction brakes, Mechatronics 26:1; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("moment", "kg m", 0.0, 120.0, (-300.0, 300.0), "yaw moment over side acceleration"),
        Parameter("time", "s", 0.06, 0.06, (0.02, 0.3), "time in which the motors follow"),
    ),
    states=("asked",),
)


def act(motion, asked, moment, time):
    pushed = min(max(moment * asked, -MOST), MOST)
    return 0.0, 0.0, 0.0, 0.0, 0.0, pushed, (motion.speed * motion.yaw_rate - asked) / time
