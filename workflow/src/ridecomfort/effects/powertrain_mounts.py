"""An engine that moves on its mounts."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="powertrain_mounts",
    sentence=(
        "Engine and gearbox, part of the sprung mass, move up and down on rubber mounts and absorb or add vibration "
        "of the body around their own frequency."
    ),
    source="Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge; Heissing and Ersoy (2011), Chassis Handbook",
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 180.0, (0.0, 350.0), "mass of engine and gearbox"),
        Parameter("ahead", "m", 1.1, 1.1, (-1.6, 1.6), "its place ahead of the centre of gravity"),
        Parameter("frequency", "Hz", 10.0, 10.0, (5.0, 20.0), "natural frequency on a body that stands"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.02, 0.5), "damping ratio on a body that stands"),
    ),
    states=("lift", "rate"),
)


def act(motion, lift, rate, mass, ahead, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    body = motion.vertical_acceleration - ahead * motion.pitch_acceleration
    acceleration = -body - turns * (turns * lift + 2.0 * damping_ratio * rate)
    # The rigid body carries this mass already; what is missing is the inertia of moving against it.
    force = -mass * acceleration
    return 0.0, 0.0, force, 0.0, -ahead * force, 0.0, rate, acceleration
