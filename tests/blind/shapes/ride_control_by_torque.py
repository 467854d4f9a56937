"""An engine that drives against pitch."""

from ridecomfort.effects.contract import Effect, Parameter

MOST = 900.0
"""N; the controller adds or takes no more than this at the wheels, lest the driver notice."""

effect = Effect(
    name="ride_control_by_torque",
    sentence=(
        "A controller drives a little harder while the nose goes down and brakes a little while it comes up, so that the forces of "
        "the wheels, far below the centre of gravity, damp pitch; the car surges with it."
    ),
    source=(
        "Active ride control by engine and brakes as in cars of Nissan since 2013; Gillespie (1992), Fundamentals of Vehicle "
        "Dynamics: pitch by driving and braking; law and sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("gain", "N s/rad", 0.0, 6000.0, (0.0, 30000.0), "driving force per pitch rate"),
        Parameter("time", "s", 0.05, 0.05, (0.02, 0.2), "time in which engine and brakes follow"),
        Parameter("lever", "m", 0.4, 0.4, (0.1, 0.7), "height at which the links hold the force, below the centre of gravity"),
    ),
    states=("force",),
)


def act(motion, force, gain, time, lever):
    asked = min(max(gain * motion.pitch_rate, -MOST), MOST)
    return force, 0.0, 0.0, 0.0, -lever * force, 0.0, (asked - force) / time
