"""Coulomb friction in the struts and joints of the suspension."""

from ridecomfort.effects.contract import Effect, Parameter

SLIDING_SPEED = 0.002
"""m/s over which the force turns with the direction of motion; below the noise of a moving wheel."""

STICKING = 20000.0
"""N s/m; what does not slide is no stiffer damper than this, which a wheel can follow at a step of 1 ms."""

effect = Effect(
    name="suspension_friction",
    sentence=(
        "Struts, seals and joints hold against the motion with a force that does not depend on its speed, "
        "so that small road unevenness passes to the body unsprung."
    ),
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Dixon (2007), The Shock Absorber Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "N", 0.0, 120.0, (0.0, 500.0), "friction force of one front suspension"),
        Parameter("rear", "N", 0.0, 100.0, (0.0, 500.0), "friction force of one rear suspension"),
    ),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    force = front if wheel < 2 else rear
    return force * min(max(velocity / (SLIDING_SPEED + force / STICKING), -1.0), 1.0)
