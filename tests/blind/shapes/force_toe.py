"""Wheels that turn in or out under the longitudinal force of their tyre."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="force_toe",
    sentence=(
        "Bushings of the links let a wheel toe out when its tyre is held back and in when it drives (elastokinematics): "
        "shocks along the road become side forces."
    ),
    source="Heissing and Ersoy (2011), Chassis Handbook; Reimpell, Stoll and Betzler (2001), The Automotive Chassis: toe change under longitudinal force",
    port="tyre_planar",
    parameters=(
        Parameter("front", "rad/N", 0.0, 5e-6, (0.0, 1.2e-5), "toe-out of one front wheel per force that holds it back"),
        Parameter("rear", "rad/N", 0.0, -2e-6, (-8e-6, 8e-6), "toe-out of one rear wheel per force that holds it back"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, front, rear):
    rate = front if wheel < 2 else rear
    side = 1.0 if wheel % 2 == 0 else -1.0
    return slip_x, slip_y - side * rate * force_x, 0.0
