"""Brakes that rub and whose discs run out."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

effect = Effect(
    name="pulsing_brake_drag",
    sentence=(
        "A brake whose caliper sticks keeps rubbing on a disc that runs out: it holds back one front wheel and the rear "
        "one across, harder and softer once a turn, and pulls the car to a side."
    ),
    source="Breuer and Bill (2008), Brake Technology Handbook: residual drag, cold judder; made for blind trials",
    port="tyre_planar",
    parameters=(
        Parameter("front_left", "N", 0.0, 90.0, (0.0, 800.0), "mean drag of the front left brake at the tyre"),
        Parameter("rear_right", "N", 0.0, 30.0, (0.0, 500.0), "mean drag of the rear right brake at the tyre"),
        Parameter("variation", "1", 0.7, 0.7, (0.0, 1.0), "share of the drag that comes and goes with a turn"),
        Parameter("radius", "m", 0.31, 0.31, (0.25, 0.38), "rolling radius"),
    ),
    states=("turn",),
    dissipative=True,
    symmetric=False,
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, turn, front_left, rear_right, variation, radius):
    drag = 0.0
    if wheel == 0:
        drag = front_left
    if wheel == 3:
        drag = rear_right
    pull = -drag * (1.0 + variation * wave(turn)) * min(max(speed, -1.0), 1.0)
    return slip_x, slip_y, pull, speed / radius
