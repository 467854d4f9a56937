"""Dampers with an inertia valve that opens when the wheel is thrown upwards."""

from ridecomfort.effects.contract import Effect, Parameter

TIME = 0.006
"""s over which the valve follows the motion."""

effect = Effect(
    name="inertia_valve",
    sentence=(
        "A sprung mass in the damper opens a bypass while the wheel is accelerated into compression by more than a threshold: "
        "bumps are taken softly, and the motion of the body, which is slower, is damped in full."
    ),
    source="Dixon (2007), The Shock Absorber Handbook: inertia-sensitive valves; form and sizes made for blind trials",
    port="suspension",
    parameters=(
        Parameter("share", "1", 0.0, 0.5, (0.0, 0.9), "share of the damping in compression that is lost with the valve open"),
        Parameter("threshold", "m/s2", 4.0, 4.0, (1.0, 15.0), "acceleration at which the valve begins to open; at twice it is open"),
    ),
    states=("followed",),
    dissipative=False,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, followed, share, threshold):
    acceleration = (velocity - followed) / TIME
    opened = min(max(acceleration / threshold - 1.0, 0.0), 1.0)
    return -share * damping * opened * max(velocity, 0.0), acceleration
