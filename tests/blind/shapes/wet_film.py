"""Tyres that float on a film of water."""

from ridecomfort.effects.contract import Effect, Parameter

LOAD = 3500.0
"""N; load that the speed of floating is given for."""

effect = Effect(
    name="wet_film",
    sentence=(
        "Beyond some speed water lifts part of the tread off a wet road and the tyre answers less to slip. A wheel that is "
        "pressed down floats later, one that is just unloaded at once."
    ),
    source="Horne and Dreher (1963), Phenomena of pneumatic tire hydroplaning, NASA TN D-2056; Pacejka (2012), Tire and Vehicle Dynamics; made for blind trials",
    port="tyre_planar",
    parameters=(
        Parameter("front", "1", 0.0, 0.45, (0.0, 0.9), "share of the answer to slip that a floating front tyre loses"),
        Parameter("rear", "1", 0.0, 0.3, (0.0, 0.9), "share of the answer to slip that a floating rear tyre loses"),
        Parameter("speed", "m/s", 17.0, 17.0, (10.0, 30.0), "speed at which a tyre begins to float"),
        Parameter("width", "m/s", 8.0, 8.0, (2.0, 15.0), "speed by which it floats in full"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, front, rear, onset, width):
    begin = onset * (max(load, 0.0) / LOAD) ** 0.5
    part = min(max((speed - begin) / width, 0.0), 1.0)
    left = 1.0 - (front if wheel < 2 else rear) * part * part * (3.0 - 2.0 * part)
    return left * slip_x, left * slip_y, 0.0
