"""A drivetrain that answers late."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

effect = Effect(
    name="drivetrain_lag",
    sentence="Engine and drivetrain follow the driver's demand with a lag; the brakes do not.",
    source="Rajamani (2012), Vehicle Dynamics and Control; Kiencke and Nielsen (2005), Automotive Control Systems",
    port="drive",
    parameters=(Parameter("time", "s", 0.0, 0.2, (0.0, 1.0), "time constant of the driving force"),),
    states=("force",),
)


def act(force, speed, past, time):
    driving, slope = lag(max(force, 0.0), past, time)
    return driving + min(force, 0.0), slope
