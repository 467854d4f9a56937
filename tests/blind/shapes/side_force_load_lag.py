"""Tyres whose side force follows the load late."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

LIGHT = 400.0
"""N; a tyre that bears less has no side force worth the name."""

effect = Effect(
    name="side_force_load_lag",
    sentence=(
        "When a tyre is pressed or relieved, its tread has to roll on before more or less of it is bent aside: on a rough "
        "road the side force follows the swinging load late and weakly, and only the slip at once."
    ),
    source=(
        "Takahashi and Pacejka (1987), Cornering on uneven roads, Vehicle System Dynamics 17; Pacejka (2012), Tire and Vehicle "
        "Dynamics: response to load variations; made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("front", "m", 0.0, 0.5, (0.0, 2.0), "way in which the side force of a front tyre follows its load"),
        Parameter("rear", "m", 0.0, 0.5, (0.0, 2.0), "way in which the side force of a rear tyre follows its load"),
    ),
    states=("load",),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, past, front, rear):
    late, change = lag(load, past, (front if wheel < 2 else rear) / max(abs(speed), 1.0))
    share = min(max(late, 0.0) / load, 3.0) if load > LIGHT else 1.0
    return slip_x, share * slip_y, 0.0, change
