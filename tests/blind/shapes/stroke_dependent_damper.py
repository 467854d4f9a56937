"""Dampers with grooves in the middle of their stroke."""

from ridecomfort.effects.contract import Effect, Parameter

LIMIT = 3.0
"""What the changing share of the damping reaches at most, over that of the linear damper."""

effect = Effect(
    name="stroke_dependent_damper",
    sentence=(
        "Grooves in the tube let oil pass the piston around the place of rest and end towards the ends of the stroke: "
        "small strokes are damped softly and large ones hard, towards the ends as well as back from there."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: stroke-dependent damping by bypass grooves; Lee and Moon (2006), "
        "Simulation and experimental validation of vehicle dynamic characteristics for displacement-sensitive shock "
        "absorber using fluid-flow modelling, Proc. IMechE D 220; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.4, (0.0, 1.0), "share of the damping that changes over the stroke, front"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 1.0), "share of the damping that changes over the stroke, rear"),
        Parameter("width", "m", 0.01, 0.01, (0.005, 0.04), "deflection from rest at which the damping is that of the linear damper"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, width):
    share = front if wheel < 2 else rear
    place = deflection / width
    return share * damping * velocity * (min(place * place, LIMIT) - 1.0)
