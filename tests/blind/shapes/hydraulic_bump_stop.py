"""Hydraulic stops that brake a wheel before its bump stop."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="hydraulic_bump_stop",
    sentence=(
        "A second piston enters a cup at the end of the damper's stroke and presses its oil through ever fewer holes: the "
        "deeper and the faster a wheel is driven in, the harder it is braked; on its way back a check valve sets it free."
    ),
    source=(
        "Dixon (2007), The Shock Absorber Handbook: position-dependent dampers, hydraulic bump stops; progressive hydraulic "
        "cushions as in Citroen's cars since 2017; sizes made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "N s/m", 0.0, 5000.0, (0.0, 25000.0), "damping in bump of a front stop at its full depth"),
        Parameter("rear", "N s/m", 0.0, 5000.0, (0.0, 25000.0), "damping in bump of a rear stop at its full depth"),
        Parameter("gap", "m", 0.006, 0.006, (0.0, 0.05), "compression from rest at which the piston enters the cup"),
        Parameter("depth", "m", 0.025, 0.025, (0.01, 0.06), "further compression at which the last hole is closed"),
    ),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, gap, depth):
    entered = min(max((deflection - gap) / depth, 0.0), 1.0)
    return (front if wheel < 2 else rear) * entered * max(velocity, 0.0)
