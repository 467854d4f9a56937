"""Toe that depends on whether a wheel goes up or down."""

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.005
"""s in which a joint that slides has followed."""

effect = Effect(
    name="toe_link_friction",
    sentence=(
        "Joints of the toe links stick before they turn and drag their bushes along, so that a wheel on its way up stands "
        "at another toe angle than on its way down: a loop in the toe curve, which a linear bump steer has not."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: elastokinematics and ball-joint torques; Matschinsky (2007), "
        "Radfuehrungen der Strassenfahrzeuge; loops of some hundredths of a degree in kinematics-and-compliance tests; sizes made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("front", "rad", 0.0, 0.0005, (-0.003, 0.003), "half the loop, toe-out on the way up, front"),
        Parameter("rear", "rad", 0.0, 0.0008, (-0.003, 0.003), "half the loop, toe-out on the way up, rear"),
        Parameter("turning", "m", 0.003, 0.003, (0.0005, 0.01), "half the travel in which the toe goes from one to the other"),
    ),
    states=("held",),
)


def act(wheel, deflection, held, front, rear, turning):
    half = front if wheel < 2 else rear
    drag = deflection - held
    kept = min(max(drag, -turning), turning)
    outward = half * kept / turning
    return 0.0, outward if wheel % 2 == 0 else -outward, 0.0, (drag - kept) / TIME
