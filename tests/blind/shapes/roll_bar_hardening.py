"""A roll bar that hardens as it is twisted."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="roll_bar_hardening",
    sentence=(
        "The links of a roll bar stand ever more askew to its arms, and its bushes close, as the body leans: it holds harder "
        "in a bend than the little rolling on a straight road shows."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: anti-roll bars; Milliken and Milliken (1995), Race Car Vehicle Dynamics: roll "
        "stiffness; made for blind trials"
    ),
    port="body",
    parameters=(Parameter("hardening", "N m/rad3", 0.0, 3.0e7, (0.0, 2.0e8), "moment over the cube of the roll angle"),),
)


def act(motion, hardening):
    roll = min(max(motion.roll, -0.1), 0.1)
    return 0.0, 0.0, 0.0, -hardening * roll**3, 0.0, 0.0
