"""A cylinder that misfires."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.wave import wave

RADIUS = 0.318
"""m; of the wheels."""

effect = Effect(
    name="engine_misfire",
    sentence=(
        "One cylinder burns badly: once in two turns of the engine part of its torque is missing, and the driving force swings with half "
        "the order of the engine, at a fixed ratio to the turns of the wheels in the gear engaged."
    ),
    source="Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge: excitation by the engine; Kiencke and Nielsen (2005), Automotive Control Systems: misfire; sizes made for blind trials",
    port="drive",
    parameters=(
        Parameter("force", "N", 0.0, 40.0, (0.0, 600.0), "amplitude of the driving force at the wheels"),
        Parameter("order", "1", 1.65, 1.65, (1.2, 6.0), "swings in a turn of the wheels: half of the overall ratio"),
    ),
    states=("angle",),
)


def act(force, speed, angle, amplitude, order):
    return force + amplitude * wave(angle), order * speed / RADIUS
