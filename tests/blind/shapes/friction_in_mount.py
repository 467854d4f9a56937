"""Friction that is felt through rubber."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="friction_in_mount",
    sentence=(
        "A damper's rod sticks in its seals while the rubber of its mount gives way: small quick motion is sprung, and only larger "
        "one rubs."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: damper modules; Yabuta, Hidaka and Fukushima (1981), Effects of suspension "
        "friction on vehicle riding comfort, Vehicle System Dynamics 10:85; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("force", "N", 0.0, 80.0, (0.0, 300.0), "force at which the seals slide"),
        Parameter("stiffness", "N/m", 60000.0, 60000.0, (20000.0, 200000.0), "stiffness of the rubber"),
    ),
    states=("held",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, held, force, rubber):
    stretch = deflection - held
    limit = force / rubber
    slide = 200.0 * (max(stretch - limit, 0.0) + min(stretch + limit, 0.0))
    return rubber * stretch if force > 0.0 else 0.0, slide
