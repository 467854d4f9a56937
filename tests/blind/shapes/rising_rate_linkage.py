"""Links whose ratio changes with the travel."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="rising_rate_linkage",
    sentence=(
        "Links swing and struts lean as a wheel rises, so that spring and damper move further for the same travel: in bump "
        "both answer harder, drawn out both answer softer."
    ),
    source=(
        "Milliken and Milliken (1995), Race Car Vehicle Dynamics: installation ratio; Heissing and Ersoy (2011), Chassis "
        "Handbook: spring and damper ratio; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1/m", 0.0, 3.0, (-6.0, 15.0), "change of the ratio of a front strut per compression, relative"),
        Parameter("rear", "1/m", 0.0, 4.0, (-6.0, 15.0), "change of the ratio of a rear strut per compression, relative"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear):
    more = min(max((front if wheel < 2 else rear) * deflection, -0.7), 1.5)
    # Spring along its own way, the preload's part of the rate at rest being in the stiffness already.
    spring = stiffness * deflection * more * (1.5 + 0.5 * more)
    return spring + damping * velocity * more * (2.0 + more)
