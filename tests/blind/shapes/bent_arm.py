"""An arm of one front wheel that a kerb has bent."""

from ridecomfort.effects.contract import Effect, Parameter

BENT = 1
"""The wheel whose arm it is: front right."""

effect = Effect(
    name="bent_arm",
    sentence=(
        "A kerb or a pothole has bent the lower arm of one front wheel, whose ends now lie at other heights than on the other side: "
        "as it rises this wheel is led aside and turned, and its side force lifts or lowers the body; the other wheels are sound."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: roll centres and toe of damaged axles; Matschinsky (2007), "
        "Radfuehrungen der Strassenfahrzeuge; sizes made for blind trials"
    ),
    port="kinematics",
    parameters=(
        Parameter("scrub", "1", 0.0, 0.05, (-0.25, 0.25), "way to the left of the front right wheel per compression"),
        Parameter("toe", "rad/m", 0.0, 0.06, (-0.4, 0.4), "angle per compression by which it is turned to the left"),
    ),
    symmetric=False,
)


def act(wheel, deflection, scrub, toe):
    if wheel == BENT:
        return 0.0, toe * deflection, scrub
    return 0.0, 0.0, 0.0
