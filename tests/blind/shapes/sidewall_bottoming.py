"""Low tyres whose sidewalls fold up to the rim."""

from ridecomfort.effects.contract import Effect, Parameter

ONSET = 0.003
"""m of travel over which the contact builds up."""

effect = Effect(
    name="sidewall_bottoming",
    sentence=(
        "The sidewalls of a low tyre fold against the rim, or a run-flat's against themselves, once it is pressed in "
        "beyond a clearance: hard edges then come through much harder than soft ones."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: tyre bottoming, as in MF-Swift; made for blind trials",
    port="tyre_vertical",
    parameters=(
        Parameter("share", "1", 0.0, 1.2, (0.0, 5.0), "stiffness of the contact over the radial stiffness of the tyre"),
        Parameter("clearance", "m", 0.006, 0.006, (0.002, 0.03), "deflection beyond that at rest at which the contact begins"),
    ),
)


def act(wheel, deflection, velocity, stiffness, rest, rotation, spin, share, clearance):
    over = max(deflection - clearance, 0.0)
    return share * stiffness * over * over / (over + ONSET)
