"""Tyres that damp with their contact."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="contact_damping",
    sentence=(
        "The more of a tyre lies on the road, the more rubber is bent as it rolls: it damps strongly while it is pressed flat "
        "and hardly while it is light."
    ),
    source=(
        "Hunt and Crossley (1975), Coefficient of restitution interpreted as damping in vibroimpact, Journal of Applied "
        "Mechanics 42:440; Pacejka (2012), Tire and Vehicle Dynamics; made for blind trials"
    ),
    port="tyre_vertical",
    parameters=(
        Parameter("front", "N s/m", 0.0, 5000.0, (-4000.0, 9000.0), "damping that a front tyre gains when its rest deflection doubles"),
        Parameter("rear", "N s/m", 0.0, 5000.0, (-4000.0, 9000.0), "damping that a rear tyre gains when its rest deflection doubles"),
    ),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, front, rear):
    more = min(max(deflection / rest, 0.5), 2.5) - 1.0
    return (front if wheel < 2 else rear) * more * velocity
