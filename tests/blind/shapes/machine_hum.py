"""A machine on the body that runs at a speed of its own."""

from math import pi, sin

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="machine_hum",
    sentence="A compressor or a fan on the body shakes it up and down at its own speed, however fast the car drives.",
    source="Den Hartog (1956), Mechanical Vibrations: unbalanced machine on a foundation; made for blind trials",
    port="body",
    parameters=(
        Parameter("force", "N", 0.0, 60.0, (0.0, 2000.0), "amplitude of the vertical force"),
        Parameter("frequency", "Hz", 19.0, 19.0, (5.0, 40.0), "how often it turns"),
    ),
    states=("phase",),
)


def act(motion, phase, force, frequency):
    return 0.0, 0.0, force * sin(phase), 0.0, 0.0, 0.0, 2.0 * pi * frequency
