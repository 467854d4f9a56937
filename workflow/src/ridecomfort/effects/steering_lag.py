"""Steering that answers late."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

effect = Effect(
    name="steering_lag",
    sentence="Column, servo and linkage turn the wheels a little after the driver has turned the steering wheel.",
    source="Rajamani (2012), Vehicle Dynamics and Control; Pacejka (2012), Tire and Vehicle Dynamics",
    port="steer",
    parameters=(Parameter("time", "s", 0.0, 0.08, (0.0, 0.15), "time constant of the angle of the front wheels"),),
    states=("angle",),
)


def act(angle, speed, force_y, past, time):
    late, slope = lag(angle, past, time)
    return late, slope
