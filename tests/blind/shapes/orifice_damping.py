"""Dampers whose force grows with the square of speed."""

from ridecomfort.effects.contract import Effect, Parameter

LIMIT = 4.0
"""Reference speeds beyond which the blow-off valve keeps the damping from growing further."""

effect = Effect(
    name="orifice_damping",
    sentence=(
        "A damper whose oil passes a fixed hole instead of a spring-loaded valve is progressive: its force grows with "
        "the square of speed, so that the slow motion of the body is hardly damped and bumps are passed on hard."
    ),
    source=(
        "Dixon (2007), The Shock Absorber Handbook: orifice flow; Reimpell, Stoll and Betzler (2001), The Automotive "
        "Chassis: progressive damping curve; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.4, (0.0, 1.0), "share of the damping that grows with speed, front"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 1.0), "share of the damping that grows with speed, rear"),
        Parameter("reference", "m/s", 0.15, 0.15, (0.05, 0.5), "speed at which the damping is that of the linear damper"),
    ),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, front, rear, reference):
    share = front if wheel < 2 else rear
    return share * damping * velocity * (min(abs(velocity) / reference, LIMIT) - 1.0)
