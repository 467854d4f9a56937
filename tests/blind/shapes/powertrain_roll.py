"""An engine that rocks about its length on its mounts."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="powertrain_roll",
    sentence=(
        "Engine and gearbox rock from side to side on their mounts: where the road rolls the body near their own "
        "frequency they turn against it."
    ),
    source=(
        "Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge; Yu, Naganathan and Dukkipati (2001), A "
        "literature review of automotive vehicle engine mounting systems, Mechanism and Machine Theory 36; made for "
        "blind trials"
    ),
    port="body",
    parameters=(
        Parameter("inertia", "kg m2", 0.0, 25.0, (0.0, 110.0), "inertia of engine and gearbox about the axis they rock on"),
        Parameter("frequency", "Hz", 7.0, 7.0, (4.0, 16.0), "natural frequency on a body that stands"),
        Parameter("damping_ratio", "1", 0.1, 0.1, (0.02, 0.4), "damping ratio on a body that stands"),
    ),
    states=("angle", "rate"),
)


def act(motion, angle, rate, inertia, frequency, damping_ratio):
    turns = 2.0 * pi * frequency
    acceleration = -motion.roll_acceleration - turns * (turns * angle + 2.0 * damping_ratio * rate)
    # The rigid body carries this inertia already; what is missing is that of turning against it.
    return 0.0, 0.0, 0.0, -inertia * acceleration, 0.0, 0.0, rate, acceleration
