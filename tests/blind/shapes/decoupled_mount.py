"""An engine on mounts with a free travel."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="decoupled_mount",
    sentence=(
        "Hydraulic mounts of an engine have a decoupler: within a fraction of a millimetre they are soft and hardly damp, beyond it "
        "they are stiffer and damp strongly."
    ),
    source=(
        "Colgate, Chang, Chiou, Liu and Kerr (1995), Modelling of a hydraulic engine mount focusing on response to sinusoidal and "
        "composite excitations, Journal of Sound and Vibration 184:503; Heissing and Ersoy (2011), Chassis Handbook; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 180.0, (0.0, 350.0), "mass of engine and gearbox"),
        Parameter("ahead", "m", 1.1, 1.1, (-1.6, 1.6), "its place ahead of the centre of gravity"),
        Parameter("frequency", "Hz", 8.0, 8.0, (5.0, 15.0), "natural frequency within the free travel, on a body that stands"),
        Parameter("free", "m", 0.0004, 0.0004, (0.0001, 0.002), "travel to either side within which the mounts are soft"),
    ),
    states=("lift", "rate"),
)


def act(motion, lift, rate, mass, ahead, frequency, free):
    turns = 2.0 * pi * frequency
    beyond = lift - min(max(lift, -free), free)
    ratio = 0.25 if beyond != 0.0 else 0.05
    body = motion.vertical_acceleration - ahead * motion.pitch_acceleration
    acceleration = -body - turns * (turns * (lift + beyond) + 2.0 * ratio * rate)
    force = -mass * acceleration
    return 0.0, 0.0, force, 0.0, -ahead * force, 0.0, rate, acceleration
