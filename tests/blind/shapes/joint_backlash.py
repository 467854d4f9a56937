"""Play between a damper and what it is bolted to."""

from ridecomfort.effects.contract import Effect, Parameter

CONTACT = 4e-4
"""m of rubber over which a damper takes hold."""

effect = Effect(
    name="joint_backlash",
    sentence=(
        "A worn eye lets its damper follow for a little way before it takes hold: after every turn of motion, and in "
        "all motion smaller than the play, the damper is missing."
    ),
    source=(
        "Nordin and Gutman (2002), Controlling mechanical systems with backlash: a survey, Automatica 38; Reimpell, "
        "Stoll and Betzler (2001), The Automotive Chassis: wear of damper mounts; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "m", 0.0, 6e-4, (0.0, 4e-3), "play of one front damper to either side, at the wheel"),
        Parameter("rear", "m", 0.0, 6e-4, (0.0, 4e-3), "play of one rear damper to either side, at the wheel"),
    ),
    states=("place",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, place, front, rear):
    play = front if wheel < 2 else rear
    ahead = place if velocity > 0.0 else -place
    held = min(max((ahead + CONTACT - play) / CONTACT, 0.0), 1.0)
    loose = (1.0 - held) * velocity
    return -damping * loose, loose
