"""Puddles in the wheel tracks."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import PHASE, wave

DENSITY = 1000.0
"""kg/m3; of water."""

WIDTH = 0.2
"""m; of a tyre."""

COEFFICIENT = 0.75
"""Drag of a tyre over the pressure of the flow on the water in front of it (TN D-552)."""

START = 2.0
"""rad; where among the puddles the left wheels start."""

FEWER = 1.3
"""Distance between puddles of the left track over that of the right, at the edge of the road."""

effect = Effect(
    name="puddle_drag",
    sentence=(
        "Water stands here and there in the wheel tracks; a tyre that ploughs through it is dragged back, first the front "
        "and then the rear wheel of one side, which slows the car and pulls it to that side."
    ),
    source=(
        "Horne, Joyner and Leland (1960), Studies of the retardation force developed on an aircraft tire rolling in "
        "slush or water, NASA TN D-552; sizes made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("depth", "m", 0.0, 0.006, (0.0, 0.02), "depth of the water in the middle of a puddle"),
        Parameter("spacing", "m", 45.0, 45.0, (15.0, 300.0), "from puddle to puddle in the right track"),
        Parameter("dry", "1", 0.7, 0.7, (0.0, 0.95), "sine above which there is water: at 0.7 a quarter of the way is wet"),
        Parameter("wheelbase", "m", 2.757, 2.757, (1.5, 6.0), "distance by which the rear wheels come later"),
    ),
    states=("way",),
    dissipative=True,
    symmetric=False,
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, way, depth, spacing, dry, wheelbase):
    right = wheel % 2
    place = way - (0.0 if wheel < 2 else wheelbase)
    level = wave(2.0 * pi * place / (spacing if right == 1 else FEWER * spacing) + START + PHASE * right)
    water = depth * max(level - dry, 0.0) / (1.0 - dry) if load > 0.0 else 0.0
    return slip_x, slip_y, -0.5 * COEFFICIENT * DENSITY * WIDTH * water * speed * abs(speed), speed
