"""Rubber between damper and body."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.effects.lag import lag

effect = Effect(
    name="top_mount",
    sentence=(
        "A damper pushes the body through a rubber mount: the two in series are a Maxwell element, which damps slow "
        "motion as before and is a mere spring to fast motion."
    ),
    source="Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge; Dixon (2007), The Shock Absorber Handbook",
    port="suspension",
    parameters=(
        Parameter("front", "m/N", 0.0, 2e-6, (0.0, 1e-5), "compliance of one front mount"),
        Parameter("rear", "m/N", 0.0, 2e-6, (0.0, 1e-5), "compliance of one rear mount"),
    ),
    states=("force",),
    order=2,
    also_sees=("damper",),
    also_returns=("damper",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, damper, force, front, rear):
    compliance = front if wheel < 2 else rear
    secant = damper / velocity if velocity != 0.0 else damping
    passed, slope = lag(damper, force, compliance * secant)
    return 0.0, passed, slope
