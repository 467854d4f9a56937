"""Rims that are bent sideways and wobble as they turn."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import PHASE, wave

RADIUS = 0.318
"""m; of the wheels."""

effect = Effect(
    name="lateral_runout",
    sentence=(
        "A rim bent on a kerb, or a tyre with a crooked belt, points a little to the left and a little to the right once a "
        "turn: its side force swings with the turn of the wheel and shakes the car sideways and in yaw."
    ),
    source=(
        "Gillespie (1992), Fundamentals of Vehicle Dynamics: lateral runout and lateral force variation; Pottinger (2005), "
        "Uniformity: a crucial attribute of tire/vehicle systems (NHTSA DOT HS 810 561); sizes made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("front", "rad", 0.0, 0.002, (0.0, 0.008), "amplitude of the angle of a front wheel"),
        Parameter("rear", "rad", 0.0, 0.001, (0.0, 0.008), "amplitude of the angle of a rear wheel"),
    ),
    states=("turn",),
    symmetric=False,
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, turn, front, rear):
    size = front if wheel < 2 else rear
    return slip_x, slip_y + size * wave(turn + PHASE * wheel), 0.0, (1.0 + slip_x) * speed / RADIUS
