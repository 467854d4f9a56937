"""Tyre forces that need some distance to build up."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

effect = Effect(
    name="tyre_relaxation",
    sentence="A tyre answers to a change of slip only after it has rolled about its relaxation length.",
    source="Pacejka (2012), Tire and Vehicle Dynamics: transient tyre behaviour, relaxation length",
    port="tyre_planar",
    parameters=(
        Parameter("longitudinal", "m", 0.0, 0.3, (0.0, 0.8), "relaxation length of the longitudinal slip"),
        Parameter("lateral", "m", 0.0, 0.5, (0.0, 1.2), "relaxation length of the slip angle"),
    ),
    states=("slip_x", "slip_y"),
    order=2,
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, past_x, past_y, longitudinal, lateral):
    pace = max(abs(speed), 1.0)
    late_x, slope_x = lag(slip_x, past_x, longitudinal / pace)
    late_y, slope_y = lag(slip_y, past_y, lateral / pace)
    return late_x, late_y, 0.0, slope_x, slope_y
