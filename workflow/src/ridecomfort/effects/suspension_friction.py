"""Coulomb friction in the struts and joints of the suspension."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

SLIDING_SPEED = 0.002
"""m/s over which the force turns with the direction of motion, at least; below the noise of a moving wheel."""

STICKING = 15000.0
"""N s/m; what does not slide is no stiffer damper than this, which a wheel of 40 kg or more can follow at a step of 2 ms. Against struts that hold
entirely it takes 1 % of a_z (120 N) on rough road, up to a sixth (120 N) and three fifths (500 N) on smooth road or at a walk."""

effect = Effect(
    name="suspension_friction",
    sentence=(
        "Struts, seals and joints hold against the motion with a force that does not depend on its speed, "
        "so that small road unevenness passes to the body unsprung; before they slide they give like springs."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Dixon (2007), The Shock Absorber Handbook; before sliding: "
        "Dahl (1976), Solid friction damping of mechanical vibrations, AIAA Journal 14:1675"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "N", 0.0, 120.0, (0.0, 500.0), "friction force of one front suspension"),
        Parameter("rear", "N", 0.0, 100.0, (0.0, 500.0), "friction force of one rear suspension"),
        Parameter("presliding", "m", 0.0, 0.0, (0.0, 0.002), "motion over which the force turns, at the wheel"),
    ),
    states=("force",),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, force, front, rear, presliding):
    limit = front if wheel < 2 else rear
    turning = max(SLIDING_SPEED, limit / STICKING)
    rigid = limit * min(max(velocity / turning, -1.0), 1.0)
    return lag(rigid, force, presliding / max(abs(velocity), turning))
